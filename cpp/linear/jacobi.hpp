#pragma once

#include "linear/laplacian_matrix.hpp"

namespace mpsdem::linear {

/// z = D^-1 r. An isolated unknown (zero diagonal) stays zero. Iterations grow with the length of a
/// pipe in particle spacings.
class Jacobi {
public:
    explicit Jacobi(const LaplacianMatrix& matrix) : inverse_(matrix.size()) {
        std::ranges::transform(matrix.diagonal(), inverse_.begin(),
                               [](Real d) { return d == 0 ? 0 : 1 / d; });
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
