#include "linear/two_level.hpp"

#include "linear/coarse_matrix.hpp"

#include <tuple>

namespace mpsdem::linear {

namespace {

CoarseSpace coarse_space(const LaplacianMatrix& matrix, const Cloud& cloud) {
    require(cloud.position.size() == matrix.size(),
            "TwoLevel: position must have one row per row of the matrix");
    return {cloud.position, cloud.particle_spacing, cloud.period};
}

/// Z^T r of one cell.
Real sum_over(std::span<const Index> members, std::span<const Real> r) noexcept {
    Real sum = 0;
    for (const Index i : members) sum += r[i];
    return sum;
}

} // namespace

TwoLevelAdditive::TwoLevelAdditive(const LaplacianMatrix& matrix, const Cloud& cloud, int threads)
    : jacobi_(matrix), space_(coarse_space(matrix, cloud)),
      factor_(coarse_matrix(matrix, space_, threads)), coarse_(space_.size() + 1, 0) {}

void TwoLevelAdditive::follow(const LaplacianMatrix& matrix, std::span<const Vec3> position,
                              int threads) {
    require(position.size() == matrix.size(),
            "TwoLevelAdditive: position must have one row per row of the matrix");
    jacobi_.follow(matrix, threads);
    space_.assign(position, threads);
}

Real TwoLevelAdditive::apply(std::span<const Real> r, std::span<Real> z, int threads) noexcept {
    parallel_for(space_.size(), threads,
                 [&](std::size_t c) { coarse_[c] = sum_over(space_.members(c), r); });
    factor_.solve(std::span(coarse_).first(space_.size()));
    const auto inverse = jacobi_.inverse_diagonal();
    const auto cell = space_.cell();
    return ordered_sum(size(), threads, [&](std::size_t i) {
        z[i] = inverse[i] * r[i] + coarse_[cell[i]];
        return r[i] * z[i];
    });
}

TwoLevelDeflation::TwoLevelDeflation(const LaplacianMatrix& matrix, const Cloud& cloud, int threads)
    : jacobi_(matrix), space_(coarse_space(matrix, cloud)), coarse_(space_.size() + 1, 0) {
    const auto touched = times_indicators(matrix, space_, threads);
    factor_ = EnvelopeCholesky(coarse_matrix(matrix, space_, touched, threads));
    touching_ = transposed(touched, space_.size() + 1);
}

void TwoLevelDeflation::start(const LaplacianMatrix& matrix, std::span<const Real> b,
                              std::span<Real> x, int threads) {
    std::vector<Real> r(size());
    std::ignore = matrix.residual(b, x, r, threads);
    parallel_for(space_.size(), threads,
                 [&](std::size_t c) { coarse_[c] = sum_over(space_.members(c), r); });
    factor_.solve(std::span(coarse_).first(space_.size()));
    const auto cell = space_.cell();
    parallel_for(size(), threads, [&](std::size_t i) { x[i] += coarse_[cell[i]]; });
}

Real TwoLevelDeflation::apply(std::span<const Real> r, std::span<Real> z, int threads) noexcept {
    std::ignore = jacobi_.apply(r, z, threads);
    parallel_for(space_.size(), threads, [&](std::size_t c) {
        Real sum = sum_over(space_.members(c), r);
        for (std::size_t k = touching_.start[c]; k < touching_.start[c + 1]; ++k) {
            sum -= static_cast<Real>(touching_.value[k]) * z[touching_.column[k]];
        }
        coarse_[c] = sum;
    });
    factor_.solve(std::span(coarse_).first(space_.size()));
    const auto cell = space_.cell();
    return ordered_sum(size(), threads, [&](std::size_t i) {
        z[i] += coarse_[cell[i]];
        return r[i] * z[i];
    });
}

} // namespace mpsdem::linear
