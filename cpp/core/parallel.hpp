#pragma once

#include <cstddef>
#include <omp.h>

/// The only file that knows OpenMP. A parallel body writes its own index only and sums are ordered
/// by the caller, so results do not depend on the number of threads.
namespace mpsdem {

/// Run body(i) for i in [0, n), on the team's threads when `threads` > 1.
template <class Body>
void parallel_for(std::size_t n, int threads, const Body& body) {
    if (threads <= 1 || n <= 1) {
        for (std::size_t i = 0; i < n; ++i) body(i);
        return;
    }
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::size_t i = 0; i < n; ++i) body(i);
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
