#pragma once

#include "core/vec3.hpp"

#include <array>
#include <span>
#include <vector>

namespace mpsdem::linear {

/// Coarse space of a cloud of unknowns: the indicators of cubic cells, Z_ic = 1 where unknown i
/// lies in cell c. The error that a one-level preconditioner leaves is smooth, nearly constant in a
/// cell.
///
/// Cells without unknowns do not count. A cell filled below `least_fill` joins the fullest of its
/// neighbors in its slab, as a few unknowns at the rim make a badly scaled coarse matrix. Numbers
/// run slab by slab along x, from both ends to the middle where x is periodic, so that only near
/// numbers couple.
class CoarseSpace {
public:
    static constexpr Real cell_spacings = 3; // [-] width of a cell in particle spacings
    static constexpr Real least_fill = 0.3;  // [-] of the unknowns that a full cell holds

    /// `period` [m] along x, 0 for none.
    CoarseSpace(std::span<const Vec3> position, Real particle_spacing, Real period);

    /// Find the unknowns in the same cells again, after they have moved or changed their order.
    void assign(std::span<const Vec3> position, int threads);

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    /// Cell of each unknown; size() for one that lies in none, as where there was nothing before.
    [[nodiscard]] std::span<const Index> cell() const noexcept { return cell_; }
    /// Unknowns of a cell, ascending.
    [[nodiscard]] std::span<const Index> members(std::size_t c) const noexcept {
        return std::span(member_).subspan(start_[c], start_[c + 1] - start_[c]);
    }

private:
    using Place = std::array<std::size_t, 3>;

    void fit_box(std::span<const Vec3> position, Real particle_spacing);
    /// Cell of the box, or the number of cells for a position that is not finite.
    [[nodiscard]] std::size_t box_cell(const Vec3& position) const noexcept;
    /// Which cell of the box each one joins: another, itself, or, being empty, none (box_cells()).
    [[nodiscard]] std::vector<std::size_t> merge_sparse(const std::vector<Index>& count,
                                                        Real particle_spacing) const;
    void number(const std::vector<std::size_t>& target);
    [[nodiscard]] std::size_t box_cells() const noexcept { return n_[0] * n_[1] * n_[2]; }

    Real period_; // [m]
    Place n_{};
    std::array<Real, 3> low_{};   // [m]
    std::array<Real, 3> width_{}; // [m]
    std::vector<Index> number_;   // (cells of the box + 1,) their coarse numbers
    std::size_t size_ = 0;
    std::vector<Index> cell_;
    std::vector<Index> start_;
    std::vector<Index> member_;
};

} // namespace mpsdem::linear
