#include "mps/profile/pipe_profile.hpp"

#include "core/check.hpp"

#include <cmath>

namespace mpsdem::mps {

namespace {

// Colebrook's constants [-], for a rough and for a smooth wall.
constexpr Real rough_wall = 3.7;
constexpr Real smooth_wall = 2.51;
// Reichardt's depths of the viscous layer [-], in wall units.
constexpr Real b = 11;
constexpr Real c = 3;

Real log_layer(Real y_plus, Real wall_karman) noexcept {
    return std::log1p(wall_karman * y_plus) / karman;
}

Real core(Real s) noexcept {
    return std::log(1.5 * (1 + s) / (1 + 2 * s * s)) / karman;
}

Real buffer_layer(Real y_plus) noexcept {
    return -std::expm1(-y_plus / b) - y_plus / b * std::exp(-y_plus / c);
}

// Means of the three over a bore of radius a in wall units, (2/a^2) int_0^a g(y) (a - y) dy.

Real mean_log_layer(Real a, Real wall_karman) noexcept {
    const Real k = wall_karman * a;
    const Real z = 1 + k;
    return (z * z * std::log(z) - k * (1 + 1.5 * k)) / (karman * k * k);
}

Real mean_core() noexcept {
    return (std::log(1.5) + 1.5 * (1 - std::log(3.))) / karman;
}

Real mean_buffer_layer(Real a) noexcept {
    const Real first = a * a / 2 - b * a - b * b * std::expm1(-a / b);
    const Real t = a / c;
    const Real second = c * c * c * (t - 2 + (t + 2) * std::exp(-t));
    return 2 / (a * a) * (first - second / b);
}

} // namespace

Real friction_factor(Real reynolds, Real relative_roughness) {
    require(reynolds > 0, "friction_factor: reynolds must be > 0");
    require(relative_roughness >= 0 && relative_roughness <= 0.05,
            "friction_factor: roughness must lie in [0, 0.05] of the pipe's diameter");
    if (reynolds < laminar_limit) return 64 / reynolds;

    // Newton in x = 1 / sqrt(f). The equation is nearly linear: four steps reach round-off.
    Real x = 7;
    for (int i = 0; i < 8; ++i) {
        const Real argument = relative_roughness / rough_wall + smooth_wall * x / reynolds;
        const Real slope = 2 / std::log(Real{10}) * smooth_wall / (reynolds * argument);
        x -= (x + 2 * std::log10(argument)) / (1 + slope);
    }
    return 1 / (x * x);
}

PipeProfile::PipeProfile(Real pipe_radius, Real bulk_velocity, Real kinematic_viscosity,
                         Real roughness)
    : pipe_radius_(pipe_radius), bulk_velocity_(bulk_velocity),
      kinematic_viscosity_(kinematic_viscosity),
      reynolds_(2 * pipe_radius * std::abs(bulk_velocity) / kinematic_viscosity) {
    require(pipe_radius > 0, "PipeProfile: pipe_radius must be > 0 m");
    require(std::isfinite(bulk_velocity), "PipeProfile: bulk_velocity must be finite");
    require(kinematic_viscosity > 0, "PipeProfile: kinematic_viscosity must be > 0 m2/s");
    require(roughness >= 0, "PipeProfile: roughness must be >= 0 m");
    if (reynolds_ == 0) return;

    friction_factor_ = mps::friction_factor(reynolds_, roughness / (2 * pipe_radius));
    friction_velocity_ = std::abs(bulk_velocity) * std::sqrt(friction_factor_ / 8);
    if (laminar()) return;

    const Real viscous_length = kinematic_viscosity / friction_velocity_;
    const Real a = pipe_radius / viscous_length;
    const Real shift = std::sqrt(Real{8}) / (smooth_wall * rough_wall);
    wall_karman_ = karman / (1 + shift * roughness / viscous_length);
    const Real rest =
        std::sqrt(8 / friction_factor_) - mean_log_layer(a, wall_karman_) - mean_core();
    buffer_ = rest / mean_buffer_layer(a);
}

Real PipeProfile::axial_velocity(Real distance) const noexcept {
    if (!(distance < pipe_radius_)) return 0;
    const Real s = distance / pipe_radius_;
    if (laminar()) return 2 * bulk_velocity_ * (1 - s * s);

    const Real y_plus = (pipe_radius_ - distance) * friction_velocity_ / kinematic_viscosity_;
    const Real u_plus = log_layer(y_plus, wall_karman_) + core(s) + buffer_ * buffer_layer(y_plus);
    return std::copysign(friction_velocity_, bulk_velocity_) * u_plus;
}

void PipeProfile::velocity(std::span<const Vec3> position,
                           std::span<Vec3> velocity) const noexcept {
    for (std::size_t i = 0; i < position.size(); ++i) {
        velocity[i] = {axial_velocity(std::hypot(position[i].y, position[i].z)), 0, 0};
    }
}

} // namespace mpsdem::mps
