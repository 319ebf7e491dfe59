#pragma once

#include "core/parallel.hpp"
#include "mps/moment.hpp"
#include "mps/pairs.hpp"

namespace mpsdem::mps {

/// |S| = sqrt(2 S:S), S the symmetric part of the velocity gradient [1/s]:
///
///   grad u_i = sum_j (u_j - u_i) (x) M_i^-1 r_ij W / r^2     i, j liquid
///
/// Exact for linear velocities, and zero in rotation, wherever the neighbors are; walls do not
/// count, as liquid slips along them in the coarse view. 0 where the neighbors are too few.
/// Source: the moment M after Khayyer & Gotoh (2011), doi:10.1016/j.jcp.2011.01.009.
void shear_rate(const Pairs auto& pairs, std::span<const Vec3> velocity, int threads,
                std::span<Real> result) {
    parallel_for(result.size(), threads, [&](std::size_t i) {
        result[i] = 0;
        if (!pairs.liquid(i)) return;
        const auto own = broadcast(velocity[i]);
        Moment<Lanes> moments;
        Vector<Lanes> x, y, z; // sums of each component of the velocity
        pairs.template fours<Among::liquid>(i, [&](const FourPairs& p) {
            const Vector<Lanes> du = p.of(velocity) - own, wr = p.over_square * p.r;
            moments.add(wr, p.r);
            x += du.x * wr;
            y += du.y * wr;
            z += du.z * wr;
        });
        const Moment<Real> moment = sum(moments);
        if (moment.flat()) return;
        const Vec3 gx = moment.solve(sum(x)), gy = moment.solve(sum(y)), gz = moment.solve(sum(z));
        const Real xy = gx.y + gy.x, xz = gx.z + gz.x, yz = gy.z + gz.y;
        result[i] =
            std::sqrt(2 * (gx.x * gx.x + gy.y * gy.y + gz.z * gz.z) + xy * xy + xz * xz + yz * yz);
    });
}

} // namespace mpsdem::mps
