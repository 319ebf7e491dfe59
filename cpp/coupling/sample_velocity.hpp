#pragma once

#include "coupling/smoothing_kernel.hpp"

#include <span>
#include <vector>

namespace mpsdem::coupling {

/// Liquid velocity at points, from liquid particles in a pipe of a period along x, 0 for none
/// [m/s]:
///
///   u(x) = sum_i u_i W_s(|x - x_i|) / sum_i W_s(|x - x_i|)
///
/// Zero where no particle is within the kernel's radius. Averages a curved profile: below it by its
/// curvature times a tenth of the radius squared.
[[nodiscard]] std::vector<Vec3> sample_velocity(const SmoothingKernel& kernel, Real period,
                                                std::span<const Vec3> position,
                                                std::span<const Vec3> velocity,
                                                std::span<const Vec3> points);

} // namespace mpsdem::coupling
