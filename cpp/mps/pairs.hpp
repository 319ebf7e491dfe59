#pragma once

#include "core/parallel.hpp"
#include "mps/weight.hpp"
#include "neighbors/neighbor_list.hpp"

namespace mpsdem::mps {

/// What an operator sums over: each(i, visit) calls visit(j, r_ij, W, W / r^2) for the neighbors j
/// of i. Operators fill the rows of the points that have neighbors of their own.
template <class P>
concept Pairs = requires(const P& pairs, std::size_t i) {
    { pairs.rows() } -> std::same_as<std::size_t>;
    { pairs.position(i) } -> std::same_as<Vec3>;
    pairs.each(i, [](Index, const Vec3&, Real, Real) {});
};

/// Weights computed where they are asked for, in double.
class EvaluatedPairs {
public:
    EvaluatedPairs(const neighbors::NeighborList& neighbors, const Weight& weight)
        : neighbors_(&neighbors), weight_(weight) {}

    [[nodiscard]] std::size_t rows() const noexcept { return neighbors_->rows(); }
    [[nodiscard]] Vec3 position(std::size_t i) const noexcept { return neighbors_->position(i); }

    template <class Visit>
    void each(std::size_t i, const Visit& visit) const {
        neighbors_->each(i, [&](Index j, const Vec3& r, Index) {
            const Real square = dot(r, r);
            visit(j, r, weight_(std::sqrt(square)), weight_.over_square(square));
        });
    }

private:
    const neighbors::NeighborList* neighbors_;
    Weight weight_;
};

/// Weights stored once a step in float32, for a liquid that asks for them in every operator. A pair
/// has the same in both its rows, so what pairs keep to round-off is kept; the kernel is rounded by
/// 1e-7, a thousandth of what the disorder of the particles does.
class StoredPairs {
public:
    explicit StoredPairs(const Weight& weight) : weight_(weight) {}

    /// Of a list that stays as it is while the pairs are in use.
    void store(const neighbors::NeighborList& neighbors, int threads) {
        neighbors_ = &neighbors;
        if (neighbors.entries() > capacity_) {
            capacity_ = neighbors.entries();
            weights_ = std::make_unique_for_overwrite<float[]>(capacity_);
            over_square_ = std::make_unique_for_overwrite<float[]>(capacity_);
        }
        const auto radius = static_cast<float>(weight_.effective_radius);
        parallel_for(rows(), threads, [&](std::size_t i) {
            const float* const square = neighbors.square().data();
            for (Index k = neighbors.first(i); k < neighbors.last(i); ++k) {
                const float r = std::sqrt(square[k]);
                const float inside = 0.85F * std::max(radius - r, 0.F);
                const float w = inside / (0.85F * r + 0.15F * radius);
                weights_[k] = w;
                over_square_[k] = r > 0 ? w / square[k] : 0;
            }
        });
    }

    [[nodiscard]] std::size_t rows() const noexcept { return neighbors_->rows(); }
    [[nodiscard]] Vec3 position(std::size_t i) const noexcept { return neighbors_->position(i); }
    [[nodiscard]] std::span<const float> weight() const noexcept {
        return {weights_.get(), neighbors_->entries()};
    }

    template <class Visit>
    void each(std::size_t i, const Visit& visit) const {
        neighbors_->each(i, [&](Index j, const Vec3& r, Index k) {
            visit(j, r, static_cast<Real>(weights_[k]), static_cast<Real>(over_square_[k]));
        });
    }

private:
    Weight weight_;
    const neighbors::NeighborList* neighbors_ = nullptr;
    std::size_t capacity_ = 0;
    std::unique_ptr<float[]> weights_;     // (entries,) [-]
    std::unique_ptr<float[]> over_square_; // (entries,) [1/m2]
};

static_assert(Pairs<EvaluatedPairs> && Pairs<StoredPairs>);

} // namespace mpsdem::mps
