#pragma once

#include "core/parallel.hpp"
#include "geometry/surface.hpp"
#include "mps/facing.hpp"
#include "mps/moment.hpp"
#include "mps/pairs.hpp"
#include "mps/reference_density.hpp"

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
void gradient(const Form& form, const ReferenceDensity& reference, const Pairs auto& pairs,
              std::span<const Real> pressure, int threads, std::span<Vec3> result) {
    const Real scale = dimensions / reference.number_density;
    parallel_for(result.size(), threads, [&](std::size_t i) {
        Vec3 sum;
        pairs.template each<Among::all>(i, [&](const Pair& p) {
            sum += (p.over_square * form(pressure[i], pressure[p.j])) * p.r;
        });
        result[i] = scale * sum;
    });
}

/// grad p_i = M_i^-1 sum_j (p_j - p_i) r_ij W / r^2, M_i the neighborhood's moment: exact for
/// linear pressures anywhere. Where M_i has no inverse, the uncorrected difference. Blows up
/// without dissipation elsewhere. Source: Khayyer & Gotoh (2011), doi:10.1016/j.jcp.2011.01.009.
void corrected_gradient(const ReferenceDensity& reference, const Pairs auto& pairs,
                        std::span<const Real> pressure, int threads, std::span<Vec3> result) {
    parallel_for(result.size(), threads, [&](std::size_t i) {
        Vec3 sum;
        Moment<Real> moment;
        pairs.template each<Among::all>(i, [&](const Pair& p) {
            sum += (p.over_square * (pressure[p.j] - pressure[i])) * p.r;
            moment.add(p.over_square, p.r);
        });
        result[i] =
            moment.flat() ? (dimensions / reference.number_density) * sum : moment.solve(sum);
    });
}

/// What the pressure of a pair is taken from.
enum class Pairing {
    difference, // p_j - p_i
    conserving, // p_j + p_i: equal and opposite, momentum among liquid is kept to round-off
};

/// grad p_i = (d / n0) sum_j ((p_j -+ p_i) + 2 p_b) r_ij W / r^2 among liquid; between liquid and
/// wall the difference along the wall, and what is more than it along the wall's normal n alone:
///
///   (p_j - p_i) r_ij + 2 (p_b [+ p_i]) (r_ij . n) n
///
/// Among walls and ghosts as among liquid. The background p_b [Pa] spreads the particles evenly;
/// along the wall it would drag. 0.02 rho U^2 holds the scatter of the density near 0.02; p_b must
/// stay below 0.2 rho (dx/dt)^2. n is that of j's wall at particle i. The conserving form blows up
/// in long pipes unless the source of the pressure is freed of its axial bias; then it held in 4 m
/// for 20 s, with a fortieth of the momentum that the difference leaves unexplained.
template <geometry::Surface Wall>
void background_gradient(Pairing pairing, Real background, const Wall& wall,
                         const ReferenceDensity& reference, const Pairs auto& pairs,
                         std::span<const Real> pressure, int threads, std::span<Vec3> result) {
    const Real scale = dimensions / reference.number_density;
    parallel_for(result.size(), threads, [&](std::size_t i) {
        const Real level = background + (pairing == Pairing::conserving ? pressure[i] : 0);
        const Lanes own = Lanes{} + pressure[i], twice = Lanes{} + 2 * level;
        const auto difference = [&](const FourPairs& p) {
            return p.over_square * (p.of(pressure) - own);
        };
        Vector<Lanes> sum;
        const auto here = broadcast(pairs.position(i));
        const auto alike = [&](const FourPairs& p) {
            sum += (difference(p) + twice * p.over_square) * p.r;
        };
        const auto unlike = [&](const FourPairs& p) {
            const auto n = facing(wall, here, here + p.r).normal;
            sum += difference(p) * p.r + (twice * p.over_square * dot(p.r, n)) * n;
        };
        if (pairs.liquid(i)) {
            pairs.template fours<Among::liquid>(i, alike);
            pairs.template fours<Among::solid>(i, unlike);
        } else {
            pairs.template fours<Among::liquid>(i, unlike);
            pairs.template fours<Among::solid>(i, alike);
        }
        result[i] = scale * mpsdem::sum(sum);
    });
}

} // namespace mpsdem::mps
