#pragma once

#include "coupling/smoothing_kernel.hpp"

#include <span>
#include <vector>

namespace mpsdem::coupling {

/// Void fraction that each solid sees in a straight pipe, periodic along x.
///
///   phi_p   = sum_q W_s(|x_p - x_q|) V_q / int_bore W_s(|x_p - x|) dx     q = p included
///   eps_p   = 1 - (phi_p - phi_self) a / (a - phi_self)   phi_p < a = 0.6
///           = 1 - phi_p                                   above
///
/// The kernel is normalised by the part of it that lies inside the bore, else a bed on the wall
/// would read too thin. phi_self is the sphere's own share: it is no obstacle to its own drag, so a
/// lone one sees eps = 1, while a dense bed must show its full solid fraction; in between, the
/// others' share is stretched to fill what the sphere itself takes in a bed of fraction a.
/// Against the spheres' volume smoothed exactly, in lattices of fraction 0.3 to 0.6 that fill the
/// bore, with r_s = 2.5 diameters: within 0.03, on the axis as at the wall.
class VoidFraction {
public:
    static constexpr Real floor = 0.3;          // [-] a clip, counted; packings have 0.36 and more
    static constexpr Real dense_fraction = 0.6; // [-] a, solid fraction of a settled bed of spheres

    VoidFraction(Real pipe_radius, Real period, Real smoothing_radius);

    /// Fill `void_fraction`, return how many of them were raised to the floor.
    [[nodiscard]] std::size_t at_solids(std::span<const Vec3> position,
                                        std::span<const Real> radius, int threads,
                                        std::span<Real> void_fraction) const;

private:
    /// Share of the kernel's integral inside the bore, at a distance from the axis [m]. Linear
    /// interpolation between tabulated integrals, error below 1e-3.
    [[nodiscard]] Real share_in_bore(Real distance) const noexcept;

    SmoothingKernel kernel_;
    Real pipe_radius_;        // [m]
    Real period_;             // [m]
    Real first_;              // [m] distance from the axis where the kernel reaches the wall
    std::vector<Real> share_; // [-] at equal distances from first_ to the wall
};

} // namespace mpsdem::coupling
