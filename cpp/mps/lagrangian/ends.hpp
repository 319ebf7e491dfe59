#pragma once

#include "mps/kind.hpp"
#include "mps/lagrangian/axial_bins.hpp"

#include <array>
#include <span>
#include <vector>

namespace mpsdem::mps::lagrangian {

/// A plate at the entrance that pushes the liquid, and an outlet that lets it go.
///
/// The plate works upstream of the pipe, so that the bore from 0 to L is always full. Its face
/// moves from -(stroke + settling) to -settling and jumps back by the stroke. The outlet is a
/// stretch of the pipe behind L where p' = 0 and the liquid keeps its velocity: liquid at L has all
/// its neighbors. What passes its end is dropped.
struct PushPlate {
    Real velocity; // [m/s] > 0, of the plate
    Real stroke;   // [m]
    Real settling; // [m] left between plate and bore, renewed with the gap at each return
    Real outlet;   // [m] length of that stretch
    /// Which slab fills a gap, and how far it is turned: shares of what is possible and of a turn,
    /// in [0, 1), in order and then from the first again.
    std::vector<std::array<Real, 2>> draws;
};

/// A particle that comes to be.
struct Entrant {
    Vec3 position, velocity; // [m], [m/s]
    Real pressure;           // [Pa]
};

/// What fills the gap behind a plate that has jumped back.
struct Refill {
    std::vector<Entrant> entrants;
    std::size_t crowded = 0; // left out, nearer than half a spacing to others
};

/// The ends of the pipe: periodic, or a plate and an outlet. What the liquid has to ask, and what
/// of them changes.
class Ends {
public:
    /// Periodic over `pipe_length`.
    explicit Ends(Real pipe_length) : pipe_length_(pipe_length), plate_{} {}
    /// `full` [1/m]: liquid particles for each metre of a full pipe.
    Ends(Real pipe_length, const PushPlate& plate, Real full);

    [[nodiscard]] bool periodic() const noexcept { return plate_.draws.empty(); }
    /// [m] along x, 0 for none.
    [[nodiscard]] Real period() const noexcept { return periodic() ? pipe_length_ : 0; }
    /// Whether liquid moves by its forces: all but what has passed the outlet.
    [[nodiscard]] bool inside(const Vec3& x) const noexcept {
        return periodic() || x.x < pipe_length_;
    }
    /// Whether it is in the bore, and counts in its means.
    [[nodiscard]] bool in_bore(const Vec3& x) const noexcept {
        return periodic() || (x.x >= 0 && x.x < pipe_length_);
    }
    /// Whether it has left for good.
    [[nodiscard]] bool beyond(const Vec3& x) const noexcept {
        return !periodic() && x.x >= pipe_length_ + plate_.outlet;
    }
    /// Bins of about `width` [m] over all that is inside.
    [[nodiscard]] AxialBins bins(Real width) const {
        return {periodic() ? 0 : face_, pipe_length_, width, periodic()};
    }
    [[nodiscard]] Real plate_velocity() const noexcept { return plate_.velocity; } // [m/s]
    [[nodiscard]] Real face() const noexcept { return face_; } // [m] of the plate

    /// Go on with the plate for dt [s].
    void advance(Real dt) noexcept { face_ += dt * plate_.velocity; }
    /// Whether the plate has reached the end of its stroke.
    [[nodiscard]] bool stroke_done() const noexcept {
        return !periodic() && face_ >= -plate_.settling;
    }
    /// Up to where the gap behind the plate reaches when it jumps back [m]; liquid in it goes.
    [[nodiscard]] Real seam() const noexcept {
        return plate_.settling > 0 ? std::max(Real{0}, face_) : face_;
    }
    /// Jump back, and fill the gap with a slab of the bore's own liquid, shifted and turned.
    [[nodiscard]] Refill jump_back(std::span<const Vec3> position, std::span<const Vec3> velocity,
                                   std::span<const Real> pressure, std::span<const Kind> kind,
                                   std::size_t most, Real spacing);

    /// All that changes.
    [[nodiscard]] std::vector<Real> state() const;
    void restore(std::span<const Real> state);

private:
    Real pipe_length_; // [m]
    PushPlate plate_;
    Real full_ = 0;           // [1/m]
    Real face_ = 0;           // [m]
    Real owed_ = 0;           // [-] particles that the bore falls short of with a gap just full
    std::size_t returns_ = 0; // [-]
};

} // namespace mpsdem::mps::lagrangian
