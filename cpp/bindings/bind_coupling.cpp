#include "bindings/array.hpp"
#include "coupling/drag_rate.hpp"
#include "coupling/void_fraction.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <tuple>

namespace mpsdem::bindings {

using namespace pybind11::literals;

namespace {

template <coupling::DragLaw Law>
void bind_law(py::module_ m, const char* name, const char* doc) {
    py::class_<Law>(m, name, doc)
        .def(py::init<>())
        .def("force_ratio", &Law::force_ratio, "reynolds"_a, "void_fraction"_a,
             R"(Drag over Stokes's drag on the superficial slip, in Model A.

Parameters
----------
reynolds : float
    Void fraction x slip x diameter / kinematic viscosity [-], >= 0.
void_fraction : float
    Share of liquid around the sphere [-], in (0, 1].

Returns
-------
float
    Force / (3 pi x dynamic viscosity x diameter x void fraction x slip) [-].
)")
        .def("covers", &Law::covers, "reynolds"_a, "void_fraction"_a,
             "Whether the law's sources stand behind it there.")
        .def("__repr__", [name](const Law&) { return std::string(name) + "()"; });
}

coupling::ImmersedSolids immersed(const Array<Real>& liquid_velocity, const Array<Real>& velocity,
                                  const Array<Real>& void_fraction, const Array<Real>& diameter,
                                  Real kinematic_viscosity) {
    return {vectors(liquid_velocity, "liquid_velocity"), vectors(velocity, "velocity"),
            values(void_fraction, "void_fraction"), values(diameter, "diameter"),
            kinematic_viscosity};
}

Array<Real> drag_rate(const coupling::AnyDragLaw& law, const Array<Real>& liquid_velocity,
                      const Array<Real>& velocity, const Array<Real>& void_fraction,
                      const Array<Real>& diameter, const Array<Real>& density, Real liquid_density,
                      Real kinematic_viscosity) {
    const auto solids =
        immersed(liquid_velocity, velocity, void_fraction, diameter, kinematic_viscosity);
    std::vector<Real> rate(solids.velocity.size());
    coupling::drag_rate(law, solids, values(density, "density"), liquid_density, rate);
    return array(rate);
}

std::size_t count_outside(const coupling::AnyDragLaw& law, const Array<Real>& liquid_velocity,
                          const Array<Real>& velocity, const Array<Real>& void_fraction,
                          const Array<Real>& diameter, Real kinematic_viscosity) {
    return coupling::count_outside(
        law, immersed(liquid_velocity, velocity, void_fraction, diameter, kinematic_viscosity));
}

std::tuple<Array<Real>, std::size_t> at_solids(const coupling::VoidFraction& stage,
                                               const Array<Real>& position,
                                               const Array<Real>& radius, int threads) {
    const auto x = vectors(position, "position");
    std::vector<Real> eps(x.size());
    const std::size_t clipped = stage.at_solids(x, values(radius, "radius"), threads, eps);
    return {array(eps), clipped};
}

} // namespace

void bind_coupling(py::module_ m) {
    m.doc() = "What liquid and solids do to each other. SI units throughout.";

    bind_law<coupling::SchillerNaumann>(m, "SchillerNaumann", R"(Drag of an isolated sphere.

The force depends on the slip alone; neighbors change nothing. Reynolds numbers up to 2e5.

References
----------
Schiller & Naumann (1933), Z. Ver. Dtsch. Ing. 77, 318-320.
)");
    bind_law<coupling::WenYu>(m, "WenYu", R"(Drag of a sphere in a fluidised suspension.

Void fractions from 0.45 to 1, Reynolds numbers up to 2e5.

References
----------
Wen & Yu (1966), Chem. Eng. Prog. Symp. Ser. 62, 100-111.
)");
    bind_law<coupling::ErgunWenYu>(
        m, "ErgunWenYu",
        R"(Ergun's packed bed up to a void fraction of 0.8, Wen & Yu above: Gidaspow's law.

Void fractions from 0.36 to 1; Reynolds numbers up to 2500 times the solid fraction in the bed,
up to 2e5 above. The drag jumps at the switch, by a factor of 3.7 at a Reynolds number of 1000.

References
----------
Ergun (1952), Chem. Eng. Prog. 48, 89-94; Ding & Gidaspow (1990), doi:10.1002/aic.690360404.
)");
    bind_law<coupling::DiFelice>(m, "DiFelice",
                                 R"(One smooth law from a packed bed to a lone sphere.

Void fractions from 0.4 to 1, Reynolds numbers 0.01 to 1e4.

References
----------
Di Felice (1994), doi:10.1016/0301-9322(94)90011-6.
)");
    bind_law<coupling::KochHill>(m, "KochHill", R"(Drag in random arrays of spheres, computed.

Void fractions from 0.36 to 0.9, Reynolds numbers up to 200.

References
----------
Koch & Hill (2001), doi:10.1146/annurev.fluid.33.1.619.
)");
    bind_law<coupling::Beetstra>(m, "Beetstra", R"(Drag in random arrays of spheres, computed.

Void fractions from 0.4 to 0.9, Reynolds numbers up to 1000.

References
----------
Beetstra, van der Hoef & Kuipers (2007), doi:10.1002/aic.11065.
)");

    m.def("drag_rate", &drag_rate, "law"_a, py::kw_only(), "liquid_velocity"_a, "velocity"_a,
          "void_fraction"_a, "diameter"_a, "density"_a, "liquid_density"_a, "kinematic_viscosity"_a,
          R"(Drag of each solid over its mass and slip, in Model B.

The drag's acceleration is ``rate * (liquid_velocity - velocity)``. In Model B the liquid carries
the whole pressure gradient, the drag is that of Model A over the void fraction, and the buoyancy
is that of the liquid's density.

Parameters
----------
law : SchillerNaumann, WenYu, ErgunWenYu, DiFelice, KochHill or Beetstra
liquid_velocity, velocity : (n, 3) float64 ndarray
    At each solid, and its own [m/s].
void_fraction : (n,) float64 ndarray
    At each solid [-], in (0, 1].
diameter, density : (n,) float64 ndarray
    Of each solid [m], [kg/m3].
liquid_density : float
    [kg/m3]
kinematic_viscosity : float
    Of the liquid [m2/s].

Returns
-------
(n,) float64 ndarray
    Rate [1/s].

References
----------
Zhou, Kuang, Chu & Yu (2010), doi:10.1017/S002211201000306X.
)");
    m.def("count_outside", &count_outside, "law"_a, py::kw_only(), "liquid_velocity"_a,
          "velocity"_a, "void_fraction"_a, "diameter"_a, "kinematic_viscosity"_a,
          R"(How many solids lie outside what the drag law's sources stand for.

Parameters
----------
law : SchillerNaumann, WenYu, ErgunWenYu, DiFelice, KochHill or Beetstra
liquid_velocity, velocity : (n, 3) float64 ndarray
    At each solid, and its own [m/s].
void_fraction : (n,) float64 ndarray
    At each solid [-], in (0, 1].
diameter : (n,) float64 ndarray
    [m]
kinematic_viscosity : float
    Of the liquid [m2/s].

Returns
-------
int
    Number of solids for which ``law.covers`` is false.
)");

    py::class_<coupling::VoidFraction>(m, "VoidFraction",
                                       R"(Void fraction that each solid sees in a straight pipe.

Neighbors count by the kernel ``4 q^5 - 5 q^4 + 1``, ``q = r / smoothing_radius``, normalised by the
part of it inside the bore. A lone sphere sees 1, a dense bed its full solid fraction.

Parameters
----------
pipe_radius : float
    Of the bore about the x axis [m].
period : float
    Of the pipe along x [m].
smoothing_radius : float
    [m]; 2.5 diameters is a good choice, 1.5 the least.
)")
        .def(py::init<Real, Real, Real>(), py::kw_only(), "pipe_radius"_a, "period"_a,
             "smoothing_radius"_a)
        .def("at_solids", &at_solids, py::kw_only(), "position"_a, "radius"_a, "threads"_a = 1,
             R"(Void fraction at each solid.

Parameters
----------
position : (n, 3) float64 ndarray
    [m]
radius : (n,) float64 ndarray
    [m]
threads : int
    The result does not depend on it.

Returns
-------
void_fraction : (n,) float64 ndarray
    [-], in [0.3, 1].
clipped : int
    How many were below 0.3 and raised to it.
)");
}

} // namespace mpsdem::bindings
