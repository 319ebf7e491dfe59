#pragma once

#include "coupling/drag_law.hpp"

#include <cmath>

namespace mpsdem::coupling {

inline constexpr Real newton_regime = 1000;   // [-] Reynolds number above which C_d is constant
inline constexpr Real newton_drag = 0.44;     // [-] C_d there
inline constexpr Real drag_crisis = 2e5;      // [-] Reynolds number where C_d falls
inline constexpr Real isolated_sphere = 0.99; // [-] void fraction above which neighbors are far

/// Drag of one sphere over Stokes's, C_d Re / 24, with
///
///   C_d = 24 / Re (1 + 0.15 Re^0.687)   Re < 1000
///       = 0.44                          above
///
/// Source: Schiller & Naumann (1933), Z. Ver. Dtsch. Ing. 77, 318-320 (no DOI); Newton's regime as
/// in Wen & Yu (1966). Within 5 % of measurements below Re 800, within 15 % to the drag crisis.
/// C_d rises by 0.4 % at the switch.
[[nodiscard]] inline Real sphere_drag_over_stokes(Real reynolds) noexcept {
    return reynolds < newton_regime ? 1 + 0.15 * std::pow(reynolds, 0.687)
                                    : newton_drag / 24 * reynolds;
}

/// An isolated sphere: the force depends on the slip alone, whatever the void fraction.
///
///   F_A / eps = 3 pi mu d r (1 + 0.15 Re_0^0.687)   Re_0 = |r| d / nu
///
/// In Model B, whose drag is F_A / eps, neighbors then change nothing at all.
struct SchillerNaumann {
    [[nodiscard]] Real force_ratio(Real reynolds, Real void_fraction) const noexcept {
        return sphere_drag_over_stokes(reynolds / void_fraction);
    }
    [[nodiscard]] bool covers(Real reynolds, Real void_fraction) const noexcept {
        return void_fraction >= isolated_sphere && reynolds / void_fraction <= drag_crisis;
    }
};
static_assert(DragLaw<SchillerNaumann>);

} // namespace mpsdem::coupling
