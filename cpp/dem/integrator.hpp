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
///
/// Added mass, c = C_m rho_liquid / rho_solid, adds c (du/dt - dv/dt) to the solid's acceleration
/// and takes it from the liquid: with r0 the slip before, both exchange j per mass of the solid,
///
///   j = dt k r + c (r - r0),  v = v' + j,  u = u' - (m/M) j,   m/M = L/k (0 without drag)
///   r = (u' - v' + (1 + m/M) c r0) / (1 + dt (k + L) + (1 + m/M) c)
///
/// Implicit, so stable for any ratio of densities, where a force from the last acceleration is not
/// once c (1 + m/M) > 1. Force: Auton, Hunt & Prud'homme (1988) doi:10.1017/S0022112088003246.
template <Medium medium>
[[gnu::always_inline]] inline void kick(Population& p, std::size_t i, Real dt) noexcept {
    using P = Population;
    Real* const solid = p.at(P::X, i);
    const Real inverse_mass = solid[P::INVERSE_MASS];
    Lanes v = load(solid + P::VX) + dt * (inverse_mass * load(solid + P::FX) + load(solid + P::AX));
    if constexpr (medium == Medium::liquid) v *= 1 / (1 + dt * *p.at(P::DRAG, i));
    if constexpr (medium == Medium::responding_liquid) {
        const Real k = *p.at(P::DRAG, i), relaxation = *p.at(P::RELAXATION, i);
        const Real added_mass = *p.at(P::ADDED_MASS, i), per_inertia = k > 0 ? relaxation / k : 0;
        const Real held = (1 + per_inertia) * added_mass;
        Real *const liquid = p.at(P::UX, i), *const given = p.at(P::JX, i);
        const Lanes u0 = load(liquid), slip0 = u0 - load(solid + P::VX);
        Lanes u = u0 + dt * load(p.at(P::BX, i));
        const Lanes slip = (1 / (1 + dt * (k + relaxation) + held)) * (u - v + held * slip0);
        const Lanes by_added_mass = added_mass * (slip - slip0);
        Lanes gain = dt * k * slip + by_added_mass;
        u -= dt * relaxation * slip + per_inertia * by_added_mass;
        gain[3] = 0; // numbers that travel with vectors stand there
        u[3] = k;
        v += gain;
        store(liquid, u);
        store(given, load(given) + gain);
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
