#include "coupling/void_fraction.hpp"

#include "core/check.hpp"
#include "core/parallel.hpp"
#include "neighbors/cell_grid.hpp"

namespace mpsdem::coupling {

namespace {

/// Share of the kernel's integral inside a cylinder, for a centre at `distance` from its axis. In
/// spherical coordinates about the centre, polar axis along the pipe, the radial integral is known.
Real share_inside(const SmoothingKernel& kernel, Real pipe_radius, Real distance) {
    constexpr int polar = 32, azimuthal = 64; // midpoint rule: the integrand is even at both ends
    const Real pi = std::numbers::pi;
    Real sum = 0, whole = 0;
    for (int j = 0; j < polar; ++j) {
        const Real theta = (j + 0.5) * pi / (2 * polar);
        const Real sine = std::sin(theta);
        for (int k = 0; k < azimuthal; ++k) {
            const Real phi = (k + 0.5) * pi / azimuthal;
            const Real off_axis = distance * std::sin(phi);
            const Real to_wall =
                std::sqrt(std::max(pipe_radius * pipe_radius - off_axis * off_axis, Real{0})) -
                distance * std::cos(phi);
            sum += sine * kernel.within(to_wall / sine);
            whole += sine * kernel.within(kernel.radius);
        }
    }
    return sum / whole;
}

constexpr Lanes counting{0, 1, 2, 3};

Real sphere_volume(Real radius) noexcept {
    return 4. / 3 * std::numbers::pi * radius * radius * radius;
}

} // namespace

VoidFraction::VoidFraction(Real pipe_radius, Real period, Real smoothing_radius)
    : kernel_{smoothing_radius}, pipe_radius_(pipe_radius), period_(period),
      first_(std::max(pipe_radius - smoothing_radius, Real{0})), share_(65) {
    require(pipe_radius > 0, "VoidFraction: pipe_radius must be > 0 m");
    require(period > 0, "VoidFraction: period must be > 0 m");
    require(
        smoothing_radius > 0 && smoothing_radius <= period,
        "VoidFraction: smoothing_radius must be > 0 m and at most the period, else a solid would "
        "be its own neighbor many times over");
    const Real step = (pipe_radius - first_) / static_cast<Real>(share_.size() - 1);
    for (std::size_t k = 0; k < share_.size(); ++k) {
        share_[k] = share_inside(kernel_, pipe_radius, first_ + static_cast<Real>(k) * step);
    }
}

Real VoidFraction::share_in_bore(Real distance) const noexcept {
    const auto last = static_cast<Real>(share_.size() - 1);
    const Real place = (distance - first_) / (pipe_radius_ - first_) * last;
    if (!(place > 0)) return share_.front();
    if (place >= last) return share_.back();
    const auto k = static_cast<std::size_t>(place);
    return std::lerp(share_[k], share_[k + 1], place - static_cast<Real>(k));
}

std::size_t VoidFraction::at_solids(std::span<const Vec3> position, std::span<const Real> radius,
                                    int threads, std::span<Real> void_fraction) const {
    require(radius.size() == position.size(), "VoidFraction: radius must have one row per solid");
    require(std::ranges::all_of(radius, [&](Real r) { return r > 0 && 3 * r <= kernel_.radius; }),
            "VoidFraction: radius must be > 0 m and at most a third of smoothing_radius: a sphere "
            "that fills the kernel has no surroundings; raise smoothing_radius");

    const bool finite = std::ranges::all_of(position, [](Vec3 x) {
        return std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z);
    });
    if (position.empty() || !finite) {
        // A diverged run is found and named by the check of the fields, not here.
        std::ranges::fill(void_fraction, Real{1});
        return 0;
    }

    std::vector<Vec3> center(position.begin(), position.end());
    for (Vec3& x : center) {
        x.x -= period_ * std::floor(x.x / period_);
        if (x.x >= period_) x.x = 0; // rounded up from just below zero
    }
    neighbors::CellGrid grid(kernel_.radius, period_);
    std::vector<Index> order;
    grid.sort(center, order);

    // Rows (x, y, z, volume) in the order of the cells; those of the padding weigh nothing.
    std::vector<Lanes> row(order.size() + lane_count);
    for (std::size_t k = 0; k < order.size(); ++k) {
        const Vec3& x = center[order[k]];
        row[k] = Lanes{x.x, x.y, x.z, sphere_volume(radius[order[k]])};
    }

    parallel_for(order.size(), threads, [&](std::size_t k) {
        const Index i = order[k];
        Lanes sums{};
        grid.around(grid.cell(k), [&](Index first, Index last, int image) {
            const Vector<Lanes> seen_from = broadcast(center[i] + Vec3{image * period_, 0, 0});
            for (Index m = first; m < last; m += lane_count) {
                const Columns other = turned(row[m], row[m + 1], row[m + 2], row[m + 3]);
                const Lanes weighted = kernel_(norm(seen_from - other.v)) * other.w;
                const auto left = static_cast<Real>(last - m);
                sums += select(counting < left, weighted, Lanes{});
            }
        });
        const Real weighted = sum(sums); // [m3]
        const Real in_bore =
            kernel_.integral() * share_in_bore(std::hypot(center[i].y, center[i].z));
        const Real all = weighted / in_bore;
        const Real own = sphere_volume(radius[i]) / in_bore;
        void_fraction[i] = all < dense_fraction
                               ? 1 - (all - own) * dense_fraction / (dense_fraction - own)
                               : 1 - all;
    });

    std::size_t clipped = 0;
    for (Real& eps : void_fraction) {
        if (eps < floor) ++clipped;
        eps = std::clamp(eps, floor, Real{1});
    }
    return clipped;
}

} // namespace mpsdem::coupling
