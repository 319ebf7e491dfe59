#include "bindings/array.hpp"
#include "coupling/sample_velocity.hpp"
#include "mps/lagrangian/liquid.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace mpsdem::bindings {

using namespace pybind11::literals;
using mps::lagrangian::AdvanceReport;
using mps::lagrangian::Liquid;
using mps::lagrangian::PushPlate;

namespace {

std::vector<mps::Kind> kinds(const Array<std::int8_t>& kind) {
    std::vector<mps::Kind> out;
    for (const std::int8_t k : values(kind, "kind")) {
        require(k == -2 || k == -1 || k == 2,
                "kind must be -2 (wall), -1 (ghost) or 2 (liquid), not " + std::to_string(k));
        out.push_back(static_cast<mps::Kind>(k));
    }
    return out;
}

using Turbulence =
    std::variant<std::monostate, const mps::MixingLength*, const mps::Smagorinsky*>; // None first

mps::lagrangian::Flow flow(const Turbulence& turbulence) {
    if (const auto* mixing = std::get_if<const mps::MixingLength*>(&turbulence)) return **mixing;
    if (const auto* small = std::get_if<const mps::Smagorinsky*>(&turbulence)) return **small;
    return mps::lagrangian::Laminar{};
}

mps::lagrangian::Solver solver_of(const std::string& name) {
    using mps::lagrangian::Solver;
    if (name == "two_level") return Solver::two_level;
    if (name == "jacobi") return Solver::jacobi;
    require(name == "cholmod", "solver must be two_level, jacobi or cholmod, not " + name);
    return Solver::cholmod;
}

mps::Pairing pairing_of(const std::string& name) {
    if (name == "conserving") return mps::Pairing::conserving;
    require(name == "difference", "pairing must be conserving or difference, not " + name);
    return mps::Pairing::difference;
}

std::vector<std::array<Real, 2>> pairs(const Array<Real>& draws) {
    require(draws.ndim() == 2 && draws.shape(1) == 2, "draws must have shape (n, 2)");
    std::vector<std::array<Real, 2>> out;
    for (py::ssize_t k = 0; k < draws.shape(0); ++k)
        out.push_back({draws.at(k, 0), draws.at(k, 1)});
    return out;
}

} // namespace

void bind_lagrangian(py::module_ m) {
    py::class_<PushPlate>(
        m, "PushPlate",
        R"(A plate that pushes the liquid into the pipe, and an outlet that lets it go.

The plate works upstream of the pipe, so that the bore is always full: its face moves from
-(stroke + settling) to -settling and jumps back by the stroke. The gap is filled with a slab of the
bore's own liquid, shifted and turned. Behind the pipe, over the length of the outlet, the pressure
is zero and the liquid keeps its velocity.

Parameters
----------
velocity : float
    Of the plate, so of the bulk [m/s], > 0.
stroke : float
    [m].
settling : float
    Length left between plate and bore, renewed with the gap at each return [m].
outlet : float
    Length of the outlet behind the pipe [m].
draws : (n, 2) float64 ndarray
    Which slab fills a gap, and how far it is turned: shares in [0, 1), a row for each return, from
    the first row again when all are used.
)")
        .def(py::init([](Real velocity, Real stroke, Real settling, Real outlet,
                         const Array<Real>& draws) {
                 return PushPlate{velocity, stroke, settling, outlet, pairs(draws)};
             }),
             py::kw_only(), "velocity"_a, "stroke"_a, "settling"_a, "outlet"_a, "draws"_a);

    py::class_<AdvanceReport>(m, "LiquidReport", "What a call of LagrangianLiquid.advance met.")
        .def_readonly("substeps", &AdvanceReport::substeps)
        .def_property_readonly(
            "iterations", [](const AdvanceReport& r) { return r.solve.iterations; },
            "Iterations of the pressure equation, all substeps.")
        .def_property_readonly(
            "retries", [](const AdvanceReport& r) { return r.solve.retries; },
            "Pressure solves that had to start anew.")
        .def_readonly("halvings", &AdvanceReport::halvings,
                      "Steps that were halved after a failed solve.")
        .def_property_readonly(
            "residual", [](const AdvanceReport& r) { return r.solve.residual; },
            "Largest residual of the pressure equation, relative [-].")
        .def_readonly("mean_gradient", &AdvanceReport::mean_gradient,
                      "Loss of pressure along the pipe, mean over the call [Pa/m].")
        .def_readonly("friction", &AdvanceReport::friction,
                      "What walls and viscosity take up, mean over the call [Pa/m].")
        .def_readonly("unexplained", &AdvanceReport::unexplained,
                      "What p' does to the axial momentum, and must not, mean [Pa/m].")
        .def_readonly("bending", &AdvanceReport::bending,
                      "Part of mean_gradient: the loss along an axis that slopes and moves [Pa/m].")
        .def_readonly("convection_error", &AdvanceReport::convection_error,
                      "Axial momentum that particles failed to carry along between solids, and "
                      "were given back, mean over the call [Pa/m].")
        .def_readonly("clamped", &AdvanceReport::clamped, "Pressures cut to the limit.")
        .def_readonly("viscosity_capped", &AdvanceReport::viscosity_capped,
                      "Eddy viscosities cut to what the step can bear.")
        .def_readonly("shifts_cut", &AdvanceReport::shifts_cut, "Shifts cut to their longest.")
        .def_readonly("deficient", &AdvanceReport::deficient,
                      "Particles whose neighbors fix no Laplacian: no viscosity acted there.")
        .def_readonly("held_back", &AdvanceReport::held_back,
                      "Particles kept from going nearer to the wall than 0.3 spacings.")
        .def_readonly("pushed", &AdvanceReport::pushed,
                      "Particles kept from going nearer to the plate than 0.3 spacings.")
        .def_readonly("plate_returns", &AdvanceReport::plate_returns, "Returns of the plate.")
        .def_readonly("entered", &AdvanceReport::entered,
                      "Particles that came to be behind the plate.")
        .def_readonly("replaced", &AdvanceReport::replaced,
                      "Particles between plate and bore that went for them.")
        .def_readonly("crowded", &AdvanceReport::crowded,
                      "Particles left out there, nearer than half a spacing to others.")
        .def_readonly("left", &AdvanceReport::left, "Particles that went through the outlet.")
        .def_property_readonly(
            "solve_seconds", [](const AdvanceReport& r) { return r.solve.seconds; },
            "Time spent in the pressure equation, set-up included [s].")
        .def_readonly("sound", &AdvanceReport::sound,
                      "False when the pressure could not be solved or speeds overflowed.");

    py::class_<Liquid>(
        m, "LagrangianLiquid",
        R"(The particle liquid of a full, straight pipe, periodic or with a push plate.

Moving particles, walls of wall and ghost particles, pressure from a Poisson equation. A liquid of
the mean flow: its stable form damps fluctuations.

Parameters
----------
position, velocity : (n, 3) float64 ndarray
    Of a layout [m], [m/s].
kind : (n,) int8 ndarray
    2 liquid, -2 wall, -1 ghost.
particle_spacing : float
    Of that layout [m].
pipe_radius, pipe_length : float
    [m].
plate : PushPlate, optional
    Without it, the pipe is periodic. With it, the layout is that of `push_plate_layout`, and what
    lies inside the pipe's radius but is no liquid is the plate.
density, kinematic_viscosity : float
    [kg/m3], [m2/s].
roughness : float
    Of the wall [m].
turbulence : MixingLength or Smagorinsky or None
    Length of the eddy viscosity, with the log law at the wall; None for laminar flow between walls
    that hold the liquid.
bulk_velocity : float
    Held each step unless a gradient is given; scales the pressure limits in any case [m/s].
pressure_gradient : float, optional
    Given loss of pressure along the pipe [Pa/m].
courant, tolerance, background, shift, pressure_limit : float
    Numbers of the method [-].
speed : float
    Of the stirring by solids, where the liquid itself hardly flows: scales the pressure limits as
    the bulk velocity does [m/s].
solver : {"two_level", "jacobi", "cholmod"}
    Of the pressure equation: conjugate gradients, or a factor each step where the build has it.
pairing : {"conserving", "difference"}
    What the gradient takes of a pair: the sum of its pressures, equal and opposite; or their
    difference, blind to a constant.
threads : int
    The results do not depend on it.

References
----------
Koshizuka & Oka (1996) doi:10.13182/NSE96-A24205.
)")
        .def(
            py::init([](const Array<Real>& position, const Array<Real>& velocity,
                        const Array<std::int8_t>& kind, Real particle_spacing, Real pipe_radius,
                        Real pipe_length, const std::optional<PushPlate>& plate, Real density,
                        Real kinematic_viscosity, Real roughness, const Turbulence& turbulence,
                        Real bulk_velocity, std::optional<Real> pressure_gradient, Real courant,
                        Real tolerance, const std::string& solver, const std::string& pairing,
                        Real background, Real shift, Real pressure_limit, Real speed, int threads) {
                using namespace mps::lagrangian;
                return Liquid(
                    vectors(position, "position"), vectors(velocity, "velocity"), kinds(kind),
                    pipe_radius, pipe_length, plate, density, kinematic_viscosity, roughness,
                    flow(turbulence), {bulk_velocity, pressure_gradient},
                    {particle_spacing, courant, tolerance, background, shift, pairing_of(pairing),
                     pressure_limit, speed, solver_of(solver), threads});
            }),
            py::kw_only(), "position"_a, "velocity"_a, "kind"_a, "particle_spacing"_a,
            "pipe_radius"_a, "pipe_length"_a, "plate"_a = py::none(), "density"_a,
            "kinematic_viscosity"_a, "roughness"_a, "turbulence"_a, "bulk_velocity"_a,
            "pressure_gradient"_a = py::none(), "courant"_a = 0.8, "tolerance"_a = 1e-3,
            "solver"_a = "two_level", "pairing"_a = "conserving", "background"_a = 0.02,
            "shift"_a = 0.25, "pressure_limit"_a = 0.25, "speed"_a = 0., "threads"_a = 1)
        .def("__len__", &Liquid::places)
        .def(
            "advance", [](Liquid& liquid, Real dt) { return liquid.advance(dt); }, "dt"_a,
            py::call_guard<py::gil_scoped_release>(),
            "Advance by dt [s], in as many substeps as Courant number and viscosity ask for.")
        .def("bend", &Liquid::bend, "bending"_a,
             "The pipe moves so in the next `advance`, of the same duration; from now on it is as "
             "at the start of it.")
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
    Held each step unless a gradient is given; scales the pressure limits in any case [m/s].
pressure_gradient : float, optional
    Given loss of pressure along the pipe [Pa/m].
)")
        .def(
            "velocity_at",
            [](const Liquid& liquid, const Array<Real>& points, Real radius) {
                return array(
                    coupling::sample_velocity({radius}, liquid.period(), liquid.liquid_position(),
                                              liquid.liquid_velocity(), vectors(points, "points")));
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
    [m/s]; zero where no liquid is within the radius.
)")
        .def_property_readonly("liquid_count", &Liquid::liquid_count)
        .def_property_readonly("count_in_bore", &Liquid::count_in_bore,
                               "Liquid particles from x = 0 to the pipe's length.")
        .def_property_readonly("plate_face", &Liquid::plate_face,
                               "Where the plate meets the liquid [m]; 0 without a plate.")
        .def_property_readonly(
            "position", [](const Liquid& l) { return array(l.position()); },
            "(n, 3) [m], in the order given; NaN in a place that no particle holds.")
        .def_property_readonly(
            "velocity", [](const Liquid& l) { return array(l.velocity()); }, "(n, 3) [m/s].")
        .def_property_readonly(
            "pressure", [](const Liquid& l) { return array(l.pressure()); },
            "(n,) p', less the mean gradient and static parts [Pa].")
        .def_property_readonly(
            "density_ratio", [](const Liquid& l) { return array(l.density_ratio()); },
            "(n,) number density over its mean in the liquid [-].")
        .def_property_readonly(
            "void_fraction", [](const Liquid& l) { return array(l.void_fraction()); },
            "(n,) share of the liquid, of the last substep [-].")
        .def_property_readonly("bulk_velocity", &Liquid::bulk_velocity,
                               "Flow rate of liquid and solids over the bore [m/s].")
        .def_property_readonly("pressure_gradient", &Liquid::pressure_gradient,
                               "Loss along the pipe in the last substep [Pa/m].")
        .def_property_readonly("wall_shear", &Liquid::wall_shear,
                               "Mean shear of the wall function [Pa]; 0 in laminar flow.")
        .def_property_readonly("kinetic_energy", &Liquid::kinetic_energy, "Per mass [J/kg].")
        .def_property_readonly("density_scatter", &Liquid::density_scatter,
                               "Standard deviation of the number density over its mean [-].")
        .def_property_readonly("pressure_noise", &Liquid::pressure_noise,
                               "Root mean square change of p' in the last substep [Pa].")
        .def(
            "state",
            [](const Liquid& l) {
                const auto s = l.snapshot();
                return py::dict("position"_a = array(s.position), "velocity"_a = array(s.velocity),
                                "pressure"_a = array(s.pressure), "id"_a = array(s.id),
                                "ends"_a = array(s.ends), "acceleration"_a = array(s.acceleration),
                                "flux"_a = array(s.flux),
                                "void_fraction"_a = array(s.void_fraction));
            },
            "The exact state as arrays, for `restore`.")
        .def(
            "restore",
            [](Liquid& l, const py::dict& state) {
                const auto position = state["position"].cast<Array<Real>>();
                const auto velocity = state["velocity"].cast<Array<Real>>();
                const auto pressure = state["pressure"].cast<Array<Real>>();
                const auto id = state["id"].cast<Array<Index>>();
                const auto ends = state["ends"].cast<Array<Real>>();
                const auto acceleration = state["acceleration"].cast<Array<Real>>();
                const auto flux = state["flux"].cast<Array<Real>>();
                const auto eps = state["void_fraction"].cast<Array<Real>>();
                const auto copy = [](auto span) {
                    return std::vector<std::remove_cvref_t<decltype(span[0])>>(span.begin(),
                                                                               span.end());
                };
                l.restore({copy(vectors(position, "position")), copy(vectors(velocity, "velocity")),
                           copy(values(pressure, "pressure")), copy(values(id, "id")),
                           copy(values(ends, "ends")), copy(vectors(acceleration, "acceleration")),
                           copy(vectors(flux, "flux")), copy(values(eps, "void_fraction"))});
            },
            "state"_a, "Continue bit-equal from a `state` of the same liquid.");
}

} // namespace mpsdem::bindings
