#pragma once

#include "core/check.hpp"
#include "core/ordered_sum.hpp"
#include "linear/float_rows.hpp"

#include <span>
#include <vector>

namespace mpsdem::linear {

/// Symmetric matrix of a weighted graph, with an optional Dirichlet part d >= 0.
///
///   (A x)_i = sum_j w_ij (x_i - x_j) + d_i x_i,   w_ij = w_ji >= 0
///
/// Written with differences, a constant gives exactly zero where d = 0: float32 weights then cost
/// 1e-9 in the solution, while a stored float32 diagonal costs 1e-4 and more in a long pipe.
/// A view: the arrays must outlive it. The entries of unknown i are first[i] ... last[i] - 1; they
/// hold its neighbors, not itself. Rows may have gaps between them.
class LaplacianMatrix {
public:
    LaplacianMatrix() = default;

    /// `first`, `last` (n,); `dirichlet` (n,), or empty for none.
    LaplacianMatrix(std::span<const Index> first, std::span<const Index> last,
                    std::span<const Index> column, std::span<const float> weight,
                    std::span<const Real> dirichlet, int threads) {
        view(first, last, column, weight, dirichlet, threads);
    }

    /// Look at another matrix; the memory of the diagonal is kept.
    void view(std::span<const Index> first, std::span<const Index> last,
              std::span<const Index> column, std::span<const float> weight,
              std::span<const Real> dirichlet, int threads) {
        first_ = first;
        last_ = last;
        column_ = column;
        weight_ = weight;
        dirichlet_ = dirichlet;
        diagonal_.resize(size());
        parallel_for(size(), threads, [&](std::size_t i) {
            const std::size_t count = last_[i] - first_[i];
            diagonal_[i] = row_sum(weight_.data() + first_[i], count) + this->dirichlet(i);
        });
    }

    [[nodiscard]] std::size_t size() const noexcept { return first_.size(); }
    [[nodiscard]] Index first(std::size_t i) const noexcept { return first_[i]; }
    [[nodiscard]] Index last(std::size_t i) const noexcept { return last_[i]; }
    [[nodiscard]] std::span<const Index> column() const noexcept { return column_; }
    [[nodiscard]] std::span<const float> weight() const noexcept { return weight_; }
    [[nodiscard]] Real dirichlet(std::size_t i) const noexcept {
        return dirichlet_.empty() ? 0 : dirichlet_[i];
    }
    /// sum_j w_ij + d_i.
    [[nodiscard]] std::span<const Real> diagonal() const noexcept { return diagonal_; }

    /// y = A x; returns the dot product of x and A x.
    [[nodiscard]] Real apply(std::span<const Real> x, std::span<Real> y,
                             int threads) const noexcept {
        return ordered_sum(size(), threads, [&](std::size_t i) {
            y[i] = times(i, x);
            return x[i] * y[i];
        });
    }

    /// r = b - A x; returns the dot product of r with itself.
    [[nodiscard]] Real residual(std::span<const Real> b, std::span<const Real> x, std::span<Real> r,
                                int threads) const noexcept {
        return ordered_sum(size(), threads, [&](std::size_t i) {
            r[i] = b[i] - times(i, x);
            return r[i] * r[i];
        });
    }

private:
    [[nodiscard]] Real times(std::size_t i, std::span<const Real> x) const noexcept {
        const Real here = x[i];
        Lanes lanes{};
        std::size_t k = first_[i];
        const std::size_t last = last_[i];
        for (; k + lane_count <= last; k += lane_count) {
            lanes += widen(&weight_[k]) * (here - gather(x.data(), &column_[k]));
        }
        Real sum = mpsdem::sum(lanes) + dirichlet(i) * here;
        for (; k < last; ++k) sum += static_cast<Real>(weight_[k]) * (here - x[column_[k]]);
        return sum;
    }

    std::span<const Index> first_, last_;
    std::span<const Index> column_;
    std::span<const float> weight_;
    std::span<const Real> dirichlet_;
    std::vector<Real> diagonal_;
};

/// Refuse arrays that are no rows of a square matrix.
inline void require_rows(std::span<const Index> row, std::span<const Index> column,
                         std::span<const float> weight, std::span<const Real> dirichlet) {
    require(!row.empty(), "LaplacianMatrix: row must have shape (n + 1,)");
    require(row.front() == 0 && row.back() == column.size() && std::ranges::is_sorted(row),
            "LaplacianMatrix: row must rise from 0 to the number of columns");
    require(std::ranges::all_of(column, [n = row.size() - 1](Index j) { return j < n; }),
            "LaplacianMatrix: column must be less than the number of rows");
    require(weight.size() == column.size(),
            "LaplacianMatrix: weight must have one value per column");
    require(dirichlet.empty() || dirichlet.size() == row.size() - 1,
            "LaplacianMatrix: dirichlet must have one value per row");
}

} // namespace mpsdem::linear
