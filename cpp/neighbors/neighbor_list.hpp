#pragma once

#include "core/vec3.hpp"
#include "neighbors/cell_grid.hpp"

#include <span>
#include <vector>

namespace mpsdem::neighbors {

/// Order of points by cells at least `cell_size` wide, x slowest; `period` along x, 0 for none.
/// Sums over neighbors run about twice as fast on points stored in this order.
[[nodiscard]] std::vector<Index> cell_order(std::span<const Vec3> position, Real cell_size,
                                            Real period);

/// Points, and for each of them all others nearer than `radius`: a full list in compressed rows,
/// ascending, so that a sum over neighbors writes one place and has one order.
///
/// Point i has the neighbors column[row[i]] ... column[row[i + 1] - 1]. The list keeps a copy of
/// the positions it was made for, so a sum over it cannot mix two states.
class NeighborList {
public:
    /// `period` [m] along x, 0 for none. A period of more than two radii leaves one image of a
    /// neighbor in reach, the nearest.
    NeighborList(Real radius, Real period);

    /// Make the list anew; memory is kept. Fast where the points are in `cell_order`.
    void find(std::span<const Vec3> position, int threads);

    [[nodiscard]] std::size_t size() const noexcept { return position_.size(); }
    [[nodiscard]] Real radius() const noexcept { return radius_; }
    [[nodiscard]] Real period() const noexcept { return period_; }
    [[nodiscard]] const std::vector<Index>& row() const noexcept { return row_; }
    [[nodiscard]] const std::vector<Index>& column() const noexcept { return column_; }
    /// Where point i is, x wrapped into [0, period).
    [[nodiscard]] Vec3 position(std::size_t i) const noexcept { return position_[i]; }

    /// Call visit(j, r_ij) for the neighbors of i, r_ij = x_j - x_i to the nearest image [m].
    /// r_ij and r_ji are opposite to the last bit.
    template <class Visit>
    void each(std::size_t i, const Visit& visit) const {
        const Vec3 x = position_[i];
        const Real half = period_ / 2;
        for (Index k = row_[i]; k < row_[i + 1]; ++k) {
            const Index j = column_[k];
            Vec3 apart = position_[j] - x;
            if (apart.x > half)
                apart.x -= period_;
            else if (apart.x < -half)
                apart.x += period_;
            visit(j, apart);
        }
    }

private:
    void search(std::size_t first, std::size_t last, std::vector<Index>& found);

    Real radius_; // [m]
    Real period_; // [m] 0: none
    std::vector<Vec3> position_;
    std::vector<Index> row_;    // (n + 1,)
    std::vector<Index> column_; // (row_[n],)

    CellGrid grid_;
    std::vector<Index> order_;                         // point of each place in the sorted order
    std::vector<Index> place_;                         // and the other way round
    std::vector<Real> sorted_x_, sorted_y_, sorted_z_; // [m] padded to whole registers
    std::vector<std::vector<Index>> block_;            // neighbors found by each block of rows
};

} // namespace mpsdem::neighbors
