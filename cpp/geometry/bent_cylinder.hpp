#pragma once

#include "geometry/bend.hpp"
#include "geometry/cylinder.hpp"

namespace mpsdem::geometry {

/// The bore of a pipe along x whose axis is bent and moves, wetted inside.
///
/// F = R - |(y, z) - w(x, t)| is zero on the wall; next to it the distance is F / |grad F|, whose
/// gradient is the wall's normal, tilted by the slope of the axis:
///
///   grad F = (e . w', -e),   e the direction from the axis to the point, in its cross-section
///
/// to the second order of the distance over the radius of the bend. Curved along the pipe by less
/// than one part in the slope's square, which is left out of the mean curvature.
class BentCylinder : public Cylinder {
public:
    explicit BentCylinder(Real radius) : Cylinder(radius, {}), radius_(radius) {}
    void bend(Bend to) noexcept { bend_ = std::move(to); }
    [[nodiscard]] const Bend& bend() const noexcept { return bend_; }

    template <class T>
    [[nodiscard]] WallPoint<T> at(const Vector<T>& point) const noexcept {
        const AxisPoint<T> axis = bend_.at(point.x);
        const Vector<T> off = point - axis.displacement;
        const T r = sqrt(off.y * off.y + off.z * off.z);
        const T inverse = select(r > 0, 1 / r, T{});
        const T tilt = inverse * (off.y * axis.slope.y + off.z * axis.slope.z);
        const T scale = 1 / sqrt(1 + tilt * tilt);
        return {scale * (radius_ - r),
                {scale * tilt, -scale * inverse * off.y, -scale * inverse * off.z}};
    }
    template <class T>
    [[nodiscard]] Vector<T> velocity(const Vector<T>& point) const noexcept {
        return bend_.at(point.x).velocity;
    }
    /// Whether a sphere reaches the wall.
    template <class T>
    [[nodiscard]] auto touches(const Vector<T>& centre, T radius) const noexcept {
        return at(centre).distance < radius;
    }

private:
    Real radius_; // [m]
    Bend bend_;
};
static_assert(Surface<BentCylinder>);

} // namespace mpsdem::geometry
