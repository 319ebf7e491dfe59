#pragma once

#include "core/lanes.hpp"

#include <array>
#include <bit>

/// Keep some of a register's worth of indices, and write them next to each other.
namespace mpsdem {

/// Bit k is set where lane k of the condition holds.
[[nodiscard]] [[gnu::always_inline]] inline unsigned bits(LaneMask condition) noexcept {
#if defined(__AVX512F__)
    return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(condition),
                                  reinterpret_cast<__m512i>(condition));
#elif defined(__AVX__)
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(condition)));
#else
    return (condition[0] != 0 ? 1U : 0U) | (condition[1] != 0 ? 2U : 0U);
#endif
}

#if defined(__AVX__) && !defined(__AVX512F__)
namespace detail {

/// For each set of 4 lanes the bytes that bring its members to the front.
inline constexpr auto to_front = [] {
    std::array<std::array<std::uint8_t, 16>, 16> bytes{};
    for (std::size_t set = 0; set < 16; ++set) {
        std::size_t next = 0;
        for (std::size_t lane = 0; lane < 4; ++lane) {
            if ((set >> lane & 1) == 0) continue;
            for (std::size_t b = 0; b < 4; ++b)
                bytes[set][next++] = static_cast<std::uint8_t>(4 * lane + b);
        }
    }
    return bytes;
}();

} // namespace detail
#endif

/// Write those of from[0 .. lane_count) whose bit in `kept` is set to out[0 ...], rubbish behind
/// them up to lane_count; return how many.
[[gnu::always_inline]] inline std::size_t pack(const Index* from, unsigned kept,
                                               Index* out) noexcept {
#if defined(__AVX512F__) && defined(__AVX512VL__)
    const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out),
                        _mm256_maskz_compress_epi32(static_cast<__mmask8>(kept), all));
#elif defined(__AVX__) && !defined(__AVX512F__)
    const __m128i all = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
    const __m128i move =
        _mm_loadu_si128(reinterpret_cast<const __m128i*>(detail::to_front[kept].data()));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out), _mm_shuffle_epi8(all, move));
#else
    std::size_t next = 0;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
        out[next] = from[lane];
        next += kept >> lane & 1;
    }
#endif
    return static_cast<std::size_t>(std::popcount(kept));
}

} // namespace mpsdem
