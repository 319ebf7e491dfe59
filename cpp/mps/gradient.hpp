#pragma once

#include "core/parallel.hpp"
#include "geometry/surface.hpp"
#include "mps/facing.hpp"
#include "mps/kind.hpp"
#include "mps/moment.hpp"
#include "mps/reference_density.hpp"
#include "neighbors/neighbor_list.hpp"

#include <concepts>

namespace mpsdem::mps {

/// What a pair of particles brings to a gradient.
template <class F>
concept GradientForm = requires(const F& form, Real p) {
    { form(p, p) } noexcept -> std::same_as<Real>;
};

/// p_j + p_i: pairs are equal and opposite, so momentum is kept to round-off; a constant pressure
/// pushes where the neighborhood is uneven, and evens it. Khayyer & Gotoh (2008),
/// doi:10.1142/S0578563408001788. Unstable in long pipes.
struct SumForm {
    [[nodiscard]] Real operator()(Real own, Real other) const noexcept { return other + own; }
};
/// p_j - p_i: a constant pressure has no gradient; momentum is kept to the order of the spacing.
/// Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
struct DifferenceForm {
    [[nodiscard]] Real operator()(Real own, Real other) const noexcept { return other - own; }
};
static_assert(GradientForm<SumForm> && GradientForm<DifferenceForm>);

/// grad p_i = (d / n0) sum_j form(p_i, p_j) r_ij W / r^2
template <GradientForm Form>
void gradient(const Form& form, const ReferenceDensity& reference,
              const neighbors::NeighborList& neighbors, std::span<const Real> pressure, int threads,
              std::span<Vec3> result) {
    const Real scale = dimensions / reference.number_density;
    parallel_for(neighbors.size(), threads, [&](std::size_t i) {
        Vec3 sum;
        neighbors.each(i, [&](Index j, const Vec3& r) {
            sum += (reference.weight.over_square(dot(r, r)) * form(pressure[i], pressure[j])) * r;
        });
        result[i] = scale * sum;
    });
}

/// grad p_i = M_i^-1 sum_j (p_j - p_i) r_ij W / r^2, M_i the neighborhood's moment: exact for
/// linear pressures anywhere. Where M_i has no inverse, the uncorrected difference. Blows up
/// without dissipation elsewhere. Source: Khayyer & Gotoh (2011), doi:10.1016/j.jcp.2011.01.009.
inline void corrected_gradient(const ReferenceDensity& reference,
                               const neighbors::NeighborList& neighbors,
                               std::span<const Real> pressure, int threads,
                               std::span<Vec3> result) {
    parallel_for(neighbors.size(), threads, [&](std::size_t i) {
        Vec3 sum;
        Moment moment;
        neighbors.each(i, [&](Index j, const Vec3& r) {
            const Real factor = reference.weight.over_square(dot(r, r));
            sum += (factor * (pressure[j] - pressure[i])) * r;
            moment.add(factor, r);
        });
        result[i] =
            moment.flat() ? (dimensions / reference.number_density) * sum : moment.solve(sum);
    });
}

/// grad p_i = (d / n0) sum_j ((p_j - p_i) + 2 p_b) r_ij W / r^2, between liquid and wall with p_b
/// along the wall's normal n alone:
///
///   (p_j - p_i) r_ij + 2 p_b (r_ij . n) n
///
/// The background p_b [Pa] spreads the particles evenly; along the wall it would drag. 0.02 rho U^2
/// holds the scatter of the density near 0.02 at the price of 3 % in friction; p_b must stay below
/// 0.2 rho (dx/dt)^2. n is that of j's wall at particle i.
template <geometry::Surface Wall>
void background_gradient(Real background, const Wall& wall, const ReferenceDensity& reference,
                         const neighbors::NeighborList& neighbors, std::span<const Kind> kind,
                         std::span<const Real> pressure, int threads, std::span<Vec3> result) {
    const Real scale = dimensions / reference.number_density;
    parallel_for(neighbors.size(), threads, [&](std::size_t i) {
        const Vec3 x = neighbors.position(i);
        Vec3 sum, push;
        neighbors.each(i, [&](Index j, const Vec3& r) {
            const Real factor = reference.weight.over_square(dot(r, r));
            sum += (factor * (pressure[j] - pressure[i])) * r;
            if (kind[j] == kind[i]) {
                push += factor * r;
            } else {
                const Vec3 n = facing(wall, x, neighbors.position(j)).normal;
                push += (factor * dot(r, n)) * n;
            }
        });
        result[i] = scale * (sum + (2 * background) * push);
    });
}

} // namespace mpsdem::mps
