#include "mps/eulerian/least_squares.hpp"

#include "core/check.hpp"
#include "mps/weight.hpp"

#include <Eigen/Eigenvalues>

#include <map>
#include <optional>
#include <string>

namespace mpsdem::mps::eulerian {

namespace {

constexpr Real gradient_reach = 2.1;  // [-] r_e over the spacing
constexpr Real laplacian_reach = 1.6; // [-]
constexpr Real upwind_reach = 2.6;    // [-]
constexpr Real upwind_bias = 0.8;     // [-] how much more what lies upwind counts
constexpr Real growth = 1.12;         // [-] of r_e where the fit is poor
constexpr int most_growths = 15;      // to five times its size
// [-] of the smallest over the largest eigenvalue of a fit, in units of r_e. On rings 3e-3 and
// more; below it a fit has large weights of both signs.
constexpr Real poorest_fit = 1e-3;

using Basis = Eigen::Matrix<Real, 5, 1>;
using Normal = Eigen::Matrix<Real, 5, 5>;

struct Neighbor {
    Index node;
    Vec3 r; // [m] from the node
};

std::vector<Neighbor> neighbors_of(const Section& section, std::size_t i, Real radius) {
    std::vector<Neighbor> found;
    for (std::size_t j = 0; j < section.size(); ++j) {
        const Vec3 r = section.place(j) - section.place(i);
        // a ring's node on the border stays out, whatever its round-off
        if (j != i && norm(r) < radius * (1 - 1e-9)) found.push_back({static_cast<Index>(j), r});
    }
    return found;
}

Basis basis(const Vec3& r, Real radius) {
    const Real y = r.y / radius, z = r.z / radius;
    return {y, z, y * y / 2, z * z / 2, y * z};
}

/// Coefficients c over (f_j - f_i), one column per neighbor, in units of the radius; none where the
/// fit is poor.
template <class Factor>
std::optional<Eigen::Matrix<Real, 5, Eigen::Dynamic>> fit(std::span<const Neighbor> neighbors,
                                                          Real radius, const Factor& factor) {
    const Weight weight{radius};
    Normal normal = Normal::Zero();
    Eigen::Matrix<Real, 5, Eigen::Dynamic> right(5, static_cast<Eigen::Index>(neighbors.size()));
    for (std::size_t k = 0; k < neighbors.size(); ++k) {
        const Vec3& r = neighbors[k].r;
        const Basis p = basis(r, radius);
        const Real w = weight(norm(r)) * factor(r);
        normal += w * p * p.transpose();
        right.col(static_cast<Eigen::Index>(k)) = w * p;
    }
    const Eigen::SelfAdjointEigenSolver<Normal> eigen(normal);
    const auto& values = eigen.eigenvalues();
    if (!(values[0] > poorest_fit * values[4])) return std::nullopt;
    return eigen.eigenvectors() * values.cwiseInverse().asDiagonal() *
           eigen.eigenvectors().transpose() * right;
}

/// Call use(radius, neighbors) with growing radii until it succeeds.
template <class Use>
void grow(const Section& section, std::size_t i, Real reach, const Use& use) {
    for (int growths = 0; growths <= most_growths; ++growths, reach *= growth) {
        const Real radius = reach * section.spacing();
        if (use(radius, neighbors_of(section, i, radius))) return;
    }
    require(false, "Section: the surroundings of node " + std::to_string(i) +
                       " fix no quadratic polynomial; the nodes are too few or too uneven");
}

template <std::size_t count>
using Row = std::map<Index, std::array<Real, count>>;

Row<2> gradient_row(const Section& section, std::size_t i) {
    Row<2> row;
    grow(section, i, gradient_reach, [&](Real radius, std::span<const Neighbor> neighbors) {
        const auto c = fit(neighbors, radius, [](const Vec3&) { return 1.; });
        if (!c) return false;
        for (std::size_t k = 0; k < neighbors.size(); ++k) {
            const auto column = static_cast<Eigen::Index>(k);
            row[neighbors[k].node] = {(*c)(0, column) / radius, (*c)(1, column) / radius};
        }
        return true;
    });
    return row;
}

template <std::size_t count>
Stencil<count> stencil(const std::vector<Row<count>>& rows) {
    Stencil<count> out;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::vector<Entry<count>> entries;
        Entry<count> self{static_cast<Index>(i), {}};
        for (const auto& [node, weight] : rows[i]) {
            entries.push_back({node, weight});
            for (std::size_t c = 0; c < count; ++c) self.weight[c] -= weight[c];
        }
        entries.push_back(self);
        out.add_row(entries);
    }
    return out;
}

} // namespace

Stencil<2> gradient_stencil(const Section& section) {
    std::vector<Row<2>> rows;
    rows.reserve(section.size());
    for (std::size_t i = 0; i < section.size(); ++i) rows.push_back(gradient_row(section, i));
    return stencil(rows);
}

Stencil<1> laplacian_stencil(const Section& section) {
    std::vector<Row<1>> rows(section.size());
    for (std::size_t i = 0; i < section.size(); ++i) {
        grow(section, i, laplacian_reach, [&](Real radius, std::span<const Neighbor> neighbors) {
            const auto c = fit(neighbors, radius, [](const Vec3&) { return 1.; });
            if (!c) return false;
            for (std::size_t k = 0; k < neighbors.size(); ++k) {
                const auto column = static_cast<Eigen::Index>(k);
                rows[i][neighbors[k].node] = {((*c)(2, column) + (*c)(3, column)) /
                                              (radius * radius)};
            }
            return true;
        });
    }
    return stencil(rows);
}

Stencil<4> upwind_stencil(const Section& section) {
    std::vector<Row<4>> rows(section.size());
    for (std::size_t i = 0; i < section.size(); ++i) {
        for (const auto& [node, weight] : gradient_row(section, i)) {
            rows[i][node][0] = weight[0];
            rows[i][node][1] = weight[1];
        }
        grow(section, i, upwind_reach, [&](Real radius, std::span<const Neighbor> neighbors) {
            for (std::size_t a = 0; a < 2; ++a) {
                const auto along = [&](Real sign) {
                    return fit(neighbors, radius, [&](const Vec3& r) {
                        return 1 + sign * upwind_bias * (a == 0 ? r.y : r.z) / norm(r);
                    });
                };
                const auto ahead = along(1), behind = along(-1);
                if (!ahead || !behind) return false;
                const auto component = static_cast<Eigen::Index>(a);
                for (std::size_t k = 0; k < neighbors.size(); ++k) {
                    const auto column = static_cast<Eigen::Index>(k);
                    rows[i][neighbors[k].node][2 + a] =
                        ((*behind)(component, column) - (*ahead)(component, column)) / (2 * radius);
                }
            }
            return true;
        });
    }
    return stencil(rows);
}

} // namespace mpsdem::mps::eulerian
