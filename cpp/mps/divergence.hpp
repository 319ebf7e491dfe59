#pragma once

#include "core/parallel.hpp"
#include "geometry/surface.hpp"
#include "mps/pairs.hpp"
#include "mps/reference_density.hpp"

#include <algorithm>

namespace mpsdem::mps {

/// div u_i = (d / n0) sum_j (u_j - u_i) . r_ij W / r^2
///
/// Wall and ghost particles count with the velocities they are given: a wall at rest is a no-slip
/// wall, and in a plug flow a source of false divergence where its particles lie unevenly.
/// Source: Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
void divergence(const ReferenceDensity& reference, const Pairs auto& pairs,
                std::span<const Vec3> velocity, int threads, std::span<Real> result) {
    const Real scale = dimensions / reference.number_density;
    parallel_for(result.size(), threads, [&](std::size_t i) {
        const auto own = broadcast(velocity[i]);
        Lanes sum{};
        pairs.template fours<Among::all>(
            i, [&](const FourPairs& p) { sum += p.over_square * dot(p.of(velocity) - own, p.r); });
        result[i] = scale * mpsdem::sum(sum);
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
/// particles among themselves count nothing.
template <geometry::Surface Wall>
void slip_divergence(const Wall& wall, const ReferenceDensity& reference, const Pairs auto& pairs,
                     std::span<const Vec3> velocity, int threads, std::span<Real> result) {
    const Real scale = dimensions / reference.number_density;
    const Real least = nearest_liquid * reference.spacing;
    const auto mirror = [&](Lanes depth, Lanes distance) {
        const Lanes k = Lanes{} + 1 + depth / max(distance, Lanes{} + least);
        return -max(-k, Lanes{} - 3);
    };
    parallel_for(result.size(), threads, [&](std::size_t i) {
        const auto own = broadcast(velocity[i]), here = broadcast(pairs.position(i));
        const auto at = wall.at(pairs.position(i));
        const auto n = broadcast(at.normal);
        Lanes sum{};
        if (pairs.liquid(i)) {
            pairs.template fours<Among::liquid>(i, [&](const FourPairs& p) {
                sum += p.over_square * dot(p.of(velocity) - own, p.r);
            });
            pairs.template fours<Among::solid>(i, [&](const FourPairs& p) {
                const Lanes k = mirror(-wall.at(here + p.r).distance, Lanes{} + at.distance);
                sum += p.over_square * k * dot(p.of(velocity) - own, n) * dot(n, p.r);
            });
        } else {
            pairs.template fours<Among::liquid>(i, [&](const FourPairs& p) {
                const auto there = wall.at(here + p.r);
                const Lanes k = mirror(Lanes{} - at.distance, there.distance);
                sum += p.over_square * k * dot(p.of(velocity) - own, there.normal) *
                       dot(there.normal, p.r);
            });
        }
        result[i] = scale * mpsdem::sum(sum);
    });
}

} // namespace mpsdem::mps
