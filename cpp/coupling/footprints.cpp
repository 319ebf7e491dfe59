#include "coupling/footprints.hpp"

#include "core/check.hpp"

#include <bit>

namespace mpsdem::coupling {

namespace {

constexpr Lanes counting{0, 1, 2, 3};

} // namespace

void Footprints::find(const mps::LiquidPoints& points, std::span<const Vec3> position) {
    require(points.position.size() == points.volume.size() && !points.position.empty(),
            "Footprints: a liquid needs a volume for each of its points");
    const Real reach = kernel_.radius, period = points.period;
    require(reach > 0 && (period == 0 || 2 * reach <= period),
            "Footprints: the smoothing radius must be > 0 m and at most half the period");
    const bool sorted = points.fixed && sorted_from_ == points.position.data() &&
                        order_.size() == points.position.size() && period == period_;
    if (sorted && std::ranges::equal(found_for_, position)) return;
    if (!sorted) sort(points);
    found_for_.clear();

    first_.assign(1, 0);
    std::size_t found = 0;
    for (const Vec3& x : position) {
        Lanes totals{};
        grid_.around(cells_.of(x), [&](Index begin, Index end, int image) {
            const Vector<Lanes> seen = broadcast(Vec3{x.x + image * period, x.y, x.z});
            if (point_.size() < found + (end - begin)) {
                point_.resize(2 * found + (end - begin));
                weight_.resize(point_.size());
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
                    point_[found] = order_[k + lane];
                    weight_[found] = weight[lane];
                    ++found;
                }
            }
        });
        const Real total = sum(totals);
        require(total > 0, "Footprints: a solid has no liquid within the smoothing radius: raise "
                           "it, or make the liquid finer");
        for (std::size_t k = first_.back(); k < found; ++k) weight_[k] /= total;
        first_.push_back(found);
    }
    found_for_.assign(position.begin(), position.end());
}

void Footprints::sort(const mps::LiquidPoints& points) {
    const Real reach = kernel_.radius;
    if (points.period != period_) grid_ = neighbors::CellGrid(reach, points.period);
    period_ = points.period;
    sorted_from_ = points.position.data();
    cells_ = neighbors::Cells(points.position, reach, points.period, 1);
    grid_.sort(points.position, cells_, order_, 1);
    row_.assign(order_.size() + lane_count, Lanes{});
    for (std::size_t k = 0; k < order_.size(); ++k) {
        const Vec3& x = points.position[order_[k]];
        row_[k] = Lanes{x.x, x.y, x.z, points.volume[order_[k]]};
    }
}

} // namespace mpsdem::coupling
