#pragma once

#include "linear/laplacian_matrix.hpp"

namespace mpsdem::linear {

/// Connected clusters of unknowns. A cluster without a Dirichlet part floats: the matrix determines
/// its solution up to a constant only, and a right-hand side has a solution only if it sums to zero
/// there. An isolated unknown (zero diagonal) is a floating cluster of one.
class Clusters {
public:
    explicit Clusters(const LaplacianMatrix& matrix);

    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] std::size_t floating_count() const noexcept { return start_.size() - 1; }
    /// Unknowns of a floating cluster, ascending.
    [[nodiscard]] std::span<const Index> floating(std::size_t c) const noexcept {
        return std::span(member_).subspan(start_[c], start_[c + 1] - start_[c]);
    }

    /// Subtract from `v` its mean over each floating cluster.
    void remove_means(std::span<Real> v, int threads) const noexcept;

private:
    std::size_t count_ = 0;
    std::vector<Index> start_{0}; // (floating clusters + 1,)
    std::vector<Index> member_;
};

} // namespace mpsdem::linear
