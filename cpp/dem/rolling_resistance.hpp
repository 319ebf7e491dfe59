#pragma once

#include "core/check.hpp"
#include "dem/contact_law.hpp"

namespace mpsdem::dem {

enum class Rolling { free, resisted };

/// Elastic-plastic spring-dashpot against rolling: comes to rest exactly, where a constant torque
/// creeps.
///
///   M = -k_r theta - c_r w_t,  |M| <= mu_r R* F_n;  k_r = k_t R*^2;  c_r = 2 (0.3) sqrt(k_r I)
///
/// theta is the pair's rolling displacement [rad], cut at the limit; the damper works only below
/// it. Source: Ai et al. (2011) doi:10.1016/j.powtec.2010.09.030, model C. Deviations: k_r from the
/// tangential stiffness; I = 7/5 m* R*^2, exact at a wall, a quarter of the pair's between spheres,
/// which scales the damper alone.
class RollingResistance {
public:
    explicit RollingResistance(Real rolling_friction) : rolling_friction_(rolling_friction) {
        require(rolling_friction >= 0, "RollingResistance: rolling_friction must be >= 0");
    }

    /// Torque on body i [N m]; body j receives the opposite. `relative_spin` is w_i - w_j [rad/s].
    template <class T>
    [[nodiscard]] Vector<T> torque(const Contact<T>& c, const ContactForce<T>& force,
                                   const Vector<T>& relative_spin, Vector<T>& roll,
                                   Real dt) const noexcept {
        const T stiffness = force.tangential_stiffness * c.reduced_radius * c.reduced_radius;
        const T inertia = 1.4 * c.reduced_mass * c.reduced_radius * c.reduced_radius;
        const T limit = rolling_friction_ * c.reduced_radius * abs(force.normal);
        const Vector<T> rate = tangential(relative_spin, c.normal);
        const Vector<T> trial = tangential(roll, c.normal) + (T{} + dt) * rate;
        const T elastic = stiffness * norm(trial);
        const auto holds = elastic <= limit;
        roll = select(holds, T{} + 1, limit / elastic) * trial;
        const T damping = select(holds, 2 * damping_ratio * sqrt(stiffness * inertia), T{});
        const Vector<T> torque = -(stiffness * roll) - damping * rate;
        const T size = norm(torque);
        return select(size > limit, limit / size, T{} + 1) * torque;
    }

private:
    static constexpr Real damping_ratio = 0.3; // [-] of critical; Ai et al. (2011), section 4.3
    Real rolling_friction_;                    // [-]
};

} // namespace mpsdem::dem
