#pragma once

#include "core/vec3.hpp"

#include <algorithm>
#if defined(__AVX__)
#include <immintrin.h>
#endif

/// One text for scalar and vector arithmetic: a kernel written on `T` runs on Real or on Lanes.
namespace mpsdem {

/// Four in every build: three components of a vector and one number that travels with them fill a
/// register, so a row of a record is loaded at once and four rows turn into columns. Without AVX
/// the compiler splits it into halves.
inline constexpr std::size_t lane_count = 4;

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

/// As many numbers in float32, in double.
[[nodiscard]] [[gnu::always_inline]] inline Lanes widen(const float* from) noexcept {
    using FloatLanes [[gnu::vector_size(lane_count * sizeof(float))]] = float;
    FloatLanes v;
    __builtin_memcpy(&v, from, sizeof v);
    return __builtin_convertvector(v, Lanes);
}
/// Lane k from values[place[k]].
[[nodiscard]] [[gnu::always_inline]] inline Lanes gather(const Real* values,
                                                         const Index* place) noexcept {
    return Lanes{values[place[0]], values[place[1]], values[place[2]], values[place[3]]};
}

/// Four solids' or pairs' rows (x, y, z, w), turned: `v.x` holds the x of all four, and so on.
struct Columns {
    Vector<Lanes> v;
    Lanes w;
};

[[nodiscard]] [[gnu::always_inline]] inline Columns turned(Lanes a, Lanes b, Lanes c,
                                                           Lanes d) noexcept {
    const Lanes ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
    const Lanes cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const Lanes ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Lanes cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    return {{__builtin_shufflevector(ab, cd, 0, 1, 4, 5),
             __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5),
             __builtin_shufflevector(ab, cd, 2, 3, 6, 7)},
            __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7)};
}

/// The way back: row k belongs to solid or pair k, with `w` behind its vector.
struct Rows {
    Lanes row[lane_count];
};

[[nodiscard]] [[gnu::always_inline]] inline Rows turned(const Vector<Lanes>& v,
                                                        Lanes w = Lanes{}) noexcept {
    const Columns r = turned(v.x, v.y, v.z, w);
    return {{r.v.x, r.v.y, r.v.z, r.w}};
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

/// Lane k from values[place[k]].
[[nodiscard]] [[gnu::always_inline]] inline Vector<Lanes> gather(const Vec3* values,
                                                                 const Index* place) noexcept {
    const auto row = [&](std::size_t k) {
        const Vec3& v = values[place[k]];
        return Lanes{v.x, v.y, v.z, 0};
    };
    return turned(row(0), row(1), row(2), row(3)).v;
}

/// The same vector in every lane.
[[nodiscard]] [[gnu::always_inline]] inline Vector<Lanes> broadcast(const Vec3& v) noexcept {
    return {Lanes{} + v.x, Lanes{} + v.y, Lanes{} + v.z};
}

/// Bit k is set where lane k holds.
[[nodiscard]] [[gnu::always_inline]] inline unsigned bits(LaneMask condition) noexcept {
#if defined(__AVX__)
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(condition)));
#else
    unsigned set = 0;
    for (unsigned k = 0; k < lane_count; ++k) set |= (condition[k] & 1u) << k;
    return set;
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
[[nodiscard]] [[gnu::always_inline]] inline Vec3 sum(const Vector<Lanes>& a) noexcept {
    return {sum(a.x), sum(a.y), sum(a.z)};
}

} // namespace mpsdem
