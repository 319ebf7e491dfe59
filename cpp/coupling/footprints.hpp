#pragma once

#include "core/parallel.hpp"
#include "coupling/smoothing_kernel.hpp"
#include "mps/load.hpp"
#include "neighbors/cell_grid.hpp"

#include <array>
#include <vector>

namespace mpsdem::coupling {

/// The part of a liquid that each solid acts upon: weights of the liquid's points i,
///
///   w_ip = V_i W_s(|x_i - x_p|) / sum_j V_j W_s(|x_j - x_p|),   sum_i w_ip = 1
///
/// What is spread with them is kept to round-off, near a wall too, as no point lies behind it: the
/// volume of the solids, so that their void fractions sum to the liquid's volume, and their
/// impulse. With the same weights a solid samples the liquid.
///
/// Solids are worked on by groups of their numbers, and spread by slabs of the pipe, wide enough
/// that every other slab's footprints share no point: neither depends on the number of threads.
class Footprints {
public:
    explicit Footprints(SmoothingKernel kernel) : kernel_(kernel), grid_(kernel.radius, 0) {}

    /// Find them for solids at `position`; positions must be finite, and x within the period.
    void find(const mps::LiquidPoints& points, std::span<const Vec3> position, int threads);

    /// visit(i, w_ip) for the points of solid p.
    template <class Visit>
    void each(std::size_t p, const Visit& visit) const {
        const Group& group = groups_[p / group_size];
        const std::size_t at = p % group_size;
        for (std::size_t k = group.first[at]; k < group.first[at + 1]; ++k)
            visit(group.point[k], group.weight[k]);
    }

    /// spread(p) for all solids, none at a time with another whose footprint shares a point with
    /// its own.
    template <class Spread>
    void spread(int threads, const Spread& spread) const {
        const std::size_t slabs = slab_first_.size() - 1;
        for (const std::size_t parity : {0, 1}) {
            parallel_for_blocks((slabs + 1 - parity) / 2, threads, [&](std::size_t b) {
                const std::size_t slab = 2 * b + parity;
                for (std::size_t k = slab_first_[slab]; k < slab_first_[slab + 1]; ++k)
                    spread(by_slab_[k]);
            });
        }
    }

    /// sum_i w_ip f_i.
    template <class T>
    [[nodiscard]] T sample(std::size_t p, std::span<const T> field) const {
        T sum{};
        each(p, [&](Index i, Real w) { sum += w * field[i]; });
        return sum;
    }

private:
    static constexpr std::size_t group_size = 16;

    /// Footprints of solids with neighboring numbers.
    struct Group {
        std::array<std::size_t, group_size + 1> first{};
        std::vector<Index> point;
        std::vector<Real> weight; // [-]
    };

    /// Sort the points by cells.
    void sort(const mps::LiquidPoints& points, int threads);
    /// Sort the solids by slabs.
    void cut(std::span<const Vec3> position);
    void find_group(std::size_t g, std::span<const Vec3> position);

    SmoothingKernel kernel_;
    neighbors::CellGrid grid_;
    neighbors::Cells cells_;
    const Vec3* sorted_from_ = nullptr; // the points that stand sorted, where they are fixed
    Real period_ = 0;                   // [m]
    std::vector<Index> order_;
    std::vector<Vec3> found_for_; // [m] the solids
    std::vector<Group> groups_;
    std::vector<std::size_t> slab_first_ = {0};
    std::vector<Index> by_slab_, slab_of_; // solids; of each solid
    std::vector<Lanes> row_;               // x, y, z, volume of the points by cells
};

} // namespace mpsdem::coupling
