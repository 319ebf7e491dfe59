#include "bindings/array.hpp"
#include "geometry/wall.hpp"

#include <pybind11/pybind11.h>

#include <tuple>

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

geometry::Bending bending(Real duration, const Array<Real>& wave_number, const Array<Real>& from,
                          const Array<Real>& velocity_before, const Array<Real>& to,
                          const Array<Real>& velocity_after) {
    const auto k = values(wave_number, "wave_number");
    const auto rows = [&](const Array<Real>& a, const char* name) {
        const auto v = vectors(a, name);
        require(v.size() == k.size(), std::string(name) + " must have one row per wave_number");
        return v;
    };
    const auto start = rows(from, "displacement_before"), end = rows(to, "displacement_after");
    const auto before = rows(velocity_before, "velocity_before");
    const auto after = rows(velocity_after, "velocity_after");
    std::vector<geometry::Bending::Mode> modes;
    for (std::size_t n = 0; n < k.size(); ++n)
        modes.push_back({k[n], start[n], before[n], end[n], after[n]});
    return {std::move(modes), duration};
}

auto axis(const geometry::Bending& bending, Real elapsed, const Array<Real>& x) {
    const geometry::Bend now = bending.at(elapsed);
    std::vector<Vec3> displacement, slope, velocity;
    for (const Real along : values(x, "x")) {
        const auto point = now.at(along);
        displacement.push_back(point.displacement);
        slope.push_back(point.slope);
        velocity.push_back(point.velocity);
    }
    return std::tuple(array(displacement), array(slope), array(velocity));
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

    py::class_<geometry::Bending>(
        m, "Bending",
        R"(How a pipe along x bends over a step: w(x, t) = sum_n a_n(t) cos(k_n x), across itself.

The amplitudes are cubics in time through their ends, displacement and velocity, so that the
velocity is the derivative of the displacement throughout.

Parameters
----------
duration : float
    Of the step [s].
wave_number : (m,) float64 ndarray
    k_n [1/m]; 0 moves the pipe as one body.
displacement_before, displacement_after : (m, 3) float64 ndarray
    a_n at the ends of the step [m]; x is 0.
velocity_before, velocity_after : (m, 3) float64 ndarray
    Their derivatives in time [m/s].
)")
        .def(py::init(&bending), py::kw_only(), "duration"_a, "wave_number"_a,
             "displacement_before"_a, "velocity_before"_a, "displacement_after"_a,
             "velocity_after"_a)
        .def("axis", &axis, "elapsed"_a, "x"_a,
             R"(Displacement, slope and velocity of the axis.

Parameters
----------
elapsed : float
    Time since the start of the step [s]; as at its ends before and after it.
x : (n,) float64 ndarray
    Places along the pipe [m].

Returns
-------
displacement, slope, velocity : (n, 3) float64 ndarray
    [m], [-], [m/s].
)");

    py::class_<geometry::BentCylinder>(
        m, "BentCylinder",
        "The bore of a pipe along x, of `radius` [m], wetted inside, whose axis is bent and moves: "
        "straight until a `Bending` tells.")
        .def(py::init<Real>(), py::kw_only(), "radius"_a)
        .def(
            "bend",
            [](geometry::BentCylinder& wall, const geometry::Bending& bending, Real elapsed) {
                wall.bend(bending.at(elapsed));
            },
            "bending"_a, "elapsed"_a, "Let it be as so long after the start of a step [s].")
        .def("distance", &distance<geometry::BentCylinder>, "points"_a, distance_doc);
}

} // namespace mpsdem::bindings
