#pragma once

#include "linear/cholmod_reference.hpp"
#include "linear/conjugate_gradients.hpp"
#include "linear/two_level.hpp"
#include "mps/pairs.hpp"

#include <optional>

namespace mpsdem::mps::lagrangian {

enum class Solver {
    two_level, // conjugate gradients, iterations independent of the pipe's length
    jacobi,    // conjugate gradients, iterations growing with it: for comparison
    cholmod,   // a sparse factor each step: the reference, where the build has found CHOLMOD
};

/// What the solves of a call met, together.
struct SolveTally {
    int iterations = 0;
    int retries = 0;   // solves that had to start anew
    Real residual = 0; // [-] largest
    Real seconds = 0;  // [s] set-up included
};

/// The pressure equation over the particles that have rows: sum_j W_ij (p_i - p_j) + d_i p_i = b_i.
/// The neighbor list with its stored weights is the matrix; nothing is assembled.
///
/// The coarse matrix is made once, in `prepare`, and kept: any definite one will do, and one of the
/// undisturbed layout costs no more iterations than a new one each step. So it is no part of a
/// liquid's state.
class PressureEquation {
public:
    PressureEquation(Solver solver, Real tolerance, Real particle_spacing, int threads)
        : solver_(solver), tolerance_(tolerance), particle_spacing_(particle_spacing),
          threads_(threads) {}

    /// Look at the matrix of these pairs; `known` (rows,) is d, or empty for none. The coarse space
    /// sorts particles by their `position` (rows,), in a bent pipe that in its sections.
    void assemble(const StoredPairs& pairs, std::span<const Vec3> position,
                  std::span<const Real> known);

    /// Make the coarse matrix from the matrix looked at.
    void prepare();

    /// Solve from the first guess in `pressure` (rows,). Where the two-level solve fails, once more
    /// from zero with a new coarse matrix; false where that fails too.
    [[nodiscard]] bool solve(std::span<const Real> right_hand_side, std::span<Real> pressure,
                             SolveTally& tally);

private:
    [[nodiscard]] linear::Cloud cloud() const { return {position_, particle_spacing_, period_}; }

    Solver solver_;
    Real tolerance_;        // [-]
    Real particle_spacing_; // [m]
    int threads_;
    Real period_ = 0;                // [m]
    std::span<const Vec3> position_; // (rows,) [m]
    linear::LaplacianMatrix matrix_;
    std::optional<linear::TwoLevelAdditive> preconditioner_;
    linear::Workspace workspace_;
};

} // namespace mpsdem::mps::lagrangian
