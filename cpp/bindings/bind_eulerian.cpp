#include "bindings/array.hpp"
#include "coupling/sample_nodes.hpp"
#include "mps/eulerian/least_squares.hpp"
#include "mps/eulerian/liquid.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace mpsdem::bindings {

using namespace pybind11::literals;
using mps::eulerian::AdvanceReport;
using mps::eulerian::Liquid;
using mps::eulerian::Section;

namespace {

Section section_of(const Array<Real>& place, const Array<Real>& area, std::size_t wall_count,
                   Real pipe_radius, Real spacing) {
    require(place.ndim() == 2 && place.shape(1) == 2, "place must have shape (n, 2)");
    std::vector<Vec3> nodes;
    for (py::ssize_t i = 0; i < place.shape(0); ++i)
        nodes.push_back({0, place.at(i, 0), place.at(i, 1)});
    return Section(nodes, values(area, "area"), wall_count, pipe_radius, spacing);
}

const char* name_of(mps::eulerian::Limit limit) {
    switch (limit) {
    case mps::eulerian::Limit::courant:
        return "courant";
    case mps::eulerian::Limit::viscosity:
        return "viscosity";
    case mps::eulerian::Limit::none:
        break;
    }
    return "none";
}

template <class Choice>
Choice chosen(const std::string& name, const char* field,
              std::initializer_list<std::pair<const char*, Choice>> choices) {
    std::string known;
    for (const auto& [key, choice] : choices) {
        if (name == key) return choice;
        known += std::string(known.empty() ? "" : ", ") + key;
    }
    throw std::invalid_argument(std::string(field) + " must be one of " + known + ", not " + name);
}

/// [node][station] as an (nodes, stations) array.
Array<Real> plane(const std::vector<Real>& values, std::size_t stations) {
    const auto columns = static_cast<py::ssize_t>(stations);
    Array<Real> a({static_cast<py::ssize_t>(values.size()) / columns, columns});
    std::copy(values.begin(), values.end(), a.mutable_data());
    return a;
}

Array<Real> velocities(const Liquid& l) {
    const auto& u = l.velocity();
    Array<Real> a({static_cast<py::ssize_t>(l.section().size()),
                   static_cast<py::ssize_t>(l.stations()), py::ssize_t{3}});
    Real* out = a.mutable_data();
    for (std::size_t i = 0; i < l.section().size(); ++i) {
        for (std::size_t k = 0; k < l.stations(); ++k) {
            *out++ = u.x[i][k];
            *out++ = u.y[i][k];
            *out++ = u.z[i][k];
        }
    }
    return a;
}

/// See an (nodes, stations, 3) array as vectors in a row.
std::span<const Vec3> node_vectors(const Array<Real>& a, const char* name) {
    require(a.ndim() == 3 && a.shape(2) == 3,
            std::string(name) + " must have shape (nodes, stations, 3)");
    return {reinterpret_cast<const Vec3*>(a.data()), static_cast<std::size_t>(a.size() / 3)};
}

template <class T>
std::vector<std::remove_const_t<T>> copy(std::span<T> span) {
    return {span.begin(), span.end()};
}

py::dict section_operators(const Array<Real>& place, const Array<Real>& area,
                           std::size_t wall_count, Real pipe_radius, Real spacing) {
    const Section section = section_of(place, area, wall_count, pipe_radius, spacing);
    const auto gradient = mps::eulerian::gradient_stencil(section);
    const auto laplacian = mps::eulerian::laplacian_stencil(section);
    const auto upwind = mps::eulerian::upwind_stencil(section);
    const std::size_t n = section.size();
    return py::dict("gradient_y"_a = plane(gradient.dense(n, 0), n),
                    "gradient_z"_a = plane(gradient.dense(n, 1), n),
                    "laplacian"_a = plane(laplacian.dense(n, 0), n),
                    "damping_y"_a = plane(upwind.dense(n, 2), n),
                    "damping_z"_a = plane(upwind.dense(n, 3), n));
}

} // namespace

void bind_eulerian(py::module_ m) {
    m.def("section_operators", &section_operators, py::kw_only(), "place"_a, "area"_a,
          "wall_count"_a, "pipe_radius"_a, "spacing"_a,
          R"(Least-squares operators across a pipe, as matrices.

Parameters
----------
place, area, wall_count, pipe_radius, spacing
    As of `EulerianLiquid`.

Returns
-------
dict of (n, n) float64 ndarray
    ``gradient_y``, ``gradient_z`` [1/m]; ``laplacian`` [1/m2]; ``damping_y``, ``damping_z`` of
    upwind differences [1/m].

References
----------
Tamai & Koshizuka (2014) doi:10.1007/s40571-014-0027-2.
)");

    py::class_<AdvanceReport>(m, "NodeLiquidReport", "What a call of EulerianLiquid.advance met.")
        .def_readonly("substeps", &AdvanceReport::substeps)
        .def_property_readonly(
            "limit", [](const AdvanceReport& r) { return name_of(r.limit); },
            "What bound the shortest step: courant, viscosity, or none where one step was enough.")
        .def_readonly("shortest", &AdvanceReport::shortest,
                      "Shortest step that the limits allowed in the call [s].")
        .def_readonly("mean_gradient", &AdvanceReport::mean_gradient,
                      "Loss of pressure along the pipe, mean over the call [Pa/m].")
        .def_readonly("friction", &AdvanceReport::friction,
                      "What the walls take up, mean over the call [Pa/m].")
        .def_readonly(
            "unexplained", &AdvanceReport::unexplained,
            "Of the axial momentum: what convection and pressure add, and must not [Pa/m].")
        .def_readonly("convection_error", &AdvanceReport::convection_error,
                      "Axial momentum that convection failed to keep between solids, and that was "
                      "given back [Pa/m].")
        .def_readonly("divergence", &AdvanceReport::divergence,
                      "Root mean square divergence at the end, times spacing over speed [-].")
        .def_readonly("solve_seconds", &AdvanceReport::solve_seconds,
                      "Time spent in the pressure equation [s].")
        .def_readonly("sound", &AdvanceReport::sound,
                      "False when speeds overflowed or the step became too short.");

    py::class_<Liquid>(m, "EulerianLiquid",
                       R"(The liquid of a full, straight, rigid, periodic round pipe on fixed nodes.

Least-squares MPS on rings of nodes that repeat along the pipe; the pressure is solved directly.
Laminar flow sticks to the wall, turbulent flow has a mixing length and a wall function: a liquid of
the mean flow.

Parameters
----------
place : (n, 2) float64 ndarray
    Nodes of a cross-section (y, z), those on the wall last [m].
area : (n,) float64 ndarray
    Of each node; sums to that of the bore [m2].
wall_count : int
    Nodes on the wall.
stations : int
    Cross-sections along the pipe, a multiple of 4; station k lies at ``(k + 1/2) / stations`` of
    the length.
spacing : float
    Between the nodes of a cross-section [m].
velocity : (n, stations, 3) float64 ndarray
    To start with; on the wall it is set by the flow [m/s].
pipe_radius, pipe_length : float
    [m].
density, kinematic_viscosity : float
    [kg/m3], [m2/s].
roughness : float
    Of the wall [m].
turbulent : bool
    Mixing length and log-law wall function; else laminar with no-slip walls.
bulk_velocity : float
    Held at every stage unless a gradient is given [m/s].
pressure_gradient : float, optional
    Given loss of pressure along the pipe [Pa/m].
convection : {"upwind", "muscl"}
    Least-squares upwind, or MUSCL-Rusanov: more damped, and stable where no viscosity helps.
scheme : {"rk2", "rk3"}
    Runge-Kutta of two or three stages.
courant : float, optional
    Largest step over the time to cross a spacing [-]; by default 0.8 with rk2, 1.2 with rk3.
threads : int
    The results do not depend on it.

References
----------
Tamai & Koshizuka (2014) doi:10.1007/s40571-014-0027-2.
)")
        .def(py::init([](const Array<Real>& place, const Array<Real>& area, std::size_t wall_count,
                         std::size_t stations, Real spacing, const Array<Real>& velocity,
                         Real pipe_radius, Real pipe_length, Real density, Real kinematic_viscosity,
                         Real roughness, bool turbulent, Real bulk_velocity,
                         std::optional<Real> pressure_gradient, const std::string& convection,
                         const std::string& scheme, std::optional<Real> courant, int threads) {
                 using namespace mps::eulerian;
                 const auto carried = chosen<Convection>(
                     convection, "convection",
                     {{"upwind", Convection::upwind}, {"muscl", Convection::muscl}});
                 const auto steps =
                     chosen<Scheme>(scheme, "scheme", {{"rk2", Scheme::rk2}, {"rk3", Scheme::rk3}});
                 const Real usual = steps == Scheme::rk2 ? 0.8 : 1.2;
                 return Liquid(section_of(place, area, wall_count, pipe_radius, spacing),
                               pipe_length, node_vectors(velocity, "velocity"), density,
                               kinematic_viscosity, roughness,
                               turbulent ? Flow::turbulent : Flow::laminar,
                               {bulk_velocity, pressure_gradient},
                               {stations, courant.value_or(usual), carried, steps, threads});
             }),
             py::kw_only(), "place"_a, "area"_a, "wall_count"_a, "stations"_a, "spacing"_a,
             "velocity"_a, "pipe_radius"_a, "pipe_length"_a, "density"_a, "kinematic_viscosity"_a,
             "roughness"_a, "turbulent"_a, "bulk_velocity"_a, "pressure_gradient"_a = py::none(),
             "convection"_a = "upwind", "scheme"_a = "rk2", "courant"_a = py::none(),
             "threads"_a = 1)
        .def("__len__", &Liquid::size)
        .def(
            "advance", [](Liquid& l, Real dt) { return l.advance(dt); }, "dt"_a,
            py::call_guard<py::gil_scoped_release>(),
            "Advance by dt [s], in as few substeps as Courant number and viscosity allow.")
        .def(
            "drive",
            [](Liquid& liquid, Real bulk_velocity, std::optional<Real> pressure_gradient) {
                liquid.drive({bulk_velocity, pressure_gradient});
            },
            py::kw_only(), "bulk_velocity"_a, "pressure_gradient"_a = py::none(),
            R"(Drive the liquid otherwise from now on.

Parameters
----------
bulk_velocity : float
    Held at every stage unless a gradient is given [m/s].
pressure_gradient : float, optional
    Given loss of pressure along the pipe [Pa/m].
)")
        .def(
            "body_force",
            [](Liquid& liquid, const Array<Real>& acceleration) {
                liquid.body_force(vector(acceleration, "acceleration"));
            },
            "acceleration"_a, "Acceleration of every mass from now on, (3,) [m/s2].")
        .def(
            "momentum_source",
            [](Liquid& liquid, const std::optional<Array<Real>>& acceleration) {
                if (acceleration)
                    liquid.momentum_source(node_vectors(*acceleration, "acceleration"));
                else
                    liquid.momentum_source({});
            },
            "acceleration"_a,
            "Force on the liquid over its mass from now on, (n, stations, 3) [m/s2]; None ends it.")
        .def(
            "velocity_at",
            [](const Liquid& liquid, const Array<Real>& points, Real radius) {
                return array(coupling::sample_nodes({radius}, liquid.section(),
                                                    liquid.axial_spacing(), liquid.velocity(),
                                                    vectors(points, "points")));
            },
            py::kw_only(), "points"_a, "radius"_a,
            R"(Liquid velocity at points, averaged with the kernel W_s over a radius.

Parameters
----------
points : (n, 3) float64 ndarray
    Positions, x within the pipe [m].
radius : float
    Of the average [m].

Returns
-------
(n, 3) float64 ndarray
    [m/s]; zero where no node is within the radius.
)")
        .def_property_readonly("stations", &Liquid::stations)
        .def_property_readonly(
            "velocity", [](const Liquid& l) { return velocities(l); }, "(n, stations, 3) [m/s].")
        .def_property_readonly(
            "pressure", [](const Liquid& l) { return plane(l.pressure(), l.stations()); },
            "(n, stations) less the mean gradient and static parts [Pa].")
        .def_property_readonly(
            "viscosity", [](const Liquid& l) { return plane(l.viscosity(), l.stations()); },
            "(n, stations) molecular and eddy viscosity of the last stage [m2/s].")
        .def_property_readonly(
            "void_fraction", [](const Liquid& l) { return plane(l.void_fraction(), l.stations()); },
            "(n, stations) share of the liquid, of the last substep [-].")
        .def_property_readonly("bulk_velocity", &Liquid::bulk_velocity,
                               "Flow rate of liquid and solids over the bore [m/s].")
        .def_property_readonly("pressure_gradient", &Liquid::pressure_gradient,
                               "Loss along the pipe in the last substep [Pa/m].")
        .def_property_readonly("wall_shear", &Liquid::wall_shear,
                               "Mean shear of the wall function [Pa]; 0 in laminar flow.")
        .def_property_readonly("kinetic_energy", &Liquid::kinetic_energy, "Per mass [J/kg].")
        .def_property_readonly("pressure_noise", &Liquid::pressure_noise,
                               "Scatter of the pressure about its mean [Pa].")
        .def_property_readonly(
            "largest_viscosity", &Liquid::largest_viscosity,
            "Molecular and eddy viscosity, the largest of the last stage [m2/s].")
        .def(
            "state",
            [](const Liquid& l) {
                const auto s = l.snapshot();
                return py::dict("velocity"_a = array(s.velocity), "pressure"_a = array(s.pressure),
                                "friction_velocity"_a = array(s.friction_velocity),
                                "drag"_a = array(s.drag), "gradient"_a = s.gradient,
                                "loaded"_a = array(s.loaded));
            },
            "The exact state as arrays, for `restore`.")
        .def(
            "restore",
            [](Liquid& l, const py::dict& state) {
                const auto velocity = state["velocity"].cast<Array<Real>>();
                const auto pressure = state["pressure"].cast<Array<Real>>();
                const auto friction = state["friction_velocity"].cast<Array<Real>>();
                const auto drag = state["drag"].cast<Array<Real>>();
                const auto loaded = state["loaded"].cast<Array<Real>>();
                l.restore({copy(vectors(velocity, "velocity")), copy(values(pressure, "pressure")),
                           copy(values(friction, "friction_velocity")), copy(values(drag, "drag")),
                           state["gradient"].cast<Real>(), copy(values(loaded, "loaded"))});
            },
            "state"_a, "Continue bit-equal from a `state` of the same liquid.");
}

} // namespace mpsdem::bindings
