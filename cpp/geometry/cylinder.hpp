#pragma once

#include "core/check.hpp"
#include "geometry/surface.hpp"

namespace mpsdem::geometry {

/// The bore of a straight pipe along x, wetted inside, moving with `velocity`.
class Cylinder {
public:
    Cylinder(Real radius, Vec3 velocity) : radius_(radius), velocity_(velocity) {
        require(radius > 0 && std::isfinite(radius), "Cylinder: radius must be > 0 m and finite");
        require(std::isfinite(norm(velocity)), "Cylinder: velocity must be finite");
    }

    template <class T>
    [[nodiscard]] WallPoint<T> at(const Vector<T>& point) const noexcept {
        const T r = sqrt(point.y * point.y + point.z * point.z);
        const T inverse = select(r > 0, 1 / r, T{});
        return {radius_ - r, {T{}, -point.y * inverse, -point.z * inverse}};
    }
    template <class T>
    [[nodiscard]] Vector<T> velocity(const Vector<T>&) const noexcept {
        return {T{} + velocity_.x, T{} + velocity_.y, T{} + velocity_.z};
    }
    /// Mean of the principal curvatures: 0 along the pipe, -1/radius around it.
    [[nodiscard]] Real curvature() const noexcept { return -1 / (2 * radius_); }
    /// Whether a sphere reaches the wall.
    template <class T>
    [[nodiscard]] auto touches(const Vector<T>& centre, T radius) const noexcept {
        const T free = radius_ - radius; // below zero it touches anywhere
        // no square root: this is asked of every solid near the wall, every step
        return centre.y * centre.y + centre.z * centre.z > free * abs(free);
    }

private:
    Real radius_;   // [m]
    Vec3 velocity_; // [m/s]
};
static_assert(Surface<Cylinder>);

} // namespace mpsdem::geometry
