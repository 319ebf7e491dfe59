#pragma once

#include "core/parallel.hpp"
#include "geometry/surface.hpp"
#include "mps/kind.hpp"
#include "mps/moment.hpp"
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
        const auto at = wall.at(neighbors.position(liquid));
        const Real depth = -wall.at(neighbors.position(solid)).distance;
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

/// div u_i = sum_j (u_j - u_i) . M_i^-1 r_ij W / r^2 at a no-slip wall, M_i the neighborhood's
/// moment: exact for linear velocities anywhere. Between liquid a and wall or ghost b the
/// difference u_b - u_a is mirrored whole,
///
///   -k (u_a - u_b)     k = min(1 + d_b / max(d_a, 0.3 dx), 3)
///
/// In a shear flow the plain sum is a source of false divergence where particles lie unevenly: a
/// cross-flow of 0.2 % of a parabola, at any spacing. 0 for walls and ghosts. Where M_i has no
/// inverse, the sum with that of the undisturbed lattice.
template <geometry::Surface Wall>
void corrected_divergence(const Wall& wall, const ReferenceDensity& reference,
                          const neighbors::NeighborList& neighbors, std::span<const Kind> kind,
                          std::span<const Vec3> velocity, int threads, std::span<Real> result) {
    const Real least = nearest_liquid * reference.spacing;
    parallel_for(neighbors.size(), threads, [&](std::size_t i) {
        result[i] = 0;
        if (kind[i] != Kind::liquid) return;
        const Real own = std::max(wall.at(neighbors.position(i)).distance, least);
        Moment moment;
        Vec3 x, y, z; // sums of each component of the velocity
        neighbors.each(i, [&](Index j, const Vec3& r) {
            const Real factor = reference.weight.over_square(dot(r, r));
            Vec3 du = velocity[j] - velocity[i];
            if (kind[j] != Kind::liquid) {
                const Real depth = -wall.at(neighbors.position(j)).distance;
                du = std::min(1 + depth / own, Real{3}) * du;
            }
            moment.add(factor, r);
            x += (factor * du.x) * r;
            y += (factor * du.y) * r;
            z += (factor * du.z) * r;
        });
        result[i] = moment.flat() ? dimensions / reference.number_density * (x.x + y.y + z.z)
                                  : moment.solve(x).x + moment.solve(y).y + moment.solve(z).z;
    });
}

} // namespace mpsdem::mps
