#pragma once

#include "core/parallel.hpp"
#include "geometry/surface.hpp"
#include "mps/facing.hpp"
#include "mps/kind.hpp"
#include "neighbors/neighbor_list.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <limits>

namespace mpsdem::mps {

/// Laplacian of the quadratic polynomial through f_i that fits the neighbors best:
///
///   minimise sum_j w (p_j . c - (f_j - f_i))^2    w = (1 - r / r_e)^2,   r_e the list's radius
///   p = (x, y, z, x^2 / 2, y^2 / 2, z^2 / 2, xy, xz, yz) of r_ij / r_e
///   lap f_i = (c_4 + c_5 + c_6) / r_e^2           T: Real or Vec3
///
/// A wall particle stands for the point of the wall nearest to it, with its own value: there the
/// wall's condition holds, wherever the particle itself is. Ghosts are left out. Exact for
/// quadratic fields, so for Poiseuille flow; first order among scattered particles, second on a
/// lattice. Not symmetric: momentum is kept to the order of the spacing.
/// Source: Tamai & Koshizuka (2014), doi:10.1007/s40571-014-0027-2.
///
/// Fills the rows of the liquid, 0 elsewhere, and 0 where the neighbors fix no quadratic (too few,
/// or in a plane); those are marked in `deficient`.
template <geometry::Surface Wall, class T>
void least_squares_laplacian(const Wall& wall, const neighbors::NeighborList& neighbors,
                             std::span<const Kind> kind, std::span<const T> field, int threads,
                             std::span<T> result, std::span<std::uint8_t> deficient) {
    using Basis = Eigen::Matrix<Real, 9, 1>;
    using Normal = Eigen::Matrix<Real, 9, 9>;
    constexpr Real smallest_pivot = 1e-5; // [-] over the largest; in a full pipe 4e-3 and more
    const Real scale = 1 / neighbors.radius();

    const auto each_node = [&](std::size_t i, const auto& visit) {
        neighbors.each(i, [&](Index j, Vec3 r, Index) {
            if (kind[j] == Kind::ghost) return;
            if (kind[j] == Kind::wall) {
                const auto at = facing(wall, neighbors.position(j), neighbors.position(j));
                r -= at.distance * at.normal;
            }
            const Vec3 q = scale * r;
            const Real rest = std::max(1 - norm(q), Real{0});
            visit(j, rest * rest,
                  Basis{{q.x, q.y, q.z, q.x * q.x / 2, q.y * q.y / 2, q.z * q.z / 2, q.x * q.y,
                         q.x * q.z, q.y * q.z}});
        });
    };

    parallel_for(result.size(), threads, [&](std::size_t i) {
        result[i] = T{};
        deficient[i] = 0;
        if (kind[i] != Kind::liquid) return;
        Normal normal = Normal::Zero();
        each_node(i, [&](Index, Real w, const Basis& p) {
            normal.template selfadjointView<Eigen::Lower>().rankUpdate(p, w);
        });
        const Eigen::LDLT<Normal> factor(normal);
        const auto pivot = factor.vectorD();
        if (!(pivot.minCoeff() > smallest_pivot * pivot.maxCoeff())) {
            deficient[i] = 1;
            return;
        }
        // One solve for the weights of a row serves every component of the field.
        const Basis row = factor.solve(Basis{{0, 0, 0, 1, 1, 1, 0, 0, 0}});
        T sum{};
        each_node(i, [&](Index j, Real w, const Basis& p) {
            sum += (w * row.dot(p)) * (field[j] - field[i]);
        });
        result[i] = (scale * scale) * sum;
    });
}

} // namespace mpsdem::mps
