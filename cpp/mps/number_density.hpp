#pragma once

#include "core/parallel.hpp"
#include "mps/pairs.hpp"

namespace mpsdem::mps {

/// Particle number density n_i = sum_j W(r_ij) [-].
/// Source: Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
void number_density(const Pairs auto& pairs, int threads, std::span<Real> density) {
    parallel_for(density.size(), threads, [&](std::size_t i) {
        Lanes sum{};
        pairs.template fours<Among::all>(i, [&](const FourPairs& p) { sum += p.weight; });
        density[i] = mpsdem::sum(sum);
    });
}

} // namespace mpsdem::mps
