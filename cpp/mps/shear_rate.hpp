#pragma once

#include "core/parallel.hpp"
#include "mps/kind.hpp"
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
void shear_rate(const Pairs auto& pairs, std::span<const Kind> kind, std::span<const Vec3> velocity,
                int threads, std::span<Real> result) {
    parallel_for(pairs.rows(), threads, [&](std::size_t i) {
        result[i] = 0;
        if (kind[i] != Kind::liquid) return;
        Moment moment;
        Vec3 x, y, z; // sums of each component of the velocity
        pairs.each(i, [&](Index j, const Vec3& r, Real, Real factor) {
            if (kind[j] != Kind::liquid) return;
            const Vec3 du = velocity[j] - velocity[i];
            moment.add(factor, r);
            x += (factor * du.x) * r;
            y += (factor * du.y) * r;
            z += (factor * du.z) * r;
        });
        if (moment.flat()) return;
        const Vec3 gx = moment.solve(x), gy = moment.solve(y), gz = moment.solve(z);
        const Real xy = gx.y + gy.x, xz = gx.z + gz.x, yz = gy.z + gz.y;
        result[i] =
            std::sqrt(2 * (gx.x * gx.x + gy.y * gy.y + gz.z * gz.z) + xy * xy + xz * xz + yz * yz);
    });
}

} // namespace mpsdem::mps
