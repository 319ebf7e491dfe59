#pragma once

#include "linear/clusters.hpp"

#include <memory>

namespace mpsdem::linear {

/// Sparse Cholesky factor of CHOLMOD, the reference for the iterative solvers: about 20 s and 3 GB
/// for 3e5 unknowns of a pipe. Only where the build has found CHOLMOD; elsewhere the constructor
/// says so. A floating cluster is pinned at its first unknown, then the mean is taken off.
class CholmodReference {
public:
    CholmodReference(const LaplacianMatrix& matrix, const Clusters& clusters);
    CholmodReference(CholmodReference&&) noexcept;
    CholmodReference& operator=(CholmodReference&&) noexcept;
    ~CholmodReference();

    /// x of A x = b, with b less its mean and x of mean zero over each floating cluster.
    void solve(std::span<const Real> b, std::span<Real> x) const;

private:
    struct Factor;
    std::unique_ptr<Factor> factor_;
};

} // namespace mpsdem::linear
