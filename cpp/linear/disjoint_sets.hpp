#pragma once

#include "core/vec3.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace mpsdem::linear {

/// Sets that are joined pair by pair; the smallest member stands for its set.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t n) : parent_(n) {
        std::iota(parent_.begin(), parent_.end(), Index{0});
    }

    [[nodiscard]] Index find(Index i) noexcept {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    void join(Index i, Index j) noexcept {
        i = find(i);
        j = find(j);
        parent_[std::max(i, j)] = std::min(i, j);
    }

private:
    std::vector<Index> parent_;
};

} // namespace mpsdem::linear
