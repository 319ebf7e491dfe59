#pragma once

#include "core/lanes.hpp"
#include "linear/sparse_rows.hpp"

namespace mpsdem::linear {

/// Cholesky factor E = L L^T that fills each row from its first entry to the diagonal. Good for an
/// order in which only near numbers couple. Stored in float32, computed and applied in double: a
/// factor is half as long to read, and a preconditioner needs no more digits.
class EnvelopeCholesky {
public:
    EnvelopeCholesky() = default;

    /// Reads the lower triangle. A pivot that round-off has made vanish is replaced by the diagonal
    /// of E, so that the factor stays definite.
    explicit EnvelopeCholesky(const SparseRows<Real>& matrix);

    [[nodiscard]] std::size_t size() const noexcept { return first_.size(); }

    /// y = E^-1 y.
    void solve(std::span<Real> y) const noexcept;

private:
    /// Rows [begin, end), one in each lane, from the rows before them.
    void factor_group(const SparseRows<Real>& matrix, std::size_t begin, std::size_t end,
                      std::span<Lanes> line);

    std::vector<Index> first_;       // column of the first entry of each row
    std::vector<std::size_t> start_; // where each row begins in value_
    std::vector<float> value_;       // rows without their diagonals
    std::vector<Real> inverse_;      // 1 / L_ii
};

} // namespace mpsdem::linear
