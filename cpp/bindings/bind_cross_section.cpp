#include "bindings/array.hpp"
#include "linear/cross_section_solver.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>

namespace mpsdem::bindings {

using namespace pybind11::literals;
using linear::CrossSectionSolver;

namespace {

/// A solver with the field that it works on.
struct Solver {
    CrossSectionSolver solver;
    Field field;
};

Solver solver_of(const Array<Real>& interior, const Array<Real>& wall, const Array<Real>& axial,
                 std::size_t stations, const std::optional<Array<Index>>& mirrors) {
    require(interior.ndim() == 2 && wall.ndim() == 2, "interior and wall must be matrices");
    const auto inner = static_cast<std::size_t>(interior.shape(0));
    const auto at_wall = static_cast<std::size_t>(wall.shape(0));
    linear::Mirrors images;
    if (mirrors) {
        require(mirrors->ndim() == 2 && mirrors->shape(0) == 2,
                "mirrors must have shape (2, nodes)");
        const auto nodes = static_cast<std::size_t>(mirrors->shape(1));
        images = {{mirrors->data(), nodes}, {mirrors->data() + nodes, nodes}};
    }
    return {{{interior.data(), static_cast<std::size_t>(interior.size())},
             {wall.data(), static_cast<std::size_t>(wall.size())},
             inner,
             at_wall,
             values(axial, "axial"),
             stations,
             images},
            Field(inner + at_wall, stations)};
}

Array<Real> solve(Solver& self, const Array<Real>& right_hand_side, int threads) {
    Field& field = self.field;
    require(right_hand_side.ndim() == 2 &&
                static_cast<std::size_t>(right_hand_side.shape(0)) == field.rows() &&
                static_cast<std::size_t>(right_hand_side.shape(1)) == field.stations(),
            "right_hand_side must have shape (nodes, stations)");
    for (std::size_t i = 0; i < field.rows(); ++i)
        std::copy_n(right_hand_side.data() + i * field.stations(), field.stations(), field[i]);
    self.solver.solve(CrossSectionSolver::WallSource::given, threads, field);
    Array<Real> out({right_hand_side.shape(0), right_hand_side.shape(1)});
    for (std::size_t i = 0; i < field.rows(); ++i)
        std::copy_n(field[i], field.stations(), out.mutable_data() + i * field.stations());
    return out;
}

} // namespace

void bind_cross_section(py::module_ m) {
    py::class_<Solver>(
        m, "CrossSectionSolver",
        R"(Direct solver of a Poisson equation on a cross-section, extruded along an axis.

``A p + d2p/dx2 = b`` at interior nodes, ``B p = b`` at the wall's: a Fourier transform along the
axis and the eigenbasis of what is left of A when the wall's values are eliminated.

Parameters
----------
interior : (n, n + w) float64 ndarray
    A, the interior nodes' columns first [1/m2].
wall : (w, n + w) float64 ndarray
    B.
axial : (stations // 2 + 1,) float64 ndarray
    What d2/dx2 makes of each wave, over the wave, <= 0 [1/m2].
stations : int
    Along the axis, a multiple of 4.
mirrors : (2, n + w) uint32 ndarray, optional
    Each node's image in either of two mirrors; where A and B share them, the even and the odd parts
    are solved apart.

Raises
------
RuntimeError
    If A has a growing mode.

References
----------
Lynch, Rice & Thomas (1964) doi:10.1007/BF01386067.
)")
        .def(py::init(&solver_of), py::kw_only(), "interior"_a, "wall"_a, "axial"_a, "stations"_a,
             "mirrors"_a = py::none())
        .def("solve", &solve, "right_hand_side"_a, py::kw_only(), "threads"_a = 1,
             R"(Solve for one right-hand side.

Parameters
----------
right_hand_side : (n + w, stations) float64 ndarray
threads : int
    The result does not depend on it.

Returns
-------
(n + w, stations) float64 ndarray
    p; where a constant is free, without it, and without the part of b that no p reaches.
)");
}

} // namespace mpsdem::bindings
