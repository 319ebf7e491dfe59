#pragma once

#include "core/vec3.hpp"

#include <algorithm>
#if defined(__AVX__)
#include <immintrin.h>
#endif

/// One text for scalar and vector arithmetic: a kernel written on `T` runs on Real or on Lanes.
namespace mpsdem {

#if defined(__AVX512F__)
inline constexpr std::size_t lane_count = 8;
#elif defined(__AVX__)
inline constexpr std::size_t lane_count = 4;
#else
inline constexpr std::size_t lane_count = 2;
#endif

/// As many reals as one register of this machine holds.
using Lanes [[gnu::vector_size(lane_count * sizeof(Real))]] = Real;
using LaneMask = decltype(Lanes{} < Lanes{});

[[nodiscard]] [[gnu::always_inline]] inline Lanes load(const Real* from) noexcept {
    Lanes v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}

[[gnu::always_inline]] inline void store(Real* to, Lanes v) noexcept {
    __builtin_memcpy(to, &v, sizeof v);
}

/// Lane k from values[place[k]].
[[nodiscard]] [[gnu::always_inline]] inline Lanes gather(const Real* values,
                                                         const Index* place) noexcept {
    Lanes v;
    for (std::size_t k = 0; k < lane_count; ++k) v[k] = values[place[k]];
    return v;
}

[[nodiscard]] inline Real sqrt(Real a) noexcept {
    return std::sqrt(a);
}
[[nodiscard]] [[gnu::always_inline]] inline Lanes sqrt(Lanes a) noexcept {
    for (std::size_t k = 0; k < lane_count; ++k) a[k] = std::sqrt(a[k]);
    return a;
}

[[nodiscard]] inline Real select(bool condition, Real yes, Real no) noexcept {
    return condition ? yes : no;
}
[[nodiscard]] [[gnu::always_inline]] inline Lanes select(LaneMask condition, Lanes yes,
                                                         Lanes no) noexcept {
    return condition ? yes : no;
}

[[nodiscard]] [[gnu::always_inline]] inline bool any(LaneMask condition) noexcept {
#if defined(__AVX512F__)
    return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(condition),
                                  reinterpret_cast<__m512i>(condition)) != 0;
#elif defined(__AVX__)
    return _mm256_movemask_pd(reinterpret_cast<__m256d>(condition)) != 0;
#else
    return (condition[0] | condition[1]) != 0;
#endif
}

[[nodiscard]] inline Real max(Real a, Real b) noexcept {
    return a > b ? a : b;
}
[[nodiscard]] [[gnu::always_inline]] inline Lanes max(Lanes a, Lanes b) noexcept {
    return a > b ? a : b;
}

template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T abs(T a) noexcept {
    return max(a, -a);
}

[[nodiscard]] [[gnu::always_inline]] inline Lanes norm(const Vector<Lanes>& a) noexcept {
    return sqrt(dot(a, a));
}

/// `v` where the condition holds, else zero.
template <class T, class Condition>
[[nodiscard]] [[gnu::always_inline]] inline Vector<T> masked(Condition condition,
                                                             const Vector<T>& v) noexcept {
    return {select(condition, v.x, T{}), select(condition, v.y, T{}), select(condition, v.z, T{})};
}

[[nodiscard]] [[gnu::always_inline]] inline Real largest(Lanes a) noexcept {
    Real most = a[0];
    for (std::size_t k = 1; k < lane_count; ++k) most = std::max(most, static_cast<Real>(a[k]));
    return most;
}

[[nodiscard]] [[gnu::always_inline]] inline Real sum(Lanes a) noexcept {
    Real total = a[0];
    for (std::size_t k = 1; k < lane_count; ++k) total += a[k];
    return total;
}

} // namespace mpsdem
