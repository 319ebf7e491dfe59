#pragma once

#include "coupling/drag_law.hpp"

#include <cmath>

namespace mpsdem::coupling {

/// One smooth law from a packed bed to a lone sphere.
///
///   F_A   = (1/8) C_d rho pi d^2 eps^2 |r| r eps^-chi
///   C_d   = (0.63 + 4.8 / sqrt(Re))^2
///   chi   = 3.7 - 0.65 exp(-(1.5 - log10 Re)^2 / 2)
///   ratio = (0.63 sqrt(Re) + 4.8)^2 / 24 eps^-chi
///
/// Source: Di Felice (1994), doi:10.1016/0301-9322(94)90011-6, with Dallavalle's C_d. Re 0.01 to
/// 1e4, void fractions 0.4 to 1. For a lone sphere it is 10 % high at Re 10 and up to 35 % at 1000.
struct DiFelice {
    [[nodiscard]] Real force_ratio(Real reynolds, Real void_fraction) const noexcept {
        const Real root = 0.63 * std::sqrt(reynolds) + 4.8;
        const Real s = 1.5 - std::log10(reynolds); // infinite at Re = 0, where chi is 3.7
        const Real chi = 3.7 - 0.65 * std::exp(-s * s / 2);
        return root * root / 24 * std::pow(void_fraction, -chi);
    }
    [[nodiscard]] bool covers(Real reynolds, Real void_fraction) const noexcept {
        return void_fraction >= 0.4 && reynolds >= 0.01 && reynolds <= 1e4;
    }
};
static_assert(DragLaw<DiFelice>);

} // namespace mpsdem::coupling
