#pragma once

#include "core/field.hpp"
#include "coupling/smoothing_kernel.hpp"
#include "mps/eulerian/section.hpp"

#include <span>
#include <vector>

namespace mpsdem::coupling {

/// Liquid velocity at points, from the nodes of a pipe periodic along x [m/s]:
///
///   u(x) = sum_i u_i A_i W_s(|x - x_i|) / sum_i A_i W_s(|x - x_i|)
///
/// Station k lies at (k + 1/2) `axial_spacing`. Zero where no node is within the kernel's radius.
/// Averages a curved profile: below it by its curvature times a tenth of the radius squared.
[[nodiscard]] std::vector<Vec3> sample_nodes(const SmoothingKernel& kernel,
                                             const mps::eulerian::Section& section,
                                             Real axial_spacing, const VectorField& velocity,
                                             std::span<const Vec3> points);

} // namespace mpsdem::coupling
