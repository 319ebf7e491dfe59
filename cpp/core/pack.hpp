#pragma once

#include "core/lanes.hpp"

#include <array>
#include <bit>

/// Keep some of a register's worth of indices, and write them next to each other.
namespace mpsdem {

#if defined(__AVX__)
static_assert(lane_count == 4 && sizeof(Index) == 4);

/// For each set of 4 lanes the bytes that bring its members to the front.
inline constexpr auto bytes_to_front = [] {
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
#endif

/// Write those of from[0 .. lane_count) whose bit in `kept` is set to out[0 ...], rubbish behind
/// them up to lane_count; return how many.
[[gnu::always_inline]] inline std::size_t pack(const Index* from, unsigned kept,
                                               Index* out) noexcept {
#if defined(__AVX__)
    const __m128i all = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
    const __m128i move =
        _mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes_to_front[kept].data()));
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
