#pragma once

#include "core/check.hpp"
#include "dem/contact_law.hpp"

namespace mpsdem::dem {

/// Hertz contact of viscoelastic bodies: damping grows with the contact radius, so that slow
/// impacts lose less. The law of other codes' "hertz/history", kept for comparisons between codes.
///
///   F_n = sqrt(R* d) (k_n d - m* g_n v_n)       F_t = -sqrt(R* d) (k_t s + m* g_t v_t)
///   |F_t| <= mu |F_n|: spring and damping cut together (see friction.hpp for what that costs)
///
/// Sources: Brilliantov et al. (1996) doi:10.1103/PhysRevE.53.5382, eq. 8; Silbert et al. (2001)
/// doi:10.1103/PhysRevE.64.051302, eqs. 1-4. F_n is not clipped, as there.
class HertzViscoelastic {
public:
    HertzViscoelastic(Real normal_stiffness, Real tangential_stiffness, Real normal_damping,
                      Real tangential_damping, Real friction)
        : k_n_(normal_stiffness), k_t_(tangential_stiffness), g_n_(normal_damping),
          g_t_(tangential_damping), friction_(friction) {
        require(normal_stiffness > 0, "HertzViscoelastic: normal_stiffness must be > 0 Pa");
        require(tangential_stiffness > 0, "HertzViscoelastic: tangential_stiffness must be > 0 Pa");
        require(normal_damping >= 0, "HertzViscoelastic: normal_damping must be >= 0 1/(m s)");
        require(tangential_damping >= 0,
                "HertzViscoelastic: tangential_damping must be >= 0 1/(m s)");
        require(friction >= 0, "HertzViscoelastic: friction must be >= 0");
        require(std::isfinite(normal_stiffness + tangential_stiffness + normal_damping +
                              tangential_damping),
                "HertzViscoelastic: stiffness and damping must be finite");
    }

    template <class T>
    [[nodiscard]] ContactForce<T> force(const Contact<T>& c, Vector<T>& spring,
                                        Real dt) const noexcept {
        const T root = sqrt(c.reduced_radius * c.overlap);
        const T v_n = dot(c.relative_velocity, c.normal);
        const Vector<T> v_t = c.relative_velocity - v_n * c.normal;
        const T f_n = root * (k_n_ * c.overlap - c.reduced_mass * g_n_ * v_n);
        const Vector<T> trial = tangential(spring + (T{} + dt) * v_t, c.normal);
        const Vector<T> damper = (c.reduced_mass * (g_t_ / k_t_)) * v_t;
        const T size = root * k_t_ * norm(trial + damper);
        const T limit = friction_ * abs(f_n);
        const auto slides = size > limit;
        const Vector<T> total = select(slides, limit / size, T{} + 1) * (trial + damper);
        spring = trial + masked(slides, total - damper - trial);
        return {f_n, (-k_t_ * root) * total, root * k_t_};
    }

    [[nodiscard]] Real energy(const Contact<Real>& c, const Vec3& spring) const noexcept {
        const Real root = std::sqrt(c.reduced_radius * c.overlap);
        return root * (2. / 5 * k_n_ * c.overlap * c.overlap + k_t_ / 2 * dot(spring, spring));
    }

private:
    Real k_n_;      // [Pa]
    Real k_t_;      // [Pa]
    Real g_n_;      // [1/(m s)]
    Real g_t_;      // [1/(m s)]
    Real friction_; // [-]
};
static_assert(ContactLaw<HertzViscoelastic>);

} // namespace mpsdem::dem
