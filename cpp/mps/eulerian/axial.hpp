#pragma once

#include "core/lanes.hpp"

#include <numbers>
#include <vector>

namespace mpsdem::mps::eulerian {

/// Differences along the pipe, between stations `spacing` apart.
struct Axial {
    Real spacing; // [m]

    /// Fourth-order central first difference [1/m].
    [[nodiscard]] [[gnu::always_inline]] Lanes first(const Real* f) const noexcept {
        return (1 / (12 * spacing)) *
               (8 * (load(f + 1) - load(f - 1)) - (load(f + 2) - load(f - 2)));
    }
    /// dx^3 / 12 d^4 f / dx^4 [1/m]: with |u| before it, the damping of the third-order upwind
    /// difference.
    [[nodiscard]] [[gnu::always_inline]] Lanes damping(const Real* f) const noexcept {
        return (1 / (12 * spacing)) *
               (load(f + 2) + load(f - 2) - 4 * (load(f + 1) + load(f - 1)) + 6 * load(f));
    }
    /// What the fourth-order second difference makes of each wave, over the wave [1/m2], <= 0.
    [[nodiscard]] std::vector<Real> second_symbol(std::size_t stations) const {
        std::vector<Real> symbol(stations / 2 + 1);
        for (std::size_t m = 0; m < symbol.size(); ++m) {
            const Real angle =
                2 * std::numbers::pi * static_cast<Real>(m) / static_cast<Real>(stations);
            symbol[m] =
                (32 * std::cos(angle) - 2 * std::cos(2 * angle) - 30) / (12 * spacing * spacing);
        }
        return symbol;
    }
};

} // namespace mpsdem::mps::eulerian
