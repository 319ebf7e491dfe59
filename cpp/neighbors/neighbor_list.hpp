#pragma once

#include "core/vec3.hpp"
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

    /// Make the list anew; memory is kept.
    void find(std::span<const Vec3> position, const Groups& groups, int threads);
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
    /// Square of the distance of each neighbor [m2], good to a millionth of the radius and the same
    /// in both rows of a pair.
    [[nodiscard]] std::span<const float> square() const noexcept {
        return {square_.get(), entries_};
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
        Vec3 origin; // [grains]
        std::vector<Index> point;
        std::vector<float> x, y, z;                  // [grains] from the origin
        std::size_t inner = 0, outer = 0, count = 0; // [0, inner) have rows, [outer, count) none
        bool exact = true;                           // float32 holds the coordinates exactly
    };

    [[nodiscard]] Vec3 nearest_image(Vec3 apart) const noexcept {
        const Real half = period_ / 2;
        if (apart.x > half)
            apart.x -= period_;
        else if (apart.x < -half)
            apart.x += period_;
        return apart;
    }
    [[nodiscard]] bool near(Index i, Index j) const noexcept {
        const Vec3 apart = nearest_image(position_[j] - position_[i]);
        return dot(apart, apart) < radius_ * radius_;
    }
    void sort_group(Sorted& sorted, const Cells& cells, std::size_t first, std::size_t count,
                    int threads);
    void reserve(std::size_t entries);
    [[nodiscard]] bool search(const Sorted& group, std::size_t first, std::size_t last,
                              Candidates& candidates, Index begin, Index end);
    void gather(const Sorted& group, std::size_t place, Candidates& candidates);
    [[nodiscard]] bool keep_near(const Candidates& candidates, std::size_t first, std::size_t last,
                                 Index i, const Vec3& centre, Index end, Index& next);

    Real radius_; // [m]
    Real period_; // [m] 0: none
    std::vector<Vec3> position_;
    std::vector<Sorted> group_;
    std::vector<Candidates> candidates_;      // of each block of rows
    std::vector<Index> first_, inner_, last_; // (rows,)
    std::size_t row_room_ = 0;                // places set aside for a row, in the mean
    std::size_t entries_ = 0, capacity_ = 0;
    std::unique_ptr<Index[]> column_; // (capacity_,)
    std::unique_ptr<float[]> square_; // (capacity_,) [m2]
};

} // namespace mpsdem::neighbors
