#pragma once

#include "geometry/bent_cylinder.hpp"

namespace mpsdem::mps::lagrangian {

/// What bounds the liquid: the pipe, straight or bent, and a plate across a straight one that faces
/// +x, if there is one.
///
/// Wall and ghost particles inside the radius of the pipe are the plate's, all others the pipe's.
/// Seen without such a particle, the wall is the pipe.
class Bore : public geometry::Cylinder {
public:
    Bore(Real radius, Real face)
        : Cylinder(radius, {}), bent_(radius), square_(radius * radius), face_(face) {}

    /// [m] So far away that it counts as none, and yet a number.
    static constexpr Real no_plate = -1e12;
    void place_plate(Real face) noexcept { face_ = face; }
    void bend(geometry::Bend to) noexcept { bent_.bend(std::move(to)); }
    [[nodiscard]] bool straight() const noexcept { return bent_.bend().straight(); }
    [[nodiscard]] const geometry::BentCylinder& bent() const noexcept { return bent_; }
    [[nodiscard]] geometry::AxisPoint<Real> axis(Real x) const noexcept {
        return bent_.bend().at(x);
    }

    [[nodiscard]] bool of_plate(const Vec3& particle) const noexcept {
        return particle.y * particle.y + particle.z * particle.z < square_;
    }
    template <class T>
    [[nodiscard]] geometry::WallPoint<T> at(const Vector<T>& point) const noexcept {
        return straight() ? Cylinder::at(point) : bent_.at(point);
    }
    template <class T>
    [[nodiscard]] Vector<T> velocity(const Vector<T>& point) const noexcept {
        return bent_.velocity(point);
    }
    template <class T>
    [[nodiscard]] auto touches(const Vector<T>& centre, T radius) const noexcept {
        return at(centre).distance < radius;
    }
    /// The part of the wall that `particle` belongs to, as seen from `point`.
    [[nodiscard]] geometry::WallPoint<Real> at(const Vec3& point,
                                               const Vec3& particle) const noexcept {
        if (!straight()) return bent_.at(point);
        if (of_plate(particle)) return {point.x - face_, {1, 0, 0}};
        return Cylinder::at(point);
    }
    [[nodiscard]] geometry::WallPoint<Lanes> at(const Vector<Lanes>& point,
                                                const Vector<Lanes>& particle) const noexcept {
        if (!straight()) return bent_.at(point);
        const auto plate = particle.y * particle.y + particle.z * particle.z < square_;
        const auto pipe = Cylinder::at(point);
        const Lanes none{}, one = none + 1;
        return {select(plate, point.x - face_, pipe.distance),
                {select(plate, one, pipe.normal.x), select(plate, none, pipe.normal.y),
                 select(plate, none, pipe.normal.z)}};
    }

private:
    geometry::BentCylinder bent_;
    Real square_; // [m2] of the radius
    Real face_;   // [m]
};
static_assert(geometry::Surface<Bore>);

} // namespace mpsdem::mps::lagrangian
