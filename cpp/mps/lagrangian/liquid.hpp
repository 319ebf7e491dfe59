#pragma once

#include "geometry/cylinder.hpp"
#include "linear/conjugate_gradients.hpp"
#include "linear/two_level.hpp"
#include "mps/kind.hpp"
#include "mps/reference_density.hpp"
#include "mps/turbulence.hpp"
#include "mps/wall_function.hpp"
#include "neighbors/neighbor_list.hpp"

#include <optional>
#include <span>
#include <vector>

namespace mpsdem::mps::lagrangian {

enum class Flow { laminar, turbulent };

/// What drives the liquid along the pipe.
struct Drive {
    Real bulk_velocity;                    // [m/s] held each step, unless a gradient is given;
                                           //       scales the background pressure in any case
    std::optional<Real> pressure_gradient; // [Pa/m] loss along the pipe, given
};

/// Numbers of the method, with the values that held in long pipes.
struct Numerics {
    Real particle_spacing;      // [m]
    Real courant = 0.8;         // [-] largest speed * step / spacing
    Real tolerance = 1e-3;      // [-] of the pressure equation's residual
    Real background = 0.02;     // [-] p_b over rho U^2
    Real shift = 0.25;          // [-] of the spacing squared, times the gradient of concentration,
                                //     for each spacing that the fastest liquid goes
    Real pressure_limit = 0.25; // [-] largest |p'| over rho U^2; beyond it, clamped and counted
    int threads = 1;
};

/// What a call of Liquid::advance met, over its substeps.
struct AdvanceReport {
    int substeps = 0;
    int iterations = 0;      // of the pressure equation, all substeps
    int retries = 0;         // pressure solves that had to start anew
    int halvings = 0;        // substeps halved after a failed solve
    Real residual = 0;       // [-] largest
    Real mean_gradient = 0;  // [Pa/m] loss of pressure along the pipe, mean over the call
    Real friction = 0;       // [Pa/m] that walls and viscosity take up, mean over the call
    Real unexplained = 0;    // [Pa/m] of the axial momentum: what p' does, and in a pipe must not
    std::size_t clamped = 0; // pressures cut to the limit
    std::size_t viscosity_capped = 0; // eddy viscosities cut to what the step can bear
    std::size_t shifts_cut = 0;       // shifts cut to their longest
    std::size_t deficient = 0;        // particles whose neighbors fix no Laplacian: no viscosity
    std::size_t held_back = 0; // particles kept from going nearer to the wall than 0.3 spacings
    Real solve_seconds = 0;    // [s] in the pressure equation, set-up included
    bool sound = true;         // false: the pressure could not be solved, or speeds overflowed
};

/// The particle liquid of a full, straight, rigid, periodic pipe: MPS proper.
///
/// A step finds the neighbors once and takes every operator there:
///
///   u* = u + dt (viscous acceleration + wall shear)
///   lap p' = (rho / dt) div u*      slip wall; less its mean and its axial long-wave bias
///   u  = u* - dt / rho grad p' + dt G / rho x^
///   x  <- x + dt u + shift
///
/// p' is what is left of the pressure when every uniform acceleration and the mean axial gradient G
/// are split off: in a full rigid pipe these move nothing, so gravity does not enter at all.
/// Stable where it was measured, but dissipative: of the kinetic energy of a swirl of 0.1 U at a
/// Reynolds number of 2e5, 45, 19 and 12 % are left after 5, 10 and 15 R/U at ten spacings across,
/// 33, 13 and 8 % at sixteen. It is a liquid of the mean flow, not of its eddies. Laminar flow has
/// no such damping: from a Reynolds number of a few hundred on a swirl lives on, at 2000 it
/// diverges.
///
/// Sources: Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205; shifting after Xu, Stansby &
/// Laurence (2009), doi:10.1016/j.jcp.2009.05.032.
class Liquid {
public:
    /// Particles as `ring_layout` or `lattice_layout` places them; velocity of the walls is zero.
    Liquid(std::span<const Vec3> position, std::span<const Vec3> velocity,
           std::span<const Kind> kind, const geometry::Cylinder& wall, Real pipe_radius,
           Real pipe_length, Real density, Real kinematic_viscosity, Real roughness, Flow flow,
           const Drive& drive, const Numerics& numerics);

    /// Advance by dt [s], in as many equal substeps as the Courant number and viscosity ask for.
    AdvanceReport advance(Real dt);

    /// Drive the liquid otherwise from now on.
    void drive(const Drive& drive) { drive_ = drive; }

    /// The liquid's own particles, without wall and ghosts, in one order.
    [[nodiscard]] std::vector<Vec3> liquid_position() const; // [m]
    [[nodiscard]] std::vector<Vec3> liquid_velocity() const; // [m/s]
    [[nodiscard]] Real pipe_length() const noexcept { return pipe_length_; }

    [[nodiscard]] std::size_t size() const noexcept { return position_.size(); }
    [[nodiscard]] std::size_t liquid_count() const noexcept { return liquid_count_; }
    [[nodiscard]] std::vector<Vec3> position() const; // [m] in the order they were given
    [[nodiscard]] std::vector<Vec3> velocity() const; // [m/s]
    [[nodiscard]] std::vector<Kind> kind() const;
    [[nodiscard]] std::vector<Real> pressure() const;      // [Pa] p'
    [[nodiscard]] std::vector<Real> density_ratio() const; // [-] n / mean n, of the last step
    [[nodiscard]] Real bulk_velocity() const;              // [m/s] mean of the particles
    [[nodiscard]] Real pressure_gradient() const noexcept { return gradient_; } // [Pa/m] last step
    [[nodiscard]] Real wall_shear() const noexcept { return wall_shear_; }      // [Pa] mean
    [[nodiscard]] Real kinetic_energy() const;                                  // [J/kg] per mass
    [[nodiscard]] Real density_scatter() const; // [-] standard deviation over the mean
    [[nodiscard]] Real pressure_noise() const noexcept {
        return pressure_noise_;
    } // [Pa] rms change

    /// Exact state; restoring it continues bit-equal.
    struct Snapshot {
        std::vector<Vec3> position, velocity;
        std::vector<Real> pressure;
        std::vector<std::int8_t> kind;
        std::vector<Index> id;
    };
    [[nodiscard]] Snapshot snapshot() const;
    void restore(const Snapshot& snapshot);

private:
    [[nodiscard]] Real fastest() const; // [m/s]
    [[nodiscard]] Real stable_step() const;
    [[nodiscard]] bool step(Real dt, AdvanceReport& report);
    void sort();
    void predict(Real dt, AdvanceReport& report);
    [[nodiscard]] std::vector<Vec3> of_liquid(const std::vector<Vec3>& values) const;
    void add_wall_shear();
    [[nodiscard]] bool solve_pressure(AdvanceReport& report);
    void take_pressure(AdvanceReport& report);
    void assemble(Real dt);
    void remove_axial_bias();
    void correct(Real dt);
    void move(Real dt, AdvanceReport& report);

    geometry::Cylinder wall_;
    Real pipe_radius_, pipe_length_; // [m]
    Real density_;                   // [kg/m3]
    Real viscosity_;                 // [m2/s] kinematic
    Flow flow_;
    Drive drive_;
    Numerics numerics_;
    ReferenceDensity reference_;
    WallFunction wall_function_;
    MixingLength mixing_length_;
    neighbors::NeighborList neighbors_;
    std::size_t liquid_count_ = 0;

    std::vector<Vec3> position_, velocity_;
    std::vector<Kind> kind_;
    std::vector<Real> pressure_; // [Pa] p'; of a ghost, its neighbors' on the wall
    std::vector<Index> id_;

    std::vector<std::uint8_t> deficient_;
    std::vector<Vec3> acceleration_, shift_;
    std::vector<Real> scalar_, eddy_viscosity_, density_number_;
    std::vector<Index> unknown_;  // by particle, or none for ghosts
    std::vector<Index> particle_; // by unknown
    std::vector<Index> row_, column_;
    std::vector<float> weight_;
    std::vector<Real> right_hand_side_, solution_;
    std::vector<Vec3> unknown_position_;
    std::optional<linear::TwoLevelAdditive> preconditioner_;

    Real gradient_ = 0, friction_ = 0, unexplained_ = 0, wall_shear_ = 0, pressure_noise_ = 0;
};

} // namespace mpsdem::mps::lagrangian
