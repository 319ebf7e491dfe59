#pragma once

#include "geometry/surface.hpp"

namespace mpsdem::mps {

/// The wall that a wall or ghost particle belongs to, as seen from a point. A wall of several parts
/// says which by an `at(point, particle)`; any other has one part. T: Real, or Lanes.
template <geometry::Surface Wall, class T>
[[nodiscard]] geometry::WallPoint<T> facing(const Wall& wall, const Vector<T>& point,
                                            const Vector<T>& particle) noexcept {
    if constexpr (requires { wall.at(point, particle); })
        return wall.at(point, particle);
    else
        return wall.at(point);
}

} // namespace mpsdem::mps
