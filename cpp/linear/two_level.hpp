#pragma once

#include "linear/coarse_space.hpp"
#include "linear/envelope_cholesky.hpp"
#include "linear/jacobi.hpp"

namespace mpsdem::linear {

/// Where the unknowns of a matrix are.
struct Cloud {
    std::span<const Vec3> position; // [m]
    Real particle_spacing;          // [m]
    Real period;                    // [m] along x, 0 for none
};

/// Additive two-level preconditioner.
///
///   z = D^-1 r + Z E^-1 Z^T r,   E = Z^T A Z,   Z of CoarseSpace
///
/// Iterations do not grow with the length of a pipe. `follow` keeps E of an earlier matrix: any
/// definite E will do, and one of 10 steps ago costs an iteration or two.
class TwoLevelAdditive {
public:
    TwoLevelAdditive(const LaplacianMatrix& matrix, const Cloud& cloud, int threads);

    /// Take a later matrix and where its unknowns are; they may differ in number and order.
    void follow(const LaplacianMatrix& matrix, std::span<const Vec3> position, int threads);

    [[nodiscard]] std::size_t size() const noexcept { return jacobi_.size(); }
    [[nodiscard]] std::size_t coarse_size() const noexcept { return space_.size(); }

    void start(const LaplacianMatrix&, std::span<const Real>, std::span<Real>, int) {}
    [[nodiscard]] Real apply(std::span<const Real> r, std::span<Real> z, int threads) noexcept;

private:
    Jacobi jacobi_;
    CoarseSpace space_;
    EnvelopeCholesky factor_;
    std::vector<Real> coarse_; // one more for what lies in no cell, always 0
};

/// Two-level preconditioner of deflation type (A-DEF2).
///
///   z = z_0 + Z E^-1 (Z^T r - (A Z)^T z_0),   z_0 = D^-1 r
///   x -> x + Z E^-1 Z^T (b - A x) at the start
///
/// Fewer iterations than the additive form, for A Z in set-up and memory; E must be of this very
/// matrix. Tang, Nabben, Vuik & Erlangga (2009), doi:10.1007/s10915-009-9272-6. Unlike classical
/// deflation it does not part from the solution when iterated past its floor.
class TwoLevelDeflation {
public:
    TwoLevelDeflation(const LaplacianMatrix& matrix, const Cloud& cloud, int threads);

    [[nodiscard]] std::size_t size() const noexcept { return jacobi_.size(); }
    [[nodiscard]] std::size_t coarse_size() const noexcept { return space_.size(); }

    void start(const LaplacianMatrix& matrix, std::span<const Real> b, std::span<Real> x,
               int threads);
    [[nodiscard]] Real apply(std::span<const Real> r, std::span<Real> z, int threads) noexcept;

private:
    Jacobi jacobi_;
    CoarseSpace space_;
    EnvelopeCholesky factor_;
    SparseRows<float> touching_; // (A Z)^T: for each cell, the unknowns that touch it
    std::vector<Real> coarse_;   // one more for what lies in no cell, always 0
};

} // namespace mpsdem::linear
