#pragma once

#include "core/lanes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mpsdem::coupling {

/// Weight that spreads a solid over the liquid around it.
///
///   W_s(r) = 4 q^5 - 5 q^4 + 1,  q = r / r_s;  0 from r_s on
///
/// Flat at the centre and at the edge, so a solid enters and leaves a neighborhood smoothly.
struct SmoothingKernel {
    Real radius; // [m] r_s

    template <class T>
    [[nodiscard]] [[gnu::always_inline]] T operator()(T r) const noexcept {
        const T q = select(r < radius, r / radius, T{} + 1);
        const T q4 = q * q * q * q;
        return (4 * q - 5) * q4 + 1;
    }

    /// Integral of W_s over the cone of one steradian up to r [m3]: int_0^r W_s s^2 ds.
    [[nodiscard]] Real within(Real r) const noexcept {
        const Real q = std::min(r / radius, Real{1});
        const Real q3 = q * q * q;
        return radius * radius * radius * q3 * (1. / 3 - q * q3 * (5. / 7 - q / 2));
    }

    /// Integral of W_s over all space [m3]: 10 pi r_s^3 / 21.
    [[nodiscard]] Real integral() const noexcept { return 4 * std::numbers::pi * within(radius); }
};

} // namespace mpsdem::coupling
