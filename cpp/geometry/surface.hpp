#pragma once

#include "core/lanes.hpp"

#include <concepts>

namespace mpsdem::geometry {

/// A wall, as seen from a point on its wetted side.
template <class T>
struct WallPoint {
    T distance;       // [m]   signed, positive on the wetted side
    Vector<T> normal; // [-]   unit vector from the wall into the bore
};

/// A surface is a small value: where the wall is, how it bends and how it moves.
/// `curvature` is its mean curvature [1/m], negative where the wall is concave as a bore is.
template <class S>
concept Surface = requires(const S& s, Vec3 point, Real radius, Vector<Lanes> points) {
    { s.at(point) } noexcept -> std::same_as<WallPoint<Real>>;
    { s.at(points) } noexcept -> std::same_as<WallPoint<Lanes>>;
    { s.velocity(point) } noexcept -> std::same_as<Vec3>;
    { s.curvature() } noexcept -> std::same_as<Real>;
    { s.touches(point, radius) } noexcept -> std::same_as<bool>; // sphere: cheap and exact
};

} // namespace mpsdem::geometry
