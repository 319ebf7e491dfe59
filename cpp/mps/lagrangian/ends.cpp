#include "mps/lagrangian/ends.hpp"

#include "core/check.hpp"
#include "mps/divergence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mpsdem::mps::lagrangian {

namespace {

constexpr Real crowded = 0.5; // [-] spacings nearer than which no particle is put to another

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

Vec3 turned(const Vec3& v, Real cosine, Real sine) noexcept {
    return {v.x, cosine * v.y - sine * v.z, sine * v.y + cosine * v.z};
}

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
    owed_ += full_ * length;
    const auto count =
        std::min({static_cast<std::size_t>(std::max(std::round(owed_), 0.)), most, source.size()});
    owed_ -= static_cast<Real>(count);
    if (count < 2) return refill;

    // So many particles in a row, spread over the gap's length: within a percent, their own.
    const auto first =
        static_cast<std::size_t>(start * static_cast<Real>(source.size() - count + 1));
    const auto slab = std::span(source).subspan(first, count);
    const Real low = position[slab.front()].x;
    const Real extent = position[slab.back()].x - low;
    const Real between = extent / static_cast<Real>(count - 1);
    const Real stretch = length / (extent + between);
    const Real cosine = std::cos(2 * std::numbers::pi * turn);
    const Real sine = std::sin(2 * std::numbers::pi * turn);

    std::vector<Vec3> beside; // what is there already next to the seam
    for (std::size_t i = 0; i < position.size(); ++i) {
        const Real ahead = position[i].x - seam;
        if (kind[i] == Kind::liquid && ahead >= 0 && ahead < crowded * spacing)
            beside.push_back(position[i]);
    }
    for (const Index i : slab) {
        Vec3 x = turned(position[i], cosine, sine);
        x.x = face_ + std::max(stretch * (x.x - low + between / 2), nearest_liquid * spacing);
        const bool near =
            x.x > seam - crowded * spacing && std::ranges::any_of(beside, [&](const Vec3& other) {
                return dot(other - x, other - x) < crowded * crowded * spacing * spacing;
            });
        if (near)
            ++refill.crowded;
        else
            refill.entrants.push_back({x, turned(velocity[i], cosine, sine), pressure[i]});
    }
    owed_ += static_cast<Real>(refill.crowded);
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
