#pragma once

#include "coupling/beetstra.hpp"
#include "coupling/di_felice.hpp"
#include "coupling/ergun_wen_yu.hpp"
#include "coupling/koch_hill.hpp"
#include "coupling/schiller_naumann.hpp"
#include "coupling/wen_yu.hpp"

#include <span>
#include <variant>

namespace mpsdem::coupling {

using AnyDragLaw = std::variant<SchillerNaumann, WenYu, ErgunWenYu, DiFelice, KochHill, Beetstra>;

/// Solids and the liquid around each of them, one entry per solid.
struct ImmersedSolids {
    std::span<const Vec3> liquid_velocity; // [m/s]   u at the solid
    std::span<const Vec3> velocity;        // [m/s]   v
    std::span<const Real> void_fraction;   // [-]     0 < eps <= 1
    std::span<const Real> diameter;        // [m]
    Real kinematic_viscosity;              // [m2/s]
};

/// Drag rate K / m [1/s] of each solid in Model B: the drag's acceleration is (K / m) (u - v).
///
///   K / m = F_A / (eps |r| m) = 18 nu rho_l / (rho_s d^2) force_ratio
///
/// Model B leaves the whole pressure gradient to the liquid, so its drag is F_A / eps and its
/// buoyancy -V rho_l g (Zhou et al. 2010, doi:10.1017/S002211201000306X).
/// `density` is that of each solid [kg/m3].
void drag_rate(const AnyDragLaw& law, const ImmersedSolids& solids, std::span<const Real> density,
               Real liquid_density, std::span<Real> rate);

/// How many solids lie outside the Reynolds numbers and void fractions that the law stands for. It
/// takes a tenth of the time of `drag_rate`.
[[nodiscard]] std::size_t count_outside(const AnyDragLaw& law, const ImmersedSolids& solids);

} // namespace mpsdem::coupling
