#include "bindings/array.hpp"
#include "neighbors/neighbor_list.hpp"

#include <pybind11/pybind11.h>

namespace mpsdem::bindings {

using namespace pybind11::literals;

namespace {

std::vector<Index> rows_of(const neighbors::NeighborList& list) {
    std::vector<Index> row{0};
    for (std::size_t i = 0; i < list.rows(); ++i)
        row.push_back(row.back() + list.last(i) - list.first(i));
    return row;
}

/// Without the gaps.
std::vector<Index> columns_of(const neighbors::NeighborList& list) {
    std::vector<Index> column;
    const auto all = list.column();
    for (std::size_t i = 0; i < list.rows(); ++i)
        column.insert(column.end(), all.begin() + list.first(i), all.begin() + list.last(i));
    return column;
}

} // namespace

void bind_neighbors(py::module_ m) {
    m.doc() = "Which points are near to which. SI units throughout.";

    m.def(
        "cell_order",
        [](const Array<Real>& position, Real cell_size, Real period) {
            return array(neighbors::cell_order(vectors(position, "position"), cell_size, period));
        },
        "position"_a, py::kw_only(), "cell_size"_a, "period"_a = 0.0,
        R"(Order of points by cubic cells, x slowest: points near in space come near in memory.

Parameters
----------
position : (n, 3) float64 ndarray
    [m]
cell_size : float
    Least width of a cell [m]; the radius of the neighbor list is a good choice.
period : float
    Of the points along x [m]; 0 for none.

Returns
-------
(n,) uint32 ndarray
    ``position[order]`` are the points, sorted.
)");

    py::class_<neighbors::NeighborList>(
        m, "NeighborList",
        R"(For each point all others nearer than a radius, in compressed rows.

The neighbors of point i are ``column[row[i]:row[i + 1]]``, ascending; a pair stands in both its
rows. The list keeps the positions that it was made for. It is made fastest where the points are
in `cell_order`; it does not depend on the number of threads.

Parameters
----------
position : (n, 3) float64 ndarray
    [m]; x is wrapped into the period.
radius : float
    Reach, itself left out [m].
period : float
    Along x [m], more than two radii; 0 for none.
threads : int
    Used to make the list.
)")
        .def(py::init([](const Array<Real>& position, Real radius, Real period, int threads) {
                 neighbors::NeighborList list(radius, period);
                 list.find(vectors(position, "position"), threads);
                 return list;
             }),
             "position"_a, py::kw_only(), "radius"_a, "period"_a = 0.0, "threads"_a = 1)
        .def(
            "find",
            [](neighbors::NeighborList& list, const Array<Real>& position, int threads) {
                list.find(vectors(position, "position"), threads);
            },
            "position"_a, py::kw_only(), "threads"_a = 1,
            R"(Make the list anew for other positions, in the same memory.

Parameters
----------
position : (n, 3) float64 ndarray
    [m]
threads : int
    Used to make the list.
)")
        .def("__len__", &neighbors::NeighborList::size)
        .def_property_readonly("radius", &neighbors::NeighborList::radius, "Reach [m].")
        .def_property_readonly("period", &neighbors::NeighborList::period,
                               "Along x [m]; 0 for none.")
        .def_property_readonly(
            "row", [](const neighbors::NeighborList& list) { return array(rows_of(list)); },
            "(n + 1,) uint32 ndarray: where the neighbors of each point begin in `column`.")
        .def_property_readonly(
            "column", [](const neighbors::NeighborList& list) { return array(columns_of(list)); },
            "(row[n],) uint32 ndarray: the neighbors, row after row.");
}

} // namespace mpsdem::bindings
