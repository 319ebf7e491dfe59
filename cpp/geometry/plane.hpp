#pragma once

#include "core/check.hpp"
#include "geometry/surface.hpp"

namespace mpsdem::geometry {

/// A flat wall through `point`, wetted on the side of `normal`, sliding with `velocity`.
class Plane {
public:
    Plane(Vec3 point, Vec3 normal, Vec3 velocity) : velocity_(velocity) {
        require(norm(normal) > 0 && std::isfinite(norm(normal)),
                "Plane: normal must be finite and not zero");
        require(std::isfinite(norm(point)), "Plane: point must be finite");
        require(std::isfinite(norm(velocity)), "Plane: velocity must be finite");
        normal_ = (1 / norm(normal)) * normal;
        offset_ = dot(point, normal_);
    }

    template <class T>
    [[nodiscard]] WallPoint<T> at(const Vector<T>& point) const noexcept {
        const Vector<T> normal{T{} + normal_.x, T{} + normal_.y, T{} + normal_.z};
        return {dot(point, normal) - offset_, normal};
    }
    template <class T>
    [[nodiscard]] Vector<T> velocity(const Vector<T>&) const noexcept {
        return {T{} + velocity_.x, T{} + velocity_.y, T{} + velocity_.z};
    }
    [[nodiscard]] Real curvature() const noexcept { return 0; }
    /// Whether a sphere reaches the wall.
    template <class T>
    [[nodiscard]] auto touches(const Vector<T>& centre, T radius) const noexcept {
        return at(centre).distance < radius;
    }

private:
    Vec3 normal_;   // [-]
    Vec3 velocity_; // [m/s]
    Real offset_;   // [m]
};
static_assert(Surface<Plane>);

} // namespace mpsdem::geometry
