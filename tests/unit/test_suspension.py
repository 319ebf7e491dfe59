"""Settling and fluidised beds in closed form: the numbers that coupled runs are held against."""

import numpy as np
import pytest
from fluids import Ergun
from fluids.drag import v_terminal

from mpsdem._core import coupling
from mpsdem.validation.suspension import (
    Sphere,
    balance_slip,
    di_felice,
    fluidised_bed_gradient,
    minimum_fluidisation_velocity,
    packed_bed_gradient,
    schiller_naumann,
    settling_velocity,
    terminal_velocity,
)

LAWS = {
    "schiller_naumann": schiller_naumann,
    "di_felice": di_felice,
    **{
        name: getattr(coupling, name)().force_ratio
        for name in ("WenYu", "ErgunWenYu", "KochHill", "Beetstra")
    },
}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)


def glass(millimetres, *, liquid_density=998.2, kinematic_viscosity=1.004e-6):
    """A bead in water at 20 degrees Celsius."""
    return Sphere(
        diameter=millimetres * 1e-3,
        density=2500.0,
        liquid_density=liquid_density,
        kinematic_viscosity=kinematic_viscosity,
    )


BEAD = glass(1, liquid_density=1000.0, kinematic_viscosity=1e-6)


def bed_of_glass(millimetres):
    """Beads in water, of the viscosity that the published numbers of beds have."""
    return glass(millimetres, kinematic_viscosity=1.002e-3 / 998.2)


def printed(text):
    """A number and half a unit of its last digit."""
    return pytest.approx(float(text), abs=0.51 * 10.0 ** -len(text.partition(".")[2]))


@pytest.mark.parametrize(
    ("millimetres", "velocity"),
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
def test_a_lone_bead_sinks_in_water_at_its_terminal_velocity(millimetres, velocity):
    assert terminal_velocity(glass(millimetres), schiller_naumann) == printed(velocity)


@pytest.mark.parametrize("millimetres", [0.1, 0.5, 2])
def test_a_lone_bead_sinks_as_others_compute(millimetres):
    bead = glass(millimetres)
    oracle = v_terminal(bead.diameter, 2500.0, 998.2, 998.2 * 1.004e-6, Method="Clift")
    # g there is 9.80665 m/s2; Clift's curve is another fit to the same measurements
    assert terminal_velocity(bead, schiller_naumann) == pytest.approx(oracle, rel=0.03)


@pytest.mark.parametrize(
    ("void_fraction", "velocity"),
    [(0.6, "0.034357"), (0.7, "0.052482"), (0.8, "0.074880"), (0.9, "0.101946"), (1, "0.134104")],
)
@pytest.mark.parametrize("law", [di_felice, coupling.DiFelice().force_ratio], ids=["own", "kernel"])
def test_a_crowd_sinks_as_di_felice_says(law, void_fraction, velocity):
    assert settling_velocity(BEAD, law, void_fraction) == printed(velocity)


@pytest.mark.parametrize(
    ("law", "kernel"),
    [(schiller_naumann, coupling.SchillerNaumann()), (di_felice, coupling.DiFelice())],
)
def test_the_laws_here_are_those_of_the_program(law, kernel):
    for void_fraction in (0.3, 0.6, 1.0):
        for reynolds in (0.0, 1e-3, 1.0, 299.0, 1e3, 1e5):
            expected = kernel.force_ratio(reynolds, void_fraction)
            assert law(reynolds, void_fraction) == pytest.approx(expected, rel=1e-12)


@every_law
@pytest.mark.parametrize("void_fraction", [0.45, 0.7, 1.0])
def test_a_sphere_let_go_with_the_slip_of_balance_stays_at_it(law, void_fraction):
    """Its acceleration, from the force and not from the balance over Reynolds numbers, is 0."""
    slip = balance_slip(BEAD, law, void_fraction)
    mass = 2500 * np.pi / 6 * 1e-9
    stokes = 3 * np.pi * 1e-3 * 1e-3 * void_fraction * slip
    drag = stokes * law(void_fraction * slip * 1e-3 / 1e-6, void_fraction) / void_fraction
    assert drag / mass == pytest.approx(9.81 * (1 - 1000 / 2500), rel=1e-10)


@every_law
def test_the_void_fraction_hinders_settling(law):
    for fractions in (np.linspace(0.35, 0.8, 10), np.linspace(0.81, 1, 10)):
        velocities = [settling_velocity(BEAD, law, fraction) for fraction in fractions]
        assert np.all(np.diff(velocities) > 0)


@pytest.mark.parametrize(
    ("superficial_velocity", "gradient"),
    [(0.001, "219.5"), (0.005, "1261.5"), (0.01, "2932.4"), (0.02, "7502.5"), (0.05, "31039")],
)
def test_a_packed_bed_loses_the_pressure_that_ergun_measured(superficial_velocity, gradient):
    ours = packed_bed_gradient(bed_of_glass(2), superficial_velocity, 0.4)
    assert ours == pytest.approx(float(gradient), rel=3e-4)
    oracle = Ergun(dp=2e-3, voidage=0.4, vs=superficial_velocity, rho=998.2, mu=1.002e-3)
    assert ours == pytest.approx(oracle, rel=1e-9)


def test_a_packed_bed_loses_what_another_program_documents():
    bed = glass(0.8, liquid_density=1000.0, kinematic_viscosity=1e-6)
    assert packed_bed_gradient(bed, 1e-3, 0.4) == printed("1338.867")


@pytest.mark.parametrize(
    ("millimetres", "velocity"), [(1, "0.00892"), (2, "0.02239"), (3, "0.03255")]
)
def test_a_bed_lifts_at_its_minimum_fluidisation_velocity(millimetres, velocity):
    assert minimum_fluidisation_velocity(bed_of_glass(millimetres), 0.4) == printed(velocity)


@pytest.mark.parametrize("millimetres", [0.01, 1, 3, 30])
def test_a_bed_that_lifts_has_the_gradient_of_its_weight(millimetres):
    bed = bed_of_glass(millimetres)
    gradient = packed_bed_gradient(bed, minimum_fluidisation_velocity(bed, 0.4), 0.4)
    assert gradient == pytest.approx(8839.6, abs=0.06)
    assert gradient == pytest.approx(fluidised_bed_gradient(bed, 0.4), rel=1e-12)


def test_a_bed_lifts_where_the_slip_of_its_solids_carries_them():
    bed = bed_of_glass(2)
    slip = balance_slip(bed, coupling.ErgunWenYu().force_ratio, 0.4)
    assert 0.4 * slip == pytest.approx(minimum_fluidisation_velocity(bed, 0.4), rel=1e-9)


@pytest.mark.parametrize("units", [(1e3, 1.0, 1.0), (1.0, 1e3, 1.0), (1.0, 1.0, 1 / 60)])
def test_nothing_depends_on_the_units(units):
    """Millimetres, grams, minutes for metres, kilograms, seconds."""
    metre, kilogram, second = units
    bead = glass(1)
    other = Sphere(
        diameter=bead.diameter * metre,
        density=bead.density * kilogram / metre**3,
        liquid_density=bead.liquid_density * kilogram / metre**3,
        kinematic_viscosity=bead.kinematic_viscosity * metre**2 / second,
        gravity=bead.gravity * metre / second**2,
    )
    velocity = metre / second
    gradient = kilogram / metre**2 / second**2
    for function, unit in (
        (lambda s: terminal_velocity(s, di_felice), velocity),
        (lambda s: settling_velocity(s, di_felice, 0.6), velocity),
        (lambda s: minimum_fluidisation_velocity(s, 0.4), velocity),
        (lambda s: packed_bed_gradient(s, 10 * s.kinematic_viscosity / s.diameter, 0.4), gradient),
        (lambda s: fluidised_bed_gradient(s, 0.4), gradient),
    ):
        assert function(other) == pytest.approx(unit * function(bead), rel=1e-9)
