#pragma once

#include "core/lanes.hpp"
#include "core/parallel.hpp"
#include "mps/kind.hpp"
#include "mps/weight.hpp"
#include "neighbors/neighbor_list.hpp"

#include <algorithm>
#include <array>

namespace mpsdem::mps {

/// Which neighbors a sum takes.
enum class Among { all, liquid, solid };

/// A neighbor j of a point i.
struct Pair {
    Index j;
    Vec3 r;           // [m] x_j - x_i
    Real weight;      // [-] W
    Real over_square; // [1/m2] W / r^2
};

/// Four of them at once; where a row has fewer left, the point itself with weight 0.
struct FourPairs {
    const Index* j;
    Vector<Lanes> r;   // [m]
    Lanes weight;      // [-]
    Lanes over_square; // [1/m2]

    /// A field at the neighbors.
    [[nodiscard]] Lanes of(std::span<const Real> field) const { return gather(field.data(), j); }
    [[nodiscard]] Vector<Lanes> of(std::span<const Vec3> field) const {
        return gather(field.data(), j);
    }
};

/// What an operator sums over. each<Among>(i, visit) calls visit(Pair) for the neighbors of i,
/// fours<Among>(i, visit) calls visit(FourPairs). An operator fills as many rows as its result has,
/// from the first.
template <class P>
concept Pairs = requires(const P& pairs, std::size_t i) {
    { pairs.rows() } -> std::same_as<std::size_t>;
    { pairs.liquid(i) } -> std::same_as<bool>;
    { pairs.position(i) } -> std::same_as<Vec3>;
    pairs.template each<Among::all>(i, [](const Pair&) {});
    pairs.template fours<Among::all>(i, [](const FourPairs&) {});
};

/// Weights computed where they are asked for, in double, for points in any order.
class EvaluatedPairs {
public:
    /// `kind` (n,), or empty where all are liquid.
    EvaluatedPairs(const neighbors::NeighborList& neighbors, const Weight& weight,
                   std::span<const Kind> kind = {})
        : neighbors_(&neighbors), weight_(weight), kind_(kind) {}

    [[nodiscard]] std::size_t rows() const noexcept { return neighbors_->rows(); }
    [[nodiscard]] Vec3 position(std::size_t i) const noexcept { return neighbors_->position(i); }
    [[nodiscard]] bool liquid(std::size_t i) const noexcept {
        return kind_.empty() || kind_[i] == Kind::liquid;
    }

    template <Among among, class Visit>
    void each(std::size_t i, const Visit& visit) const {
        neighbors_->each(i, [&](Index j, const Vec3& r, Index) {
            if (among != Among::all && liquid(j) != (among == Among::liquid)) return;
            const Real square = dot(r, r);
            visit(Pair{j, r, weight_(std::sqrt(square)), weight_.over_square(square)});
        });
    }

    template <Among among, class Visit>
    void fours(std::size_t i, const Visit& visit) const {
        std::array<Index, lane_count> j{};
        FourPairs four;
        std::size_t count = 0;
        const auto clear = [&] {
            j.fill(static_cast<Index>(i));
            four = {j.data(), {}, Lanes{}, Lanes{}};
            count = 0;
        };
        clear();
        each<among>(i, [&](const Pair& pair) {
            j[count] = pair.j;
            four.r.x[count] = pair.r.x;
            four.r.y[count] = pair.r.y;
            four.r.z[count] = pair.r.z;
            four.weight[count] = pair.weight;
            four.over_square[count] = pair.over_square;
            if (++count < lane_count) return;
            visit(four);
            clear();
        });
        if (count > 0) visit(four);
    }

private:
    const neighbors::NeighborList* neighbors_;
    Weight weight_;
    std::span<const Kind> kind_;
};

/// Weights stored once a step in float32, for a liquid that asks for them in every operator. Its
/// own particles come first. A pair has the same weights in both its rows, so what pairs keep to
/// round-off is kept; the kernel is rounded by 1e-6, a thousandth of what disorder does.
class StoredPairs {
public:
    /// `period` [m] along x, 0 for none.
    StoredPairs(const Weight& weight, Real period)
        : weight_(weight), neighbors_(weight.effective_radius, period) {}

    /// Make the list anew, and keep the weights of its pairs; liquid is the first group.
    void find(std::span<const Vec3> position, const neighbors::Groups& groups, int threads) {
        liquid_count_ = groups.group.front();
        neighbors_.find(position, groups, threads, *this);
    }
    [[nodiscard]] const neighbors::NeighborList& neighbors() const noexcept { return neighbors_; }

    /// As the list asks for while it is made.
    void reserve(std::size_t entries) {
        if (entries <= capacity_) return;
        capacity_ = entries;
        weights_ = std::make_unique_for_overwrite<float[]>(capacity_);
        over_square_ = std::make_unique_for_overwrite<float[]>(capacity_);
    }
    void operator()(Index entry, std::span<const float> square) noexcept {
        const auto radius = static_cast<float>(weight_.effective_radius);
        float *const w = weights_.get() + entry, *const over_square = over_square_.get() + entry;
        for (std::size_t k = 0; k < square.size(); ++k) {
            const float r = std::sqrt(square[k]);
            const float inside = 0.85F * std::max(radius - r, 0.F);
            w[k] = inside / (0.85F * r + 0.15F * radius);
            over_square[k] = square[k] > 0 ? w[k] / square[k] : 0;
        }
    }

    [[nodiscard]] std::size_t rows() const noexcept { return neighbors_.rows(); }
    [[nodiscard]] Vec3 position(std::size_t i) const noexcept { return neighbors_.position(i); }
    [[nodiscard]] bool liquid(std::size_t i) const noexcept { return i < liquid_count_; }
    /// W by the entries of the neighbor list.
    [[nodiscard]] std::span<const float> weight() const noexcept {
        return {weights_.get(), neighbors_.entries()};
    }

    /// Multiply W, and not W / r^2, by the mean of a factor (rows,) at the ends of each pair: the
    /// list is then the matrix of an equation whose coefficient varies.
    void scale_weights(std::span<const Real> factor, int threads) {
        const std::span<const Index> inner = neighbors_.inner(), column = neighbors_.column();
        parallel_for(rows(), threads, [&](std::size_t i) {
            for (Index k = neighbors_.first(i); k < inner[i]; ++k)
                weights_[k] *= static_cast<float>((factor[i] + factor[column[k]]) / 2);
        });
    }

    template <Among among, class Visit>
    void each(std::size_t i, const Visit& visit) const {
        const auto [first, last] = range<among>(i);
        const Index* const column = neighbors_.column().data();
        for (Index k = first; k < last; ++k) {
            visit(Pair{column[k], neighbors_.apart(i, column[k]), static_cast<Real>(weights_[k]),
                       static_cast<Real>(over_square_[k])});
        }
    }

    template <Among among, class Visit>
    void fours(std::size_t i, const Visit& visit) const {
        const auto [first, last] = range<among>(i);
        const Index* const column = neighbors_.column().data();
        const float *const weights = weights_.get(), *const over_square = over_square_.get();
        Index k = first;
        for (; k + lane_count <= last; k += lane_count) {
            visit(FourPairs{column + k, neighbors_.apart_of_four(i, column + k), widen(weights + k),
                            widen(over_square + k)});
        }
        if (k == last) return;
        std::array<Index, lane_count> j;
        std::array<float, lane_count> w{}, f{};
        j.fill(static_cast<Index>(i));
        std::copy(column + k, column + last, j.begin());
        std::copy(weights + k, weights + last, w.begin());
        std::copy(over_square + k, over_square + last, f.begin());
        visit(FourPairs{j.data(), neighbors_.apart_of_four(i, j.data()), widen(w.data()),
                        widen(f.data())});
    }

private:
    struct Range {
        Index first, last;
    };
    /// Rows are ascending: liquid comes first.
    template <Among among>
    [[nodiscard]] Range range(std::size_t i) const noexcept {
        const Index first = neighbors_.first(i), last = neighbors_.last(i);
        if constexpr (among == Among::all) return {first, last};
        const Index* const column = neighbors_.column().data();
        Index split = last;
        if (last > first && column[last - 1] >= liquid_count_)
            split = static_cast<Index>(
                std::lower_bound(column + first, column + last, liquid_count_) - column);
        return among == Among::liquid ? Range{first, split} : Range{split, last};
    }

    Weight weight_;
    neighbors::NeighborList neighbors_;
    std::size_t liquid_count_ = 0;
    std::size_t capacity_ = 0;
    std::unique_ptr<float[]> weights_;     // (entries,) [-]
    std::unique_ptr<float[]> over_square_; // (entries,) [1/m2]
};

static_assert(Pairs<EvaluatedPairs> && Pairs<StoredPairs>);

} // namespace mpsdem::mps
