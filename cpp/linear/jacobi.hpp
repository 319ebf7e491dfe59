#pragma once

#include "linear/laplacian_matrix.hpp"

namespace mpsdem::linear {

/// z = D^-1 r. An isolated unknown (zero diagonal) stays zero. Iterations grow with the length of a
/// pipe in particle spacings.
class Jacobi {
public:
    explicit Jacobi(const LaplacianMatrix& matrix) { follow(matrix, 1); }

    /// Take another matrix; memory is kept.
    void follow(const LaplacianMatrix& matrix, int threads) {
        inverse_.resize(matrix.size());
        const auto diagonal = matrix.diagonal();
        parallel_for(size(), threads,
                     [&](std::size_t i) { inverse_[i] = diagonal[i] == 0 ? 0 : 1 / diagonal[i]; });
    }

    [[nodiscard]] std::size_t size() const noexcept { return inverse_.size(); }
    [[nodiscard]] std::span<const Real> inverse_diagonal() const noexcept { return inverse_; }

    void start(const LaplacianMatrix&, std::span<const Real>, std::span<Real>, int) {}

    [[nodiscard]] Real apply(std::span<const Real> r, std::span<Real> z, int threads) noexcept {
        return ordered_sum(size(), threads, [&](std::size_t i) {
            z[i] = inverse_[i] * r[i];
            return r[i] * z[i];
        });
    }

private:
    std::vector<Real> inverse_;
};

} // namespace mpsdem::linear
