#pragma once

#include "core/field.hpp"
#include "mps/eulerian/axial.hpp"

/// What the liquid carries with it, -(u . grad) u, at the inner nodes of one chunk of stations; and
/// on the way |S|, as the gradients are there.
namespace mpsdem::mps::eulerian {

/// Where a sweep writes: the acceleration [m/s2] and |S|^2 [1/s2].
struct Carried {
    VectorField& acceleration;
    Field& strain;
};

/// How much of the speed along the pipe counts for the damping across it, besides the speed across
/// [-]. A straight flow has no speed across, so nothing else damps what the scattered nodes'
/// pressure feeds: without it laminar flow is unstable from a cell Reynolds number U dx / nu of 50.
/// The damping vanishes for quadratics, so for Poiseuille flow, but not for a log law: there it
/// costs a seventh of the friction factor, and eddy viscosity needs no help.
struct CrossDamping {
    Real share;
};
inline constexpr CrossDamping laminar_damping{0.2};
inline constexpr CrossDamping turbulent_damping{0};

/// Along the pipe: fourth-order differences, damped by |u| dx^3 / 12 d^4/dx^4 as third-order upwind
/// differences are.
[[nodiscard]] [[gnu::always_inline]] inline Lanes
carried_along(const Axial& axial, Lanes speed, const Real* f, Lanes& slope) noexcept {
    slope = axial.first(f);
    return speed * slope + abs(speed) * axial.damping(f);
}

} // namespace mpsdem::mps::eulerian
