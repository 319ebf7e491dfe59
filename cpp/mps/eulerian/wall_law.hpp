#pragma once

#include "mps/eulerian/section.hpp"
#include "mps/turbulence.hpp"
#include "mps/wall_function.hpp"

#include <span>

namespace mpsdem::mps::eulerian {

/// What a turbulent flow does at the wall and in the layer next to it, which is too thin for the
/// nodes: at each wall node, from the velocity u_1 at a distance y_1 inward, a spacing,
///
///   u*^2       from the log law (`WallFunction`)
///   u_wall     = u_1 - u*^2 y_1 / (nu + kappa u* y_1 / 2)      slip, along u_1
///   nu_t       = l u* at the layer's nodes, l the mixing length; 0 on the wall
///
/// The slip lets the straight line between wall and layer carry the flow rate of the log law.
class WallLaw {
public:
    WallLaw(Real kinematic_viscosity, Real roughness, const Section& section)
        : viscosity_(kinematic_viscosity), function_(kinematic_viscosity, roughness),
          distance_(section.layer_distance()) {}

    /// Where a sweep writes: the wall's velocity, u* of each wall node, and for each station the
    /// force of the wall on the liquid along the pipe over density and length [m3/s2].
    struct Output {
        VectorField& velocity;
        Field& friction_velocity; // wall nodes only
        std::span<Real> drag;
    };

    /// Of the stations [begin, end).
    void slip(const Section& section, std::size_t begin, std::size_t end, Output out) const {
        VectorField& u = out.velocity;
        std::fill(out.drag.begin() + static_cast<std::ptrdiff_t>(begin),
                  out.drag.begin() + static_cast<std::ptrdiff_t>(end), 0);
        for (std::size_t w = 0; w < section.wall_count(); ++w) {
            const std::size_t i = section.interior_count() + w;
            const Vec3 normal = section.outward(i);
            const auto [node, share] = section.inward(w);
            for (std::size_t k = begin; k < end; ++k) {
                const auto at = [&](const Field& f) {
                    return share[0] * f[node[0]][k] + share[1] * f[node[1]][k];
                };
                const Vec3 near = tangential(Vec3{at(u.x), at(u.y), at(u.z)}, normal);
                const Real speed = norm(near);
                const Real shear =
                    function_.shear(speed, distance_, out.friction_velocity[w][k]); // [m2/s2]
                const Real u_star = std::sqrt(shear);
                const Real over_speed = speed > 0 ? 1 / speed : 0;
                const Real mean = viscosity_ + karman / 2 * u_star * distance_;
                const Vec3 wall = (1 - over_speed * shear * distance_ / mean) * near;
                u.x[i][k] = wall.x;
                u.y[i][k] = wall.y;
                u.z[i][k] = wall.z;
                out.friction_velocity[w][k] = u_star;
                out.drag[k] -= section.wall_share() * over_speed * shear * near.x;
            }
        }
    }

    /// Viscosity at every node, nu + nu_t [m2/s]; returns the largest of the stations.
    [[nodiscard]] Real viscosity(const Section& section, const MixingLength& mixing_length,
                                 const Field& strain, const Field& friction_velocity,
                                 std::size_t begin, std::size_t end, Field& viscosity) const {
        Lanes most{};
        const Lanes molecular = viscosity_ + Lanes{};
        for (std::size_t i = 0; i < section.interior_count(); ++i) {
            const Real l = mixing_length.length(section.place(i));
            for (std::size_t k = begin; k < end; k += lane_count) {
                const Lanes nu = molecular + l * l * sqrt(load(strain[i] + k));
                store(viscosity[i] + k, nu);
                most = max(most, nu);
            }
        }
        const std::size_t wall = section.interior_count();
        for (std::size_t n = 0; n < section.layer().size(); ++n) {
            const std::size_t i = section.layer()[n];
            const Real l = mixing_length.length(section.place(i));
            const auto [node, share] = section.at_wall(n);
            for (std::size_t k = begin; k < end; k += lane_count) {
                const Lanes u_star = share[0] * load(friction_velocity[node[0] - wall] + k) +
                                     share[1] * load(friction_velocity[node[1] - wall] + k);
                const Lanes nu = molecular + l * u_star;
                store(viscosity[i] + k, nu);
                most = max(most, nu);
            }
        }
        for (std::size_t i = 0; i < section.interior_count(); ++i) viscosity.wrap(i, begin, end);
        return largest(most);
    }

private:
    Real viscosity_; // [m2/s]
    WallFunction function_;
    Real distance_; // [m]
};

} // namespace mpsdem::mps::eulerian
