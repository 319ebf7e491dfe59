#pragma once

#include "core/parallel.hpp"
#include "core/vec3.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace mpsdem {

/// Sum of term(i) for i in [0, n), in an order that depends on n alone: blocks, each of a few
/// independent chains. `term` may also write what belongs to index i.
template <class Value = Real, class Term>
[[nodiscard]] Value ordered_sum(std::size_t n, int threads, const Term& term) {
    constexpr std::size_t most_blocks = 256, block_size = 1024, chains = 8;
    const std::size_t blocks = std::min(most_blocks, n / block_size + 1);
    std::array<Value, most_blocks> partial{};
    parallel_for(blocks, threads, [&](std::size_t b) {
        std::array<Value, chains> sum{};
        std::size_t i = n * b / blocks;
        const std::size_t last = n * (b + 1) / blocks;
        for (; i + chains <= last; i += chains) {
            for (std::size_t k = 0; k < chains; ++k) sum[k] += term(i + k);
        }
        for (std::size_t k = 0; i < last; ++i, ++k) sum[k] += term(i);
        partial[b] = std::accumulate(sum.begin(), sum.end(), Value{});
    });
    return std::accumulate(partial.begin(), partial.begin() + blocks, Value{});
}

} // namespace mpsdem
