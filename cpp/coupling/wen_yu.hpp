#pragma once

#include "coupling/schiller_naumann.hpp"

namespace mpsdem::coupling {

/// A sphere of a fluidised suspension.
///
///   beta  = (3/4) C_d eps (1 - eps) rho |r| / d eps^-2.65,   F_A = beta V r / (1 - eps)
///   ratio = C_d Re / 24 eps^-3.65
///
/// with the C_d of `sphere_drag_over_stokes` at the superficial Reynolds number.
/// Source: Wen & Yu (1966), Chem. Eng. Prog. Symp. Ser. 62, 100-111 (no DOI), in the form of
/// Ding & Gidaspow (1990), doi:10.1002/aic.690360404. Fitted to liquid-fluidised beds: void
/// fractions from 0.45 to 1.
struct WenYu {
    [[nodiscard]] Real force_ratio(Real reynolds, Real void_fraction) const noexcept {
        return sphere_drag_over_stokes(reynolds) * std::pow(void_fraction, -3.65);
    }
    [[nodiscard]] bool covers(Real reynolds, Real void_fraction) const noexcept {
        return void_fraction >= 0.45 && reynolds <= drag_crisis;
    }
};
static_assert(DragLaw<WenYu>);

} // namespace mpsdem::coupling
