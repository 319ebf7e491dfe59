#include "bindings/array.hpp"
#include "linear/cholmod_reference.hpp"
#include "linear/conjugate_gradients.hpp"
#include "linear/two_level.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <tuple>
#include <variant>

namespace mpsdem::bindings {

using namespace pybind11::literals;

namespace {

/// A matrix, with the arrays that it looks at and what is known of its graph.
struct Matrix {
    Array<Index> row, column;
    Array<float> weight;
    std::optional<Array<Real>> dirichlet;
    linear::LaplacianMatrix view;
    linear::Clusters clusters;
};

Matrix matrix(const Array<Index>& row, const Array<Index>& column, const Array<float>& weight,
              const std::optional<Array<Real>>& dirichlet, int threads) {
    const auto r = values(row, "row"), c = values(column, "column");
    const auto w = values(weight, "weight");
    const auto d = dirichlet ? values(*dirichlet, "dirichlet") : std::span<const Real>{};
    linear::require_rows(r, c, w, d);
    linear::LaplacianMatrix view(r.first(r.size() - 1), r.subspan(1), c, w, d, threads);
    linear::Clusters clusters(view);
    return {row, column, weight, dirichlet, std::move(view), std::move(clusters)};
}

Array<Real> apply_matrix(const Matrix& matrix, const Array<Real>& x, int threads) {
    const auto from = values(x, "x");
    require(from.size() == matrix.view.size(), "x must have one value per row of the matrix");
    std::vector<Real> y(from.size());
    std::ignore = matrix.view.apply(from, y, threads);
    return array(y);
}

std::vector<Array<Index>> floating_clusters(const Matrix& matrix) {
    std::vector<Array<Index>> clusters;
    for (std::size_t c = 0; c < matrix.clusters.floating_count(); ++c) {
        const auto members = matrix.clusters.floating(c);
        clusters.emplace_back(static_cast<py::ssize_t>(members.size()), members.data());
    }
    return clusters;
}

template <linear::Preconditioner P>
Array<Real> apply_preconditioner(P& preconditioner, const Array<Real>& residual, int threads) {
    const auto r = values(residual, "residual");
    require(r.size() == preconditioner.size(),
            "residual must have one value per row of the matrix");
    std::vector<Real> z(r.size());
    std::ignore = preconditioner.apply(r, z, threads);
    return array(z);
}

template <linear::Preconditioner P>
py::class_<P> bind_preconditioner(py::module_ m, const char* name, const char* doc) {
    return py::class_<P>(m, name, doc)
        .def("apply", &apply_preconditioner<P>, "residual"_a, "threads"_a = 1,
             R"(What the preconditioner makes of a residual.

Parameters
----------
residual : (n,) float64 ndarray
threads : int
    The result does not depend on it.

Returns
-------
(n,) float64 ndarray
)")
        .def("__len__", &P::size);
}

template <class TwoLevel>
TwoLevel two_level(const Matrix& matrix, const Array<Real>& position, Real particle_spacing,
                   Real period, int threads) {
    return {matrix.view, {vectors(position, "position"), particle_spacing, period}, threads};
}

struct Solution {
    Array<Real> x;
    linear::SolveReport report;

    [[nodiscard]] const char* outcome() const {
        switch (report.outcome) {
        case linear::Outcome::converged:
            return "converged";
        case linear::Outcome::exhausted:
            return "exhausted";
        default:
            return "broken";
        }
    }
};

using AnyPreconditioner =
    std::variant<linear::Jacobi*, linear::TwoLevelAdditive*, linear::TwoLevelDeflation*>;

Solution conjugate_gradients(const Matrix& matrix, const Array<Real>& right_hand_side,
                             const AnyPreconditioner& preconditioner, Real tolerance,
                             int max_iterations, const std::optional<Array<Real>>& start,
                             int threads) {
    std::vector<Real> x(matrix.view.size(), 0);
    if (start) {
        const auto from = values(*start, "start");
        require(from.size() == x.size(), "start must have one value per row of the matrix");
        std::ranges::copy(from, x.begin());
    }
    linear::Workspace workspace;
    const auto report = std::visit(
        [&](auto* m) {
            return linear::conjugate_gradients(matrix.view, matrix.clusters, *m,
                                               values(right_hand_side, "right_hand_side"),
                                               tolerance, max_iterations, threads, x, workspace);
        },
        preconditioner);
    return {array(x), report};
}

} // namespace

void bind_linear(py::module_ m) {
    m.doc() = "Solvers for the pressure equation on a cloud of particles.";

    py::class_<Matrix>(m, "LaplacianMatrix",
                       R"(Symmetric matrix of a weighted graph of neighbors.

``(A x)_i = sum_j w_ij (x_i - x_j) + d_i x_i`` with ``w_ij = w_ji >= 0``. Written with differences, a
constant gives exactly zero where ``d = 0``; float32 weights then cost 1e-9 in the solution.

Parameters
----------
row : (n + 1,) uint32 ndarray
    The neighbors of unknown i stand in ``row[i]`` to ``row[i + 1]``, each pair in both rows.
column : (m,) uint32 ndarray
    Neighbors, without the unknown itself.
weight : (m,) float32 ndarray
    Of each neighbor, >= 0.
dirichlet : (n,) float64 ndarray, optional
    d, >= 0: the weights of neighbors whose value is known.
threads : int
    The result does not depend on it.

Notes
-----
The arrays are looked at, not copied: they must not change while the matrix is in use. Unknowns that
are near in space should be near in number, else a product takes twice the time.
)")
        .def(py::init(&matrix), py::kw_only(), "row"_a, "column"_a, "weight"_a,
             "dirichlet"_a = py::none(), "threads"_a = 1)
        .def("__len__", [](const Matrix& matrix) { return matrix.view.size(); })
        .def("apply", &apply_matrix, "x"_a, "threads"_a = 1,
             R"(The product A x.

Parameters
----------
x : (n,) float64 ndarray
threads : int
    The result does not depend on it.

Returns
-------
(n,) float64 ndarray
)")
        .def_property_readonly(
            "diagonal",
            [](const Matrix& matrix) {
                const auto d = matrix.view.diagonal();
                return Array<Real>(static_cast<py::ssize_t>(d.size()), d.data());
            },
            "(n,) float64 ndarray: sum_j w_ij + d_i.")
        .def_property_readonly(
            "cluster_count", [](const Matrix& matrix) { return matrix.clusters.count(); },
            "Number of connected clusters; an unknown without neighbors is one.")
        .def_property_readonly(
            "floating_clusters", &floating_clusters,
            "Unknowns of each cluster without a Dirichlet part, where A x = b fixes x up to a\n"
            "constant and b must sum to zero: list of uint32 ndarrays, ascending.");

    py::class_<linear::CoarseSpace>(m, "CoarseSpace",
                                    R"(Cells of three particle spacings over a cloud of unknowns.

A cell filled below 30 % joins the fullest of its neighbors in its slab; cells without unknowns do
not count. Numbers run slab by slab along x, from both ends to the middle where x is periodic.

Parameters
----------
position : (n, 3) float64 ndarray
    [m]
particle_spacing : float
    [m]
period : float
    Along x [m]; 0 for none.
)")
        .def(py::init([](const Array<Real>& position, Real particle_spacing, Real period) {
                 return linear::CoarseSpace(vectors(position, "position"), particle_spacing,
                                            period);
             }),
             py::kw_only(), "position"_a, "particle_spacing"_a, "period"_a = 0.0)
        .def("__len__", &linear::CoarseSpace::size)
        .def_property_readonly(
            "cell",
            [](const linear::CoarseSpace& space) {
                const auto cell = space.cell();
                return Array<Index>(static_cast<py::ssize_t>(cell.size()), cell.data());
            },
            "(n,) uint32 ndarray: cell of each unknown; the number of cells where the position is\n"
            "not finite.");

    bind_preconditioner<linear::Jacobi>(m, "Jacobi",
                                        R"(Preconditioner z = r / diagonal.

Iterations grow with the length of a pipe in particle spacings.

Parameters
----------
matrix : LaplacianMatrix
)")
        .def(py::init([](const Matrix& matrix) { return linear::Jacobi(matrix.view); }),
             "matrix"_a);

    bind_preconditioner<linear::TwoLevelAdditive>(
        m, "TwoLevelAdditive",
        R"(Jacobi plus a coarse solve on the cells of CoarseSpace.

Iterations do not grow with the length of a pipe. The coarse factor may be kept while the matrix
changes a little: see `follow`.

Parameters
----------
matrix : LaplacianMatrix
position : (n, 3) float64 ndarray
    Of the unknowns [m].
particle_spacing : float
    [m]
period : float
    Along x [m]; 0 for none.
threads : int
    The result does not depend on it.
)")
        .def(py::init(&two_level<linear::TwoLevelAdditive>), "matrix"_a, py::kw_only(),
             "position"_a, "particle_spacing"_a, "period"_a = 0.0, "threads"_a = 1)
        .def_property_readonly("coarse_size", &linear::TwoLevelAdditive::coarse_size,
                               "Number of coarse cells.")
        .def(
            "follow",
            [](linear::TwoLevelAdditive& preconditioner, const Matrix& matrix,
               const Array<Real>& position, int threads) {
                preconditioner.follow(matrix.view, vectors(position, "position"), threads);
            },
            "matrix"_a, py::kw_only(), "position"_a, "threads"_a = 1,
            R"(Take a later matrix, keeping the cells and their factor.

A factor of 10 steps ago costs an iteration or two.

Parameters
----------
matrix : LaplacianMatrix
    Its unknowns may differ in number and order from those before.
position : (n, 3) float64 ndarray
    Of its unknowns [m].
threads : int
    The result does not depend on it.
)");

    bind_preconditioner<linear::TwoLevelDeflation>(
        m, "TwoLevelDeflation",
        R"(Deflation of the cells of CoarseSpace (A-DEF2).

Fewer iterations than `TwoLevelAdditive`, for a longer set-up; good for one matrix and a small
tolerance.

Parameters
----------
matrix : LaplacianMatrix
    The solver must be given this same matrix.
position : (n, 3) float64 ndarray
    Of the unknowns [m].
particle_spacing : float
    [m]
period : float
    Along x [m]; 0 for none.
threads : int
    The result does not depend on it.

References
----------
Tang, Nabben, Vuik & Erlangga (2009), doi:10.1007/s10915-009-9272-6.
)")
        .def(py::init(&two_level<linear::TwoLevelDeflation>), "matrix"_a, py::kw_only(),
             "position"_a, "particle_spacing"_a, "period"_a = 0.0, "threads"_a = 1)
        .def_property_readonly("coarse_size", &linear::TwoLevelDeflation::coarse_size,
                               "Number of coarse cells.");

    py::class_<Solution>(m, "Solution", "What a solve returned, and how it ended.")
        .def_readonly("x", &Solution::x, "(n,) float64 ndarray.")
        .def_property_readonly(
            "iterations", [](const Solution& s) { return s.report.iterations; },
            "Products with the matrix after the first residual.")
        .def_property_readonly(
            "residual", [](const Solution& s) { return s.report.residual; },
            "|b - A x| / |b| [-], as the recursion has it; nan in a broken solve may be its cause.")
        .def_property_readonly(
            "converged",
            [](const Solution& s) { return s.report.outcome == linear::Outcome::converged; },
            "Whether the residual came down to the tolerance.")
        .def_property_readonly(
            "broken", [](const Solution& s) { return s.report.outcome == linear::Outcome::broken; },
            "Whether a value was not finite, or the matrix not definite: more iterations do not\n"
            "help.")
        .def("__repr__", [](const Solution& s) {
            return std::string("Solution(") + s.outcome() +
                   ", iterations=" + std::to_string(s.report.iterations) +
                   ", residual=" + py::repr(py::float_(s.report.residual)).cast<std::string>() +
                   ")";
        });

    m.def("conjugate_gradients", &conjugate_gradients, "matrix"_a, "right_hand_side"_a,
          py::kw_only(), py::arg("preconditioner").none(false), "tolerance"_a = 1e-6,
          "max_iterations"_a = 1000, "start"_a = py::none(), "threads"_a = 1,
          R"(Solve A x = b by preconditioned conjugate gradients.

Parameters
----------
matrix : LaplacianMatrix
right_hand_side : (n,) float64 ndarray
    b. Its mean over each floating cluster is taken off.
preconditioner : Jacobi, TwoLevelAdditive or TwoLevelDeflation
tolerance : float
    Largest residual over the size of b [-], >= 1e-13.
max_iterations : int
start : (n,) float64 ndarray, optional
    First guess; zero if not given.
threads : int
    The result does not depend on it.

Returns
-------
Solution
    x has mean zero over each floating cluster.
)");

    py::class_<linear::CholmodReference>(
        m, "CholmodReference",
        R"(Sparse Cholesky factor of CHOLMOD, to check the others by.

About 20 s and 3 GB for 3e5 unknowns of a pipe.

Parameters
----------
matrix : LaplacianMatrix

Raises
------
RuntimeError
    If the build found no CHOLMOD (`_core.cholmod` is empty), or the factor does not exist.
)")
        .def(py::init([](const Matrix& matrix) {
                 return linear::CholmodReference(matrix.view, matrix.clusters);
             }),
             "matrix"_a)
        .def(
            "solve",
            [](const linear::CholmodReference& reference, const Array<Real>& right_hand_side) {
                std::vector<Real> x(static_cast<std::size_t>(right_hand_side.size()));
                reference.solve(values(right_hand_side, "right_hand_side"), x);
                return array(x);
            },
            "right_hand_side"_a,
            R"(Solve A x = b.

Parameters
----------
right_hand_side : (n,) float64 ndarray
    b. Its mean over each floating cluster is taken off.

Returns
-------
(n,) float64 ndarray
    x, of mean zero over each floating cluster.
)");
}

} // namespace mpsdem::bindings
