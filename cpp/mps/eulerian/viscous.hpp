#pragma once

#include "mps/eulerian/axial.hpp"
#include "mps/eulerian/stencil.hpp"

namespace mpsdem::mps::eulerian {

/// Viscous acceleration of node i from station k on [m/s2]: the viscosity of a pair is its mean,
///
///   sum_j L_ij (nu_i + nu_j) / 2 (u_j - u_i)  +  the same along the pipe, second order
///
/// which is (lap(nu u) + nu lap u - u lap nu) / 2 = div(nu grad u), exact for quadratic nu u, u and
/// nu. Momentum is kept to the order of the spacing: the weights are not symmetric.
[[nodiscard]] [[gnu::always_inline]] inline Vector<Lanes>
viscous_acceleration(std::span<const Entry<1>> entries, const Axial& axial, const Field& viscosity,
                     const VectorField& u, std::size_t i, std::ptrdiff_t k) noexcept {
    const Lanes nu = load(viscosity[i] + k);
    const Vector<Lanes> here{load(u.x[i] + k), load(u.y[i] + k), load(u.z[i] + k)};
    Vector<Lanes> sum;
    const auto add = [&](Lanes weight, std::size_t j, std::ptrdiff_t at) {
        sum.x += weight * (load(u.x[j] + at) - here.x);
        sum.y += weight * (load(u.y[j] + at) - here.y);
        sum.z += weight * (load(u.z[j] + at) - here.z);
    };
    for (const auto& e : entries.first(entries.size() - 1)) // the last is the node itself
        add((e.weight[0] / 2) * (nu + load(viscosity[e.node] + k)), e.node, k);
    const Real along = 1 / (2 * axial.spacing * axial.spacing);
    add(along * (nu + load(viscosity[i] + k + 1)), i, k + 1);
    add(along * (nu + load(viscosity[i] + k - 1)), i, k - 1);
    return sum;
}

} // namespace mpsdem::mps::eulerian
