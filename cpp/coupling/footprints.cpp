#include "coupling/footprints.hpp"

#include "core/check.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace mpsdem::coupling {

namespace {

constexpr Lanes counting{0, 1, 2, 3};

} // namespace

void Footprints::find(const mps::LiquidPoints& points, std::span<const Vec3> position,
                      int threads) {
    require(points.position.size() == points.volume.size() && !points.position.empty(),
            "Footprints: a liquid needs a volume for each of its points");
    const Real reach = kernel_.radius, period = points.period;
    require(reach > 0 && (period == 0 || 2 * reach <= period),
            "Footprints: the smoothing radius must be > 0 m and at most half the period");
    const bool sorted = points.fixed && sorted_from_ == points.position.data() &&
                        order_.size() == points.position.size() && period == period_;
    if (sorted && std::ranges::equal(found_for_, position)) return;
    if (!sorted) sort(points, threads);
    found_for_.clear();
    groups_.resize((position.size() + group_size - 1) / group_size);
    parallel_for_blocks(groups_.size(), threads, [&](std::size_t g) { find_group(g, position); });
    for (std::size_t p = 0; p < position.size(); ++p) {
        const auto& first = groups_[p / group_size].first;
        require(first[p % group_size + 1] > first[p % group_size],
                "Footprints: a solid has no liquid within the smoothing radius: raise it, or make "
                "the liquid finer");
    }
    cut(position);
    found_for_.assign(position.begin(), position.end());
}

void Footprints::find_group(std::size_t g, std::span<const Vec3> position) {
    const Real reach = kernel_.radius;
    Group& group = groups_[g];
    const std::size_t begin_solid = g * group_size;
    const std::size_t count = std::min(group_size, position.size() - begin_solid);
    std::size_t found = 0;
    for (std::size_t s = 0; s < count; ++s) {
        const Vec3& x = position[begin_solid + s];
        Lanes totals{};
        grid_.around(cells_.of(x), [&](Index begin, Index end, int image) {
            const Vector<Lanes> seen = broadcast(Vec3{x.x + image * period_, x.y, x.z});
            if (group.point.size() < found + (end - begin)) {
                group.point.resize(2 * found + (end - begin));
                group.weight.resize(group.point.size());
            }
            for (Index k = begin; k < end; k += lane_count) {
                const Columns at = turned(row_[k], row_[k + 1], row_[k + 2], row_[k + 3]);
                const Vector<Lanes> r = at.v - seen;
                const Lanes square = dot(r, r);
                const auto left = static_cast<Real>(end - k);
                const LaneMask near = (square < reach * reach) & (counting < left);
                unsigned hits = bits(near);
                if (hits == 0) continue;
                const Lanes weight = select(near, at.w * kernel_(sqrt(square)), Lanes{});
                totals += weight;
                for (; hits != 0; hits &= hits - 1) {
                    const auto lane = static_cast<std::size_t>(std::countr_zero(hits));
                    group.point[found] = order_[k + lane];
                    group.weight[found] = weight[lane];
                    ++found;
                }
            }
        });
        const Real total = sum(totals);
        if (!(total > 0)) found = group.first[s]; // no liquid here
        for (std::size_t k = group.first[s]; k < found; ++k) group.weight[k] /= total;
        group.first[s + 1] = found;
    }
}

void Footprints::cut(std::span<const Vec3> position) {
    Real begin = 0, length = period_;
    if (period_ == 0 && !position.empty()) {
        const auto [least, most] = std::ranges::minmax(position, {}, &Vec3::x);
        begin = least.x;
        length = most.x - least.x;
    }
    constexpr Real most_slabs = 4096;
    const Real fit = std::min(most_slabs, std::floor(length / (2 * kernel_.radius)));
    // an even number, as the last slab borders on the first
    const auto slabs = std::max<std::size_t>(1, 2 * static_cast<std::size_t>(fit / 2));
    const Real per_length = static_cast<Real>(slabs) / std::max(length, 2 * kernel_.radius);
    slab_first_.assign(slabs + 1, 0);
    slab_of_.resize(position.size());
    by_slab_.resize(position.size());
    for (std::size_t p = 0; p < position.size(); ++p) {
        const auto slab = static_cast<std::size_t>((position[p].x - begin) * per_length);
        slab_of_[p] = static_cast<Index>(std::min(slab, slabs - 1));
        ++slab_first_[slab_of_[p] + 1];
    }
    for (std::size_t s = 0; s < slabs; ++s) slab_first_[s + 1] += slab_first_[s];
    for (std::size_t p = position.size(); p-- > 0;)
        by_slab_[--slab_first_[slab_of_[p] + 1]] = static_cast<Index>(p);
    // Each entry now stands at its slab's beginning: move them back to their places.
    for (std::size_t s = 0; s < slabs; ++s) slab_first_[s] = slab_first_[s + 1];
    slab_first_[slabs] = position.size();
}

void Footprints::sort(const mps::LiquidPoints& points, int threads) {
    const Real reach = kernel_.radius;
    if (points.period != period_) grid_ = neighbors::CellGrid(reach, points.period);
    period_ = points.period;
    sorted_from_ = points.position.data();
    cells_ = neighbors::Cells(points.position, reach, points.period, threads);
    grid_.sort(points.position, cells_, order_, threads);
    row_.assign(order_.size() + lane_count, Lanes{});
    for (std::size_t k = 0; k < order_.size(); ++k) {
        const Vec3& x = points.position[order_[k]];
        row_[k] = Lanes{x.x, x.y, x.z, points.volume[order_[k]]};
    }
}

} // namespace mpsdem::coupling
