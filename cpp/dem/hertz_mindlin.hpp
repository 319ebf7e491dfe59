#pragma once

#include "core/check.hpp"
#include "dem/friction.hpp"
#include "dem/restitution.hpp"

namespace mpsdem::dem {

/// Elastic constants of one body.
struct Elasticity {
    Real youngs_modulus; // [Pa]
    Real poisson_ratio;  // [-]
};

/// Hertz normal and Mindlin (no micro-slip) tangential force.
///
///   F_n = (2/3) S_n d - c_n v_n >= 0   S_n = 2 E* sqrt(R* d),  1/E* = sum (1 - nu^2) / E
///   F_t by friction_force              S_t = 8 G* sqrt(R* d),  1/G* = sum 2 (2 - nu) (1 + nu) / E
///   c   = a sqrt(2/3 S m*)             a from damping_factor(e, 3/2, 1/4);  sums over both bodies
///
/// Source: Di Renzo & Di Maio (2004) doi:10.1016/j.ces.2003.09.037, eqs. 4-14. Deviation: contacts
/// do not pull, and the damping is calibrated for that, so that `restitution` is what comes back.
/// Known error: a stuck tangential spring stiffens under growing overlap, which is no one's work.
/// Undamped (e = 1), an oblique impact gains up to 0.2 % energy at friction 0.5; none at e <= 0.95.
class HertzMindlin {
public:
    HertzMindlin(const Elasticity& first, const Elasticity& second, Real restitution, Real friction)
        : e_star_(1 / (normal_compliance(first) + normal_compliance(second))),
          g_star_(1 / (tangential_compliance(first) + tangential_compliance(second))),
          root_ratio_(std::sqrt(4 * g_star_ / e_star_)), friction_(friction) {
        require(restitution > 0 && restitution <= 1,
                "HertzMindlin: restitution must lie in (0, 1]");
        require(friction >= 0, "HertzMindlin: friction must be >= 0");
        require(std::isfinite(e_star_),
                "HertzMindlin: youngs_modulus must be finite for one body at least");
        damping_ = damping_factor(restitution, 1.5, 0.25) * std::sqrt(2. / 3);
    }

    template <class T>
    [[nodiscard]] ContactForce<T> force(const Contact<T>& c, Vector<T>& spring,
                                        Real dt) const noexcept {
        const T root = sqrt(c.reduced_radius * c.overlap);
        const T s_n = 2 * e_star_ * root;
        const T s_t = 8 * g_star_ * root;
        const T c_n = damping_ * sqrt(s_n * c.reduced_mass);
        const T c_t = root_ratio_ * c_n;
        const T f_n = max(2. / 3 * s_n * c.overlap - c_n * dot(c.relative_velocity, c.normal), T{});
        return {f_n, friction_force(c, spring, s_t, c_t, friction_ * f_n, dt), s_t};
    }

    [[nodiscard]] Real energy(const Contact<Real>& c, const Vec3& spring) const noexcept {
        const Real root = std::sqrt(c.reduced_radius * c.overlap);
        return 8. / 15 * e_star_ * root * c.overlap * c.overlap +
               4 * g_star_ * root * dot(spring, spring);
    }

private:
    static Real normal_compliance(const Elasticity& body) {
        require(body.youngs_modulus > 0, "HertzMindlin: youngs_modulus must be > 0 Pa");
        require(body.poisson_ratio > -1 && body.poisson_ratio <= 0.5,
                "HertzMindlin: poisson_ratio must lie in (-1, 0.5]");
        return (1 - body.poisson_ratio * body.poisson_ratio) / body.youngs_modulus;
    }
    static Real tangential_compliance(const Elasticity& body) {
        return 2 * (2 - body.poisson_ratio) * (1 + body.poisson_ratio) / body.youngs_modulus;
    }

    Real e_star_;      // [Pa]
    Real g_star_;      // [Pa]
    Real root_ratio_;  // [-]  sqrt(S_t / S_n)
    Real friction_;    // [-]
    Real damping_ = 0; // [-]
};
static_assert(ContactLaw<HertzMindlin>);

} // namespace mpsdem::dem
