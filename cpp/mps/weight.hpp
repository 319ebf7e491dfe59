#pragma once

#include "core/vec3.hpp"

namespace mpsdem::mps {

inline constexpr Real dimensions = 3; // d [-]

/// How much a neighbor counts.
///
///   W(r) = r_e / (0.85 r + 0.15 r_e) - 1    r < r_e,   else 0
///
/// Bounded at r = 0 (W = 5.67), so that close particles do not dominate a sum.
/// Source: Zhang, Wan & Hino (2014), doi:10.1016/S1001-6058(14)60065-8.
struct Weight {
    Real effective_radius; // [m] r_e

    [[nodiscard]] Real operator()(Real r) const noexcept {
        const Real inside = 0.85 * (effective_radius - r);
        return inside > 0 ? inside / (0.85 * r + 0.15 * effective_radius) : 0;
    }
    /// W / r^2 [1/m2] from r^2, the factor of the first-order operators; 0 for points in one
    /// place, whose pair has no direction. One division, for speed.
    [[nodiscard]] Real over_square(Real square) const noexcept {
        const Real r = std::sqrt(square);
        const Real inside = 0.85 * (effective_radius - r);
        return inside > 0 && r > 0 ? inside / ((0.85 * r + 0.15 * effective_radius) * square) : 0;
    }
};

} // namespace mpsdem::mps
