#include "neighbors/neighbor_list.hpp"

#include "core/check.hpp"
#include "core/ordered_sum.hpp"
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
constexpr Real widest_exact_cell = 3; // [-] radii: differences below 2^23 grains are exact
constexpr float nowhere = 1e30F;      // [grains]

void require_finite(std::span<const Vec3> position, int threads) {
    const Real lost = ordered_sum(position.size(), threads, [&](std::size_t i) {
        const Vec3& x = position[i];
        return std::isfinite(x.x + x.y + x.z) ? 0. : 1.;
    });
    require(lost == 0, "position must be finite");
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
    require_finite(position, 1);
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
    struct Nothing {
        void reserve(std::size_t) {}
        void operator()(Index, std::span<const float>) const {}
    };
    find(position, {{position.size()}, position.size()}, threads, Nothing{});
}

void NeighborList::prepare(std::span<const Vec3> position, const Groups& groups, int threads) {
    require(position.size() < std::numeric_limits<Index>::max(),
            "NeighborList: position must have fewer than 2^32 rows");
    require_finite(position, threads);
    wrap(position, period_, threads, position_);
    const Cells cells(position_, radius_, period_, threads);
    exact_ = std::ranges::all_of(
        cells.inverse, [&](Real inverse) { return inverse * radius_ * widest_exact_cell >= 1; });
    group_.resize(groups.group.size(), {CellGrid(radius_, period_), {}, {}, {}, {}});
    blocks_.clear();
    std::size_t points = 0;
    bool reaches_rows = groups.rows == 0;
    for (std::size_t g = 0; g < group_.size(); ++g) {
        const std::size_t count = groups.group[g];
        sort_group(group_[g], cells, points, count, threads);
        points += count;
        reaches_rows = reaches_rows || points == groups.rows;
        if (points > groups.rows) continue;
        for (std::size_t k = 0; k < count; k += block_rows)
            blocks_.push_back({g, k, std::min(count, k + block_rows)});
    }
    require(reaches_rows, "NeighborList: rows must be those of whole groups");
    require(points == position.size(), "NeighborList: the groups must have all points");
    first_.resize(groups.rows);
    inner_.resize(groups.rows);
    last_.resize(groups.rows);
    candidates_.resize(std::max(candidates_.size(), blocks_.size()));
    tight_ = false;
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

std::size_t NeighborList::make_room() {
    row_room_ = tight_ ? row_room_ + row_room_ / 2 : std::max(row_room_, least_row_room);
    tight_ = true;
    const std::size_t room = row_room_ * block_rows;
    entries_ = room * blocks_.size();
    require(entries_ <= std::numeric_limits<Index>::max(),
            "NeighborList: more than 2^32 pairs; is radius too large?");
    if (entries_ > capacity_) {
        // memory that is never written to is never taken: the gaps cost nothing
        column_ = std::make_unique_for_overwrite<Index[]>(entries_);
        capacity_ = entries_;
    }
    return room;
}

bool NeighborList::find_row(const Sorted& group, std::size_t place, Candidates& candidates,
                            Index cell_begin, Index end, Index& next) {
    const Index i = group.order[place];
    const Vec3 centre{group.x[place], group.y[place], group.z[place]};
    candidates.square.resize(
        std::max(candidates.square.size(), next - cell_begin + candidates.count + octet_count));
    first_[i] = next;
    if (!keep_near(candidates, 0, candidates.inner, i, centre, cell_begin, end, next)) return false;
    inner_[i] = next;
    if (!keep_near(candidates, candidates.outer, candidates.count, i, centre, cell_begin, end,
                   next))
        return false;
    last_[i] = next;
    return true;
}

/// Collect what is in the cells around the cell of a place.
void NeighborList::collect(const Sorted& group, std::size_t place, Candidates& candidates) {
    const Vec3 origin{group.x[place], group.y[place], group.z[place]};
    const Real period = std::nearbyint(grains * period_ / radius_);
    candidates.origin = origin;
    candidates.inner = candidates.outer = candidates.count = 0;
    std::size_t points = 0;
    for (const Sorted& other : group_) {
        points += other.x.size();
        other.grid.around(group.grid.cell(place), [&](Index first, Index last, int image) {
            const std::size_t count = last - first, at = candidates.count;
            candidates.reserve(at + count);
            const auto append = [&](const std::vector<Real>& from, Real zero,
                                    std::vector<float>& to) {
                const Real* const source = from.data() + first;
                float* const target = to.data() + at;
                for (std::size_t m = 0; m < count; ++m)
                    target[m] = static_cast<float>(source[m] - zero);
            };
            append(other.x, origin.x + image * period, candidates.x);
            append(other.y, origin.y, candidates.y);
            append(other.z, origin.z, candidates.z);
            std::copy_n(other.order.begin() + first, count,
                        candidates.point.begin() + static_cast<std::ptrdiff_t>(at));
            candidates.count += count;
        });
        if (points == rows()) {
            candidates.sort(0, candidates.count);
            candidates.inner = candidates.count;
            candidates.pad();
            candidates.outer = candidates.count;
        }
    }
    candidates.sort(candidates.outer, candidates.count);
    candidates.pad();
}

/// Fill the last register with points that are near to nothing.
void NeighborList::Candidates::pad() {
    reserve(count + octet_count);
    for (; count % octet_count != 0; ++count) {
        point[count] = 0;
        x[count] = nowhere;
    }
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
bool NeighborList::keep_near(Candidates& candidates, std::size_t first, std::size_t last, Index i,
                             const Vec3& centre, Index cell_begin, Index end, Index& next) {
    const Vec3 apart = centre - candidates.origin;
    const auto x = static_cast<float>(apart.x), y = static_cast<float>(apart.y),
               z = static_cast<float>(apart.z);
    const auto grain = static_cast<float>(radius_ / grains);
    const auto half = static_cast<float>(period_ / 2) / grain;
    const float *const xs = candidates.x.data(), *const ys = candidates.y.data(),
                       *const zs = candidates.z.data();
    const Index* const point = candidates.point.data();
    const bool exact = exact_;
    Index* const column = column_.get();
    float* const squares = candidates.square.data();
    Index at = next;
    for (std::size_t m = first; m < last; m += octet_count) {
        if (at + octet_count > end) return false;
        const FloatOctet dx = load_octet(xs + m) - x;
        const FloatOctet dy = load_octet(ys + m) - y;
        const FloatOctet dz = load_octet(zs + m) - z;
        const FloatOctet square = dx * dx + dy * dy + dz * dz;
        unsigned near_ones = bits(square < square_of_radius - rounding);
        unsigned doubtful = bits(square < square_of_radius + rounding);
        if (!exact) {
            doubtful = bits(square < nowhere);
            near_ones = 0;
        }
        if (doubtful != near_ones) {
            for (unsigned left = doubtful & ~near_ones; left != 0; left &= left - 1) {
                const auto k = static_cast<unsigned>(std::countr_zero(left));
                const bool image = period_ == 0 || std::abs(dx[k]) < half;
                if (image && near(i, point[m + k])) near_ones |= 1U << k;
            }
        }
        near_ones &= bits(load_indices(point + m) != i);
        at += static_cast<Index>(pack(point + m, (grain * grain) * square, near_ones, column + at,
                                      squares + (at - cell_begin)));
    }
    next = at;
    return true;
}

} // namespace mpsdem::neighbors
