#pragma once

#include "core/lanes.hpp"
#include "core/parallel.hpp"
#include "neighbors/cell_grid.hpp"

#include <memory>
#include <span>
#include <vector>

namespace mpsdem::neighbors {

/// Order of points by cells at least `cell_size` wide, x slowest; `period` along x, 0 for none.
/// Sums over neighbors run about twice as fast on points stored in this order.
[[nodiscard]] std::vector<Index> cell_order(std::span<const Vec3> position, Real cell_size,
                                            Real period);

/// How points are stored: `group[g]` of them after each other, each group best in the order of
/// cells as wide as the radius over the box of all.
/// The first `rows` points, whole groups, have neighbors of their own; the others are neighbors
/// only.
struct Groups {
    std::vector<std::size_t> group;
    std::size_t rows;
};

/// Points, and for each of them all others nearer than `radius`: a full list, each row ascending,
/// so that a sum over neighbors writes one place and has one order.
///
/// The neighbors of point i are column()[first(i)] ... column()[last(i) - 1]; between rows there
/// may be gaps. The list keeps a copy of the positions it was made for, so a sum over it cannot mix
/// two states.
class NeighborList {
public:
    /// `period` [m] along x, 0 for none. A period of more than two radii leaves one image of a
    /// neighbor in reach, the nearest.
    NeighborList(Real radius, Real period);

    /// Make the list anew; memory is kept. What is wanted of the distances is kept by `store`,
    /// while they are at hand: after store.reserve(entries()), store(k, squares) gives the squares
    /// of the distances of the entries from k on [m2], good to a millionth of the radius and the
    /// same in both rows of a pair.
    template <class Store>
    void find(std::span<const Vec3> position, const Groups& groups, int threads, Store&& store) {
        prepare(position, groups, threads);
        std::vector<char> fits(blocks_.size(), 0);
        while (std::ranges::find(fits, 0) != fits.end()) {
            const std::size_t room = make_room();
            store.reserve(entries_);
            parallel_for_blocks(blocks_.size(), threads, [&](std::size_t b) {
                fits[b] = static_cast<char>(search(blocks_[b], candidates_[b],
                                                   static_cast<Index>(b * room),
                                                   static_cast<Index>((b + 1) * room), store));
            });
        }
    }
    /// Of points of one group, all with rows.
    void find(std::span<const Vec3> position, int threads);

    [[nodiscard]] std::size_t size() const noexcept { return position_.size(); }
    [[nodiscard]] std::size_t rows() const noexcept { return first_.size(); }
    [[nodiscard]] Real radius() const noexcept { return radius_; }
    [[nodiscard]] Real period() const noexcept { return period_; }
    /// Where points are, x wrapped into [0, period) [m].
    [[nodiscard]] std::span<const Vec3> position() const noexcept { return position_; }
    [[nodiscard]] Vec3 position(std::size_t i) const noexcept { return position_[i]; }

    [[nodiscard]] Index first(std::size_t i) const noexcept { return first_[i]; }
    [[nodiscard]] Index last(std::size_t i) const noexcept { return last_[i]; }
    [[nodiscard]] std::span<const Index> first() const noexcept { return first_; }
    /// Where, in each row, the neighbors end that have rows themselves.
    [[nodiscard]] std::span<const Index> inner() const noexcept { return inner_; }
    /// Room of all rows, gaps and all.
    [[nodiscard]] std::size_t entries() const noexcept { return entries_; }
    [[nodiscard]] std::span<const Index> column() const noexcept {
        return {column_.get(), entries_};
    }
    /// Call visit(j, r_ij, k) for the neighbors of i, entries k in [first(i), last(i)), r_ij =
    /// x_j - x_i to the nearest image [m]. r_ij and r_ji are opposite to the last bit.
    template <class Visit>
    void each(std::size_t i, const Visit& visit) const {
        const Vec3 x = position_[i];
        for (Index k = first_[i]; k < last_[i]; ++k) {
            const Index j = column_[k];
            visit(j, nearest_image(position_[j] - x), k);
        }
    }
    /// x_j - x_i to the nearest image [m].
    [[nodiscard]] Vec3 apart(std::size_t i, Index j) const noexcept {
        return nearest_image(position_[j] - position_[i]);
    }
    /// The same for four j at once.
    [[nodiscard]] [[gnu::always_inline]] Vector<Lanes>
    apart_of_four(std::size_t i, const Index* j) const noexcept {
        Vector<Lanes> apart = gather(position_.data(), j) - broadcast(position_[i]);
        const Lanes half = Lanes{} + period_ / 2, none{};
        apart.x -= select(apart.x > half, Lanes{} + period_, none);
        apart.x += select(apart.x < -half, Lanes{} + period_, none);
        return apart;
    }

private:
    /// Points of a group in the order of their cells, coordinates rounded to whole grains.
    struct Sorted {
        CellGrid grid;
        std::vector<Index> order;  // point of each place
        std::vector<Real> x, y, z; // [grains]
    };
    /// All that may be near to the points of a cell, group after group, padded to whole registers.
    struct Candidates {
        void reserve(std::size_t size);
        void sort(std::size_t first, std::size_t last);
        void pad();
        Vec3 origin; // [grains]
        std::vector<Index> point;
        std::vector<float> x, y, z;                  // [grains] from the origin
        std::size_t inner = 0, outer = 0, count = 0; // [0, inner) have rows, [outer, count) none
        std::vector<float> square; // [m2] of the neighbors found, in the rows of the cell
    };

    [[nodiscard]] Vec3 nearest_image(Vec3 difference) const noexcept {
        const Real half = period_ / 2;
        if (difference.x > half)
            difference.x -= period_;
        else if (difference.x < -half)
            difference.x += period_;
        return difference;
    }
    [[nodiscard]] bool near(Index i, Index j) const noexcept {
        const Vec3 r = apart(i, j);
        return dot(r, r) < radius_ * radius_;
    }
    /// Some places of a group, searched by one thread in one go.
    struct Block {
        std::size_t group, first, last;
    };

    void prepare(std::span<const Vec3> position, const Groups& groups, int threads);
    void sort_group(Sorted& sorted, const Cells& cells, std::size_t first, std::size_t count,
                    int threads);
    /// More than at the last call; the entries for a block.
    [[nodiscard]] std::size_t make_room();
    void collect(const Sorted& group, std::size_t place, Candidates& candidates);
    /// Find the row of the point in a place; false where it goes beyond the end.
    [[nodiscard]] bool find_row(const Sorted& group, std::size_t place, Candidates& candidates,
                                Index cell_begin, Index end, Index& next);
    [[nodiscard]] bool keep_near(Candidates& candidates, std::size_t first, std::size_t last,
                                 Index i, const Vec3& centre, Index cell_begin, Index end,
                                 Index& next);

    /// Find the rows of a block, to be written to [begin, end); false where they do not fit.
    template <class Store>
    [[nodiscard]] bool search(const Block& block, Candidates& candidates, Index begin, Index end,
                              Store& store) {
        const Sorted& group = group_[block.group];
        Index next = begin;
        for (std::size_t k = block.first; k < block.last;) {
            collect(group, k, candidates);
            const Index cell_begin = next;
            const std::size_t cell = group.grid.cell(k);
            for (; k < block.last && group.grid.cell(k) == cell; ++k)
                if (!find_row(group, k, candidates, cell_begin, end, next)) return false;
            store(cell_begin, std::span<const float>(candidates.square).first(next - cell_begin));
        }
        return true;
    }

    Real radius_; // [m]
    Real period_; // [m] 0: none
    std::vector<Vec3> position_;
    std::vector<Sorted> group_;
    std::vector<Block> blocks_;
    std::vector<Candidates> candidates_;      // of each block of rows
    std::vector<Index> first_, inner_, last_; // (rows,)
    bool exact_ = true;                       // float32 holds differences of candidates exactly
    std::size_t row_room_ = 0;                // places set aside for a row, in the mean
    bool tight_ = false;                      // the last ones were not enough
    std::size_t entries_ = 0, capacity_ = 0;
    std::unique_ptr<Index[]> column_; // (capacity_,)
};

} // namespace mpsdem::neighbors
