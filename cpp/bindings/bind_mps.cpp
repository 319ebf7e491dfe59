#include "bindings/array.hpp"
#include "mps/profile/pipe_profile.hpp"

#include <pybind11/pybind11.h>

namespace mpsdem::bindings {

using namespace pybind11::literals;

void bind_mps(py::module_ m) {
    m.doc() = "Liquids. SI units throughout.";

    m.def("friction_factor", &mps::friction_factor, "reynolds"_a, "relative_roughness"_a = 0.0,
          R"(Darcy friction factor of a full pipe.

Parameters
----------
reynolds : float
    Of the bulk velocity and the pipe's diameter [-], > 0.
relative_roughness : float
    Sand-grain roughness over the pipe's diameter [-], at most 0.05.

Returns
-------
float
    ``64 / reynolds`` below 2300, above it the solution of Colebrook's equation [-].

Notes
-----
Between 2300 and 4000 the flow of nature is intermittent and no law holds.

References
----------
Colebrook (1939), doi:10.1680/ijoti.1939.13150.
)");

    py::class_<mps::PipeProfile>(m, "PipeProfile",
                                 R"(Developed velocity profile of a full straight pipe, prescribed.

The pipe's axis is the x axis. Laminar (parabola) below a Reynolds number of 2300, above it
Reichardt's turbulent profile, made to carry the bulk velocity with Colebrook's friction factor.

Parameters
----------
pipe_radius : float
    [m]
bulk_velocity : float
    Along x, of either sign or zero [m/s].
kinematic_viscosity : float
    [m2/s]
roughness : float
    Sand-grain roughness of the wall [m], at most 0.05 of the pipe's diameter.

References
----------
Reichardt (1951), doi:10.1002/zamm.19510310704.
)")
        .def(py::init<Real, Real, Real, Real>(), py::kw_only(), "pipe_radius"_a, "bulk_velocity"_a,
             "kinematic_viscosity"_a, "roughness"_a = 0.0)
        .def(
            "velocity",
            [](const mps::PipeProfile& profile, const Array<Real>& position) {
                const auto x = vectors(position, "position");
                std::vector<Vec3> velocity(x.size());
                profile.velocity(x, velocity);
                return array(velocity);
            },
            "position"_a,
            R"(Liquid velocity at points.

Parameters
----------
position : (n, 3) float64 ndarray
    [m]

Returns
-------
(n, 3) float64 ndarray
    Velocity [m/s]; zero outside the bore.
)")
        .def_property_readonly("reynolds", &mps::PipeProfile::reynolds,
                               "Reynolds number of bulk velocity and diameter [-].")
        .def_property_readonly("laminar", &mps::PipeProfile::laminar,
                               "Whether the profile is the parabola.")
        .def_property_readonly("friction_factor", &mps::PipeProfile::friction_factor,
                               "Darcy friction factor [-]; 0 where the liquid rests.")
        .def_property_readonly("friction_velocity", &mps::PipeProfile::friction_velocity,
                               "Root of wall shear stress over density, >= 0 [m/s].");
}

} // namespace mpsdem::bindings
