#pragma once

#include "core/field.hpp"

#include <array>
#include <span>
#include <vector>

namespace mpsdem::mps::eulerian {

/// What a node takes from another: its weights in `count` sums.
template <std::size_t count>
struct Entry {
    Index node;
    std::array<Real, count> weight;
};

/// `count` linear operators on a cross-section that share their neighbors; the node itself is its
/// own last entry, with the weights that make every operator give 0 for a constant.
template <std::size_t count>
class Stencil {
public:
    void add_row(std::span<const Entry<count>> entries) {
        entries_.insert(entries_.end(), entries.begin(), entries.end());
        start_.push_back(static_cast<Index>(entries_.size()));
    }
    [[nodiscard]] std::size_t rows() const noexcept { return start_.size() - 1; }
    [[nodiscard]] std::size_t entries() const noexcept { return entries_.size(); }
    [[nodiscard]] std::span<const Entry<count>> of(std::size_t i) const noexcept {
        return {entries_.data() + start_[i], entries_.data() + start_[i + 1]};
    }
    /// Sum of the weights' magnitudes in the heaviest row: bounds the operator's eigenvalues.
    [[nodiscard]] Real bound(std::size_t rows, std::size_t weight) const noexcept {
        Real most = 0;
        for (std::size_t i = 0; i < rows; ++i) {
            Real sum = 0;
            for (const auto& e : of(i)) sum += std::abs(e.weight[weight]);
            most = std::max(most, sum);
        }
        return most;
    }
    /// Weights of all rows as a matrix of rows() x columns, by rows.
    [[nodiscard]] std::vector<Real> dense(std::size_t columns, std::size_t weight) const {
        std::vector<Real> matrix(rows() * columns);
        for (std::size_t i = 0; i < rows(); ++i)
            for (const auto& e : of(i)) matrix[i * columns + e.node] += e.weight[weight];
        return matrix;
    }

private:
    std::vector<Index> start_{0};
    std::vector<Entry<count>> entries_;
};

/// The operators' values at one node for `registers` x lane_count stations from k on.
template <std::size_t registers, std::size_t count>
struct Sums {
    Lanes of[count][registers];
};

template <std::size_t registers, std::size_t count>
[[nodiscard]] [[gnu::always_inline]] inline Sums<registers, count>
apply(std::span<const Entry<count>> entries, const Field& field, std::size_t k) noexcept {
    Sums<registers, count> sums{};
    for (const auto& e : entries) {
        const Real* from = field[e.node] + k;
        for (std::size_t v = 0; v < registers; ++v) {
            const Lanes value = load(from + v * lane_count);
            for (std::size_t c = 0; c < count; ++c) sums.of[c][v] += e.weight[c] * value;
        }
    }
    return sums;
}

} // namespace mpsdem::mps::eulerian
