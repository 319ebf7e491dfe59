#include "mps/lagrangian/pressure_equation.hpp"

#include <chrono>

namespace mpsdem::mps::lagrangian {

namespace {

constexpr int most_iterations = 500;         // [-] of the two-level method, which needs about ten
constexpr int most_jacobi_iterations = 5000; // [-] of the other, about one for each layer

Real seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<Real>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

void PressureEquation::assemble(const StoredPairs& pairs, std::span<const Vec3> position,
                                std::span<const Real> known) {
    const neighbors::NeighborList& neighbors = pairs.neighbors();
    period_ = neighbors.period();
    position_ = position.first(neighbors.rows());
    matrix_.view(neighbors.first(), neighbors.inner(), neighbors.column(), pairs.weight(), known,
                 threads_);
}

void PressureEquation::prepare() {
    if (solver_ == Solver::two_level) preconditioner_.emplace(matrix_, cloud(), threads_);
}

bool PressureEquation::solve(std::span<const Real> right_hand_side, std::span<Real> pressure,
                             SolveTally& tally) {
    const auto start = std::chrono::steady_clock::now();
    const linear::Clusters clusters(matrix_);
    const auto iterate = [&](auto& preconditioner, int most) {
        const auto report =
            linear::conjugate_gradients(matrix_, clusters, preconditioner, right_hand_side,
                                        tolerance_, most, threads_, pressure, workspace_);
        tally.iterations += report.iterations;
        tally.residual = std::max(tally.residual, report.residual);
        return report.outcome == linear::Outcome::converged;
    };
    bool solved = false;
    switch (solver_) {
    case Solver::two_level: {
        if (!preconditioner_) preconditioner_.emplace(matrix_, cloud(), threads_);
        linear::TwoLevelAdditive& kept = *preconditioner_;
        kept.follow(matrix_, position_, threads_);
        solved = iterate(kept, most_iterations);
        if (!solved) {
            ++tally.retries;
            std::ranges::fill(pressure, Real{0});
            linear::TwoLevelAdditive anew(matrix_, cloud(), threads_);
            solved = iterate(anew, most_iterations);
        }
        break;
    }
    case Solver::jacobi: {
        linear::Jacobi preconditioner(matrix_);
        solved = iterate(preconditioner, most_jacobi_iterations);
        break;
    }
    case Solver::cholmod:
        linear::CholmodReference(matrix_, clusters).solve(right_hand_side, pressure);
        solved = std::ranges::all_of(pressure, [](Real p) { return std::isfinite(p); });
        break;
    }
    tally.seconds += seconds_since(start);
    return solved;
}

} // namespace mpsdem::mps::lagrangian
