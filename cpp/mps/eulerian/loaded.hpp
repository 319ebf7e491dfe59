#pragma once

#include "core/field.hpp"

#include <span>
#include <vector>

namespace mpsdem::mps::eulerian {

/// What a liquid on nodes keeps while there are solids in it. Fields are [node][station], walls
/// last; they have there what the liquid inward of them has.
struct Loaded {
    Loaded(std::size_t nodes, std::size_t stations)
        : eps(nodes, stations), beta(nodes, stations), eps_viscosity(nodes, stations),
          pressure(nodes, stations), flux(nodes, stations), drag(nodes, stations),
          rate_before(nodes, stations) {}

    Field eps;               // [-] void fraction of the last substep
    Field beta;              // [1/s] over the liquid's density
    Field eps_viscosity;     // [m2/s] eps nu
    Field pressure;          // [m2/s2] p over density, kept from step to step
    VectorField flux;        // [m/s] s of the solids
    VectorField drag;        // [m/s2] D over density
    VectorField rate_before; // [m/s2] du/dt by convection and viscosity, of the substep before

    Real step_before = 0;     // [s]; 0: there was none
    Real gradient = 0;        // [m/s2] G over density, as held at the end of it
    Real error_before = 0;    // [m/s2] convection's error over density, of the substep before
    Real friction_before = 0; // [m/s2] of the walls, likewise

    /// All that the next step needs, as one row of numbers; `unpack` refuses any other.
    [[nodiscard]] std::vector<Real> packed() const;
    void unpack(std::span<const Real> numbers);

    // By inner node and station, as the solids see them.
    std::vector<Vec3> velocity;     // [m/s] at the start of the substep
    std::vector<Vec3> acceleration; // [m/s2] over the last substep, drag apart
    std::vector<Real> wall_drag;    // [m3/s2] by station
};

} // namespace mpsdem::mps::eulerian
