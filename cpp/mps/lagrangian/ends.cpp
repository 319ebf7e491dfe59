#include "mps/lagrangian/ends.hpp"

#include "core/check.hpp"
#include "mps/divergence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mpsdem::mps::lagrangian {

namespace {

constexpr Real owed_share = 0.25; // [-] of what the bore is short of, added to every later filling
constexpr int turns_tried = 8;    // [-] of a slab
constexpr Real crowded = 0.5;     // [-] spacings nearer than which no particle is put to another

/// The liquid of the bore, from the entrance to the outlet.
std::vector<Index> along_the_bore(const Ends& ends, std::span<const Vec3> position,
                                  std::span<const Kind> kind) {
    std::vector<Index> order;
    for (std::size_t i = 0; i < position.size(); ++i)
        if (kind[i] == Kind::liquid && ends.in_bore(position[i]))
            order.push_back(static_cast<Index>(i));
    std::ranges::stable_sort(order, {}, [&](Index i) { return position[i].x; });
    return order;
}

/// A turn about the axis of the pipe.
class Turn {
public:
    explicit Turn(Real share)
        : cosine_(std::cos(2 * std::numbers::pi * share)),
          sine_(std::sin(2 * std::numbers::pi * share)) {}
    /// Of a vector, with x in place of its own.
    [[nodiscard]] Vec3 operator()(const Vec3& v, Real x) const noexcept {
        return {x, cosine_ * v.y - sine_ * v.z, sine_ * v.y + cosine_ * v.z};
    }

private:
    Real cosine_, sine_;
};

} // namespace

Ends::Ends(Real pipe_length, const PushPlate& plate, Real full)
    : pipe_length_(pipe_length), plate_(plate), full_(full),
      face_(-(plate.stroke + plate.settling)) {
    require(plate.velocity > 0, "PushPlate: velocity must be > 0 m/s");
    require(plate.stroke > 0, "PushPlate: stroke must be > 0 m");
    require(plate.settling >= 0, "PushPlate: settling must be >= 0 m");
    require(plate.outlet > 0, "PushPlate: outlet must be > 0 m");
    require(plate.stroke + plate.settling <= pipe_length,
            "PushPlate: stroke and settling together must be at most the pipe's length");
    require(!plate.draws.empty(), "PushPlate: draws must not be empty");
    for (const auto& draw : plate.draws)
        for (const Real share : draw)
            require(share >= 0 && share < 1, "PushPlate: draws must lie in [0, 1)");
}

Refill Ends::jump_back(std::span<const Vec3> position, std::span<const Vec3> velocity,
                       std::span<const Real> pressure, std::span<const Kind> kind, std::size_t most,
                       Real spacing) {
    Refill refill;
    const Real seam = this->seam();
    face_ -= plate_.stroke;
    const auto [start, turn] = plate_.draws[returns_++ % plate_.draws.size()];
    const auto source = along_the_bore(*this, position, kind);
    const Real length = seam - face_;
    // What has come into the bore of late: where it is short, as next to the seam no particle may
    // be near to another, the gap gets the more.
    const Real look = std::min(2 * plate_.stroke, pipe_length_ - seam);
    const auto came = std::ranges::count_if(
        source, [&](Index i) { return position[i].x >= seam && position[i].x < seam + look; });
    owed_ += owed_share * (full_ * look - static_cast<Real>(came));
    const Real wanted = std::round(full_ * length + owed_);
    const auto count =
        std::min({static_cast<std::size_t>(std::max(wanted, 0.)), most, source.size()});
    if (count < 2) return refill;

    // So many particles in a row, spread over the gap's length: within a percent, their own.
    const auto first =
        static_cast<std::size_t>(start * static_cast<Real>(source.size() - count + 1));
    const auto slab = std::span(source).subspan(first, count);
    const Real low = position[slab.front()].x;
    const Real extent = position[slab.back()].x - low;
    const Real between = extent / static_cast<Real>(count - 1);
    const Real stretch = length / (extent + between);
    std::vector<Vec3> beside; // what is there already next to the seam
    for (std::size_t i = 0; i < position.size(); ++i) {
        const Real ahead = position[i].x - seam;
        if (kind[i] == Kind::liquid && ahead >= 0 && ahead < crowded * spacing)
            beside.push_back(position[i]);
    }
    const auto place = [&](Index i, const Turn& by) {
        const Real x = stretch * (position[i].x - low + between / 2);
        return by(position[i], face_ + std::max(x, nearest_liquid * spacing));
    };
    const auto near = [&](const Vec3& x) {
        return x.x > seam - crowded * spacing && std::ranges::any_of(beside, [&](const Vec3& y) {
                   return dot(y - x, y - x) < crowded * crowded * spacing * spacing;
               });
    };
    // Of some turns the one that leaves out the fewest.
    Turn best(turn);
    refill.crowded = count + 1;
    for (int k = 0; k < turns_tried; ++k) {
        const Turn by(turn + static_cast<Real>(k) / turns_tried);
        const auto out = static_cast<std::size_t>(
            std::ranges::count_if(slab, [&](Index i) { return near(place(i, by)); }));
        if (out >= refill.crowded) continue;
        refill.crowded = out;
        best = by;
    }
    for (const Index i : slab) {
        const Vec3 x = place(i, best);
        if (!near(x)) refill.entrants.push_back({x, best(velocity[i], velocity[i].x), pressure[i]});
    }
    return refill;
}

std::vector<Real> Ends::state() const {
    return {face_, owed_, static_cast<Real>(returns_)};
}

void Ends::restore(std::span<const Real> state) {
    require(state.size() == 3, "restore: the snapshot belongs to another liquid");
    face_ = state[0];
    owed_ = state[1];
    returns_ = static_cast<std::size_t>(state[2]);
}

} // namespace mpsdem::mps::lagrangian
