#pragma once

#include <cstdint>

namespace mpsdem::mps {

/// What a particle is, numbered as by Pan, Wei & Wan, "MPS-DEM Method for Particle Effects on Mixed
/// Transportation Characteristics of Horizontal Pipeline".
enum class Kind : std::int8_t {
    wall = -2,  // on the wall; its pressure is an unknown
    ghost = -1, // behind the wall, to complete the sums; its pressure is extrapolated
    liquid = 2,
};

} // namespace mpsdem::mps
