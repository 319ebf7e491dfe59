#pragma once

#include "core/check.hpp"
#include "core/parallel.hpp"
#include "core/vec3.hpp"

#include <algorithm>
#include <concepts>
#include <span>

namespace mpsdem::mps {

/// An eddy viscosity is nu_t = l^2 |S|; a model gives the length l [m] at a point.
template <class M>
concept LengthModel = requires(const M& model, Vec3 x) {
    { model.length(x) } noexcept -> std::same_as<Real>;
};

/// Mixing length of developed flow in a round pipe about the x axis:
///
///   l / R = 0.14 - 0.08 s^2 - 0.06 s^4     s = r / R
///
/// 0.4 of the distance from the wall next to it, 0.14 R on the axis. A model of the mean flow.
/// Source: Nikuradse (1932), VDI-Forschungsheft 356; in Schlichting, Boundary-Layer Theory, ch. 20.
/// For Reynolds numbers from 1e5.
class MixingLength {
public:
    explicit MixingLength(Real pipe_radius) : pipe_radius_(pipe_radius) {
        require(pipe_radius > 0, "MixingLength: pipe_radius must be > 0 m");
    }
    [[nodiscard]] Real length(const Vec3& x) const noexcept {
        const Real s2 = (x.y * x.y + x.z * x.z) / (pipe_radius_ * pipe_radius_);
        return pipe_radius_ * std::max(0.14 - (0.08 + 0.06 * s2) * s2, Real{0});
    }

private:
    Real pipe_radius_; // [m]
};

/// l = C_s dx: the eddies too small for the spacing. A model of what large eddies leave over: in a
/// coarse pipe, where the particles carry no eddies, friction comes out too low (8 % at R/dx = 8).
/// Source: Smagorinsky (1963), doi:10.1175/1520-0493(1963)091<0099:GCEWTP>2.3.CO;2; C_s is 0.1 to
/// 0.2.
class Smagorinsky {
public:
    Smagorinsky(Real coefficient, Real spacing) : length_(coefficient * spacing) {
        require(coefficient >= 0, "Smagorinsky: coefficient must be >= 0");
        require(spacing > 0, "Smagorinsky: spacing must be > 0 m");
    }
    [[nodiscard]] Real length(const Vec3&) const noexcept { return length_; }

private:
    Real length_; // [m]
};

static_assert(LengthModel<MixingLength> && LengthModel<Smagorinsky>);

/// nu_t = min(l^2 |S|, largest) [m2/s]. An explicit step needs the cap: 0.1 dx^2 / dt holds.
template <LengthModel Model>
void eddy_viscosity(const Model& model, std::span<const Vec3> position,
                    std::span<const Real> shear_rate, Real largest, int threads,
                    std::span<Real> viscosity) {
    parallel_for(position.size(), threads, [&](std::size_t i) {
        const Real l = model.length(position[i]);
        viscosity[i] = std::min(l * l * shear_rate[i], largest);
    });
}

} // namespace mpsdem::mps
