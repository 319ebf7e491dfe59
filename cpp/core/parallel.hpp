#pragma once

#include <omp.h>

#include <cstddef>

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

/// Lanes of one vectorised loop: body(k) for k in [0, N), free of dependences between lanes.
template <int N, class Body>
[[gnu::always_inline]] inline void simd_for(const Body& body) {
#pragma omp simd
    for (int k = 0; k < N; ++k) body(k);
}

[[nodiscard]] inline int available_threads() { return omp_get_max_threads(); }

} // namespace mpsdem
