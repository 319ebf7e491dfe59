#pragma once

#include "core/check.hpp"
#include "core/vec3.hpp"
#include "mps/profile/pipe_profile.hpp"

#include <algorithm>

namespace mpsdem::mps {

/// Wall shear from the speed u along the wall at a distance y: the greater of
///
///   laminar    u*^2 = nu u / y
///   log law    u / u* = ln(y+ / (1 + 0.26 k+)) / kappa + B     y+ = y u* / nu,  k+ = k u* / nu
///
/// kappa = 0.41, B = 5.2. The two meet at y+ = 11 on a smooth wall. 0.26 = exp(-kappa (8.5 - B))
/// lets the log law become ln(y / k) / kappa + 8.5 on a fully rough wall, with Colebrook's
/// transition between.
/// Sources: Pope (2000), Turbulent Flows, ch. 7; Nikuradse (1933), VDI-Forschungsheft 361;
/// Colebrook (1939), doi:10.1680/ijoti.1939.13150. Against Reichardt's profile of pipe flow, Re 1e4
/// to 1e6: shear within 10 % from y+ = 30 to y = 0.3 R for a roughness k below y; in the buffer
/// layer, y+ from 5 to 30, up to 20 % low, beside rough walls 30 %. k counts to 3.9 y at most.
class WallFunction {
public:
    WallFunction(Real kinematic_viscosity, Real roughness)
        : viscosity_(kinematic_viscosity), roughness_(roughness) {
        require(kinematic_viscosity > 0, "WallFunction: kinematic_viscosity must be > 0 m2/s");
        require(roughness >= 0, "WallFunction: roughness must be >= 0 m");
    }

    /// Wall shear stress over density, u*^2 [m2/s2], for speed >= 0 [m/s] and distance > 0 [m].
    [[nodiscard]] Real shear(Real speed, Real distance) const noexcept {
        return shear(speed, distance, speed);
    }
    /// The same, sought from a u* that is known to be near, such as that of the step before: one or
    /// two logarithms instead of six.
    [[nodiscard]] Real shear(Real speed, Real distance, Real guess) const noexcept {
        const Real laminar = viscosity_ * speed / distance;
        const bool near = guess < speed && guess > smallest_guess * speed;
        Real log_law = near ? friction_velocity(speed, distance, guess) : 0;
        if (log_law == 0) log_law = friction_velocity(speed, distance, speed);
        return std::max(laminar, log_law * log_law);
    }

private:
    static constexpr Real b = 5.2;               // [-] smooth wall
    static constexpr Real rough_b = 8.5;         // [-] fully rough wall
    static constexpr Real smallest_guess = 0.02; // [-] u* over the speed, u+ = 50

    /// u* of the log law, by Newton's method on u* (ln(...) / kappa + B) = u: convex, so that it
    /// falls monotonically to the root from above, and from below after one step. It has converged
    /// when a step falls below 1e-8, as each leaves about the square of the one before. 0 where y+
    /// is so small that the law has no root, or the start so low that it finds none.
    [[nodiscard]] Real friction_velocity(Real speed, Real distance, Real start) const noexcept {
        const Real k = std::min(std::exp(-karman * (rough_b - b)) * roughness_, distance);
        Real u = start;
        for (int iteration = 0; iteration < 12; ++iteration) {
            const Real rough = viscosity_ + k * u; // [m2/s]
            const Real plus = std::log(distance * u / rough) / karman + b;
            const Real slope = plus + viscosity_ / (karman * rough);
            if (!(slope > 0)) return 0;
            const Real step = (u * plus - speed) / slope;
            u -= step;
            if (!(std::abs(step) > 1e-8 * u)) break;
        }
        return u;
    }

    Real viscosity_; // [m2/s] nu
    Real roughness_; // [m]    k
};

} // namespace mpsdem::mps
