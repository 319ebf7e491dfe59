#include "bindings/array.hpp"
#include "coupling/exchange.hpp"
#include "mps/eulerian/liquid.hpp"
#include "mps/lagrangian/liquid.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace mpsdem::bindings {

using namespace pybind11::literals;
using coupling::Exchange;
using Particles = mps::lagrangian::Liquid;
using Nodes = mps::eulerian::Liquid;

namespace {

std::vector<Vec3> copied(std::span<const Vec3> v) {
    return {v.begin(), v.end()};
}

} // namespace

void bind_exchange(py::module_ m) {
    py::class_<Exchange>(m, "Exchange",
                         R"(Two-way exchange between solids and a liquid, in Model B.

A step: `begin` looks at the liquid around the solids; these go on, in substeps in which the liquid
at each of them responds as `response` says; `give` takes what they did, and `advance` moves the
liquid with it. The impulse on the solids is the liquid's loss to round-off.

Parameters
----------
smoothing_radius : float
    Over which a solid acts on the liquid, and samples it [m].
liquid_density : float
    [kg/m3].
threads : int
    The result does not depend on it.

References
----------
Zhou, Kuang, Chu & Yu (2010) doi:10.1017/S002211201000306X, set II.
)")
        .def(py::init<Real, Real, int>(), py::kw_only(), "smoothing_radius"_a, "liquid_density"_a,
             "threads"_a = 1)
        .def(
            "begin",
            [](Exchange& e, const Particles& liquid, const Array<Real>& position,
               const Array<Real>& radius) {
                e.begin(liquid.points(), liquid.liquid_velocity(), liquid.liquid_acceleration(),
                        vectors(position, "position"), values(radius, "radius"));
            },
            py::keep_alive<1, 2>(), "liquid"_a, py::kw_only(), "position"_a, "radius"_a,
            R"(Look at the liquid around the solids at the start of a step.

Parameters
----------
liquid : LagrangianLiquid
position : (n, 3) float64 ndarray
    Of the solids, x within the pipe [m].
radius : (n,) float64 ndarray
    [m].

Raises
------
ValueError
    If a solid has no liquid within the smoothing radius.
)")
        .def(
            "begin",
            [](Exchange& e, Nodes& liquid, const Array<Real>& position, const Array<Real>& radius) {
                const auto points = liquid.points();
                e.begin(points, liquid.interior_velocity(), liquid.interior_acceleration(),
                        vectors(position, "position"), values(radius, "radius"));
            },
            py::keep_alive<1, 2>(), "liquid"_a, py::kw_only(), "position"_a, "radius"_a,
            "The same for a liquid on nodes.")
        .def_property_readonly(
            "liquid_velocity", [](const Exchange& e) { return array(copied(e.liquid_velocity())); },
            "(n, 3) of the liquid at the solids, when the step began [m/s].")
        .def(
            "response",
            [](Exchange& e, const Array<Real>& drag, const Array<Real>& velocity) {
                const auto r = e.response(values(drag, "drag"), vectors(velocity, "velocity"));
                return std::pair(array(r.acceleration), array(r.relaxation));
            },
            py::kw_only(), "drag"_a, "velocity"_a,
            R"(How the liquid at each solid is going to change: du/dt = a - L (u - v).

Parameters
----------
drag : (n,) float64 ndarray
    Drag over slip now [kg/s].
velocity : (n, 3) float64 ndarray
    Of the solids now [m/s].

Returns
-------
acceleration : (n, 3) float64 ndarray
    a [m/s2].
relaxation : (n,) float64 ndarray
    L [1/s].
)")
        .def(
            "give",
            [](Exchange& e, const Array<Real>& position, const Array<Real>& mean_velocity,
               const Array<Real>& drag, const std::optional<Array<Real>>& impulse, Real duration) {
                e.give({vectors(position, "position"), vectors(mean_velocity, "mean_velocity"),
                        values(drag, "drag"),
                        impulse ? vectors(*impulse, "impulse") : std::span<const Vec3>(),
                        duration});
            },
            py::kw_only(), "position"_a, "mean_velocity"_a, "drag"_a, "impulse"_a, "duration"_a,
            R"(Take what the solids did over a step of the liquid.

Parameters
----------
position : (n, 3) float64 ndarray
    At its start, x within the pipe [m].
mean_velocity : (n, 3) float64 ndarray
    [m/s].
drag : (n,) float64 ndarray
    Drag over slip, mean [kg/s].
impulse : (n, 3) float64 ndarray or None
    That the drag gave them [N s]; None for solids that are held, which take any.
duration : float
    [s].
)")
        .def(
            "advance",
            [](Exchange& e, Particles& liquid, Real dt) { return liquid.advance(dt, &e); },
            "liquid"_a, "dt"_a, py::call_guard<py::gil_scoped_release>(),
            "Advance the liquid by dt [s] with the solids in it; returns its report.")
        .def(
            "advance", [](Exchange& e, Nodes& liquid, Real dt) { return liquid.advance(dt, &e); },
            "liquid"_a, "dt"_a, py::call_guard<py::gil_scoped_release>(),
            "The same for a liquid on nodes.")
        .def_property_readonly(
            "impulse", [](const Exchange& e) { return array(copied(e.impulse())); },
            "(n, 3) on the solids, over the last advance [N s].")
        .def_property_readonly(
            "clipped", &Exchange::clipped,
            "Void fractions of the liquid raised to the floor in the last advance.")
        .def_property_readonly("mismatch", &Exchange::mismatch,
                               "Impulse on liquid and solids together, over the sum of the sizes "
                               "of those on the solids [-].")
        .def_property_readonly("liquid_volume_error", &Exchange::liquid_volume_error,
                               "Liquid volume over bore less solids, less 1 [-].");
}

} // namespace mpsdem::bindings
