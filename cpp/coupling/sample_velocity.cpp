#include "coupling/sample_velocity.hpp"

#include "core/check.hpp"
#include "neighbors/cell_grid.hpp"

namespace mpsdem::coupling {

std::vector<Vec3> sample_velocity(const SmoothingKernel& kernel, Real period,
                                  std::span<const Vec3> position, std::span<const Vec3> velocity,
                                  std::span<const Vec3> points) {
    require(kernel.radius > 0, "sample_velocity: radius must be > 0 m");
    // One sort of points and particles together: the points come first in `all`.
    neighbors::CellGrid grid(kernel.radius, period);
    std::vector<Vec3> all(points.begin(), points.end());
    all.insert(all.end(), position.begin(), position.end());
    std::vector<Index> order;
    grid.sort(all, order);
    std::vector<Vec3> result(points.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (order[k] >= points.size()) continue;
        Vec3 sum;
        Real weights = 0;
        grid.around(grid.cell(k), [&](Index begin, Index end, int image) {
            const Vec3 x = all[order[k]] + Vec3{image * period, 0, 0};
            for (Index m = begin; m < end; ++m) {
                if (order[m] < points.size()) continue;
                const Real w = kernel(norm(x - all[order[m]]));
                sum += w * velocity[order[m] - points.size()];
                weights += w;
            }
        });
        if (weights > 0) result[order[k]] = (1 / weights) * sum;
    }
    return result;
}

} // namespace mpsdem::coupling
