#pragma once

#include "core/parallel.hpp"
#include "mps/pairs.hpp"
#include "mps/reference_density.hpp"

namespace mpsdem::mps {

/// What a liquid brings along that moves past its own particles [m/s2]: particles that fill a bore
/// with solids in it move with the volume flux w = eps u + s, the liquid in it with u, and
///
///   a_i = (2 d / n0) / eps_i sum_j max(0, -q_ij . r_ij) (u_j - u_i) W / r^2     j liquid
///   q   = eps (u - w),  q_ij the mean of the pair
///
/// upwind, of first order: each neighbor counts as far as the flux comes from it. Stable while
/// |u - w| dt < dx / 2 or so. Where q_i = 0 it is left out.
void relative_convection(const ReferenceDensity& reference, const Pairs auto& pairs,
                         std::span<const Vec3> relative_flux, std::span<const Real> void_fraction,
                         std::span<const Vec3> velocity, int threads,
                         std::span<Vec3> acceleration) {
    const Real scale = dimensions / reference.number_density;
    parallel_for(acceleration.size(), threads, [&](std::size_t i) {
        acceleration[i] = {};
        const Vec3& q = relative_flux[i];
        if (!pairs.liquid(i) || dot(q, q) == 0) return;
        const auto own = broadcast(velocity[i]), flux = broadcast(q);
        Vector<Lanes> sum;
        pairs.template fours<Among::liquid>(i, [&](const FourPairs& p) {
            const Lanes inflow = max(-dot(p.of(relative_flux) + flux, p.r), Lanes{}); // twice it
            sum += (p.over_square * inflow) * (p.of(velocity) - own);
        });
        acceleration[i] = (scale / void_fraction[i]) * mpsdem::sum(sum);
    });
}

} // namespace mpsdem::mps
