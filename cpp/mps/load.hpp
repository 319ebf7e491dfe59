#pragma once

#include "core/vec3.hpp"

#include <span>

namespace mpsdem::mps {

/// Where a liquid is computed, and the volume of the bore that each point stands for.
struct LiquidPoints {
    std::span<const Vec3> position; // [m]
    std::span<const Real> volume;   // [m3] liquid and solids
    Real period;                    // [m] along x, 0 for none
    bool fixed = false;             // whether they stay where they are from step to step
};

/// What solids do to a liquid at one of its points, in a line of the cache; the liquid is the
/// continuous phase of Model B, in which all of the pressure gradient acts on the liquid (Zhou et
/// al. 2010, doi:10.1017/S002211201000306X).
///
///   div(eps u + s) = 0
///   eps rho du/dt = -grad p + viscous terms + D - beta u + S
///
/// The buoyancy of the solids and the weight of the liquid make up rho g, a uniform force, which in
/// a full rigid pipe moves nothing.
struct alignas(64) LoadAt {
    Real void_fraction = 0; // [-] eps, share of the liquid
    Real drag = 0;          // [kg/(m3 s)] beta, of all solids that act here
    Vec3 solids_flux;       // [m/s] s = (1 - eps) v, volume of solids per area
    Vec3 drag_of_solids;    // [N/m3] D, the sum of beta v over them
};

/// Of all points; none: no solids.
using Load = std::span<const LoadAt>;

/// The solids as a liquid meets them in each substep of an advance.
class Loading {
public:
    Loading() = default;
    Loading(const Loading&) = default;
    Loading(Loading&&) = default;
    Loading& operator=(const Loading&) = default;
    Loading& operator=(Loading&&) = default;
    virtual ~Loading() = default;

    /// Load of a substep of `dt` [s] that begins `elapsed` [s] after the advance did. It
    /// holds until the next call.
    [[nodiscard]] virtual Load before(const LiquidPoints& points, Real elapsed, Real dt) = 0;

    /// After the substep, from the velocity that it gave [m/s]: impulse per volume that the solids
    /// still owe the liquid [N s/m3], so that what it received is what they gave, to round-off.
    [[nodiscard]] virtual std::span<const Vec3> owed(std::span<const Vec3> velocity) = 0;
};

} // namespace mpsdem::mps
