#pragma once

#include "core/check.hpp"
#include "dem/friction.hpp"
#include "dem/restitution.hpp"

namespace mpsdem::dem {

/// Linear spring-dashpot with a Coulomb slider.
///
///   F_n = k_n d - c_n v_n >= 0,   F_t by friction_force with k_t and c_t
///
/// Source: Cundall & Strack (1979) doi:10.1680/geot.1979.29.1.47. The damping is given in kg/s, or
/// follows from the restitution: c = a sqrt(k m*), a from damping_factor(e, 1, 0), for each pair's
/// m*.
class LinearSpring {
public:
    LinearSpring(Real normal_stiffness, Real tangential_stiffness, Real normal_damping,
                 Real tangential_damping, Real friction)
        : k_n_(normal_stiffness), k_t_(tangential_stiffness), c_n_(normal_damping),
          c_t_(tangential_damping), friction_(friction) {
        require(normal_stiffness > 0, "LinearSpring: normal_stiffness must be > 0 N/m");
        require(tangential_stiffness >= 0, "LinearSpring: tangential_stiffness must be >= 0 N/m");
        require(normal_damping >= 0, "LinearSpring: normal_damping must be >= 0 kg/s");
        require(tangential_damping >= 0, "LinearSpring: tangential_damping must be >= 0 kg/s");
        require(friction >= 0, "LinearSpring: friction must be >= 0");
        require(std::isfinite(normal_stiffness + tangential_stiffness + normal_damping +
                              tangential_damping),
                "LinearSpring: stiffness and damping must be finite");
    }

    [[nodiscard]] static LinearSpring with_restitution(Real normal_stiffness,
                                                       Real tangential_stiffness, Real restitution,
                                                       Real friction) {
        require(restitution > 0 && restitution <= 1,
                "LinearSpring: restitution must lie in (0, 1]");
        LinearSpring law(normal_stiffness, tangential_stiffness, 0, 0, friction);
        law.damping_ = damping_factor(restitution, 1, 0);
        return law;
    }

    template <class T>
    [[nodiscard]] ContactForce<T> force(const Contact<T>& c, Vector<T>& spring,
                                        Real dt) const noexcept {
        const T c_n = c_n_ + damping_ * sqrt(k_n_ * c.reduced_mass);
        const T c_t = c_t_ + damping_ * sqrt(k_t_ * c.reduced_mass);
        const T f_n = max(k_n_ * c.overlap - c_n * dot(c.relative_velocity, c.normal), T{});
        return {f_n, friction_force(c, spring, T{} + k_t_, c_t, friction_ * f_n, dt), T{} + k_t_};
    }

    [[nodiscard]] Real energy(const Contact<Real>& c, const Vec3& spring) const noexcept {
        return k_n_ / 2 * c.overlap * c.overlap + k_t_ / 2 * dot(spring, spring);
    }

private:
    Real k_n_;         // [N/m]
    Real k_t_;         // [N/m]
    Real c_n_;         // [kg/s]
    Real c_t_;         // [kg/s]
    Real friction_;    // [-]
    Real damping_ = 0; // [-]
};
static_assert(ContactLaw<LinearSpring>);

} // namespace mpsdem::dem
