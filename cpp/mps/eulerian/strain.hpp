#pragma once

#include "core/lanes.hpp"

namespace mpsdem::mps::eulerian {

/// |S|^2 = 2 S:S, S the symmetric part of the velocity gradient [1/s2]; row a of the gradient is
/// that of component a.
[[nodiscard]] [[gnu::always_inline]] inline Lanes
squared_strain(const Vector<Lanes>& x, const Vector<Lanes>& y, const Vector<Lanes>& z) noexcept {
    const Lanes xy = x.y + y.x, xz = x.z + z.x, yz = y.z + z.y;
    return 2 * (x.x * x.x + y.y * y.y + z.z * z.z) + xy * xy + xz * xz + yz * yz;
}

} // namespace mpsdem::mps::eulerian
