#pragma once

#include "dem/population.hpp"

namespace mpsdem::dem {

/// Velocity half of the velocity Verlet step for solid i, over `dt` [s]:
///
///   v <- (v + dt (F/m + a)) / (1 + dt k),   r w <- r w + dt (5/2) (T/r) / m
///
/// k is the drag rate; its part k u of the force stands in `a`, so drag is implicit in v
/// and stable for any k dt. Verlet: Swope et al. (1982) doi:10.1063/1.442716.
template <Medium medium>
[[gnu::always_inline]] inline void kick(Population& p, std::size_t i, Real dt) noexcept {
    using P = Population;
    Real* const solid = p.at(P::X, i);
    const Real inverse_mass = solid[P::INVERSE_MASS];
    Lanes v = load(solid + P::VX) + dt * (inverse_mass * load(solid + P::FX) + load(solid + P::AX));
    if constexpr (medium == Medium::liquid) {
        v *= 1 / (1 + dt * *p.at(P::DRAG, i));
        Real* const moved = p.at(P::PX, i);
        store(moved, load(moved) + dt * v);
    }
    store(solid + P::VX, v);
    store(solid + P::SX, load(solid + P::SX) + (2.5 * dt * inverse_mass) * load(solid + P::TX));
}

/// Velocity half for the solids [begin, end).
template <Medium medium>
void kick(Population& p, std::size_t begin, std::size_t end, Real dt) noexcept {
    for (std::size_t i = begin; i < end; ++i) kick<medium>(p, i, dt);
}

/// Velocity half over `kick_time`, then position half over `dt`, in one pass; forces and torques
/// are cleared for the new positions. Returns the largest squared speed relative to `frame`
/// [m2/s2], which bounds how far any pair can close.
template <Medium medium>
[[nodiscard]] Real kick_and_drift(Population& p, std::size_t begin, std::size_t end, Real kick_time,
                                  Real dt, Vec3 frame) noexcept {
    using P = Population;
    const Lanes offset{frame.x, frame.y, frame.z, 0};
    Real fastest2 = 0;
    for (std::size_t i = begin; i < end; ++i) {
        kick<medium>(p, i, kick_time);
        Real* const solid = p.at(P::X, i);
        const Lanes v = load(solid + P::VX);
        store(solid + P::X, load(solid + P::X) + dt * v);
        store(solid + P::FX, Lanes{});
        store(solid + P::TX, Lanes{});
        const Lanes relative = v - offset;
        fastest2 = max(fastest2, sum(relative * relative));
    }
    return fastest2;
}

} // namespace mpsdem::dem
