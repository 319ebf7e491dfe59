#pragma once

#include "core/lanes.hpp"

/// Rows stored in float32 and summed in double: half the traffic, the full sum.
namespace mpsdem::linear {

using mpsdem::widen;

[[nodiscard]] [[gnu::always_inline]] inline Lanes widen(const Real* from) noexcept {
    return load(from);
}

/// Sum of a contiguous row.
[[nodiscard]] inline Real row_sum(const float* a, std::size_t n) noexcept {
    Lanes lanes{};
    std::size_t k = 0;
    for (; k + lane_count <= n; k += lane_count) lanes += widen(a + k);
    Real total = sum(lanes);
    for (; k < n; ++k) total += static_cast<Real>(a[k]);
    return total;
}

/// Dot product of two contiguous rows.
template <class A, class B>
[[nodiscard]] inline Real row_dot(const A* a, const B* b, std::size_t n) noexcept {
    Lanes even{}, odd{};
    std::size_t k = 0;
    for (; k + 2 * lane_count <= n; k += 2 * lane_count) {
        even += widen(a + k) * widen(b + k);
        odd += widen(a + k + lane_count) * widen(b + k + lane_count);
    }
    Real total = sum(even + odd);
    for (; k < n; ++k) total += static_cast<Real>(a[k]) * static_cast<Real>(b[k]);
    return total;
}

} // namespace mpsdem::linear
