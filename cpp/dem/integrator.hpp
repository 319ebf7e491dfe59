#pragma once

#include "dem/population.hpp"

namespace mpsdem::dem {

/// Velocity half of the velocity Verlet step for solid i, over `dt` [s]:
///
///   v <- (v + dt (F/m + a)) / (1 + dt k),   r w <- r w + dt (5/2) (T/r) / m
///
/// k is the drag rate; its part k u of the force stands in `a`, so drag is implicit in v
/// and stable for any k dt. Verlet: Swope et al. (1982) doi:10.1063/1.442716.
///
/// A liquid that responds is driven by b and relaxes to the solids at the rate L = k m / M, where M
/// is the inertia [kg] of the liquid that one solid has to carry along. Both are implicit:
///
///   v = v' + dt k (u - v),  u = u' - dt L (u - v);   v' = v + dt (F/m + a),  u' = u + dt b
///
/// The difference is one equation for the slip r = u - v,
///
///   r = (u' - v') / (1 + dt (k + L)),   v = v' + dt k r,   u = u' - dt L r,
///
/// whose factor lies in (0, 1]: stable and without overshoot for any step. m v + M u changes by
/// m (F/m + a) + M b alone.
template <Medium medium>
[[gnu::always_inline]] inline void kick(Population& p, std::size_t i, Real dt) noexcept {
    using P = Population;
    Real* const solid = p.at(P::X, i);
    const Real inverse_mass = solid[P::INVERSE_MASS];
    Lanes v = load(solid + P::VX) + dt * (inverse_mass * load(solid + P::FX) + load(solid + P::AX));
    if constexpr (medium == Medium::liquid) v *= 1 / (1 + dt * *p.at(P::DRAG, i));
    if constexpr (medium == Medium::responding_liquid) {
        const Real k = *p.at(P::DRAG, i), relaxation = *p.at(P::RELAXATION, i);
        Real *const liquid = p.at(P::UX, i), *const given = p.at(P::JX, i);
        Lanes u = load(liquid) + dt * load(p.at(P::BX, i));
        u[3] = 0; // rates travel there
        const Lanes slip = (1 / (1 + dt * (k + relaxation))) * (u - v);
        const Lanes gain = dt * k * slip;
        v += gain;
        u -= dt * relaxation * slip;
        store(given, load(given) + gain);
        u[3] = k;
        store(liquid, u);
    }
    if constexpr (medium != Medium::dry) {
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
