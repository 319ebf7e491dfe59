#include "bindings/array.hpp"
#include "geometry/cylinder.hpp"
#include "geometry/plane.hpp"
#include "mps/divergence.hpp"
#include "mps/gradient.hpp"
#include "mps/laplacian.hpp"
#include "mps/least_squares_laplacian.hpp"
#include "mps/number_density.hpp"
#include "mps/relative_convection.hpp"
#include "mps/shear_rate.hpp"
#include "mps/shifting.hpp"
#include "mps/turbulence.hpp"
#include "mps/viscosity.hpp"
#include "mps/wall_function.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <tuple>
#include <variant>

namespace mpsdem::bindings {

using namespace pybind11::literals;

namespace {

using AnyWall = std::variant<const geometry::Plane*, const geometry::Cylinder*>;
using AnyLengthModel = std::variant<const mps::MixingLength*, const mps::Smagorinsky*>;

using mps::EvaluatedPairs;
using mps::Kind;
using mps::ReferenceDensity;
using neighbors::NeighborList;

void require_rows(std::size_t rows, const NeighborList& neighbors, const char* name) {
    require(rows == neighbors.size(),
            std::string(name) + " must have one row per point of the neighbor list");
}

void require_reach(const NeighborList& neighbors, const mps::Weight& weight) {
    require(neighbors.radius() >= weight.effective_radius,
            "neighbors must reach to effective_radius: make the list with that radius");
}

std::span<const Real> scalars_of(const NeighborList& neighbors, const Array<Real>& a,
                                 const char* name) {
    require_rows(values(a, name).size(), neighbors, name);
    return values(a, name);
}

std::span<const Vec3> vectors_of(const NeighborList& neighbors, const Array<Real>& a,
                                 const char* name) {
    require_rows(vectors(a, name).size(), neighbors, name);
    return vectors(a, name);
}

std::vector<Kind> kinds_of(const NeighborList& neighbors, const Array<std::int8_t>& a) {
    const auto numbers = values(a, "kind");
    require_rows(numbers.size(), neighbors, "kind");
    std::vector<Kind> kind;
    kind.reserve(numbers.size());
    for (const std::int8_t number : numbers) {
        kind.push_back(static_cast<Kind>(number));
        require(kind.back() == Kind::liquid || kind.back() == Kind::wall ||
                    kind.back() == Kind::ghost,
                "kind must be 2 (liquid), -2 (wall) or -1 (ghost)");
    }
    return kind;
}

/// Call the operator `fill(result)`, and give what it filled to Python.
template <class T, class Fill>
Array<Real> filled(std::size_t n, const Fill& fill) {
    std::vector<T> result(n);
    fill(std::span<T>(result));
    return array(result);
}

Array<Real> number_density(const NeighborList& neighbors, const ReferenceDensity& reference,
                           int threads) {
    require_reach(neighbors, reference.weight);
    return filled<Real>(neighbors.size(), [&](auto result) {
        mps::number_density(EvaluatedPairs(neighbors, reference.weight), threads, result);
    });
}

template <mps::GradientForm Form>
Array<Real> gradient(const NeighborList& neighbors, const ReferenceDensity& reference,
                     const Array<Real>& pressure, int threads) {
    require_reach(neighbors, reference.weight);
    const auto p = scalars_of(neighbors, pressure, "pressure");
    return filled<Vec3>(p.size(), [&](auto result) {
        mps::gradient(Form{}, reference, EvaluatedPairs(neighbors, reference.weight), p, threads,
                      result);
    });
}

Array<Real> corrected_gradient(const NeighborList& neighbors, const ReferenceDensity& reference,
                               const Array<Real>& pressure, int threads) {
    require_reach(neighbors, reference.weight);
    const auto p = scalars_of(neighbors, pressure, "pressure");
    return filled<Vec3>(p.size(), [&](auto result) {
        mps::corrected_gradient(reference, EvaluatedPairs(neighbors, reference.weight), p, threads,
                                result);
    });
}

template <mps::Pairing pairing>
Array<Real> background_gradient(const NeighborList& neighbors, const ReferenceDensity& reference,
                                const Array<Real>& pressure, Real background,
                                const Array<std::int8_t>& kind, const AnyWall& any, int threads) {
    require_reach(neighbors, reference.weight);
    const auto p = scalars_of(neighbors, pressure, "pressure");
    const auto kinds = kinds_of(neighbors, kind);
    return filled<Vec3>(p.size(), [&](auto result) {
        std::visit(
            [&](const auto* wall) {
                mps::background_gradient(pairing, background, *wall, reference,
                                         EvaluatedPairs(neighbors, reference.weight, kinds), p,
                                         threads, result);
            },
            any);
    });
}

Array<Real> divergence(const NeighborList& neighbors, const ReferenceDensity& reference,
                       const Array<Real>& velocity, int threads) {
    require_reach(neighbors, reference.weight);
    const auto u = vectors_of(neighbors, velocity, "velocity");
    return filled<Real>(u.size(), [&](auto result) {
        mps::divergence(reference, EvaluatedPairs(neighbors, reference.weight), u, threads, result);
    });
}

Array<Real> slip_divergence(const NeighborList& neighbors, const ReferenceDensity& reference,
                            const Array<Real>& velocity, const Array<std::int8_t>& kind,
                            const AnyWall& any, int threads) {
    require_reach(neighbors, reference.weight);
    const auto u = vectors_of(neighbors, velocity, "velocity");
    const auto kinds = kinds_of(neighbors, kind);
    return filled<Real>(u.size(), [&](auto result) {
        std::visit(
            [&](const auto* wall) {
                mps::slip_divergence(*wall, reference,
                                     EvaluatedPairs(neighbors, reference.weight, kinds), u, threads,
                                     result);
            },
            any);
    });
}

Array<Real> corrected_divergence(const NeighborList& neighbors, const ReferenceDensity& reference,
                                 const Array<Real>& velocity, const Array<std::int8_t>& kind,
                                 const AnyWall& any, int threads) {
    require_reach(neighbors, reference.weight);
    const auto u = vectors_of(neighbors, velocity, "velocity");
    const auto kinds = kinds_of(neighbors, kind);
    return filled<Real>(u.size(), [&](auto result) {
        std::visit(
            [&](const auto* wall) {
                mps::corrected_divergence(*wall, reference,
                                          EvaluatedPairs(neighbors, reference.weight, kinds), u,
                                          threads, result);
            },
            any);
    });
}

Array<Real> laplacian(const NeighborList& neighbors, const ReferenceDensity& reference,
                      const Array<Real>& field, int threads) {
    require_reach(neighbors, reference.weight);
    const auto apply = [&]<class T>(std::span<const T> f) {
        return filled<T>(f.size(), [&](auto result) {
            mps::laplacian(reference, EvaluatedPairs(neighbors, reference.weight), f, threads,
                           result);
        });
    };
    return field.ndim() == 1 ? apply(scalars_of(neighbors, field, "field"))
                             : apply(vectors_of(neighbors, field, "field"));
}

std::tuple<Array<Real>, std::size_t> least_squares_laplacian(const NeighborList& neighbors,
                                                             const Array<Real>& field,
                                                             const Array<std::int8_t>& kind,
                                                             const AnyWall& any, int threads) {
    const auto kinds = kinds_of(neighbors, kind);
    std::vector<std::uint8_t> deficient(neighbors.size());
    const auto apply = [&]<class T>(std::span<const T> f) {
        return filled<T>(f.size(), [&](std::span<T> result) {
            std::visit(
                [&](const auto* wall) {
                    mps::least_squares_laplacian(*wall, neighbors, std::span<const Kind>(kinds), f,
                                                 threads, result, std::span(deficient));
                },
                any);
        });
    };
    auto result = field.ndim() == 1 ? apply(scalars_of(neighbors, field, "field"))
                                    : apply(vectors_of(neighbors, field, "field"));
    return {std::move(result), static_cast<std::size_t>(std::ranges::count(deficient, 1))};
}

Array<Real> viscous_acceleration(const NeighborList& neighbors, const ReferenceDensity& reference,
                                 const Array<Real>& velocity, const Array<Real>& viscosity,
                                 const Array<std::int8_t>& kind, int threads) {
    require_reach(neighbors, reference.weight);
    const auto u = vectors_of(neighbors, velocity, "velocity");
    const auto nu = scalars_of(neighbors, viscosity, "viscosity");
    const auto kinds = kinds_of(neighbors, kind);
    return filled<Vec3>(u.size(), [&](auto result) {
        mps::viscous_acceleration(reference, EvaluatedPairs(neighbors, reference.weight, kinds), nu,
                                  u, threads, result);
    });
}

Array<Real> shear_rate(const NeighborList& neighbors, const ReferenceDensity& reference,
                       const Array<Real>& velocity, const Array<std::int8_t>& kind, int threads) {
    require_reach(neighbors, reference.weight);
    const auto u = vectors_of(neighbors, velocity, "velocity");
    const auto kinds = kinds_of(neighbors, kind);
    return filled<Real>(u.size(), [&](auto result) {
        mps::shear_rate(EvaluatedPairs(neighbors, reference.weight, kinds), u, threads, result);
    });
}

Array<Real> relative_convection(const NeighborList& neighbors, const ReferenceDensity& reference,
                                const Array<Real>& relative_flux, const Array<Real>& void_fraction,
                                const Array<Real>& velocity, const Array<std::int8_t>& kind,
                                int threads) {
    require_reach(neighbors, reference.weight);
    const auto flux = vectors_of(neighbors, relative_flux, "relative_flux");
    const auto u = vectors_of(neighbors, velocity, "velocity");
    const auto eps = values(void_fraction, "void_fraction");
    require_rows(eps.size(), neighbors, "void_fraction");
    const auto kinds = kinds_of(neighbors, kind);
    return filled<Vec3>(u.size(), [&](auto result) {
        mps::relative_convection(reference, EvaluatedPairs(neighbors, reference.weight, kinds),
                                 flux, eps, u, threads, result);
    });
}

Array<Real> shifting(const NeighborList& neighbors, const ReferenceDensity& reference,
                     Real coefficient, int threads) {
    require_reach(neighbors, reference.weight);
    return filled<Vec3>(neighbors.size(), [&](auto result) {
        mps::shifting(coefficient, reference, EvaluatedPairs(neighbors, reference.weight), threads,
                      result);
    });
}

std::pair<Array<Real>, Array<Real>> stored_weights(const Array<Real>& position,
                                                   const ReferenceDensity& reference, Real period) {
    const auto x = vectors(position, "position");
    mps::StoredPairs pairs(reference.weight, period);
    pairs.find(x, {{x.size()}, x.size()}, 1);
    std::vector<Real> weight, over_square;
    for (std::size_t i = 0; i < x.size(); ++i) {
        pairs.each<mps::Among::all>(i, [&](const mps::Pair& pair) {
            weight.push_back(pair.weight);
            over_square.push_back(pair.over_square);
        });
    }
    return {array(weight), array(over_square)};
}

Array<Real> eddy_viscosity(const AnyLengthModel& any, const Array<Real>& position,
                           const Array<Real>& shear_rate, Real largest, int threads) {
    const auto x = vectors(position, "position");
    const auto rate = values(shear_rate, "shear_rate");
    require(rate.size() == x.size(), "shear_rate must have one row per position");
    return filled<Real>(x.size(), [&](auto result) {
        std::visit(
            [&](const auto* model) {
                mps::eddy_viscosity(*model, x, rate, largest, threads, result);
            },
            any);
    });
}

template <class Model>
Array<Real> length(const Model& model, const Array<Real>& position) {
    const auto x = vectors(position, "position");
    return filled<Real>(x.size(), [&](auto result) {
        std::ranges::transform(x, result.begin(), [&](Vec3 at) { return model.length(at); });
    });
}

constexpr const char* length_doc = R"(Length l of the eddy viscosity l^2 |S|.

Parameters
----------
position : (n, 3) float64 ndarray
    [m]

Returns
-------
(n,) float64 ndarray
    [m]
)";

Array<Real> shear(const mps::WallFunction& function, const Array<Real>& speed,
                  const Array<Real>& distance) {
    const auto u = values(speed, "speed"), y = values(distance, "distance");
    require(u.size() == y.size(), "distance must have one row per speed");
    require(std::ranges::all_of(u, [](Real v) { return v >= 0; }), "speed must be >= 0 m/s");
    require(std::ranges::all_of(y, [](Real d) { return d > 0; }), "distance must be > 0 m");
    return filled<Real>(u.size(), [&](auto result) {
        std::ranges::transform(u, y, result.begin(),
                               [&](Real v, Real d) { return function.shear(v, d); });
    });
}

void bind_pressure_operators(py::module_& m) {
    m.def("number_density", &number_density, "neighbors"_a, "reference"_a, py::kw_only(),
          "threads"_a = 1,
          R"(Sum of the neighbors' weights.

Parameters
----------
neighbors : NeighborList
reference : ReferenceDensity
threads : int
    The result does not depend on it.

Returns
-------
(n,) float64 ndarray
    [-]; ``reference.number_density`` on the lattice.

References
----------
Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
)");
    m.def("relative_convection", &relative_convection, "neighbors"_a, "reference"_a, py::kw_only(),
          "relative_flux"_a, "void_fraction"_a, "velocity"_a, "kind"_a, "threads"_a = 1,
          R"(What a liquid brings along that moves past its own particles, upwind.

Parameters
----------
neighbors : NeighborList
reference : ReferenceDensity
relative_flux : (n, 3) float64 ndarray
    q = eps (u - w), w the particles' own velocity [m/s].
void_fraction : (n,) float64 ndarray
    eps, share of the liquid [-].
velocity : (n, 3) float64 ndarray
    u of the liquid [m/s].
kind : (n,) int8 ndarray
    2 liquid, -2 wall, -1 ghost; only liquid brings something.
threads : int
    The result does not depend on it.

Returns
-------
(n, 3) float64 ndarray
    -(q . grad) u / eps [m/s2]; 0 where q is.
)");
    m.def("shifting", &shifting, "neighbors"_a, "reference"_a, py::kw_only(), "coefficient"_a,
          "threads"_a = 1,
          R"(Where particles should go for their neighborhoods to be even.

Parameters
----------
neighbors : NeighborList
reference : ReferenceDensity
coefficient : float
    Of the spacing squared times the gradient of concentration [-]; 0.1 each step holds.
threads : int
    The result does not depend on it.

Returns
-------
(n, 3) float64 ndarray
    [m]

References
----------
Xu, Stansby & Laurence (2009), doi:10.1016/j.jcp.2009.05.032.
)");
    m.def("stored_weights", &stored_weights, "position"_a, "reference"_a, py::kw_only(),
          "period"_a = 0.0,
          R"(The weights as the particle liquid keeps them, rounded to float32.

Parameters
----------
position : (n, 3) float64 ndarray
    [m]
reference : ReferenceDensity
period : float
    Along x [m]; 0 for none.

Returns
-------
(m,) float64 ndarray, (m,) float64 ndarray
    W [-] and W / r^2 [1/m2] of the neighbors, in the order of a `NeighborList`.
)");
    m.def("sum_gradient", &gradient<mps::SumForm>, "neighbors"_a, "reference"_a, "pressure"_a,
          py::kw_only(), "threads"_a = 1,
          R"(Pressure gradient from p_j + p_i.

Momentum is kept to round-off. A constant pressure pushes apart where particles lie unevenly, and
more so where the sums are cut off.

Parameters
----------
neighbors : NeighborList
reference : ReferenceDensity
pressure : (n,) float64 ndarray
    [Pa]
threads : int
    The result does not depend on it.

Returns
-------
(n, 3) float64 ndarray
    [Pa/m]

References
----------
Khayyer & Gotoh (2008), doi:10.1142/S0578563408001788.
)");
    m.def("difference_gradient", &gradient<mps::DifferenceForm>, "neighbors"_a, "reference"_a,
          "pressure"_a, py::kw_only(), "threads"_a = 1,
          R"(Pressure gradient from p_j - p_i.

A constant pressure has none. Exact for linear pressures on the lattice; among scattered particles
the error does not fall with the spacing.

Parameters
----------
neighbors : NeighborList
reference : ReferenceDensity
pressure : (n,) float64 ndarray
    [Pa]
threads : int
    The result does not depend on it.

Returns
-------
(n, 3) float64 ndarray
    [Pa/m]

References
----------
Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
)");
    m.def("corrected_gradient", &corrected_gradient, "neighbors"_a, "reference"_a, "pressure"_a,
          py::kw_only(), "threads"_a = 1,
          R"(Pressure gradient from p_j - p_i and the inverse moment of the neighborhood.

Exact for linear pressures wherever the neighbors are. Where they lie in a plane, the uncorrected
difference.

Parameters
----------
neighbors : NeighborList
reference : ReferenceDensity
pressure : (n,) float64 ndarray
    [Pa]
threads : int
    The result does not depend on it.

Returns
-------
(n, 3) float64 ndarray
    [Pa/m]

References
----------
Khayyer & Gotoh (2011), doi:10.1016/j.jcp.2011.01.009.
)");
    m.def("background_gradient", &background_gradient<mps::Pairing::difference>, "neighbors"_a,
          "reference"_a, "pressure"_a, py::kw_only(), "background"_a, "kind"_a,
          "wall"_a.none(false), "threads"_a = 1,
          R"(Pressure gradient from p_j - p_i, and 2 p_b that spreads the particles evenly.

Between liquid and wall the background pushes along the wall's normal alone.

Parameters
----------
neighbors : NeighborList
reference : ReferenceDensity
pressure : (n,) float64 ndarray
    [Pa]
background : float
    p_b [Pa]; 0.02 of density x bulk velocity^2 is a good choice.
kind : (n,) int8 ndarray
    2 liquid, -2 wall, -1 ghost.
wall : Plane or Cylinder
threads : int
    The result does not depend on it.

Returns
-------
(n, 3) float64 ndarray
    [Pa/m]
)");
    m.def(
        "conserving_gradient", &background_gradient<mps::Pairing::conserving>, "neighbors"_a,
        "reference"_a, "pressure"_a, py::kw_only(), "background"_a, "kind"_a, "wall"_a.none(false),
        "threads"_a = 1,
        R"(Pressure gradient from p_j + p_i among liquid, and 2 p_b that spreads the particles evenly.

Momentum among liquid is kept to round-off. Between liquid and wall the difference counts along the
wall, the sum along its normal.

Parameters
----------
neighbors : NeighborList
reference : ReferenceDensity
pressure : (n,) float64 ndarray
    [Pa]
background : float
    p_b [Pa]; 0.02 of density x bulk velocity^2 is a good choice.
kind : (n,) int8 ndarray
    2 liquid, -2 wall, -1 ghost.
wall : Plane or Cylinder
threads : int
    The result does not depend on it.

Returns
-------
(n, 3) float64 ndarray
    [Pa/m]
)");
    m.def("divergence", &divergence, "neighbors"_a, "reference"_a, "velocity"_a, py::kw_only(),
          "threads"_a = 1,
          R"(Divergence of the velocity; walls count with the velocities they are given.

Parameters
----------
neighbors : NeighborList
reference : ReferenceDensity
velocity : (n, 3) float64 ndarray
    [m/s]; 0 at the wall makes it a no-slip wall.
threads : int
    The result does not depend on it.

Returns
-------
(n,) float64 ndarray
    [1/s]

References
----------
Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
)");
    m.def("slip_divergence", &slip_divergence, "neighbors"_a, "reference"_a, "velocity"_a,
          py::kw_only(), "kind"_a, "wall"_a.none(false), "threads"_a = 1,
          R"(Divergence of the velocity beside a wall that lets the liquid slip.

Only the velocity through the wall counts, mirrored in it: plug flow has no divergence.

Parameters
----------
neighbors : NeighborList
reference : ReferenceDensity
velocity : (n, 3) float64 ndarray
    Of liquid, wall and ghosts [m/s].
kind : (n,) int8 ndarray
    2 liquid, -2 wall, -1 ghost.
wall : Plane or Cylinder
threads : int
    The result does not depend on it.

Returns
-------
(n,) float64 ndarray
    [1/s]
)");
    m.def("corrected_divergence", &corrected_divergence, "neighbors"_a, "reference"_a, "velocity"_a,
          py::kw_only(), "kind"_a, "wall"_a.none(false), "threads"_a = 1,
          R"(Divergence of the velocity beside a no-slip wall, exact for linear velocities.

The whole velocity is mirrored in the wall.

Parameters
----------
neighbors : NeighborList
reference : ReferenceDensity
velocity : (n, 3) float64 ndarray
    Of liquid, wall and ghosts [m/s].
kind : (n,) int8 ndarray
    2 liquid, -2 wall, -1 ghost.
wall : Plane or Cylinder
threads : int
    The result does not depend on it.

Returns
-------
(n,) float64 ndarray
    [1/s]; 0 at walls and ghosts.
)");
}

void bind_viscous_operators(py::module_& m) {
    m.def("laplacian", &laplacian, "neighbors"_a, "reference"_a, "field"_a, py::kw_only(),
          "threads"_a = 1,
          R"(Laplacian from weighted differences.

Second order on the lattice; among scattered particles its error grows as the spacing falls.

Parameters
----------
neighbors : NeighborList
reference : ReferenceDensity
field : (n,) or (n, 3) float64 ndarray
threads : int
    The result does not depend on it.

Returns
-------
(n,) or (n, 3) float64 ndarray
    Unit of the field / m2.

References
----------
Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
)");
    m.def("least_squares_laplacian", &least_squares_laplacian, "neighbors"_a, "field"_a,
          py::kw_only(), "kind"_a, "wall"_a.none(false), "threads"_a = 1,
          R"(Laplacian of the quadratic polynomial that fits the neighbors best.

Exact for quadratic fields wherever the neighbors are. A wall particle's value is taken to hold on
the wall, at the point nearest to the particle; ghosts are left out.

Parameters
----------
neighbors : NeighborList
field : (n,) or (n, 3) float64 ndarray
kind : (n,) int8 ndarray
    2 liquid, -2 wall, -1 ghost.
wall : Plane or Cylinder
threads : int
    The result does not depend on it.

Returns
-------
result : (n,) or (n, 3) float64 ndarray
    Unit of the field / m2; 0 but for the liquid.
deficient : int
    How many liquid particles have neighbors that fix no quadratic; their result is 0.

References
----------
Tamai & Koshizuka (2014), doi:10.1007/s40571-014-0027-2.
)");
    m.def("viscous_acceleration", &viscous_acceleration, "neighbors"_a, "reference"_a, "velocity"_a,
          py::kw_only(), "viscosity"_a, "kind"_a, "threads"_a = 1,
          R"(Acceleration by viscosity between liquid particles, a pair's being the mean of two.

Momentum is kept to round-off and kinetic energy falls. The wall's shear is not in it.

Parameters
----------
neighbors : NeighborList
reference : ReferenceDensity
velocity : (n, 3) float64 ndarray
    [m/s]
viscosity : (n,) float64 ndarray
    Kinematic, eddies included [m2/s].
kind : (n,) int8 ndarray
    2 liquid, -2 wall, -1 ghost.
threads : int
    The result does not depend on it.

Returns
-------
(n, 3) float64 ndarray
    [m/s2]; 0 but for the liquid.

References
----------
Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
)");
    m.def("shear_rate", &shear_rate, "neighbors"_a, "reference"_a, "velocity"_a, py::kw_only(),
          "kind"_a, "threads"_a = 1,
          R"(Rate of strain sqrt(2 S:S) among liquid particles.

Exact for linear velocities wherever the neighbors are; rotation has none.

Parameters
----------
neighbors : NeighborList
reference : ReferenceDensity
velocity : (n, 3) float64 ndarray
    [m/s]
kind : (n,) int8 ndarray
    2 liquid, -2 wall, -1 ghost.
threads : int
    The result does not depend on it.

Returns
-------
(n,) float64 ndarray
    [1/s]; 0 but for the liquid, and where its neighbors are too few.
)");
}

void bind_turbulence(py::module_& m) {
    py::class_<mps::MixingLength>(m, "MixingLength",
                                  R"(Nikuradse's mixing length of developed flow in a round pipe.

``l / R = 0.14 - 0.08 s^2 - 0.06 s^4`` with ``s = r / R``; the axis is the x axis.

Parameters
----------
pipe_radius : float
    [m]

References
----------
Nikuradse (1932), VDI-Forschungsheft 356.
)")
        .def(py::init<Real>(), py::kw_only(), "pipe_radius"_a)
        .def("length", &length<mps::MixingLength>, "position"_a, length_doc);
    py::class_<mps::Smagorinsky>(m, "Smagorinsky",
                                 R"(Length of the eddies that the spacing does not resolve.

A coarse pipe flow with it alone has too little friction: its particles carry no eddies.

Parameters
----------
spacing : float
    Of the particles [m].
coefficient : float
    Length over spacing [-], 0.1 to 0.2.

References
----------
Smagorinsky (1963), doi:10.1175/1520-0493(1963)091<0099:GCEWTP>2.3.CO;2.
)")
        .def(py::init([](Real spacing, Real coefficient) {
                 return mps::Smagorinsky(coefficient, spacing);
             }),
             py::kw_only(), "spacing"_a, "coefficient"_a = 0.1)
        .def("length", &length<mps::Smagorinsky>, "position"_a, length_doc);
    m.def("eddy_viscosity", &eddy_viscosity, "model"_a.none(false), py::kw_only(), "position"_a,
          "shear_rate"_a, "largest"_a, "threads"_a = 1,
          R"(Eddy viscosity, the smaller of length^2 x rate of strain and `largest`.

Parameters
----------
model : MixingLength or Smagorinsky
position : (n, 3) float64 ndarray
    [m]
shear_rate : (n,) float64 ndarray
    [1/s]
largest : float
    What the time step allows [m2/s]; 0.1 of spacing^2 / step holds.
threads : int
    The result does not depend on it.

Returns
-------
(n,) float64 ndarray
    [m2/s]
)");
    py::class_<mps::WallFunction>(m, "WallFunction",
                                  R"(Wall shear from the speed at a distance from the wall.

The greater of a laminar layer's and that of the logarithmic law with 0.41 and 5.2, shifted by the
roughness as in Colebrook's formula.

Parameters
----------
kinematic_viscosity : float
    [m2/s]
roughness : float
    Sand grains of the wall [m].

References
----------
Pope (2000), Turbulent Flows, ch. 7. Colebrook (1939), doi:10.1680/ijoti.1939.13150.
)")
        .def(py::init<Real, Real>(), py::kw_only(), "kinematic_viscosity"_a, "roughness"_a = 0.0)
        .def("shear", &shear, py::kw_only(), "speed"_a, "distance"_a,
             R"(Wall shear stress over density.

Parameters
----------
speed : (n,) float64 ndarray
    Along the wall, relative to it, >= 0 [m/s].
distance : (n,) float64 ndarray
    From the wall, > 0 [m].

Returns
-------
(n,) float64 ndarray
    [m2/s2]
)");
}

} // namespace

void bind_mps_operators(py::module_ m) {
    py::class_<ReferenceDensity>(
        m, "ReferenceDensity",
        R"(Sums over the undisturbed lattice, by which operators are scaled.

Parameters
----------
spacing : float
    Of the particles [m].
effective_radius : float
    Reach of the weight ``r_e / (0.85 r + 0.15 r_e) - 1`` [m], in (1, 10] spacings.

References
----------
Zhang, Wan & Hino (2014), doi:10.1016/S1001-6058(14)60065-8.
)")
        .def(py::init<Real, Real>(), py::kw_only(), "spacing"_a, "effective_radius"_a)
        .def_readonly("spacing", &ReferenceDensity::spacing, "[m]")
        .def_property_readonly(
            "effective_radius",
            [](const ReferenceDensity& reference) { return reference.weight.effective_radius; },
            "[m]")
        .def_readonly("number_density", &ReferenceDensity::number_density,
                      "Sum of the weights [-].")
        .def_readonly("lambda_", &ReferenceDensity::lambda,
                      "Mean of the distances squared, by weight [m2].");
    bind_pressure_operators(m);
    bind_viscous_operators(m);
    bind_turbulence(m);
}

} // namespace mpsdem::bindings
