#pragma once

#include "core/check.hpp"
#include "core/lanes.hpp"

#include <numbers>

namespace mpsdem::dem {

/// Viscous force of a liquid squeezed out of, or drawn into, a narrow gap h, along the normal:
///
///   F = -6 pi mu R*^2 u_n (1 / max(h, h_min) - 1 / h_c),   0 < h < h_c;   R* the reduced radius
///
/// h_min stands for the roughness of the surfaces, h_c is where the drag of a lone solid takes
/// over; bodies that touch feel their contact alone. Source: Biegert, Vowinckel & Meiburg (2017)
/// doi:10.1016/j.jcp.2017.03.035; lengths here are over R*. Deviations: 1/h_c is taken off, so that
/// the force starts from zero; at a bore R* is that of its mean curvature, within 0.2 % of
/// Reynolds' equation where the solid's radius is a tenth of the bore's.
class Lubrication {
public:
    Lubrication(Real viscosity, Real least_gap, Real cutoff)
        : viscosity_(viscosity), least_gap_(least_gap), cutoff_(cutoff) {
        require(viscosity > 0 && std::isfinite(viscosity),
                "Lubrication: viscosity must be > 0 Pa s and finite");
        require(least_gap > 0, "Lubrication: least_gap must be > 0");
        require(cutoff > least_gap && cutoff <= most_cutoff,
                "Lubrication: cutoff must be > least_gap and <= 2");
    }

    /// On body i [N], positive apart. `normal_velocity` is dot(v_i - v_j, normal) [m/s].
    template <class T>
    [[nodiscard]] T force(T gap, T normal_velocity, T reduced_radius) const noexcept {
        const T narrow = max(gap, least_gap_ * reduced_radius);
        const T inverse = max(1 / narrow - 1 / (cutoff_ * reduced_radius), T{});
        const T f = -6 * std::numbers::pi * viscosity_ * reduced_radius * reduced_radius * inverse;
        return select(gap > 0, f * normal_velocity, T{});
    }

    /// Gap h_c [m].
    [[nodiscard]] Real reach(Real reduced_radius) const noexcept {
        return cutoff_ * reduced_radius;
    }
    /// Fastest rate [1/s] at which a pair is slowed, by its reduced radius over reduced mass
    /// [m/kg].
    [[nodiscard]] Real rate(Real radius_over_mass) const noexcept {
        return 6 * std::numbers::pi * viscosity_ * radius_over_mass *
               (1 / least_gap_ - 1 / cutoff_);
    }

private:
    static constexpr Real most_cutoff = 2; // [-] farther, a solid could meet two images of another

    Real viscosity_; // [Pa s]
    Real least_gap_; // [-]
    Real cutoff_;    // [-]
};

} // namespace mpsdem::dem
