#pragma once

#include "core/parallel.hpp"
#include "geometry/surface.hpp"
#include "mps/facing.hpp"
#include "mps/moment.hpp"
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

/// How much of the liquid's own velocity a particle `depth` behind the wall is to have, turned
/// round, beside liquid at a `distance` from it [-]; cut where the liquid all but touches the wall.
[[nodiscard]] inline Lanes mirror_factor(Lanes depth, Lanes distance, Lanes least) noexcept {
    const Lanes k = Lanes{} + 1 + depth / max(distance, least);
    return -max(-k, Lanes{} - 3);
}

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
        return mirror_factor(depth, distance, Lanes{} + least);
    };
    parallel_for(result.size(), threads, [&](std::size_t i) {
        const auto own = broadcast(velocity[i]), here = broadcast(pairs.position(i));
        Lanes sum{};
        if (pairs.liquid(i)) {
            pairs.template fours<Among::liquid>(i, [&](const FourPairs& p) {
                sum += p.over_square * dot(p.of(velocity) - own, p.r);
            });
            pairs.template fours<Among::solid>(i, [&](const FourPairs& p) {
                const auto there = here + p.r;
                const auto at = facing(wall, here, there);
                const Lanes k = mirror(-facing(wall, there, there).distance, at.distance);
                sum +=
                    p.over_square * k * dot(p.of(velocity) - own, at.normal) * dot(at.normal, p.r);
            });
        } else {
            pairs.template fours<Among::liquid>(i, [&](const FourPairs& p) {
                const auto at = facing(wall, here + p.r, here);
                const Lanes k = mirror(-facing(wall, here, here).distance, at.distance);
                sum +=
                    p.over_square * k * dot(p.of(velocity) - own, at.normal) * dot(at.normal, p.r);
            });
        }
        result[i] = scale * mpsdem::sum(sum);
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
                          const Pairs auto& pairs, std::span<const Vec3> velocity, int threads,
                          std::span<Real> result) {
    const Real least = nearest_liquid * reference.spacing;
    parallel_for(result.size(), threads, [&](std::size_t i) {
        result[i] = 0;
        if (!pairs.liquid(i)) return;
        const auto own = broadcast(velocity[i]), here = broadcast(pairs.position(i));
        Moment<Lanes> moments;
        Vector<Lanes> x, y, z; // sums of each component of the velocity
        const auto add = [&](const FourPairs& p, const Vector<Lanes>& du) {
            const Vector<Lanes> wr = p.over_square * p.r;
            moments.add(wr, p.r);
            x += du.x * wr;
            y += du.y * wr;
            z += du.z * wr;
        };
        pairs.template fours<Among::liquid>(
            i, [&](const FourPairs& p) { add(p, p.of(velocity) - own); });
        pairs.template fours<Among::solid>(i, [&](const FourPairs& p) {
            const auto there = here + p.r;
            const Lanes k = mirror_factor(-facing(wall, there, there).distance,
                                          facing(wall, here, there).distance, Lanes{} + least);
            add(p, k * (p.of(velocity) - own));
        });
        const Moment<Real> moment = sum(moments);
        const Vec3 gx = sum(x), gy = sum(y), gz = sum(z);
        result[i] = moment.flat() ? dimensions / reference.number_density * (gx.x + gy.y + gz.z)
                                  : moment.solve(gx).x + moment.solve(gy).y + moment.solve(gz).z;
    });
}

} // namespace mpsdem::mps
