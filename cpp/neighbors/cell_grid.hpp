#pragma once

#include "core/vec3.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace mpsdem::neighbors {

/// Cubic cells over the box of some points; x may be periodic. Numbers run with x slowest, so that
/// points sorted by cells form slabs along a pipe.
struct Cells {
    Cells() = default;
    /// `period` [m] along x, 0 for none; positions must be finite and in [0, period). Cells are at
    /// least `cell_size` wide.
    Cells(std::span<const Vec3> position, Real cell_size, Real period, int threads);

    [[nodiscard]] std::size_t count() const noexcept {
        return static_cast<std::size_t>(n[0] * n[1] * n[2]);
    }
    [[nodiscard]] Index of(const Vec3& position) const noexcept {
        const auto along = [&](std::size_t d, Real x) {
            const auto k = static_cast<std::int64_t>((x - low[d]) * inverse[d]);
            return std::clamp<std::int64_t>(k, 0, n[d] - 1);
        };
        return static_cast<Index>((along(0, position.x) * n[1] + along(1, position.y)) * n[2] +
                                  along(2, position.z));
    }

    std::array<std::int64_t, 3> n{};
    std::array<Real, 3> low{};     // [m]
    std::array<Real, 3> inverse{}; // [1/m] of the width of a cell
};

/// Points binned into cells by a counting sort.
class CellGrid {
public:
    CellGrid(Real cell_size, Real period) : cell_size_(cell_size), period_(period) {}

    /// Order of the points by cell: the k-th sorted point is position[order[k]].
    void sort(std::span<const Vec3> position, std::vector<Index>& order) {
        sort(position, Cells(position, cell_size_, period_, 1), order, 1);
    }
    /// The same by given cells, which other points may share.
    void sort(std::span<const Vec3> position, const Cells& cells, std::vector<Index>& order,
              int threads);

    /// Call visit(first, last, image) for the ranges of sorted points in the cells around a cell,
    /// in ascending order of the cells for each image; `image` periods are to be added to x_i -
    /// x_j.
    template <class Visit>
    void around(std::size_t cell, const Visit& visit) const {
        if (start_.empty()) return;
        const auto c = static_cast<std::int64_t>(cell);
        const std::int64_t cz = c % n_[2], cy = c / n_[2] % n_[1], cx = c / (n_[2] * n_[1]);
        for (std::int64_t dx = -1; dx <= 1; ++dx) {
            std::int64_t ix = cx + dx;
            int image = 0;
            if (period_ > 0) {
                if (n_[0] == 1) { // too few cells: every image of the one column
                    image = static_cast<int>(-dx);
                    ix = 0;
                } else if (ix < 0) {
                    image = 1;
                    ix = n_[0] - 1;
                } else if (ix == n_[0]) {
                    image = -1;
                    ix = 0;
                }
            } else if (ix < 0 || ix >= n_[0]) {
                continue;
            }
            for (std::int64_t iy = std::max<std::int64_t>(cy - 1, 0);
                 iy <= std::min(cy + 1, n_[1] - 1); ++iy) {
                const std::int64_t row = (ix * n_[1] + iy) * n_[2];
                const std::int64_t low = row + std::max<std::int64_t>(cz - 1, 0);
                const std::int64_t high = row + std::min(cz + 1, n_[2] - 1);
                visit(start_[static_cast<std::size_t>(low)],
                      start_[static_cast<std::size_t>(high) + 1], image);
            }
        }
    }

    /// Cell of the k-th sorted point.
    [[nodiscard]] std::size_t cell(std::size_t k) const noexcept { return cell_[k]; }

private:
    Real cell_size_; // [m]
    Real period_;    // [m]
    std::array<std::int64_t, 3> n_{};
    std::vector<Index> start_;          // (cells + 1,) first sorted point of each cell
    std::vector<Index> cell_;           // (n,) by sorted point
    std::vector<Index> cell_of_, next_; // memory of a sort
};

} // namespace mpsdem::neighbors
