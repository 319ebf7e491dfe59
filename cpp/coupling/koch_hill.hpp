#pragma once

#include "coupling/drag_law.hpp"

#include <cmath>

namespace mpsdem::coupling {

/// Computed flow through random arrays of equal spheres, at solid fractions p = 1 - eps.
///
///   ratio = eps (F_0 + F_3 Re / 2)
///   F_0   = (1 + 3 sqrt(p / 2) + 135/64 p ln p + 16.14 p)
///           / (1 + 0.681 p - 8.48 p^2 + 8.16 p^3)     p < 0.4
///         = 10 p / eps^3                              above
///   F_3   = 0.0673 + 0.212 p + 0.0232 / eps^5
///
/// The sources count the whole force, that of the pressure gradient included, of which the drag is
/// the share eps, and have the radius in their Reynolds number, hence Re / 2.
/// Sources: Koch & Hill (2001), doi:10.1146/annurev.fluid.33.1.619, after lattice Boltzmann
/// computations by Hill et al. (2001), doi:10.1017/S0022112001005936, in the one form for all Re of
/// van Buijtenen et al. (2011), Chem. Eng. Sci. 66, 2368-2376. Void fractions from 0.36 to 0.9, as
/// F_3 is another one beyond; Re up to 200.
/// Deviations: other authors print 17.14 p where these have 16.14 p; theirs has the limit of dilute
/// arrays (Kim & Russel 1985, J. Fluid Mech. 154, 269-286), and 4 % more F_0 at a p of 0.2. 8.14 in
/// place of 8.16 is a misprint. A lone sphere's drag comes out 22 % high at Re 100.
struct KochHill {
    [[nodiscard]] Real force_ratio(Real reynolds, Real void_fraction) const noexcept {
        const Real p = 1 - void_fraction;
        const Real squared = void_fraction * void_fraction;
        const Real f3 = 0.0673 + 0.212 * p + 0.0232 / (squared * squared * void_fraction);
        return void_fraction * (creep(p) + f3 * reynolds / 2);
    }
    [[nodiscard]] bool covers(Real reynolds, Real void_fraction) const noexcept {
        return void_fraction >= 0.36 && void_fraction <= 0.9 && reynolds <= 200;
    }

private:
    /// F_0 at a solid fraction p.
    [[nodiscard]] static Real creep(Real p) noexcept {
        if (p >= 0.4) return 10 * p / ((1 - p) * (1 - p) * (1 - p));
        const Real p_ln_p = p > 0 ? p * std::log(p) : 0;
        return (1 + 3 * std::sqrt(p / 2) + 135. / 64 * p_ln_p + 16.14 * p) /
               (1 + p * (0.681 + p * (-8.48 + 8.16 * p)));
    }
};
static_assert(DragLaw<KochHill>);

} // namespace mpsdem::coupling
