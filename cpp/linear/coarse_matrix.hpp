#pragma once

#include "linear/coarse_space.hpp"
#include "linear/laplacian_matrix.hpp"
#include "linear/sparse_rows.hpp"

namespace mpsdem::linear {

/// A Z by unknowns: for each, the cells that it touches; the last column is for what lies in no
/// cell.
[[nodiscard]] SparseRows<float> times_indicators(const LaplacianMatrix& matrix,
                                                 const CoarseSpace& space, int threads);

/// E = Z^T A Z. Where no Dirichlet part holds a set of coupled cells, E is singular there: the last
/// cell of the set is then pinned, by its diagonal once more. That changes nothing for a right-hand
/// side that sums to zero over the set.
[[nodiscard]] SparseRows<Real> coarse_matrix(const LaplacianMatrix& matrix,
                                             const CoarseSpace& space, int threads);

/// The same from A Z, which is shorter to read.
[[nodiscard]] SparseRows<Real> coarse_matrix(const LaplacianMatrix& matrix,
                                             const CoarseSpace& space,
                                             const SparseRows<float>& touched, int threads);

} // namespace mpsdem::linear
