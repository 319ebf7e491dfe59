#pragma once

#include "mps/eulerian/carried.hpp"
#include "mps/eulerian/section.hpp"
#include "mps/eulerian/stencil.hpp"
#include "mps/eulerian/strain.hpp"

namespace mpsdem::mps::eulerian {

/// Gradient across the pipe of a field at every node, wall included: y and z parts [1/m of f].
inline void gradient_across(const Stencil<2>& stencil, const Field& f, std::size_t begin,
                            std::size_t end, Field& y, Field& z) {
    for (std::size_t i = 0; i < stencil.rows(); ++i) {
        const auto entries = stencil.of(i);
        by_registers(begin, end, [&](std::size_t k, auto registers) {
            constexpr std::size_t n = decltype(registers)::value;
            const auto sums = apply<n, 2>(entries, f, k);
            for (std::size_t v = 0; v < n; ++v) {
                store(y[i] + k + v * lane_count, sums.of[0][v]);
                store(z[i] + k + v * lane_count, sums.of[1][v]);
            }
        });
    }
}

/// Gradients of the three components across the pipe, for `carry_muscl`.
struct Gradients {
    VectorField y, z; // d/dy, d/dz [1/s]
};

/// Edge by edge, with the weights c_ij of the gradient and the speed q = c_ij . (u_i + u_j) / 2:
///
///   sum_j q (f_j - f_i) - (|q| + s |c_ij|) (f_j - f_i - r_ij . (grad f_i + grad f_j) / 2)
///
/// s the damping's share of |u_x|. Rusanov's damping acts on the jump between linear
/// reconstructions (MUSCL), without a limiter. Slower and more damped than `carry_upwind`, and it
/// holds where no viscosity helps. Sources: Rusanov (1961), doi:10.1016/0041-5553(62)90062-9; van
/// Leer (1979), doi:10.1016/0021-9991(79)90145-1.
inline void carry_muscl(const Section& section, const Stencil<2>& stencil, const Axial& axial,
                        CrossDamping damping, const VectorField& u, const Gradients& gradients,
                        std::size_t begin, std::size_t end, Carried out) {
    const Field* const component[3] = {&u.x, &u.y, &u.z};
    const Field* const slope_y[3] = {&gradients.y.x, &gradients.y.y, &gradients.y.z};
    const Field* const slope_z[3] = {&gradients.z.x, &gradients.z.y, &gradients.z.z};
    Field* const result[3] = {&out.acceleration.x, &out.acceleration.y, &out.acceleration.z};
    for (std::size_t i = 0; i < section.interior_count(); ++i) {
        for (std::size_t k = begin; k < end; k += lane_count) {
            const Lanes uy = load(u.y[i] + k), uz = load(u.z[i] + k);
            const Lanes least = damping.share * abs(load(u.x[i] + k));
            Lanes f[3], gy[3], gz[3], sum[3]{};
            for (std::size_t a = 0; a < 3; ++a) {
                f[a] = load((*component[a])[i] + k);
                gy[a] = load((*slope_y[a])[i] + k);
                gz[a] = load((*slope_z[a])[i] + k);
            }
            for (const auto& e : stencil.of(i)) {
                if (e.node == i) continue;
                const std::size_t j = e.node;
                const Vec3 r = section.place(j) - section.place(i);
                const Lanes q = (e.weight[0] / 2) * (uy + load(u.y[j] + k)) +
                                (e.weight[1] / 2) * (uz + load(u.z[j] + k));
                const Lanes size =
                    abs(q) +
                    std::sqrt(e.weight[0] * e.weight[0] + e.weight[1] * e.weight[1]) * least;
                for (std::size_t a = 0; a < 3; ++a) {
                    const Lanes jump = load((*component[a])[j] + k) - f[a];
                    const Lanes smooth = (r.y / 2) * (gy[a] + load((*slope_y[a])[j] + k)) +
                                         (r.z / 2) * (gz[a] + load((*slope_z[a])[j] + k));
                    sum[a] += q * jump - size * (jump - smooth);
                }
            }
            Vector<Lanes> gradient[3];
            for (std::size_t a = 0; a < 3; ++a) {
                Lanes slope;
                const Lanes along =
                    carried_along(axial, load(u.x[i] + k), (*component[a])[i] + k, slope);
                store((*result[a])[i] + k, -(along + sum[a]));
                gradient[a] = {slope, gy[a], gz[a]};
            }
            store(out.strain[i] + k, squared_strain(gradient[0], gradient[1], gradient[2]));
        }
    }
}

} // namespace mpsdem::mps::eulerian
