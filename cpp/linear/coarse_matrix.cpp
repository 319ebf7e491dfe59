#include "linear/coarse_matrix.hpp"

#include "linear/disjoint_sets.hpp"

namespace mpsdem::linear {

namespace {

Real dirichlet(const LaplacianMatrix& matrix, std::span<const Index> unknowns) noexcept {
    return std::accumulate(unknowns.begin(), unknowns.end(), Real{0},
                           [&](Real sum, Index i) { return sum + matrix.dirichlet(i); });
}

void pin_floating_sets(const LaplacianMatrix& matrix, const CoarseSpace& space,
                       SparseRows<Real>& coarse) {
    const auto n = static_cast<Index>(coarse.size());
    DisjointSets sets(n);
    for (Index c = 0; c < n; ++c) {
        for (std::size_t k = coarse.start[c]; k < coarse.start[c + 1]; ++k) {
            if (coarse.value[k] != 0 && coarse.column[k] < n) sets.join(c, coarse.column[k]);
        }
    }
    std::vector<char> held(n, 0);
    std::vector<Index> last(n, 0);
    for (Index c = 0; c < n; ++c) {
        const Index set = sets.find(c);
        last[set] = c;
        if (dirichlet(matrix, space.members(c)) != 0) held[set] = 1;
    }
    for (Index c = 0; c < n; ++c) {
        if (sets.find(c) != c || held[c] != 0) continue;
        for (std::size_t k = coarse.start[last[c]]; k < coarse.start[last[c] + 1]; ++k) {
            if (coarse.column[k] != last[c]) continue;
            coarse.value[k] = coarse.value[k] == 0 ? 1 : 2 * coarse.value[k];
        }
    }
}

/// Add the off-diagonal entries of A in one row to the columns of their cells.
void add_row(const LaplacianMatrix& matrix, std::span<const Index> cell, Index i, SparseSum& sum) {
    const Index* const column = matrix.column().data();
    const float* const weight = matrix.weight().data();
    sum.add(matrix.first(i), matrix.last(i), [=](std::size_t k) {
        return std::pair(cell[column[k]], -static_cast<Real>(weight[k]));
    });
}

} // namespace

SparseRows<float> times_indicators(const LaplacianMatrix& matrix, const CoarseSpace& space,
                                   int threads) {
    const auto cell = space.cell();
    return sum_rows<float>(matrix.size(), space.size() + 1, threads, [&](Index i, SparseSum& sum) {
        add_row(matrix, cell, i, sum);
        sum.balance(cell[i], matrix.dirichlet(i));
    });
}

SparseRows<Real> coarse_matrix(const LaplacianMatrix& matrix, const CoarseSpace& space,
                               int threads) {
    const auto cell = space.cell();
    auto coarse =
        sum_rows<Real>(space.size(), space.size() + 1, threads, [&](Index c, SparseSum& sum) {
            for (const Index i : space.members(c)) add_row(matrix, cell, i, sum);
            sum.balance(c, dirichlet(matrix, space.members(c)));
        });
    pin_floating_sets(matrix, space, coarse);
    return coarse;
}

SparseRows<Real> coarse_matrix(const LaplacianMatrix& matrix, const CoarseSpace& space,
                               const SparseRows<float>& touched, int threads) {
    auto coarse =
        sum_rows<Real>(space.size(), space.size() + 1, threads, [&](Index c, SparseSum& sum) {
            for (const Index i : space.members(c)) {
                sum.add(touched.start[i], touched.start[i + 1], [&](std::size_t k) {
                    return std::pair(touched.column[k], touched.value[k]);
                });
            }
            sum.balance(c, dirichlet(matrix, space.members(c)));
        });
    pin_floating_sets(matrix, space, coarse);
    return coarse;
}

} // namespace mpsdem::linear
