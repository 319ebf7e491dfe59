#pragma once

#include "core/lanes.hpp"

#include <concepts>

namespace mpsdem::dem {

/// One touching pair, seen from body i. The sign convention is fixed here and nowhere else:
/// `normal` points from j to i, `relative_velocity` is v_i - v_j at the contact point, so
/// dot(relative_velocity, normal) < 0 while the bodies approach.
template <class T>
struct Contact {
    Vector<T> normal;            // [-]    unit vector
    Vector<T> relative_velocity; // [m/s]  spin included
    T overlap;                   // [m]    > 0
    T reduced_radius;            // [m]    R_i R_j / (R_i + R_j);  1 / (1/R_i + curvature) at a wall
    T reduced_mass;              // [kg]   m_i m_j / (m_i + m_j);  m_i at a wall
};

/// Force on body i; body j receives the opposite.
template <class T>
struct ContactForce {
    T normal;               // [N]    along Contact::normal, positive apart
    Vector<T> tangential;   // [N]
    T tangential_stiffness; // [N/m]
};

/// A contact law is a small value type: parameters in, one pair's force out. `spring` is the
/// pair's tangential displacement [m]; the law advances it by `dt` [s] and the caller stores it.
/// The force is written on T without branches: one text serves one pair and a register of pairs.
template <class Law>
concept ContactLaw = requires(const Law& law, const Contact<Real>& c, Vec3& spring,
                              const Contact<Lanes>& lanes, Vector<Lanes>& springs, Real dt) {
    { law.force(c, spring, dt) } noexcept -> std::same_as<ContactForce<Real>>;
    { law.force(lanes, springs, dt) } noexcept -> std::same_as<ContactForce<Lanes>>;
    { law.energy(c, spring) } noexcept -> std::same_as<Real>;
};

} // namespace mpsdem::dem
