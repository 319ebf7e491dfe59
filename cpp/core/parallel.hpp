#pragma once

#include <cstddef>
#include <omp.h>

/// The only file that knows OpenMP. A parallel body writes its own index only and sums are ordered
/// by the caller, so results do not depend on the number of threads.
namespace mpsdem {

/// One compiled text of a loop for one thread and for many: two copies may round differently, as a
/// compiler fuses multiplications and additions at will.
template <class Body>
[[gnu::noinline]] void for_range(std::size_t first, std::size_t last, const Body& body) {
    for (std::size_t i = first; i < last; ++i) body(i);
}

/// Run body(i) for i in [0, n), on the team's threads when `threads` > 1.
template <class Body>
void parallel_for(std::size_t n, int threads, const Body& body) {
    if (threads <= 1 || n <= 1) {
        for_range(0, n, body);
        return;
    }
    const auto parts = static_cast<std::size_t>(threads);
#pragma omp parallel for num_threads(threads) schedule(static, 1)
    for (std::size_t p = 0; p < parts; ++p) for_range(n * p / parts, n * (p + 1) / parts, body);
}

/// Run body(b) for few, uneven pieces of work, each on whichever thread is free.
template <class Body>
void parallel_for_blocks(std::size_t n, int threads, const Body& body) {
    if (threads <= 1 || n <= 1) {
        for (std::size_t b = 0; b < n; ++b) body(b);
        return;
    }
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
    for (std::size_t b = 0; b < n; ++b) body(b);
}

[[nodiscard]] inline int available_threads() {
    return omp_get_max_threads();
}

} // namespace mpsdem
