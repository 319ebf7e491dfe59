#pragma once

#include "core/field.hpp"
#include "linear/mirrors.hpp"

#include <memory>
#include <span>

namespace mpsdem::linear {

/// Direct solver of a Poisson equation on a cross-section extruded along a periodic axis:
///
///   A p + d^2 p / dx^2 = b   at interior nodes        B p = b   at the wall's nodes
///
/// A and B act within the cross-section, the same at every station; d^2/dx^2 is given by its value
/// on each axial wave. The wall's values are eliminated; what is left of A is diagonal in its own
/// eigenbasis (complex pairs as 2 x 2 blocks), so a solve is a Fourier transform along the axis, a
/// matrix product, a division, a matrix product and the transform back. Where A and B share two
/// mirrors of the nodes, the even and the odd parts are solved apart, at a quarter of the cost, and
/// the eigenbasis is found at a sixteenth of it. Where A lets a constant
/// free, the part of b that no p can reach is dropped and p has none of that mode.
/// The fast diagonalisation of Lynch, Rice & Thomas (1964), doi:10.1007/BF01386067.
class CrossSectionSolver {
public:
    /// `interior`: A, interior nodes x all nodes by rows [1/m2]; `wall`: B, wall nodes x all nodes
    /// by rows; the interior comes first. `axial`: of the waves 0 to stations / 2 [1/m2], <= 0.
    /// `mirrors`: of all nodes; those that A and B do not share are left unused.
    CrossSectionSolver(std::span<const Real> interior, std::span<const Real> wall,
                       std::size_t interior_count, std::size_t wall_count,
                       std::span<const Real> axial, std::size_t stations,
                       const Mirrors& mirrors = {});
    CrossSectionSolver(CrossSectionSolver&&) noexcept;
    CrossSectionSolver& operator=(CrossSectionSolver&&) noexcept;
    ~CrossSectionSolver();

    enum class WallSource { none, given };

    /// From b to p in place; b of the wall's rows counts only where it is `given`.
    void solve(WallSource source, int threads, Field& values);

private:
    struct Basis;
    std::unique_ptr<Basis> basis_;
};

} // namespace mpsdem::linear
