"""Drag of a solid: published values, limits, and what it may not depend on."""

from math import isfinite

import numpy as np
import pytest
from fluids import Ergun
from fluids.drag import drag_sphere
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from mpsdem._core import coupling

LAWS = [
    coupling.SchillerNaumann(),
    coupling.WenYu(),
    coupling.ErgunWenYu(),
    coupling.DiFelice(),
]
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
    ("void_fraction", "reynolds", "di_felice", "ergun", "wen_yu"),
    [
        (0.4, 1, "30.05", "31.86", "32.60"),
        (0.4, 100, "90.06", "92.01", "128.9"),
        (0.6, 1, "7.30", "9.53", "7.42"),
        (0.6, 100, "25.35", "36.27", "29.35"),
        (0.8, 1, "2.68", "2.76", "2.60"),
        (0.8, 100, "10.31", "17.80", "10.27"),
        (0.8, 1000, "55.5", "154.5", "41.4"),
    ],
)
def test_the_laws_return_the_published_forces(void_fraction, reynolds, di_felice, ergun, wen_yu):
    assert coupling.DiFelice().force_ratio(reynolds, void_fraction) == printed(di_felice)
    assert coupling.ErgunWenYu().force_ratio(reynolds, void_fraction) == printed(ergun)
    assert coupling.WenYu().force_ratio(reynolds, void_fraction) == printed(wen_yu)


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


@pytest.mark.parametrize("law", LAWS[:3], ids=repr)
@pytest.mark.parametrize("reynolds", [0.1, 1, 10, 100, 500, 1000, 1e4, 1e5])
def test_a_lone_sphere_has_the_measured_drag(law, reynolds):
    coefficient = 24 / reynolds * law.force_ratio(reynolds, 1.0)
    accuracy = 0.07 if reynolds <= 1000 else 0.15
    assert coefficient == pytest.approx(drag_sphere(reynolds, Method="Clift"), rel=accuracy)


@pytest.mark.parametrize("reynolds", [0.1, 1, 10, 100])
def test_di_felice_has_the_drag_of_a_lone_sphere_to_its_stated_accuracy(reynolds):
    coefficient = 24 / reynolds * coupling.DiFelice().force_ratio(reynolds, 1.0)
    assert coefficient == pytest.approx(drag_sphere(reynolds, Method="Clift"), rel=0.14)


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
