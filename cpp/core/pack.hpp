#pragma once

#include "core/lanes.hpp"

#include <array>
#include <bit>
#include <cstdint>

/// Eight numbers in float32 at once, and how to keep some of them next to each other.
namespace mpsdem {

inline constexpr std::size_t octet_count = 8;

using FloatOctet [[gnu::vector_size(octet_count * sizeof(float))]] = float;
using IndexOctet [[gnu::vector_size(octet_count * sizeof(Index))]] = Index;
using OctetMask = decltype(FloatOctet{} < FloatOctet{});

[[nodiscard]] [[gnu::always_inline]] inline FloatOctet load_octet(const float* from) noexcept {
    FloatOctet v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}

[[nodiscard]] [[gnu::always_inline]] inline IndexOctet load_indices(const Index* from) noexcept {
    IndexOctet v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}

/// Bit k is set where number k holds.
[[nodiscard]] [[gnu::always_inline]] inline unsigned bits(OctetMask condition) noexcept {
#if defined(__AVX__)
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(condition)));
#else
    unsigned set = 0;
    for (unsigned k = 0; k < octet_count; ++k)
        set |= (static_cast<unsigned>(condition[k]) & 1u) << k;
    return set;
#endif
}

#if defined(__AVX2__)
static_assert(sizeof(Index) == sizeof(float));

/// For each set of 8 the places that bring its members to the front.
inline constexpr auto places_to_front = [] {
    std::array<std::array<std::uint8_t, octet_count>, 256> places{};
    for (std::size_t set = 0; set < 256; ++set) {
        std::size_t next = 0;
        for (std::size_t k = 0; k < octet_count; ++k) {
            if ((set >> k & 1) != 0) places[set][next++] = static_cast<std::uint8_t>(k);
        }
    }
    return places;
}();
#endif

/// Write those of eight indices and eight numbers whose bit in `kept` is set to where `index` and
/// `value` point, rubbish behind them up to octet_count; return how many.
[[gnu::always_inline]] inline std::size_t pack(const Index* from, FloatOctet numbers, unsigned kept,
                                               Index* index, float* value) noexcept {
#if defined(__AVX2__)
    const __m256i move = _mm256_cvtepu8_epi32(
        _mm_loadl_epi64(reinterpret_cast<const __m128i*>(places_to_front[kept].data())));
    const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(index), _mm256_permutevar8x32_epi32(all, move));
    _mm256_storeu_ps(value, _mm256_permutevar8x32_ps(reinterpret_cast<__m256>(numbers), move));
#else
    std::size_t next = 0;
    for (std::size_t k = 0; k < octet_count; ++k) {
        index[next] = from[k];
        value[next] = numbers[k];
        next += kept >> k & 1;
    }
#endif
    return static_cast<std::size_t>(std::popcount(kept));
}

} // namespace mpsdem
