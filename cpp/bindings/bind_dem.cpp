#include "bindings/array.hpp"
#include "dem/solids.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <tuple>

namespace mpsdem::bindings {

using namespace pybind11::literals;

namespace {

/// An optional argument: none is empty.
std::span<const Vec3> vectors(const std::optional<Array<Real>>& a, const char* name) {
    return a ? bindings::vectors(*a, name) : std::span<const Vec3>{};
}
std::span<const Real> values(const std::optional<Array<Real>>& a, const char* name) {
    return a ? bindings::values(*a, name) : std::span<const Real>{};
}

/// One number for all, written to `same`, or one for each; zero for all is empty.
std::span<const Real> one_or_many(const std::variant<Real, Array<Real>>& a, const char* name,
                                  std::size_t n, std::vector<Real>& same) {
    if (const auto* each = std::get_if<Array<Real>>(&a)) return bindings::values(*each, name);
    if (std::get<Real>(a) != 0) same.assign(n, std::get<Real>(a));
    return same;
}

using LawArgument =
    std::variant<const dem::LinearSpring*, const dem::HertzMindlin*, const dem::HertzViscoelastic*>;
using WallArgument =
    std::variant<const geometry::Plane*, const geometry::Cylinder*, const geometry::BentCylinder*>;

/// The value behind a variant of pointers: pybind11 fills those, never a value without a default.
template <class Value, class Argument>
Value value_of(const Argument& argument, const char* name) {
    return std::visit(
        [&](const auto* p) -> Value {
            require(p != nullptr, std::string(name) + " must not be None");
            return *p;
        },
        argument);
}

dem::ContactModel model(const LawArgument& law, Real rolling_friction) {
    return {value_of<dem::AnyContactLaw>(law, "contact law"),
            dem::RollingResistance(rolling_friction),
            rolling_friction > 0 ? dem::Rolling::resisted : dem::Rolling::free};
}

template <class Law>
auto contact_force(const Law& law, const Array<Real>& normal, const Array<Real>& relative_velocity,
                   Real overlap, Real reduced_radius, Real reduced_mass, const Array<Real>& spring,
                   Real dt) {
    const dem::Contact<Real> contact{vector(normal, "normal"),
                                     vector(relative_velocity, "relative_velocity"), overlap,
                                     reduced_radius, reduced_mass};
    Vec3 s = vector(spring, "spring");
    const dem::ContactForce<Real> f = law.force(contact, s, dt);
    return std::tuple(array(f.normal * contact.normal), array(f.tangential), array(s));
}

template <class Law>
void bind_contact_force(py::class_<Law>& law) {
    law.def("contact_force", &contact_force<Law>, py::kw_only(), "normal"_a, "relative_velocity"_a,
            "overlap"_a, "reduced_radius"_a, "reduced_mass"_a, "spring"_a, "dt"_a,
            R"(Force of one contact on body i.

Parameters
----------
normal : (3,) float64 ndarray
    Unit vector from body j to body i.
relative_velocity : (3,) float64 ndarray
    v_i - v_j at the contact point, spin included [m/s].
overlap, reduced_radius : float
    [m].
reduced_mass : float
    [kg].
spring : (3,) float64 ndarray
    Tangential displacement before the step [m].
dt : float
    Step [s].

Returns
-------
normal, tangential : (3,) float64 ndarray
    Force on body i [N].
spring : (3,) float64 ndarray
    Tangential displacement after the step [m].
)");
}

} // namespace

void bind_dem(py::module_ m) {
    m.doc() = "Discrete element method: contact laws and the solids. SI units throughout.";

    py::class_<dem::LinearSpring> linear(m, "LinearSpring", "Linear spring-dashpot with friction.");
    linear
        .def(py::init<Real, Real, Real, Real, Real>(), py::kw_only(), "normal_stiffness"_a,
             "tangential_stiffness"_a, "normal_damping"_a, "tangential_damping"_a, "friction"_a)
        .def_static("with_restitution", &dem::LinearSpring::with_restitution, py::kw_only(),
                    "normal_stiffness"_a, "tangential_stiffness"_a, "restitution"_a, "friction"_a,
                    "Damping chosen for each pair so that an impact returns `restitution`.");
    bind_contact_force(linear);

    py::class_<dem::HertzMindlin> hertz(m, "HertzMindlin",
                                        "Hertz normal and Mindlin tangential force.");
    hertz.def(py::init([](Real youngs_modulus, Real poisson_ratio, Real restitution, Real friction,
                          std::optional<Real> other_youngs_modulus,
                          std::optional<Real> other_poisson_ratio) {
                  return dem::HertzMindlin({youngs_modulus, poisson_ratio},
                                           {other_youngs_modulus.value_or(youngs_modulus),
                                            other_poisson_ratio.value_or(poisson_ratio)},
                                           restitution, friction);
              }),
              py::kw_only(), "youngs_modulus"_a, "poisson_ratio"_a, "restitution"_a, "friction"_a,
              "other_youngs_modulus"_a = py::none(), "other_poisson_ratio"_a = py::none(),
              R"(Contact of bodies of one material, or of two.

Parameters
----------
youngs_modulus, other_youngs_modulus : float
    [Pa]; infinite for a rigid body. The other body's is the first's unless given.
poisson_ratio, other_poisson_ratio : float
    [-].
restitution : float
    Returned by a head-on impact at any speed [-].
friction : float
    Sliding friction [-].
)");
    bind_contact_force(hertz);

    py::class_<dem::HertzViscoelastic> viscoelastic(
        m, "HertzViscoelastic", "Hertz contact of viscoelastic bodies, for comparing codes.");
    viscoelastic.def(py::init<Real, Real, Real, Real, Real>(), py::kw_only(), "normal_stiffness"_a,
                     "tangential_stiffness"_a, "normal_damping"_a, "tangential_damping"_a,
                     "friction"_a);
    bind_contact_force(viscoelastic);

    m.def("damping_factor", &dem::damping_factor, "restitution"_a, "p"_a, "q"_a,
          "Factor a of x'' + a x^q x' + x^p = 0 that returns `restitution` without pulling.");

    py::class_<dem::Lubrication>(
        m, "Lubrication",
        R"(Viscous force in narrow gaps between solids and at walls, along the normal.

F = -6 pi viscosity R^2 u_n (1 / max(h, h_min) - 1 / h_c) for gaps 0 < h < h_c; R is the reduced
radius. Source: Biegert, Vowinckel & Meiburg (2017) doi:10.1016/j.jcp.2017.03.035.

Parameters
----------
viscosity : float
    Of the liquid, dynamic [Pa s], > 0.
least_gap : float
    h_min / R [-], > 0: the roughness of the surfaces.
cutoff : float
    h_c / R [-], > least_gap and <= 2.

Raises
------
ValueError
    A number out of its range.
)")
        .def(py::init<Real, Real, Real>(), py::kw_only(), "viscosity"_a, "least_gap"_a = 3e-3,
             "cutoff"_a = 1.)
        .def("force", &dem::Lubrication::force<Real>, py::kw_only(), "gap"_a, "normal_velocity"_a,
             "reduced_radius"_a,
             "On the first body, positive apart [N]. `gap` and `reduced_radius` in m; "
             "`normal_velocity` [m/s], positive while the bodies part.");

    py::class_<dem::AdvanceReport>(m, "AdvanceReport", "What a call of Solids.advance met.")
        .def_readonly("largest_overlap", &dem::AdvanceReport::largest_overlap,
                      "Largest overlap over the smaller radius [-].")
        .def_readonly("prunes", &dem::AdvanceReport::prunes)
        .def_readonly("sorts", &dem::AdvanceReport::sorts)
        .def_readonly("finite", &dem::AdvanceReport::finite,
                      "False when positions or velocities overflowed: the state is lost.");

    py::class_<dem::Solids>(m, "Solids", R"(Spheres that touch each other and walls.

Parameters
----------
position, velocity, spin : (n, 3) float64 ndarray
    [m], [m/s], [rad/s].
radius, density : (n,) float64 ndarray
    [m], [kg/m3].
pair_law, wall_law : LinearSpring, HertzMindlin or HertzViscoelastic
    Contact law between solids and at walls.
pair_rolling_friction, wall_rolling_friction : float
    [-].
walls : list of Plane, Cylinder or BentCylinder
period : float
    Length of the periodic x axis [m]; 0 for none.
threads : int
    The results do not depend on it.
lubrication : Lubrication, optional
    None: gaps hold nothing. Its force bounds the step of `advance`.
)")
        .def(py::init([](const Array<Real>& position, const Array<Real>& velocity,
                         const Array<Real>& spin, const Array<Real>& radius,
                         const Array<Real>& density, const LawArgument& pair_law,
                         const LawArgument& wall_law, Real pair_rolling_friction,
                         Real wall_rolling_friction, const std::vector<WallArgument>& walls,
                         Real period, int threads,
                         const std::optional<dem::Lubrication>& lubrication) {
                 std::vector<geometry::Wall> surfaces;
                 for (const WallArgument& wall : walls)
                     surfaces.push_back(value_of<geometry::Wall>(wall, "wall"));
                 return dem::Solids(
                     vectors(position, "position"), vectors(velocity, "velocity"),
                     vectors(spin, "spin"), values(radius, "radius"), values(density, "density"),
                     model(pair_law, pair_rolling_friction), model(wall_law, wall_rolling_friction),
                     std::move(surfaces), period, threads, lubrication);
             }),
             py::kw_only(), "position"_a, "velocity"_a, "spin"_a, "radius"_a, "density"_a,
             "pair_law"_a, "wall_law"_a, "pair_rolling_friction"_a = 0.,
             "wall_rolling_friction"_a = 0., "walls"_a = std::vector<WallArgument>{},
             "period"_a = 0., "threads"_a = 1, "lubrication"_a = py::none())
        .def("__len__", &dem::Solids::size)
        .def(
            "set_forcing",
            [](dem::Solids& solids, const Array<Real>& acceleration,
               const std::optional<Array<Real>>& liquid_velocity,
               const std::optional<Array<Real>>& drag_rate,
               const std::optional<Array<Real>>& liquid_acceleration,
               const std::optional<Array<Real>>& relaxation,
               const std::variant<Real, Array<Real>>& added_mass) {
                std::vector<Real> same;
                solids.set_forcing(vectors(acceleration, "acceleration"),
                                   vectors(liquid_velocity, "liquid_velocity"),
                                   values(drag_rate, "drag_rate"),
                                   vectors(liquid_acceleration, "liquid_acceleration"),
                                   values(relaxation, "relaxation"),
                                   one_or_many(added_mass, "added_mass", solids.size(), same));
            },
            py::kw_only(), "acceleration"_a, "liquid_velocity"_a = py::none(),
            "drag_rate"_a = py::none(), "liquid_acceleration"_a = py::none(),
            "relaxation"_a = py::none(), "added_mass"_a = 0.,
            R"(From now on dv/dt = F/m + acceleration + drag_rate (u - v), u = liquid_velocity.

With the last two the liquid responds: du/dt = liquid_acceleration - relaxation (u - v), from
`liquid_velocity` on. Both are implicit in the slip u - v, together: stable for any step. The
liquid's inertia of each solid, drag_rate * mass / relaxation [kg], times u and the solid's mass
times v then keep their sum in the exchange.

Added mass adds added_mass (du/dt - dv/dt) to the solid's acceleration, implicitly: stable for any
ratio of densities. A liquid that responds gets the opposite with the inertia above; one that does
not has du/dt = 0. Contacts see the solid's own mass. Starts `drag_impulse` and `mean_velocity` anew.

Parameters
----------
acceleration : (n, 3) float64 ndarray
    [m/s2].
liquid_velocity : (n, 3) float64 ndarray, optional
    [m/s]; together with `drag_rate`.
drag_rate : (n,) float64 ndarray, optional
    [1/s], >= 0.
liquid_acceleration : (n, 3) float64 ndarray, optional
    What else moves the liquid at each solid [m/s2]; together with `relaxation`.
relaxation : (n,) float64 ndarray, optional
    Rate at which the liquid at each solid nears the solid's velocity [1/s], >= 0.
added_mass : float or (n,) float64 ndarray
    Over the solid's own mass [-], >= 0: C_m rho_liquid / rho_solid, C_m = 1/2 for a sphere. Force:
    Auton, Hunt & Prud'homme (1988) doi:10.1017/S0022112088003246. Other than 0 only with `drag_rate`.

Raises
------
ValueError
    A shape, a negative number, or one of those that come together is missing.
)")
        .def("bend", &dem::Solids::bend, "bending"_a,
             "Bent walls move so in the next `advance`, and stay as at its end.")
        .def("advance", &dem::Solids::advance, "dt"_a, "steps"_a,
             py::call_guard<py::gil_scoped_release>(),
             "Take `steps` steps of velocity Verlet of `dt` [s]. ValueError: dt is not > 0, or too "
             "long for lubrication.")
        .def_property_readonly(
            "position", [](const dem::Solids& s) { return array(s.position()); },
            "(n, 3) [m], x within the period.")
        .def_property_readonly(
            "velocity", [](const dem::Solids& s) { return array(s.velocity()); }, "(n, 3) [m/s].")
        .def_property_readonly(
            "spin", [](const dem::Solids& s) { return array(s.spin()); }, "(n, 3) [rad/s].")
        .def_property_readonly(
            "radius", [](const dem::Solids& s) { return array(s.radius()); }, "(n,) [m].")
        .def_property_readonly(
            "mass", [](const dem::Solids& s) { return array(s.mass()); }, "(n,) [kg].")
        .def_property_readonly(
            "laps", [](const dem::Solids& s) { return array(s.laps()); },
            "(n,) times around the periodic axis.")
        .def_property_readonly(
            "drag_impulse", [](const dem::Solids& s) { return array(s.drag_impulse()); },
            "(n, 3) impulse of drag and added mass on each solid since set_forcing [N s].")
        .def_property_readonly(
            "mean_velocity", [](const dem::Solids& s) { return array(s.mean_velocity()); },
            "(n, 3) mean over the time since set_forcing, as drag saw it [m/s]; in a liquid only.")
        .def_property_readonly(
            "liquid_velocity", [](const dem::Solids& s) { return array(s.liquid_velocity()); },
            "(n, 3) of the liquid at each solid now [m/s]; in a liquid only.")
        .def_property_readonly(
            "wall_impulse", [](const dem::Solids& s) { return array(s.wall_impulse()); },
            "(3,) impulse of the walls on the solids, lubrication included, since the start [N s].")
        .def_property_readonly("longest_step", &dem::Solids::longest_step,
                               "That lubrication allows [s]; infinite without.")
        .def_property_readonly("kinetic_energy", &dem::Solids::kinetic_energy, "[J]")
        .def_property_readonly("elastic_energy", &dem::Solids::elastic_energy, "[J]")
        .def(
            "contacts",
            [](const dem::Solids& s) {
                const dem::ContactTable t = s.contacts();
                return py::dict("first"_a = array(t.first), "second"_a = array(t.second),
                                "overlap"_a = array(t.overlap), "normal"_a = array(t.normal),
                                "force"_a = array(t.force));
            },
            "What touches now: first, second (-1 - w for wall w), overlap [m], normal, force [N].")
        .def(
            "state",
            [](const dem::Solids& s) {
                const auto snapshot = s.snapshot();
                return py::dict("reals"_a = array(snapshot.reals),
                                "integers"_a = array(snapshot.integers));
            },
            "The exact state as arrays of private layout, for `restore`; forcing is not part of "
            "it.")
        .def(
            "restore",
            [](dem::Solids& s, const py::dict& state) {
                const auto reals = state["reals"].cast<Array<Real>>();
                const auto integers = state["integers"].cast<Array<std::int64_t>>();
                const auto r = values(reals, "reals");
                const auto k = values(integers, "integers");
                s.restore({{r.begin(), r.end()}, {k.begin(), k.end()}});
            },
            "state"_a, "Continue bit-equal from a `state` of the same population.");
}

} // namespace mpsdem::bindings
