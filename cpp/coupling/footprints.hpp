#pragma once

#include "coupling/smoothing_kernel.hpp"
#include "mps/load.hpp"
#include "neighbors/cell_grid.hpp"

#include <vector>

namespace mpsdem::coupling {

/// The part of a liquid that each solid acts upon: weights of the liquid's points i,
///
///   w_ip = V_i W_s(|x_i - x_p|) / sum_j V_j W_s(|x_j - x_p|),   sum_i w_ip = 1
///
/// What is spread with them is kept to round-off, near a wall too, as no point lies behind it: the
/// volume of the solids, so that their void fractions sum to the liquid's volume, and their
/// impulse. With the same weights a solid samples the liquid.
class Footprints {
public:
    explicit Footprints(SmoothingKernel kernel) : kernel_(kernel), grid_(kernel.radius, 0) {}

    /// Find them for solids at `position`; positions must be finite, and x within the period.
    void find(const mps::LiquidPoints& points, std::span<const Vec3> position);

    /// visit(i, w_ip) for the points of solid p.
    template <class Visit>
    void each(std::size_t p, const Visit& visit) const {
        for (std::size_t k = first_[p]; k < first_[p + 1]; ++k) visit(point_[k], weight_[k]);
    }

    /// sum_i w_ip f_i.
    template <class T>
    [[nodiscard]] T sample(std::size_t p, std::span<const T> field) const {
        T sum{};
        each(p, [&](Index i, Real w) { sum += w * field[i]; });
        return sum;
    }

private:
    /// Sort the points by cells.
    void sort(const mps::LiquidPoints& points);

    SmoothingKernel kernel_;
    neighbors::CellGrid grid_;
    neighbors::Cells cells_;
    const Vec3* sorted_from_ = nullptr; // the points that stand sorted, where they are fixed
    Real period_ = 0;                   // [m]
    std::vector<Index> order_;
    std::vector<Vec3> found_for_; // [m] the solids
    std::vector<std::size_t> first_ = {0};
    std::vector<Index> point_;
    std::vector<Real> weight_; // [-]
    std::vector<Lanes> row_;   // x, y, z, volume of the points by cells
};

} // namespace mpsdem::coupling
