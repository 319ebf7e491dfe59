#pragma once

#include "coupling/wen_yu.hpp"

namespace mpsdem::coupling {

/// Ergun's packed bed up to a void fraction of 0.8, Wen & Yu's suspension above.
///
///   beta  = 150 (1 - eps)^2 mu / (eps d^2) + 1.75 (1 - eps) rho |r| / d     eps <= 0.8
///   F_A   = beta V r / (1 - eps)
///   ratio = (150 (1 - eps) + 1.75 Re) / (18 eps^2)
///
/// Sources: Ergun (1952), Chem. Eng. Prog. 48, 89-94 (no DOI); the combination is that of
/// Ding & Gidaspow (1990), doi:10.1002/aic.690360404, whence its other name, Gidaspow's law. The
/// reference paper of the horizontal pipe has it in eqs. 16 to 19, with the same switch, C_d and
/// Reynolds number, without a misprint. Ergun's data: void fractions 0.36 to 0.8 here,
/// Re / (1 - eps) up to 2500 (the viscous limit holds to 0). Deviation from nature: at the switch
/// the drag falls at once, by a factor of 1.1 at Re 1, 1.7 at Re 100 and 3.7 at Re 1000.
struct ErgunWenYu {
    static constexpr Real switch_void_fraction = 0.8; // [-]

    [[nodiscard]] Real force_ratio(Real reynolds, Real void_fraction) const noexcept {
        if (void_fraction > switch_void_fraction) {
            return suspension.force_ratio(reynolds, void_fraction);
        }
        return (150 * (1 - void_fraction) + 1.75 * reynolds) / (18 * void_fraction * void_fraction);
    }
    [[nodiscard]] bool covers(Real reynolds, Real void_fraction) const noexcept {
        if (void_fraction > switch_void_fraction) return suspension.covers(reynolds, void_fraction);
        return void_fraction >= 0.36 && reynolds <= 2500 * (1 - void_fraction);
    }

private:
    static constexpr WenYu suspension{};
};
static_assert(DragLaw<ErgunWenYu>);

} // namespace mpsdem::coupling
