#pragma once

#include "dem/contact_law.hpp"

namespace mpsdem::dem {

/// Tangential force of a spring with a Coulomb slider and a damper that works only while it sticks.
///
///   s <- s - (s.n) n + v_t dt;   |k s| <= mu F_n: cut the spring alone
///   F_t = -k s - c v_t           (sticking), |F_t| <= mu F_n
///
/// Cutting the spring together with the damping force, as is common, stores damping in the spring:
/// the rebound of an oblique impact then never converges with the step.
template <class T>
[[nodiscard]] Vector<T> friction_force(const Contact<T>& c, Vector<T>& spring, T stiffness,
                                       T damping, T limit, Real dt) noexcept {
    const Vector<T> v_t = tangential(c.relative_velocity, c.normal);
    const Vector<T> trial = tangential(spring, c.normal) + (T{} + dt) * v_t;
    const T elastic = stiffness * norm(trial);
    const auto sticks = elastic <= limit;
    spring = select(sticks, T{} + 1, limit / elastic) * trial;
    const Vector<T> force = -(stiffness * spring) - select(sticks, damping, T{}) * v_t;
    const T size = norm(force);
    return select(size > limit, limit / size, T{} + 1) * force;
}

} // namespace mpsdem::dem
