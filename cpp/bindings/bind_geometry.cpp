#include "bindings/array.hpp"
#include "geometry/wall.hpp"

#include <pybind11/pybind11.h>

namespace mpsdem::bindings {

using namespace pybind11::literals;

namespace {

template <class S>
auto distance(const S& surface, const Array<Real>& points) {
    const auto x = vectors(points, "points");
    std::vector<Real> out;
    out.reserve(x.size());
    for (const Vec3 p : x) out.push_back(surface.at(p).distance);
    return array(out);
}

constexpr const char* distance_doc =
    R"(Distance of points from the wall, positive on the wetted side.

Parameters
----------
points : (n, 3) float64 ndarray
    Positions [m].

Returns
-------
(n,) float64 ndarray
    Signed distance [m].
)";

} // namespace

void bind_geometry(py::module_ m) {
    m.doc() = "Walls as analytic surfaces. SI units throughout.";

    py::class_<geometry::Plane>(m, "Plane",
                                "A flat wall through `point` [m], wetted on the side of `normal`, "
                                "moving with `velocity` [m/s].")
        .def(py::init([](const Array<Real>& point, const Array<Real>& normal,
                         const Array<Real>& velocity) {
                 return geometry::Plane(vector(point, "point"), vector(normal, "normal"),
                                        vector(velocity, "velocity"));
             }),
             py::kw_only(), "point"_a, "normal"_a, "velocity"_a)
        .def("distance", &distance<geometry::Plane>, "points"_a, distance_doc);

    py::class_<geometry::Cylinder>(m, "Cylinder",
                                   "The bore of a straight pipe along x, of `radius` [m], wetted "
                                   "inside, moving with `velocity` [m/s].")
        .def(py::init([](Real radius, const Array<Real>& velocity) {
                 return geometry::Cylinder(radius, vector(velocity, "velocity"));
             }),
             py::kw_only(), "radius"_a, "velocity"_a)
        .def("distance", &distance<geometry::Cylinder>, "points"_a, distance_doc);
}

} // namespace mpsdem::bindings
