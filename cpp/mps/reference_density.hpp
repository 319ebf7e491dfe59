#pragma once

#include "core/check.hpp"
#include "mps/weight.hpp"

namespace mpsdem::mps {

/// What the operators are normalised by: sums over the undisturbed cubic lattice, a particle at the
/// origin left out.
///
///   n0 = sum W(|x|)        lambda = sum |x|^2 W(|x|) / n0
///
/// With these, divergence and gradient are exact for linear fields on the lattice, and the
/// Laplacian for quadratic ones.
/// Source: Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
struct ReferenceDensity {
    ReferenceDensity(Real particle_spacing, Real effective_radius)
        : spacing(particle_spacing), weight{effective_radius} {
        require(spacing > 0, "ReferenceDensity: spacing must be > 0 m");
        require(effective_radius > spacing && effective_radius <= 10 * spacing,
                "ReferenceDensity: effective_radius must be more than one spacing, and at most 10");
        const int reach = static_cast<int>(effective_radius / spacing) + 1;
        for (int i = -reach; i <= reach; ++i) {
            for (int j = -reach; j <= reach; ++j) {
                for (int k = -reach; k <= reach; ++k) {
                    if (i == 0 && j == 0 && k == 0) continue;
                    const Real square = (i * i + j * j + k * k) * spacing * spacing;
                    const Real w = weight(std::sqrt(square));
                    number_density += w;
                    lambda += w * square;
                }
            }
        }
        lambda /= number_density;
    }

    Real spacing; // [m]
    Weight weight;
    Real number_density = 0; // [-]  n0
    Real lambda = 0;         // [m2]
};

} // namespace mpsdem::mps
