#include "dem/restitution.hpp"

#include "core/check.hpp"

namespace mpsdem::dem {

namespace {

/// Speed of the rebound [-] for one damping factor, by classical Runge-Kutta in time.
Real rebound_speed(Real factor, Real p, Real q) {
    constexpr Real step = 4e-3; // in units of the impact's own time; the rebound is exact to 1e-6
    const auto acceleration = [=](Real x, Real v) {
        x = x > 0 ? x : 0;
        return -std::pow(x, p) - factor * std::pow(x, q) * v;
    };
    // The first instant is free flight: x^q is not smooth at first touch.
    Real x = 1e-9, v = 1;
    while (true) {
        const Real a1 = acceleration(x, v);
        if (v < 0 && (a1 >= 0 || x <= 0)) return -v; // the force would pull: contact is over
        // Strong damping stops the body within a fraction of the undamped time.
        const Real h = step / (1 + factor);
        const Real a2 = acceleration(x + h / 2 * v, v + h / 2 * a1);
        const Real a3 = acceleration(x + h / 2 * (v + h / 2 * a1), v + h / 2 * a2);
        const Real a4 = acceleration(x + h * (v + h / 2 * a2), v + h * a3);
        x += h * v + h * h / 6 * (a1 + a2 + a3);
        v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
}

} // namespace

Real damping_factor(Real restitution, Real p, Real q) {
    require(restitution > 0 && restitution <= 1, "restitution must lie in (0, 1]");
    if (restitution == 1) return 0;
    Real low = 0, high = 1;
    while (rebound_speed(high, p, q) > restitution) high *= 2;
    for (int k = 0; k < 40; ++k) {
        const Real middle = (low + high) / 2;
        (rebound_speed(middle, p, q) > restitution ? low : high) = middle;
    }
    return (low + high) / 2;
}

} // namespace mpsdem::dem
