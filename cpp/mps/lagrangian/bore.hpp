#pragma once

#include "geometry/cylinder.hpp"

namespace mpsdem::mps::lagrangian {

/// What bounds the liquid: the pipe, and a plate across it that faces +x, if there is one.
///
/// Wall and ghost particles inside the radius of the pipe are the plate's, all others the pipe's.
/// Seen without such a particle, the wall is the pipe.
class Bore : public geometry::Cylinder {
public:
    Bore(Real radius, Real face) : Cylinder(radius, {}), square_(radius * radius), face_(face) {}

    /// [m] So far away that it counts as none, and yet a number.
    static constexpr Real no_plate = -1e12;
    void place_plate(Real face) noexcept { face_ = face; }

    [[nodiscard]] bool of_plate(const Vec3& particle) const noexcept {
        return particle.y * particle.y + particle.z * particle.z < square_;
    }
    using Cylinder::at;
    /// The part of the wall that `particle` belongs to, as seen from `point`.
    [[nodiscard]] geometry::WallPoint<Real> at(const Vec3& point,
                                               const Vec3& particle) const noexcept {
        if (of_plate(particle)) return {point.x - face_, {1, 0, 0}};
        return Cylinder::at(point);
    }
    [[nodiscard]] geometry::WallPoint<Lanes> at(const Vector<Lanes>& point,
                                                const Vector<Lanes>& particle) const noexcept {
        const auto plate = particle.y * particle.y + particle.z * particle.z < square_;
        const auto pipe = Cylinder::at(point);
        const Lanes none{}, one = none + 1;
        return {select(plate, point.x - face_, pipe.distance),
                {select(plate, one, pipe.normal.x), select(plate, none, pipe.normal.y),
                 select(plate, none, pipe.normal.z)}};
    }

private:
    Real square_; // [m2] of the radius
    Real face_;   // [m]
};
static_assert(geometry::Surface<Bore>);

} // namespace mpsdem::mps::lagrangian
