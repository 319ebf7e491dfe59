#pragma once

#include "linear/clusters.hpp"

#include <cmath>
#include <concepts>

namespace mpsdem::linear {

/// Applied once an iteration: z = M^-1 r, returning the dot product of r and z. Once before them,
/// `start` may move the first guess x of A x = b to where the preconditioner needs it.
template <class P>
concept Preconditioner = requires(P& m, const P& constant, const LaplacianMatrix& a,
                                  std::span<const Real> r, std::span<Real> z, int threads) {
    { constant.size() } -> std::same_as<std::size_t>;
    m.start(a, r, z, threads);
    { m.apply(r, z, threads) } noexcept -> std::same_as<Real>;
};

[[nodiscard]] inline Real dot(std::span<const Real> a, std::span<const Real> b, int threads) {
    return ordered_sum(a.size(), threads, [&](std::size_t i) { return a[i] * b[i]; });
}

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

/// [-] Below, what rounding has left of constants in the residual of a floating cluster would grow.
inline constexpr Real least_tolerance = 1e-13;

/// Memory of a solve, kept from one to the next.
struct Workspace {
    std::vector<Real> b, r, p, z;
};

/// Preconditioned conjugate gradients for A x = b, from the first guess in x.
///
/// Where no Dirichlet part holds a cluster, A x = b is solved for b less its mean there, and x has
/// mean zero there: the constants, to which A is blind, are projected out of b and out of x.
/// The recursion's residual and the true one part near 1e-12.
template <Preconditioner P>
SolveReport conjugate_gradients(const LaplacianMatrix& a, const Clusters& clusters, P& m,
                                std::span<const Real> right_hand_side, Real tolerance,
                                int max_iterations, int threads, std::span<Real> x,
                                Workspace& workspace) {
    require(right_hand_side.size() == a.size() && x.size() == a.size() && m.size() == a.size(),
            "conjugate_gradients: right_hand_side, start and preconditioner must have one value "
            "per row of the matrix");
    require(tolerance >= least_tolerance,
            "conjugate_gradients: tolerance must be >= 1e-13, below which round-off rules");
    require(max_iterations >= 0, "conjugate_gradients: max_iterations must be >= 0");
    constexpr Real round_off = 1e-14; // [-] of the right-hand side, left over from its mean

    auto& [b, r, p, z] = workspace;
    b.assign(right_hand_side.begin(), right_hand_side.end());
    const Real given = std::sqrt(dot(b, b, threads));
    clusters.remove_means(b, threads);
    const Real size = std::sqrt(dot(b, b, threads));
    if (!std::isfinite(size)) return {Outcome::broken, 0, size};
    if (size <= round_off * given) {
        std::ranges::fill(x, Real{0});
        return {Outcome::converged, 0, 0};
    }

    clusters.remove_means(x, threads);
    m.start(a, b, x, threads);
    r.resize(a.size());
    z.resize(a.size());
    p.assign(a.size(), 0);
    const std::span<Real> q = z; // A p takes the place of z once p is made of it
    Real residual = std::sqrt(a.residual(b, x, r, threads)) / size;
    Real before = 1; // r.z of the iteration before
    for (int iteration = 0;; ++iteration) {
        const auto end = [&](Outcome outcome) {
            clusters.remove_means(x, threads);
            return SolveReport{outcome, iteration, residual};
        };
        if (!std::isfinite(residual)) return end(Outcome::broken);
        if (residual <= tolerance) return end(Outcome::converged);
        if (iteration == max_iterations) return end(Outcome::exhausted);

        const Real now = m.apply(r, z, threads);
        const Real turn = now / before;
        parallel_for(a.size(), threads, [&](std::size_t i) { p[i] = z[i] + turn * p[i]; });
        const Real energy = a.apply(p, q, threads);
        const Real step = now / energy;
        if (!(now > 0 && energy > 0 && std::isfinite(step))) return end(Outcome::broken);
        const auto advance = [&](std::size_t i) {
            x[i] += step * p[i];
            r[i] -= step * q[i];
            return r[i] * r[i];
        };
        residual = std::sqrt(ordered_sum(a.size(), threads, advance)) / size;
        before = now;
    }
}

} // namespace mpsdem::linear
