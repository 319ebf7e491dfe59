#pragma once

#include "core/parallel.hpp"
#include "mps/pairs.hpp"
#include "mps/reference_density.hpp"

namespace mpsdem::mps {

/// Viscous acceleration between liquid particles, the viscosity of a pair being its mean [m/s2]:
///
///   a_i = (2 d / (n0 lambda)) sum_j (nu_i + nu_j) / 2 (u_j - u_i) W     j liquid
///
/// Pairs are equal and opposite: momentum is kept to round-off, kinetic energy only falls. Walls
/// are left to the wall function. Stable for steps below dt = lambda n0 / (2 d nu sum W), about
/// 0.3 dx^2 / nu.
/// Source: Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205, with a viscosity that varies.
void viscous_acceleration(const ReferenceDensity& reference, const Pairs auto& pairs,
                          std::span<const Real> viscosity, std::span<const Vec3> velocity,
                          int threads, std::span<Vec3> acceleration) {
    const Real scale = dimensions / (reference.number_density * reference.lambda);
    parallel_for(acceleration.size(), threads, [&](std::size_t i) {
        Vector<Lanes> sum;
        if (pairs.liquid(i)) {
            const auto own = broadcast(velocity[i]);
            pairs.template fours<Among::liquid>(i, [&](const FourPairs& p) {
                sum += (p.weight * (p.of(viscosity) + viscosity[i])) * (p.of(velocity) - own);
            });
        }
        acceleration[i] = scale * mpsdem::sum(sum);
    });
}

} // namespace mpsdem::mps
