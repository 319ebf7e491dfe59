#pragma once

#include "core/parallel.hpp"
#include "mps/weight.hpp"
#include "neighbors/neighbor_list.hpp"

namespace mpsdem::mps {

/// Particle number density n_i = sum_j W(r_ij) [-].
/// Source: Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
inline void number_density(const Weight& weight, const neighbors::NeighborList& neighbors,
                           int threads, std::span<Real> density) {
    parallel_for(neighbors.size(), threads, [&](std::size_t i) {
        Real sum = 0;
        neighbors.each(i, [&](Index, const Vec3& r) { sum += weight(norm(r)); });
        density[i] = sum;
    });
}

} // namespace mpsdem::mps
