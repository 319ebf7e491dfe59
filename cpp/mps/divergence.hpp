#pragma once

#include "core/parallel.hpp"
#include "geometry/surface.hpp"
#include "mps/facing.hpp"
#include "mps/kind.hpp"
#include "mps/reference_density.hpp"
#include "neighbors/neighbor_list.hpp"

#include <algorithm>

namespace mpsdem::mps {

/// div u_i = (d / n0) sum_j (u_j - u_i) . r_ij W / r^2
///
/// Wall and ghost particles count with the velocities they are given: a wall at rest is a no-slip
/// wall, and in a plug flow a source of false divergence where its particles lie unevenly.
/// Source: Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
inline void divergence(const ReferenceDensity& reference, const neighbors::NeighborList& neighbors,
                       std::span<const Vec3> velocity, int threads, std::span<Real> result) {
    const Real scale = dimensions / reference.number_density;
    parallel_for(neighbors.size(), threads, [&](std::size_t i) {
        Real sum = 0;
        neighbors.each(i, [&](Index j, const Vec3& r) {
            sum += reference.weight.over_square(dot(r, r)) * dot(velocity[j] - velocity[i], r);
        });
        result[i] = scale * sum;
    });
}

inline constexpr Real nearest_liquid = 0.3; // [-] spacings from the wall, as near as liquid comes

/// The same with a wall that lets slip: between liquid a and wall or ghost b the difference
/// u_b - u_a becomes
///
///   -k ((u_a - u_b) . n) n     k = min(1 + d_b / max(d_a, 0.3 dx), 3)
///
/// the normal velocity mirrored in the wall, n its normal at a, d the distances from it. Only the
/// velocity through the wall counts, so plug flow and rotation about the axis have no divergence.
/// Exact for a normal velocity linear in the distance, where k is not cut. Pairs of wall and ghost
/// particles count nothing, and a ghost's own sum is 0.
template <geometry::Surface Wall>
void slip_divergence(const Wall& wall, const ReferenceDensity& reference,
                     const neighbors::NeighborList& neighbors, std::span<const Kind> kind,
                     std::span<const Vec3> velocity, int threads, std::span<Real> result) {
    const Real scale = dimensions / reference.number_density;
    const Real least = nearest_liquid * reference.spacing;
    const auto mirrored = [&](std::size_t liquid, std::size_t solid) {
        const Vec3 particle = neighbors.position(solid);
        const auto at = facing(wall, neighbors.position(liquid), particle);
        const Real depth = -facing(wall, particle, particle).distance;
        const Real k = std::min(1 + depth / std::max(at.distance, least), Real{3});
        return (-k * dot(velocity[liquid] - velocity[solid], at.normal)) * at.normal;
    };
    parallel_for(neighbors.size(), threads, [&](std::size_t i) {
        Real sum = 0;
        const bool liquid = kind[i] == Kind::liquid;
        if (kind[i] != Kind::ghost) {
            neighbors.each(i, [&](Index j, const Vec3& r) {
                const bool other = kind[j] == Kind::liquid;
                if (!liquid && !other) return;
                const Vec3 du = liquid && other ? velocity[j] - velocity[i]
                                : liquid        ? mirrored(i, j)
                                                : -mirrored(j, i);
                sum += reference.weight.over_square(dot(r, r)) * dot(du, r);
            });
        }
        result[i] = scale * sum;
    });
}

} // namespace mpsdem::mps
