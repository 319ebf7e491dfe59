#include "neighbors/neighbor_list.hpp"

#include "core/check.hpp"
#include "core/pack.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace mpsdem::neighbors {

namespace {

constexpr std::size_t block_rows = 2048;    // rows that one thread searches in one go
constexpr std::size_t padding = lane_count; // places that a register reaches beyond an end

void require_finite(std::span<const Vec3> position) {
    require(std::ranges::all_of(position,
                                [](Vec3 x) {
                                    return std::isfinite(x.x) && std::isfinite(x.y) &&
                                           std::isfinite(x.z);
                                }),
            "position must be finite");
}

std::vector<Vec3> wrapped(std::span<const Vec3> position, Real period) {
    std::vector<Vec3> inside(position.begin(), position.end());
    if (period > 0) {
        for (Vec3& x : inside) {
            x.x -= period * std::floor(x.x / period);
            if (x.x >= period) x.x = 0; // rounded up from just below zero
        }
    }
    return inside;
}

/// Points in sorted order, and the one whose neighbors are sought.
struct Candidates {
    const Real *x, *y, *z;
    const Index* order;
    Real square; // [m2] of the radius
    Vec3 centre;
    Index self; // place of the centre
};

/// Write those of [first, last) that are near to `out`, rubbish behind them up to `padding`; return
/// how many. The difference is taken before the shift by a period: it is then opposite to the last
/// bit for i and j, and the list symmetric even where a distance equals the radius.
std::size_t keep_near(const Candidates& c, Index first, Index last, Real shift, Index* out) {
    std::size_t count = 0;
    for (Index m = first; m < last; m += lane_count) {
        const Lanes dx = (load(c.x + m) - c.centre.x) - shift;
        const Lanes dy = load(c.y + m) - c.centre.y;
        const Lanes dz = load(c.z + m) - c.centre.z;
        unsigned near = bits(dx * dx + dy * dy + dz * dz < c.square);
        if (last - m < lane_count) near &= (1U << (last - m)) - 1;
        if (c.self - m < lane_count) near &= ~(1U << (c.self - m));
        count += pack(c.order + m, near, out + count);
    }
    return count;
}

} // namespace

std::vector<Index> cell_order(std::span<const Vec3> position, Real cell_size, Real period) {
    require(cell_size > 0, "cell_size must be > 0 m");
    require(period >= 0, "period must be >= 0 m");
    require_finite(position);
    std::vector<Index> order;
    if (!position.empty()) CellGrid(cell_size, period).sort(wrapped(position, period), order);
    return order;
}

NeighborList::NeighborList(Real radius, Real period)
    : radius_(radius), period_(period), row_(1, 0), grid_(radius, period) {
    require(radius > 0, "NeighborList: radius must be > 0 m");
    require(period == 0 || period > 2 * radius,
            "NeighborList: period must be more than two radii, or 0 for none: else a point would "
            "meet a neighbor twice");
}

void NeighborList::find(std::span<const Vec3> position, int threads) {
    require(position.size() < std::numeric_limits<Index>::max(),
            "NeighborList: position must have fewer than 2^32 rows");
    require_finite(position);
    const std::size_t n = position.size();
    position_ = wrapped(position, period_);
    row_.assign(n + 1, 0);
    column_.clear();
    if (n == 0) return;

    grid_.sort(position_, order_);
    order_.resize(n + padding);
    place_.resize(n);
    for (auto* sorted : {&sorted_x_, &sorted_y_, &sorted_z_}) sorted->resize(n + padding);
    for (std::size_t k = 0; k < n; ++k) {
        const Vec3 x = position_[order_[k]];
        place_[order_[k]] = static_cast<Index>(k);
        sorted_x_[k] = x.x;
        sorted_y_[k] = x.y;
        sorted_z_[k] = x.z;
    }

    const std::size_t blocks = (n + block_rows - 1) / block_rows;
    block_.resize(std::max(blocks, block_.size()));
    parallel_for_blocks(blocks, threads, [&](std::size_t b) {
        search(b * block_rows, std::min(n, (b + 1) * block_rows), block_[b]);
    });

    std::uint64_t total = 0; // row_[i + 1] holds the count of row i until here
    for (std::size_t i = 0; i < n; ++i) {
        total += row_[i + 1];
        row_[i + 1] = static_cast<Index>(total);
    }
    require(total <= std::numeric_limits<Index>::max(),
            "NeighborList: more than 2^32 pairs; is radius too large?");
    column_.resize(total);
    parallel_for_blocks(blocks, threads, [&](std::size_t b) {
        const Index first = row_[b * block_rows];
        const Index last = row_[std::min(n, (b + 1) * block_rows)];
        std::copy_n(block_[b].begin(), last - first, column_.begin() + first);
    });
}

void NeighborList::search(std::size_t first_row, std::size_t last_row, std::vector<Index>& found) {
    std::size_t count = 0;
    Candidates candidates{sorted_x_.data(),
                          sorted_y_.data(),
                          sorted_z_.data(),
                          order_.data(),
                          radius_ * radius_,
                          Vec3{},
                          0};
    for (std::size_t i = first_row; i < last_row; ++i) {
        candidates.centre = position_[i];
        candidates.self = place_[i];
        const std::size_t begin = count;
        grid_.around(grid_.cell(place_[i]), [&](Index first, Index last, int image) {
            if (count + (last - first) + padding > found.size())
                found.resize(2 * found.size() + (last - first) + padding);
            count += keep_near(candidates, first, last, image * period_, found.data() + count);
        });
        const auto own = std::span(found).subspan(begin, count - begin);
        if (!std::ranges::is_sorted(own)) std::ranges::sort(own);
        row_[i + 1] = static_cast<Index>(count - begin);
    }
}

} // namespace mpsdem::neighbors
