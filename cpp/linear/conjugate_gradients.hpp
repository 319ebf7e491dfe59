#pragma once

#include "linear/clusters.hpp"

#include <cmath>
#include <concepts>

namespace mpsdem::linear {

/// Applied once an iteration, z = M^-1 r, and once before them: `start` may move the first guess x
/// of A x = b to where the preconditioner needs it.
template <class P>
concept Preconditioner = requires(P& m, const P& constant, const LaplacianMatrix& a,
                                  std::span<const Real> r, std::span<Real> z, int threads) {
    { constant.size() } -> std::same_as<std::size_t>;
    m.start(a, r, z, threads);
    { m.apply(r, z, threads) } noexcept;
};

enum class Outcome {
    converged,
    exhausted, // out of iterations
    broken,    // a value that is not finite, or a matrix or preconditioner that is not definite
};

struct SolveReport {
    Outcome outcome;
    int iterations;
    Real residual; // [-] |b - A x| / |b|, as the recursion has it
};

/// Preconditioned conjugate gradients for A x = b, from the first guess in x.
///
/// Where no Dirichlet part holds a cluster, A x = b is solved for b less its mean there, and x has
/// mean zero there: the constants are projected out of the right-hand side and of every direction.
/// The recursion's residual and the true one part near 1e-12.
template <Preconditioner P>
SolveReport conjugate_gradients(const LaplacianMatrix& a, const Clusters& clusters, P& m,
                                std::span<const Real> right_hand_side, Real tolerance,
                                int max_iterations, int threads, std::span<Real> x) {
    require(right_hand_side.size() == a.size() && x.size() == a.size() && m.size() == a.size(),
            "conjugate_gradients: right_hand_side, start and preconditioner must have one value "
            "per row of the matrix");
    require(tolerance > 0, "conjugate_gradients: tolerance must be > 0");
    require(max_iterations >= 0, "conjugate_gradients: max_iterations must be >= 0");
    constexpr Real round_off = 1e-14; // [-] of the right-hand side, left over from its mean

    std::vector<Real> b(right_hand_side.begin(), right_hand_side.end());
    const Real given = std::sqrt(dot(b, b, threads));
    clusters.remove_means(b, threads);
    const Real size = std::sqrt(dot(b, b, threads));
    if (!std::isfinite(size)) return {Outcome::broken, 0, size};
    if (size <= round_off * given) {
        std::ranges::fill(x, Real{0});
        return {Outcome::converged, 0, 0};
    }

    m.start(a, b, x, threads);
    clusters.remove_means(x, threads);
    std::vector<Real> r(a.size()), p(a.size(), 0), z(a.size());
    Real residual = std::sqrt(a.residual(b, x, r, threads)) / size;
    Real before = 1; // r.z of the iteration before
    for (int iteration = 0;; ++iteration) {
        if (!std::isfinite(residual)) return {Outcome::broken, iteration, residual};
        if (residual <= tolerance) return {Outcome::converged, iteration, residual};
        if (iteration == max_iterations) return {Outcome::exhausted, iteration, residual};

        m.apply(r, z, threads);
        clusters.remove_means(z, threads);
        const Real now = dot(r, z, threads);
        const Real turn = now / before;
        parallel_for(a.size(), threads, [&](std::size_t i) { p[i] = z[i] + turn * p[i]; });
        const std::span<Real> q = z; // A p takes the place of z, which is not needed any more
        const Real energy = a.apply(p, q, threads);
        const Real step = now / energy;
        if (!(now > 0 && energy > 0 && std::isfinite(step))) {
            return {Outcome::broken, iteration, residual};
        }
        residual = std::sqrt(ordered_sum(a.size(), threads,
                                         [&](std::size_t i) {
                                             x[i] += step * p[i];
                                             r[i] -= step * q[i];
                                             return r[i] * r[i];
                                         })) /
                   size;
        before = now;
    }
}

} // namespace mpsdem::linear
