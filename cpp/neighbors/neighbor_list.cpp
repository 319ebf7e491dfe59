#include "neighbors/neighbor_list.hpp"

#include "core/check.hpp"
#include "core/pack.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace mpsdem::neighbors {

namespace {

constexpr std::size_t block_rows = 2048;      // rows that one thread searches in one go
constexpr std::size_t least_row_room = 48;    // of the 38 that a lattice has within 2.1 spacings
constexpr Real grains = 1 << 20;              // [-] of a radius
constexpr float square_of_radius = 1LL << 40; // [grains2]
constexpr float rounding = 5e-6F * square_of_radius; // [grains2] of a square near that
constexpr Real exact_below = 1 << 23; // [grains] differences of less are exact in float32
constexpr float nowhere = 1e30F;      // [grains]

void require_finite(std::span<const Vec3> position) {
    require(std::ranges::all_of(position,
                                [](Vec3 x) {
                                    return std::isfinite(x.x) && std::isfinite(x.y) &&
                                           std::isfinite(x.z);
                                }),
            "position must be finite");
}

void wrap(std::span<const Vec3> position, Real period, int threads, std::vector<Vec3>& inside) {
    inside.resize(position.size());
    parallel_for(position.size(), threads, [&](std::size_t i) {
        Vec3 x = position[i];
        if (period > 0) {
            x.x -= period * std::floor(x.x / period);
            if (x.x >= period) x.x = 0; // rounded up from just below zero
        }
        inside[i] = x;
    });
}

} // namespace

std::vector<Index> cell_order(std::span<const Vec3> position, Real cell_size, Real period) {
    require(cell_size > 0, "cell_size must be > 0 m");
    require(period >= 0, "period must be >= 0 m");
    require_finite(position);
    std::vector<Index> order;
    std::vector<Vec3> inside;
    wrap(position, period, 1, inside);
    CellGrid(cell_size, period).sort(inside, order);
    return order;
}

NeighborList::NeighborList(Real radius, Real period) : radius_(radius), period_(period) {
    require(radius > 0, "NeighborList: radius must be > 0 m");
    require(period == 0 || period > 2 * radius,
            "NeighborList: period must be more than two radii, or 0 for none: else a point would "
            "meet a neighbor twice");
}

void NeighborList::find(std::span<const Vec3> position, int threads) {
    find(position, {{position.size()}, position.size()}, threads);
}

void NeighborList::find(std::span<const Vec3> position, const Groups& groups, int threads) {
    require(position.size() < std::numeric_limits<Index>::max(),
            "NeighborList: position must have fewer than 2^32 rows");
    require_finite(position);
    wrap(position, period_, threads, position_);
    const Cells cells(position_, radius_, period_);
    group_.resize(groups.group.size(), {CellGrid(radius_, period_), {}, {}, {}, {}});
    struct Block {
        std::size_t group, first, last; // places
    };
    std::vector<Block> blocks;
    std::size_t points = 0;
    for (std::size_t g = 0; g < group_.size(); ++g) {
        const std::size_t count = groups.group[g];
        sort_group(group_[g], cells, points, count, threads);
        points += count;
        if (points > groups.rows) continue;
        for (std::size_t k = 0; k < count; k += block_rows)
            blocks.push_back({g, k, std::min(count, k + block_rows)});
    }
    require(points == position.size(), "NeighborList: the groups must have all points");

    first_.resize(groups.rows);
    inner_.resize(groups.rows);
    last_.resize(groups.rows);
    candidates_.resize(std::max(candidates_.size(), blocks.size()));
    row_room_ = std::max(row_room_, least_row_room);
    std::vector<char> fits(blocks.size(), 0);
    while (std::ranges::find(fits, 0) != fits.end()) {
        const std::size_t room = row_room_ * block_rows;
        reserve(room * blocks.size());
        parallel_for_blocks(blocks.size(), threads, [&](std::size_t b) {
            const auto [g, first, last] = blocks[b];
            fits[b] = static_cast<char>(search(group_[g], first, last, candidates_[b],
                                               static_cast<Index>(b * room),
                                               static_cast<Index>((b + 1) * room)));
        });
        row_room_ += row_room_ / 2;
    }
    row_room_ = blocks.empty() ? 0 : entries_ / (block_rows * blocks.size());
}

void NeighborList::sort_group(Sorted& sorted, const Cells& cells, std::size_t first,
                              std::size_t count, int threads) {
    const auto points = std::span(position_).subspan(first, count);
    sorted.grid.sort(points, cells, sorted.order, threads);
    for (auto* component : {&sorted.x, &sorted.y, &sorted.z}) component->resize(count);
    const Real scale = grains / radius_;
    parallel_for(count, threads, [&](std::size_t k) {
        const Vec3 x = points[sorted.order[k]];
        sorted.order[k] += static_cast<Index>(first);
        sorted.x[k] = std::nearbyint(scale * x.x);
        sorted.y[k] = std::nearbyint(scale * x.y);
        sorted.z[k] = std::nearbyint(scale * x.z);
    });
}

void NeighborList::reserve(std::size_t entries) {
    require(entries <= std::numeric_limits<Index>::max(),
            "NeighborList: more than 2^32 pairs; is radius too large?");
    entries_ = entries;
    if (entries <= capacity_) return;
    // memory that is never written to is never taken: the gaps cost nothing
    column_ = std::make_unique_for_overwrite<Index[]>(entries);
    square_ = std::make_unique_for_overwrite<float[]>(entries);
    capacity_ = entries;
}

/// Find the rows of the points in some places of a group, to be written to [begin, end); false
/// where they do not fit.
bool NeighborList::search(const Sorted& group, std::size_t first, std::size_t last,
                          Candidates& candidates, Index begin, Index end) {
    Index next = begin;
    for (std::size_t k = first; k < last; ++k) {
        if (k == first || group.grid.cell(k) != group.grid.cell(k - 1))
            gather(group, k, candidates);
        const Index i = group.order[k];
        const Vec3 centre{group.x[k], group.y[k], group.z[k]};
        first_[i] = next;
        if (!keep_near(candidates, 0, candidates.inner, i, centre, end, next)) return false;
        inner_[i] = next;
        if (!keep_near(candidates, candidates.outer, candidates.count, i, centre, end, next))
            return false;
        last_[i] = next;
    }
    return true;
}

/// Collect what is in the cells around the cell of a place.
void NeighborList::gather(const Sorted& group, std::size_t place, Candidates& candidates) {
    const Vec3 origin{group.x[place], group.y[place], group.z[place]};
    const Real period = std::nearbyint(grains * period_ / radius_);
    candidates.origin = origin;
    candidates.exact = true;
    std::size_t count = 0, points = 0;
    const auto pad = [&] {
        const std::size_t padded = (count + octet_count - 1) / octet_count * octet_count;
        candidates.reserve(padded);
        for (; count < padded; ++count) {
            candidates.point[count] = 0;
            candidates.x[count] = nowhere;
        }
    };
    candidates.inner = 0;
    candidates.outer = 0;
    for (const Sorted& other : group_) {
        points += other.x.size();
        other.grid.around(group.grid.cell(place), [&](Index first, Index last, int image) {
            const Vec3 shifted{origin.x + image * period, origin.y, origin.z};
            candidates.reserve(count + (last - first));
            for (Index m = first; m < last; ++m, ++count) {
                const Vec3 apart = Vec3{other.x[m], other.y[m], other.z[m]} - shifted;
                candidates.point[count] = other.order[m];
                candidates.x[count] = static_cast<float>(apart.x);
                candidates.y[count] = static_cast<float>(apart.y);
                candidates.z[count] = static_cast<float>(apart.z);
                candidates.exact = candidates.exact && std::abs(apart.x) < exact_below &&
                                   std::abs(apart.y) < exact_below &&
                                   std::abs(apart.z) < exact_below;
            }
        });
        if (points == rows()) {
            candidates.sort(0, count);
            candidates.inner = count;
            pad();
            candidates.outer = count;
        }
    }
    candidates.sort(candidates.outer, count);
    candidates.count = count;
    pad();
}

void NeighborList::Candidates::reserve(std::size_t size) {
    if (size <= point.size()) return;
    const std::size_t room = 2 * size + octet_count;
    point.resize(room);
    for (auto* component : {&x, &y, &z}) component->resize(room);
}

/// Put a part of them in ascending order, as they are where the points were stored so.
void NeighborList::Candidates::sort(std::size_t first, std::size_t last) {
    const auto part = std::span(point).subspan(first, last - first);
    if (std::ranges::is_sorted(part)) return;
    std::vector<std::size_t> order(part.size());
    std::iota(order.begin(), order.end(), first);
    std::ranges::sort(order, {}, [&](std::size_t k) { return point[k]; });
    const auto apply = [&](auto& values) {
        auto sorted = std::vector(values.begin(), values.begin() + order.size());
        for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = values[order[k]];
        std::ranges::copy(sorted, values.begin() + static_cast<std::ptrdiff_t>(first));
    };
    apply(point);
    apply(x);
    apply(y);
    apply(z);
}

/// Append the candidates [first, last) that are near to point i at `centre` [grains] to its row.
/// Whole grains make the difference of two points the same float32 number but for its sign whatever
/// they are counted from; pairs so near to the radius that rounding decides are looked at in
/// double.
bool NeighborList::keep_near(const Candidates& candidates, std::size_t first, std::size_t last,
                             Index i, const Vec3& centre, Index end, Index& next) {
    const Vec3 apart = centre - candidates.origin;
    const auto x = static_cast<float>(apart.x), y = static_cast<float>(apart.y),
               z = static_cast<float>(apart.z);
    const auto grain = static_cast<float>(radius_ / grains);
    for (std::size_t m = first; m < last; m += octet_count) {
        if (next + octet_count > end) return false;
        const FloatOctet dx = load_octet(&candidates.x[m]) - x;
        const FloatOctet dy = load_octet(&candidates.y[m]) - y;
        const FloatOctet dz = load_octet(&candidates.z[m]) - z;
        const FloatOctet square = dx * dx + dy * dy + dz * dz;
        const auto other = bits(load_indices(&candidates.point[m]) != i);
        unsigned near_ones = bits(square < square_of_radius - rounding);
        unsigned doubtful = bits(square < square_of_radius + rounding) & ~near_ones;
        if (!candidates.exact) doubtful = bits(square < nowhere), near_ones = 0;
        for (; doubtful != 0; doubtful &= doubtful - 1) {
            const auto k = static_cast<unsigned>(std::countr_zero(doubtful));
            const bool image =
                period_ == 0 || std::abs(dx[k]) * grain < static_cast<float>(period_) / 2;
            if (image && near(i, candidates.point[m + k])) near_ones |= 1U << k;
        }
        next += static_cast<Index>(pack(&candidates.point[m], (grain * grain) * square,
                                        near_ones & other, &column_[next], &square_[next]));
    }
    return true;
}

} // namespace mpsdem::neighbors
