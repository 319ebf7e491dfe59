#include "coupling/sample_nodes.hpp"

#include "core/check.hpp"

namespace mpsdem::coupling {

std::vector<Vec3> sample_nodes(const SmoothingKernel& kernel, const mps::eulerian::Section& section,
                               Real axial_spacing, const VectorField& velocity,
                               std::span<const Vec3> points) {
    require(kernel.radius > 0, "sample_nodes: radius must be > 0 m");
    const auto stations = static_cast<std::ptrdiff_t>(velocity.x.stations());
    std::vector<Vec3> result(points.size());
    for (std::size_t n = 0; n < points.size(); ++n) {
        const Vec3& x = points[n];
        Vec3 sum;
        Real weights = 0;
        for (std::size_t i = 0; i < section.size(); ++i) {
            const Vec3 across{0, x.y - section.place(i).y, x.z - section.place(i).z};
            const Real left = kernel.radius * kernel.radius - dot(across, across);
            if (!(left > 0)) continue;
            const Real reach = std::sqrt(left);
            const auto station = [&](Real place) { return place / axial_spacing - 0.5; };
            const auto first = static_cast<std::ptrdiff_t>(std::ceil(station(x.x - reach)));
            const auto last = static_cast<std::ptrdiff_t>(std::floor(station(x.x + reach)));
            for (std::ptrdiff_t k = first; k <= last; ++k) {
                const Real along = x.x - (static_cast<Real>(k) + 0.5) * axial_spacing;
                const Real w =
                    section.area(i) * kernel(std::hypot(along, std::sqrt(dot(across, across))));
                const auto at = static_cast<std::size_t>((k % stations + stations) % stations);
                sum += w * Vec3{velocity.x[i][at], velocity.y[i][at], velocity.z[i][at]};
                weights += w;
            }
        }
        if (weights > 0) result[n] = (1 / weights) * sum;
    }
    return result;
}

} // namespace mpsdem::coupling
