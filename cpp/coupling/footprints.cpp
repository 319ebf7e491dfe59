#include "coupling/footprints.hpp"

#include "core/check.hpp"

namespace mpsdem::coupling {

void Footprints::find(const mps::LiquidPoints& points, std::span<const Vec3> position) {
    require(points.position.size() == points.volume.size() && !points.position.empty(),
            "Footprints: a liquid needs a volume for each of its points");
    const Real reach = kernel_.radius, period = points.period;
    require(reach > 0 && (period == 0 || 2 * reach <= period),
            "Footprints: the smoothing radius must be > 0 m and at most half the period");
    if (!grid_ || period != period_) grid_.emplace(reach, period);
    period_ = period;
    const neighbors::Cells cells(points.position, reach, period, 1);
    grid_->sort(points.position, cells, order_, 1);
    sorted_.resize(order_.size());
    for (std::size_t k = 0; k < order_.size(); ++k) sorted_[k] = points.position[order_[k]];

    first_.assign(1, 0);
    point_.clear();
    weight_.clear();
    for (const Vec3& x : position) {
        Real total = 0;
        grid_->around(cells.of(x), [&](Index begin, Index end, int image) {
            const Vec3 seen{x.x + image * period, x.y, x.z};
            for (Index k = begin; k < end; ++k) {
                const Vec3 r = sorted_[k] - seen;
                const Real square = dot(r, r);
                if (square >= reach * reach) continue;
                const Index i = order_[k];
                point_.push_back(i);
                weight_.push_back(points.volume[i] * kernel_(std::sqrt(square)));
                total += weight_.back();
            }
        });
        require(total > 0, "Footprints: a solid has no liquid within the smoothing radius: raise "
                           "it, or make the liquid finer");
        for (std::size_t k = first_.back(); k < weight_.size(); ++k) weight_[k] /= total;
        first_.push_back(weight_.size());
    }
}

} // namespace mpsdem::coupling
