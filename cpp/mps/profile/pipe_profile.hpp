#pragma once

#include "core/vec3.hpp"

#include <span>

namespace mpsdem::mps {

inline constexpr Real laminar_limit =
    2300;                            // [-] Reynolds number below which a pipe flow is laminar
inline constexpr Real karman = 0.41; // [-] von Karman's constant

/// Darcy friction factor of a full pipe: 64 / Re below the laminar limit, above it Colebrook's
///
///   1 / sqrt(f) = -2 log10(e / (3.7 D) + 2.51 / (Re sqrt(f)))
///
/// Source: Colebrook (1939), doi:10.1680/ijoti.1939.13150. `relative_roughness` is e / D, at most
/// 0.05. Within about 3 % of measurements in smooth pipes from Re 4000; between 2300 and 4000 no
/// law holds, as the flow is intermittent.
[[nodiscard]] Real friction_factor(Real reynolds, Real relative_roughness);

/// Developed velocity profile of a full straight pipe with its axis along x, prescribed.
///
/// Laminar: u = 2 U (1 - s^2), s = r / R. Turbulent, with u* = U sqrt(f/8), y+ = (R - r) u* / nu:
///
///   u / u* = ln(1 + kappa' y+) / kappa + ln(1.5 (1 + s) / (1 + 2 s^2)) / kappa
///            + C (1 - exp(-y+/11) - (y+/11) exp(-y+/3))
///   kappa' = kappa / (1 + sqrt(8) / (2.51 * 3.7) e+),   e+ = e u* / nu
///
/// One formula from the wall to the axis: viscous sublayer, log law, and a core that is flat on the
/// axis; a roughness e shifts the log law as Colebrook's formula implies. C follows from the
/// condition that the profile carries U with the friction factor above.
/// Source: Reichardt (1951), doi:10.1002/zamm.19510310704, whose C is 7.8; the roughness by
/// comparing Colebrook's two terms. Valid where the friction factor is. The core's part adds
/// 0.83 / (kappa R+) to the wall's slope, 0.05 % at Re 2e5.
class PipeProfile {
public:
    PipeProfile(Real pipe_radius, Real bulk_velocity, Real kinematic_viscosity, Real roughness);

    /// Axial velocity at a distance from the axis [m/s]; 0 outside the bore.
    [[nodiscard]] Real axial_velocity(Real distance) const noexcept;
    void velocity(std::span<const Vec3> position, std::span<Vec3> velocity) const noexcept;

    [[nodiscard]] Real reynolds() const noexcept { return reynolds_; }
    [[nodiscard]] bool laminar() const noexcept { return reynolds_ < laminar_limit; }
    [[nodiscard]] Real friction_factor() const noexcept { return friction_factor_; }
    [[nodiscard]] Real friction_velocity() const noexcept { return friction_velocity_; }

private:
    Real pipe_radius_;         // [m]
    Real bulk_velocity_;       // [m/s]  U, signed along x
    Real kinematic_viscosity_; // [m2/s]
    Real reynolds_;            // [-]    2 R |U| / nu
    Real friction_factor_{};   // [-]    Darcy; 0 where the liquid rests
    Real friction_velocity_{}; // [m/s]  u* >= 0
    Real wall_karman_{};       // [-]    kappa'
    Real buffer_{};            // [-]    C
};

} // namespace mpsdem::mps
