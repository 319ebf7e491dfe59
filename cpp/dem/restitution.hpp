#pragma once

#include "core/vec3.hpp"

namespace mpsdem::dem {

/// Damping factor a of the scalar impact  x'' + a x^q x' + x^p = 0,  x(0) = 0, x'(0) = 1,
/// that returns with the speed `restitution` [-] when a pulling force is cut to zero.
/// Hertz: p = 3/2, q = 1/4 (the same for every impact speed, Tsuji, Tanaka & Ishida (1992)
/// doi:10.1016/0032-5910(92)88030-L); linear spring: p = 1, q = 0.
[[nodiscard]] Real damping_factor(Real restitution, Real p, Real q);

} // namespace mpsdem::dem
