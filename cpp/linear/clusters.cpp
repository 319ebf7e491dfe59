#include "linear/clusters.hpp"

#include "linear/disjoint_sets.hpp"

namespace mpsdem::linear {

Clusters::Clusters(const LaplacianMatrix& matrix) {
    const auto n = static_cast<Index>(matrix.size());
    DisjointSets sets(n);
    const auto join = [&](Index i, std::size_t entry) {
        if (matrix.weight()[entry] != 0) sets.join(i, matrix.column()[entry]);
    };

    // The first and the last neighbor of each already join nearly all into one set. As the graph is
    // symmetric, the edges that are missing then start from an unknown outside that set: few rows
    // are read whole.
    for (Index i = 0; i < n; ++i) {
        if (matrix.first(i) == matrix.last(i)) continue;
        join(i, matrix.first(i));
        join(i, matrix.last(i) - 1);
    }
    std::vector<Index> size(n, 0);
    for (Index i = 0; i < n; ++i) ++size[sets.find(i)];
    const auto largest = static_cast<Index>(std::ranges::max_element(size) - size.begin());
    for (Index i = 0; i < n; ++i) {
        if (sets.find(i) == sets.find(largest)) continue;
        for (std::size_t k = matrix.first(i); k < matrix.last(i); ++k) join(i, k);
    }

    std::vector<char> grounded(n, 0);
    std::ranges::fill(size, Index{0});
    for (Index i = 0; i < n; ++i) {
        const Index root = sets.find(i);
        if (matrix.dirichlet(i) != 0) grounded[root] = 1;
        ++size[root];
    }
    std::vector<Index> next(n, 0);
    for (Index i = 0; i < n; ++i) {
        if (size[i] == 0) continue;
        ++count_;
        if (grounded[i] != 0) continue;
        next[i] = start_.back();
        start_.push_back(start_.back() + size[i]);
    }
    member_.resize(start_.back());
    for (Index i = 0; i < n; ++i) {
        if (const Index root = sets.find(i); grounded[root] == 0) member_[next[root]++] = i;
    }
}

void Clusters::remove_means(std::span<Real> v, int threads) const noexcept {
    constexpr std::size_t worth_a_team = 8192;
    for (std::size_t c = 0; c < floating_count(); ++c) {
        const auto members = floating(c);
        const int team = members.size() < worth_a_team ? 1 : threads;
        const Real total =
            ordered_sum(members.size(), team, [&](std::size_t k) { return v[members[k]]; });
        const Real mean = total / static_cast<Real>(members.size());
        parallel_for(members.size(), team, [&](std::size_t k) { v[members[k]] -= mean; });
    }
}

} // namespace mpsdem::linear
