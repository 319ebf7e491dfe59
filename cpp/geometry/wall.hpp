#pragma once

#include "geometry/bent_cylinder.hpp"
#include "geometry/cylinder.hpp"
#include "geometry/plane.hpp"

#include <variant>

namespace mpsdem::geometry {

/// Any wall of a scene; visited once per stage, never inside a loop over particles.
using Wall = std::variant<Plane, Cylinder, BentCylinder>;

} // namespace mpsdem::geometry
