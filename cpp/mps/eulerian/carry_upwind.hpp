#pragma once

#include "mps/eulerian/carried.hpp"
#include "mps/eulerian/section.hpp"
#include "mps/eulerian/stencil.hpp"
#include "mps/eulerian/strain.hpp"

namespace mpsdem::mps::eulerian {

/// Least-squares upwind: across the pipe u . C f + (|u_y| + s) E_y f + (|u_z| + s) E_z f with the
/// weights of `upwind_stencil`, s the damping's share of |u_x|. Third order in the damping, second
/// in the rest.
inline void carry_upwind(const Section& section, const Stencil<4>& stencil, const Axial& axial,
                         CrossDamping damping, const VectorField& u, std::size_t begin,
                         std::size_t end, Carried out) {
    for (std::size_t i = 0; i < section.interior_count(); ++i) {
        const auto entries = stencil.of(i);
        by_registers(begin, end, [&](std::size_t k, auto registers) {
            constexpr std::size_t n = decltype(registers)::value;
            Vector<Lanes> gradient[3][n];
            const Field* const component[3] = {&u.x, &u.y, &u.z};
            Field* const result[3] = {&out.acceleration.x, &out.acceleration.y,
                                      &out.acceleration.z};
            for (std::size_t a = 0; a < 3; ++a) {
                const Field& f = *component[a];
                const auto sums = apply<n, 4>(entries, f, k);
                for (std::size_t v = 0; v < n; ++v) {
                    const std::size_t at = k + v * lane_count;
                    const Lanes ux = load(u.x[i] + at);
                    const Lanes uy = load(u.y[i] + at), uz = load(u.z[i] + at);
                    const Lanes least = damping.share * abs(ux);
                    Lanes slope;
                    const Lanes along = carried_along(axial, ux, f[i] + at, slope);
                    const Lanes across = uy * sums.of[0][v] + uz * sums.of[1][v] +
                                         (abs(uy) + least) * sums.of[2][v] +
                                         (abs(uz) + least) * sums.of[3][v];
                    store((*result[a])[i] + at, -(along + across));
                    gradient[a][v] = {slope, sums.of[0][v], sums.of[1][v]};
                }
            }
            for (std::size_t v = 0; v < n; ++v) {
                store(out.strain[i] + k + v * lane_count,
                      squared_strain(gradient[0][v], gradient[1][v], gradient[2][v]));
            }
        });
    }
}

} // namespace mpsdem::mps::eulerian
