"""Drag of a solid: published values, limits, and what it may not depend on."""

from math import isfinite, pi
from typing import get_args

import numpy as np
import pytest
from fluids import Ergun
from fluids.drag import drag_sphere
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from mpsdem._core import coupling
from mpsdem.case import Solids
from mpsdem.plan.scales import DRAG_LAWS

MEASURED_LAWS = [coupling.SchillerNaumann(), coupling.WenYu(), coupling.ErgunWenYu()]
COMPUTED_LAWS = [coupling.KochHill(), coupling.Beetstra()]
LAWS = [*MEASURED_LAWS, coupling.DiFelice(), *COMPUTED_LAWS]
CROWDED_LAWS = LAWS[1:]
GRAVITY = 9.81
WATER = {"liquid_density": 998.2, "kinematic_viscosity": 1.004e-6}

every_law = pytest.mark.parametrize("law", LAWS, ids=repr)
every_crowded_law = pytest.mark.parametrize("law", CROWDED_LAWS, ids=repr)


def rate(
    law,
    slip=0.1,
    *,
    void_fraction=1.0,
    diameter=1e-3,
    density=2500.0,
    liquid_density=1000.0,
    kinematic_viscosity=1e-6,
    velocity=(0.0, 0.0, 0.0),
):
    """Drag rate of one solid, its slip along x [1/s]."""
    velocity = np.array([velocity])
    (result,) = coupling.drag_rate(
        law,
        liquid_velocity=velocity
        + np.broadcast_to(slip, 3) * ([1, 0, 0] if np.isscalar(slip) else 1),
        velocity=velocity,
        void_fraction=np.array([void_fraction]),
        diameter=np.array([diameter]),
        density=np.array([density]),
        liquid_density=liquid_density,
        kinematic_viscosity=kinematic_viscosity,
    )
    return result


def balance_slip(law, *, density=2500.0, liquid_density=1000.0, **liquid):
    """Slip at which drag carries the weight of the solid in the liquid [m/s]."""
    weight = (1 - liquid_density / density) * GRAVITY

    def excess(slip):
        return (
            slip * rate(law, slip, density=density, liquid_density=liquid_density, **liquid)
            - weight
        )

    return brentq(excess, 1e-9, 10, xtol=1e-12)


def printed(text):
    """A number and half a unit of its last digit."""
    digits = len(text.partition(".")[2])
    return pytest.approx(float(text), abs=0.51 * 10.0**-digits)


# Model A force over 3 pi mu d eps r, worked out apart from this code from the published equations.
@pytest.mark.parametrize(
    ("void_fraction", "reynolds", "di_felice", "beetstra", "koch_hill", "ergun", "wen_yu"),
    [
        (0.4, 1, "30.05", "37.87", "37.99", "31.86", "32.60"),
        (0.4, 100, "90.06", "89.79", "86.70", "92.01", "128.9"),
        (0.6, 1, "7.30", "11.84", "11.25", "9.53", "7.42"),
        (0.6, 100, "25.35", "30.74", "24.62", "36.27", "29.35"),
        (0.8, 1, "2.68", "4.25", "4.25", "2.76", "2.60"),
        (0.8, 100, "10.31", "12.95", "11.39", "17.80", "10.27"),
        (0.8, 1000, "55.5", "71.3", "76.4", "154.5", "41.4"),
    ],
)
def test_the_laws_return_the_published_forces(
    void_fraction, reynolds, di_felice, beetstra, koch_hill, ergun, wen_yu
):
    state = reynolds, void_fraction
    assert coupling.DiFelice().force_ratio(*state) == printed(di_felice)
    assert coupling.Beetstra().force_ratio(*state) == printed(beetstra)
    assert coupling.KochHill().force_ratio(*state) == printed(koch_hill)
    assert coupling.ErgunWenYu().force_ratio(*state) == printed(ergun)
    assert coupling.WenYu().force_ratio(*state) == printed(wen_yu)


def test_every_law_that_a_case_may_name_exists():
    assert set(get_args(Solids.model_fields["drag"].annotation)) == set(DRAG_LAWS)
    assert {type(law) for law in LAWS} == set(DRAG_LAWS.values())
    assert DRAG_LAWS["gidaspow"] is DRAG_LAWS["ergun_wen_yu"]


@pytest.mark.parametrize(
    ("millimetres", "terminal_velocity"),
    [
        (0.1, "0.00729"),
        (0.2, "0.02291"),
        (0.5, "0.07347"),
        (1, "0.14606"),
        (2, "0.26764"),
        (3, "0.36630"),
        (5, "0.47289"),
        (10, "0.66877"),
        (15, "0.81907"),
    ],
)
def test_a_lone_glass_bead_settles_in_water_at_its_terminal_velocity(
    millimetres, terminal_velocity
):
    slip = balance_slip(
        coupling.SchillerNaumann(),
        diameter=millimetres * 1e-3,
        **WATER,
    )
    assert slip == printed(terminal_velocity)


@pytest.mark.parametrize(
    ("void_fraction", "settling_velocity"),
    [(0.6, "0.034357"), (0.7, "0.052482"), (0.8, "0.074880"), (0.9, "0.101946"), (1, "0.134104")],
)
def test_a_crowd_of_glass_beads_settles_as_di_felice_says(void_fraction, settling_velocity):
    """Without net flux the solids fall at eps times their slip, the liquid rises past them."""
    slip = balance_slip(coupling.DiFelice(), void_fraction=void_fraction)
    assert void_fraction * slip == printed(settling_velocity)


@pytest.mark.parametrize(
    ("superficial_velocity", "gradient"),
    [(0.001, 219.5), (0.005, 1261.5), (0.01, 2932.4), (0.02, 7502.5), (0.05, 31039)],
)
def test_a_packed_bed_loses_the_pressure_that_ergun_measured(superficial_velocity, gradient):
    """In Model B the drag of all solids in a volume is its whole pressure loss."""
    void_fraction, density = 0.4, 2500.0
    slip = superficial_velocity / void_fraction
    acceleration = slip * rate(
        coupling.ErgunWenYu(),
        slip,
        void_fraction=void_fraction,
        diameter=2e-3,
        liquid_density=998.2,
        kinematic_viscosity=1.002e-3 / 998.2,
    )
    ours = (1 - void_fraction) * density * acceleration
    assert ours == pytest.approx(gradient, rel=3e-4)
    oracle = Ergun(dp=2e-3, voidage=0.4, vs=superficial_velocity, rho=998.2, mu=1.002e-3)
    assert ours == pytest.approx(oracle, rel=1e-9)


@pytest.mark.parametrize(("millimetres", "velocity"), [(1, 0.00892), (2, 0.02239), (3, 0.03255)])
def test_a_glass_bed_lifts_at_its_minimum_fluidisation_velocity(millimetres, velocity):
    slip = balance_slip(
        coupling.ErgunWenYu(),
        void_fraction=0.4,
        diameter=millimetres * 1e-3,
        **WATER,
    )
    assert 0.4 * slip == pytest.approx(velocity, rel=2e-3)


@pytest.mark.parametrize("law", MEASURED_LAWS, ids=repr)
@pytest.mark.parametrize("reynolds", [0.1, 1, 10, 100, 500, 1000, 1e4, 1e5])
def test_a_lone_sphere_has_the_measured_drag(law, reynolds):
    coefficient = 24 / reynolds * law.force_ratio(reynolds, 1.0)
    accuracy = 0.07 if reynolds <= 1000 else 0.15
    assert coefficient == pytest.approx(drag_sphere(reynolds, Method="Clift"), rel=accuracy)


@pytest.mark.parametrize("reynolds", [0.1, 1, 10, 100])
def test_di_felice_has_the_drag_of_a_lone_sphere_to_its_stated_accuracy(reynolds):
    coefficient = 24 / reynolds * coupling.DiFelice().force_ratio(reynolds, 1.0)
    assert coefficient == pytest.approx(drag_sphere(reynolds, Method="Clift"), rel=0.14)


@pytest.mark.parametrize(
    ("law", "reynolds", "excess"),
    [
        (coupling.KochHill(), 100, 0.22),
        (coupling.Beetstra(), 100, 0.16),
        (coupling.Beetstra(), 1000, 0.57),
    ],
    ids=repr,
)
def test_the_laws_of_arrays_drag_a_lone_sphere_too_much(law, reynolds, excess):
    assert not law.covers(reynolds, 1.0)
    coefficient = 24 / reynolds * law.force_ratio(reynolds, 1.0)
    measured = drag_sphere(reynolds, Method="Clift")
    assert coefficient / measured - 1 == pytest.approx(excess, abs=0.01)


@pytest.mark.parametrize("law", COMPUTED_LAWS, ids=repr)
@pytest.mark.parametrize(("solid_fraction", "force"), [(0.45, 28.1), (0.5236, 42.1)])
def test_creep_through_a_dense_array_drags_like_a_cubic_lattice(law, solid_fraction, force):
    """The whole force, that of the pressure included, over Stokes's, by Zick & Homsy (1982)."""
    model_b = law.force_ratio(0.0, 1 - solid_fraction) / (1 - solid_fraction)
    assert model_b == pytest.approx(force, rel=0.18)


@every_law
@pytest.mark.parametrize("void_fraction", [0.3, 0.6, 0.8, 0.9, 1.0])
def test_the_drag_of_a_solid_without_slip_is_finite_and_that_of_creep(law, void_fraction):
    at_rest = law.force_ratio(0.0, void_fraction)
    assert isfinite(at_rest)
    assert at_rest == pytest.approx(law.force_ratio(1e-9, void_fraction), rel=1e-3)
    assert rate(law, 0.0, void_fraction=void_fraction) > 0


@every_law
def test_creeping_drag_of_a_lone_sphere_is_that_of_stokes(law):
    # 18 mu / (rho_s d^2); 4 % below it in Di Felice's fit
    assert rate(law, 0.0, diameter=1e-3, density=2500.0) == pytest.approx(7.2, rel=0.041)


@every_law
def test_a_faster_slip_drags_more(law):
    slips = np.geomspace(1e-6, 10, 200)
    for void_fraction in (0.4, 0.7, 0.95):
        force = [slip * rate(law, slip, void_fraction=void_fraction) for slip in slips]
        assert np.all(np.diff(force) > 0)


@every_crowded_law
@pytest.mark.parametrize("slip", [1e-5, 1e-2, 1.0])
def test_a_denser_crowd_drags_more(law, slip):
    for fractions in (np.linspace(0.3, 0.8, 20), np.linspace(0.81, 1, 20)):
        rates = [rate(law, slip, void_fraction=fraction) for fraction in fractions]
        assert np.all(np.diff(rates) < 0)


@every_law
@pytest.mark.parametrize("void_fraction", [0.4, 0.7, 0.95])
@pytest.mark.parametrize("slip", [1e-4, 0.02, 0.5])
def test_models_a_and_b_put_the_same_force_on_a_solid_of_a_uniform_bed(law, void_fraction, slip):
    """Upwards, in a bed that fills a pipe: a column of liquid and solids, nothing accelerated.

    Model A: the solid feels its drag and the gradient, the liquid eps times the gradient.
    Model B: the solid feels drag and buoyancy of the liquid, the liquid the whole gradient.
    """
    diameter, density, liquid_density, kinematic_viscosity = 1e-3, 2500.0, 1000.0, 1e-6
    volume = pi / 6 * diameter**3
    number_density = (1 - void_fraction) / volume

    reynolds = void_fraction * slip * diameter / kinematic_viscosity
    stokes = 3 * pi * liquid_density * kinematic_viscosity * diameter * void_fraction * slip
    drag_a = stokes * law.force_ratio(reynolds, void_fraction)
    # 0 = eps (-dp/dz) - eps rho g - n F
    gradient_a = liquid_density * GRAVITY + number_density * drag_a / void_fraction
    force_a = drag_a + volume * gradient_a

    mass = density * volume
    drag_b = mass * slip * rate(law, slip, void_fraction=void_fraction)
    force_b = drag_b + volume * liquid_density * GRAVITY
    # 0 = -dp/dz - eps rho g - n (F + V rho g)
    gradient_b = void_fraction * liquid_density * GRAVITY + number_density * force_b

    assert force_b == pytest.approx(force_a, rel=1e-12)
    assert gradient_b == pytest.approx(gradient_a, rel=1e-12)


@every_law
@pytest.mark.parametrize("void_fraction", [0.4, 0.7, 0.95])
def test_the_gradient_of_a_fluidised_bed_carries_the_mixture(law, void_fraction):
    density, liquid_density, diameter = 2500.0, 1000.0, 1e-3
    slip = balance_slip(law, void_fraction=void_fraction, diameter=diameter)
    reynolds = void_fraction * slip * diameter / 1e-6
    model_a = 18e-3 / diameter**2 * void_fraction * slip * law.force_ratio(reynolds, void_fraction)
    gradient = liquid_density * GRAVITY + (1 - void_fraction) * model_a / void_fraction
    mixture = void_fraction * liquid_density + (1 - void_fraction) * density
    assert gradient == pytest.approx(mixture * GRAVITY, rel=1e-9)


def test_neighbors_do_not_change_the_drag_of_schiller_naumann():
    law = coupling.SchillerNaumann()
    for slip in (0.0, 0.01, 0.1, 5.0):
        crowded = rate(law, slip, void_fraction=0.45)
        assert crowded == pytest.approx(rate(law, slip, void_fraction=1.0), rel=1e-14)


def test_ergun_wen_yu_is_wen_yu_above_a_void_fraction_of_0_8():
    ours, wen_yu = coupling.ErgunWenYu(), coupling.WenYu()
    for reynolds in (0.0, 1.0, 999.0, 1e4):
        assert ours.force_ratio(reynolds, 0.8001) == wen_yu.force_ratio(reynolds, 0.8001)
        assert ours.force_ratio(reynolds, 0.8) > wen_yu.force_ratio(reynolds, 0.8)


component = st.floats(-2.0, 2.0)


@every_law
@given(slip=st.tuples(component, component, component), wind=st.tuples(*[component] * 3))
def test_the_drag_depends_on_the_size_of_the_slip_alone(law, slip, wind):
    turned = np.array([slip[1], -slip[2], slip[0]])
    reference = rate(law, np.array(slip), void_fraction=0.6)
    assert rate(law, turned, void_fraction=0.6, velocity=wind) == pytest.approx(reference, rel=1e-9)


scale = st.floats(0.1, 10)


@every_law
@given(metre=scale, kilogram=scale, second=scale)
def test_the_drag_rate_does_not_depend_on_the_units(law, metre, kilogram, second):
    scaled = rate(
        law,
        0.2 * metre / second,
        void_fraction=0.6,
        diameter=2e-3 * metre,
        density=2500 * kilogram / metre**3,
        liquid_density=1000 * kilogram / metre**3,
        kinematic_viscosity=1e-6 * metre**2 / second,
    )
    assert scaled * second == pytest.approx(
        rate(law, 0.2, void_fraction=0.6, diameter=2e-3), rel=1e-9
    )


def test_solids_outside_the_range_of_a_law_are_counted():
    """A lone sphere, a bed and a rushing sphere: each law was made for some of them."""

    def outside(law):
        return coupling.count_outside(
            law,
            liquid_velocity=np.array([[0.1, 0, 0], [0.01, 0, 0], [30.0, 0, 0]]),
            velocity=np.zeros((3, 3)),
            void_fraction=np.array([1.0, 0.4, 1.0]),
            diameter=np.full(3, 0.01),
            kinematic_viscosity=1e-6,
        )

    assert outside(coupling.SchillerNaumann()) == 2  # the bed and the rushing one
    assert outside(coupling.WenYu()) == 2
    assert outside(coupling.ErgunWenYu()) == 1  # the rushing one
    assert outside(coupling.DiFelice()) == 1
    assert outside(coupling.KochHill()) == 2  # all but the bed
    assert outside(coupling.Beetstra()) == 2


@pytest.mark.parametrize(
    ("law", "inside", "outside"),
    # pairs of Reynolds number and void fraction at each bound
    [
        (coupling.SchillerNaumann(), [(0, 0.99), (2e5, 1)], [(1, 0.98), (2.1e5, 1)]),
        (coupling.WenYu(), [(0, 0.45), (2e5, 1)], [(1, 0.44), (2.1e5, 0.7)]),
        (
            coupling.ErgunWenYu(),
            [(0, 0.36), (1249, 0.5), (499, 0.8), (2e5, 0.81)],
            [(1, 0.35), (1251, 0.5), (501, 0.8), (2.1e5, 0.81)],
        ),
        (
            coupling.DiFelice(),
            [(0.01, 0.4), (1e4, 1)],
            [(1, 0.39), (0.009, 0.7), (1.1e4, 0.7)],
        ),
        (coupling.KochHill(), [(0, 0.36), (200, 0.9)], [(1, 0.35), (1, 0.91), (201, 0.7)]),
        (coupling.Beetstra(), [(0, 0.4), (1000, 0.9)], [(1, 0.39), (1, 0.91), (1001, 0.7)]),
    ],
    ids=lambda value: repr(value) if not isinstance(value, list) else "",
)
def test_a_law_covers_the_range_of_its_sources_and_nothing_beyond(law, inside, outside):
    assert [state for state in inside if not law.covers(*state)] == []
    assert [state for state in outside if law.covers(*state)] == []


def test_an_empty_population_has_no_drag():
    none = coupling.drag_rate(
        coupling.DiFelice(),
        liquid_velocity=np.empty((0, 3)),
        velocity=np.empty((0, 3)),
        void_fraction=np.empty(0),
        diameter=np.empty(0),
        density=np.empty(0),
        liquid_density=1000.0,
        kinematic_viscosity=1e-6,
    )
    assert none.shape == (0,)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"void_fraction": 0.0}, r"void_fraction must lie in \(0, 1\]"),
        ({"void_fraction": 1.1}, r"void_fraction must lie in \(0, 1\]"),
        ({"void_fraction": np.nan}, r"void_fraction must lie in \(0, 1\]"),
        ({"diameter": 0.0}, "diameter must be > 0 m"),
        ({"density": -1.0}, "density must be > 0 kg/m3"),
        ({"liquid_density": 0.0}, "liquid_density must be > 0 kg/m3"),
        ({"kinematic_viscosity": np.nan}, "kinematic_viscosity must be > 0 m2/s"),
    ],
)
def test_bad_input_names_the_field(change, message):
    with pytest.raises(ValueError, match=message):
        rate(coupling.WenYu(), **change)


def test_arrays_of_different_lengths_are_refused():
    with pytest.raises(ValueError, match="one row per solid"):
        coupling.drag_rate(
            coupling.WenYu(),
            liquid_velocity=np.zeros((2, 3)),
            velocity=np.zeros((2, 3)),
            void_fraction=np.ones(1),
            diameter=np.ones(2),
            density=np.ones(2),
            liquid_density=1000.0,
            kinematic_viscosity=1e-6,
        )
