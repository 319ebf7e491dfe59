#pragma once

#include "core/parallel.hpp"
#include "mps/pairs.hpp"
#include "mps/reference_density.hpp"

namespace mpsdem::mps {

/// lap f_i = (2 d / (n0 lambda)) sum_j (f_j - f_i) W     T: Real or Vec3
///
/// Symmetric: what i gains, j loses. Second order on a lattice; among scattered particles its error
/// grows as one over the spacing. A wall acts through the values of its particles.
/// Source: Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
template <class T>
void laplacian(const ReferenceDensity& reference, const Pairs auto& pairs, std::span<const T> field,
               int threads, std::span<T> result) {
    const Real scale = 2 * dimensions / (reference.number_density * reference.lambda);
    parallel_for(result.size(), threads, [&](std::size_t i) {
        T sum{};
        pairs.template each<Among::all>(
            i, [&](const Pair& p) { sum += p.weight * (field[p.j] - field[i]); });
        result[i] = scale * sum;
    });
}

} // namespace mpsdem::mps
