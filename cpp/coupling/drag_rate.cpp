#include "coupling/drag_rate.hpp"

#include "core/check.hpp"

#include <algorithm>

namespace mpsdem::coupling {

namespace {

bool positive(std::span<const Real> values) {
    return std::ranges::all_of(values, [](Real x) { return x > 0; });
}

void check(const ImmersedSolids& solids) {
    const std::size_t n = solids.velocity.size();
    require(solids.liquid_velocity.size() == n && solids.void_fraction.size() == n &&
                solids.diameter.size() == n,
            "drag: liquid_velocity, velocity, void_fraction and diameter must have one row per "
            "solid");
    require(std::ranges::all_of(solids.void_fraction, [](Real x) { return x > 0 && x <= 1; }),
            "drag: void_fraction must lie in (0, 1]");
    require(positive(solids.diameter), "drag: diameter must be > 0 m");
    require(solids.kinematic_viscosity > 0, "drag: kinematic_viscosity must be > 0 m2/s");
}

Real reynolds(const ImmersedSolids& solids, std::size_t i) noexcept {
    const Real slip = norm(solids.liquid_velocity[i] - solids.velocity[i]);
    return solids.void_fraction[i] * slip * solids.diameter[i] / solids.kinematic_viscosity;
}

} // namespace

void drag_rate(const AnyDragLaw& any, const ImmersedSolids& solids, std::span<const Real> density,
               Real liquid_density, std::span<Real> rate) {
    check(solids);
    require(density.size() == solids.velocity.size(), "drag: density must have one row per solid");
    require(positive(density), "drag: density must be > 0 kg/m3");
    require(liquid_density > 0, "drag: liquid_density must be > 0 kg/m3");
    std::visit(
        [&](const DragLaw auto& law) {
            for (std::size_t i = 0; i < rate.size(); ++i) {
                const Real d = solids.diameter[i];
                const Real stokes =
                    18 * solids.kinematic_viscosity * liquid_density / (density[i] * d * d);
                rate[i] = stokes * law.force_ratio(reynolds(solids, i), solids.void_fraction[i]);
            }
        },
        any);
}

std::size_t count_outside(const AnyDragLaw& any, const ImmersedSolids& solids) {
    check(solids);
    return std::visit(
        [&](const DragLaw auto& law) {
            std::size_t count = 0;
            for (std::size_t i = 0; i < solids.velocity.size(); ++i) {
                if (!law.covers(reynolds(solids, i), solids.void_fraction[i])) ++count;
            }
            return count;
        },
        any);
}

} // namespace mpsdem::coupling
