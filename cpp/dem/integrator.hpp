#pragma once

#include "core/lanes.hpp"
#include "dem/population.hpp"

namespace mpsdem::dem {

/// Velocity half of the velocity Verlet step, for a register of solids, over `dt` [s]:
///
///   v <- (v + dt (F/m + a)) / (1 + dt k),   r w <- r w + dt (5/2) (T/r) / m
///
/// k is the drag rate; its part k u of the force stands in `a`, so drag is implicit in v
/// and stable for any k dt. Verlet: Swope et al. (1982) doi:10.1063/1.442716.
template <Medium medium>
[[gnu::always_inline]] inline void kick(Real* solid, Real dt) noexcept {
    using P = Population;
    const Lanes inverse_mass = load(solid + P::INVERSE_MASS * lanes);
    const Lanes damping =
        medium == Medium::liquid ? 1 / (1 + dt * load(solid + P::DRAG * lanes)) : Lanes{};
    for (std::size_t d = 0; d < 3; ++d) {
        const auto at = [=](P::Field f) { return solid + (f + d) * lanes; };
        Lanes v = load(at(P::VX)) + dt * (load(at(P::FX)) * inverse_mass + load(at(P::AX)));
        if constexpr (medium == Medium::liquid) {
            v *= damping;
            store(at(P::PX), load(at(P::PX)) + dt * v);
        }
        store(at(P::VX), v);
        store(at(P::SX), load(at(P::SX)) + (2.5 * dt) * (load(at(P::TX)) * inverse_mass));
    }
}

/// Position half: x <- x + dt v; forces and torques are cleared for the new positions. Returns the
/// squared speed relative to `frame` [m2/s2].
[[gnu::always_inline]] inline Lanes drift(Real* solid, Real dt, const Vec3& frame) noexcept {
    using P = Population;
    const Real offset[3] = {frame.x, frame.y, frame.z};
    Lanes speed2{};
    for (std::size_t d = 0; d < 3; ++d) {
        const auto at = [=](P::Field f) { return solid + (f + d) * lanes; };
        const Lanes v = load(at(P::VX));
        store(at(P::X), load(at(P::X)) + dt * v);
        store(at(P::FX), Lanes{});
        store(at(P::TX), Lanes{});
        const Lanes relative = v - offset[d];
        speed2 += relative * relative;
    }
    return speed2;
}

/// Velocity half for the solids [begin, end), both on whole tiles.
template <Medium medium>
void kick(Population& p, std::size_t begin, std::size_t end, Real dt) noexcept {
    for (std::size_t i = begin; i < end; i += lane_count)
        kick<medium>(p.values() + Population::place(i), dt);
}

/// Velocity half over `kick_time`, then position half over `dt`, in one pass. Returns the largest
/// squared speed relative to `frame` [m2/s2], which bounds how far any pair can close.
template <Medium medium>
[[nodiscard]] Real kick_and_drift(Population& p, std::size_t begin, std::size_t end, Real kick_time,
                                  Real dt, Vec3 frame) noexcept {
    Lanes fastest2{};
    for (std::size_t i = begin; i < end; i += lane_count) {
        Real* solid = p.values() + Population::place(i);
        kick<medium>(solid, kick_time);
        fastest2 = max(fastest2, drift(solid, dt, frame));
    }
    return largest(fastest2);
}

} // namespace mpsdem::dem
