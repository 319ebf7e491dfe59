"""The particle liquid, held to exact flows, to conservation and to published friction."""

import fluids
import numpy as np
import pytest

from mpsdem._core import mps
from mpsdem.geometry import Kind, ring_layout

RADIUS = 0.1
DENSITY = 1000.0


def pipe(*, across, length, reynolds, velocity, swirl=0.0, **options):
    """Liquid with a given start, at a bulk velocity of 1 m/s; velocity(s) over s = r / R.

    The swirl is a disturbance across the pipe that turns about the axis once a diameter.
    """
    layout = ring_layout(radius=RADIUS, length=length, spacing=2 * RADIUS / across)
    share = np.hypot(layout.position[:, 1], layout.position[:, 2]) / RADIUS
    start = np.zeros_like(layout.position)
    moving = layout.kind == Kind.LIQUID
    start[moving, 0] = velocity(share[moving])
    turn = np.pi * layout.position[moving, 0] / RADIUS
    across_flow = swirl * (1 - share[moving] ** 2)
    start[moving, 1] = across_flow * np.sin(turn)
    start[moving, 2] = across_flow * np.cos(turn)
    return mps.LagrangianLiquid(
        **{
            "position": layout.position,
            "velocity": start,
            "kind": layout.kind,
            "particle_spacing": layout.spacing,
            "pipe_radius": RADIUS,
            "pipe_length": length,
            "density": DENSITY,
            "kinematic_viscosity": 2 * RADIUS / reynolds,
            "roughness": 0.0,
            "turbulent": reynolds > 2300,
            "bulk_velocity": 1.0,
        }
        | options
    ), moving


def parabola(share):
    return 2 * (1 - share**2)


def power_law(share):
    return 1.2245 * (1 - share) ** (1 / 7)


def run(liquid, *, time, step):
    reports = [liquid.advance(step) for _ in range(round(time / step))]
    assert all(report.sound for report in reports)
    return reports


def test_poiseuille_flow_stays_what_it_is():
    """Under the exact gradient, 64 / Re, for half of the time that viscosity takes to act."""
    reynolds = 50
    gradient = 64 / reynolds * DENSITY / 2 / (2 * RADIUS)
    liquid, moving = pipe(
        across=10, length=0.2, reynolds=reynolds, velocity=parabola, pressure_gradient=gradient
    )
    run(liquid, time=0.6, step=0.004)
    x = liquid.position[moving]
    exact = parabola(np.hypot(x[:, 1], x[:, 2]) / RADIUS)
    error = liquid.velocity[moving] - exact[:, None] * [1, 0, 0]
    assert np.linalg.norm(error) < 0.006 * np.linalg.norm(exact)
    assert liquid.velocity[moving, 0].mean() == pytest.approx(exact.mean(), rel=0.003)


@pytest.mark.parametrize(
    ("reynolds", "roughness"),
    [
        (2e5, 0.0),
        (1e5, 0.002 * 2 * RADIUS),
    ],
)
def test_turbulent_friction_is_that_of_colebrook(reynolds, roughness):
    liquid, _ = pipe(
        across=10,
        length=0.2,
        reynolds=reynolds,
        velocity=power_law,
        swirl=0.1,
        roughness=roughness,
    )
    run(liquid, time=2.0, step=0.012)
    reports = run(liquid, time=2.0, step=0.012)
    gradient = np.mean([report.mean_gradient for report in reports])
    friction = gradient * 2 * RADIUS / (DENSITY / 2)
    expected = fluids.friction_factor(Re=reynolds, eD=roughness / (2 * RADIUS), Method="Colebrook")
    assert friction == pytest.approx(expected, rel=0.05)


def test_a_long_pipe_is_as_quiet_as_a_short_one():
    """Forms that look safe in a short pipe blow up within tens of steps in one of 20 diameters."""
    liquid, moving = pipe(across=8, length=4.0, reynolds=2e5, velocity=power_law, swirl=0.1)
    run(liquid, time=0.6, step=0.015)
    reports = run(liquid, time=0.6, step=0.015)
    x = liquid.position[moving]
    assert np.hypot(x[:, 1], x[:, 2]).max() < RADIUS
    assert liquid.density_scatter < 0.03
    assert liquid.pressure_noise < 0.005 * DENSITY
    assert max(report.iterations / report.substeps for report in reports) < 40


def test_the_bulk_velocity_is_held_and_no_particle_lost():
    liquid, moving = pipe(across=8, length=0.4, reynolds=2e5, velocity=power_law)
    run(liquid, time=0.3, step=0.015)
    assert liquid.bulk_velocity == pytest.approx(1.0, rel=1e-12)
    assert liquid.liquid_count == moving.sum()
    walls = ~moving
    assert np.array_equal(liquid.velocity[walls], np.zeros((walls.sum(), 3)))


def test_energy_does_not_grow_without_drive():
    liquid, _ = pipe(
        across=8, length=0.4, reynolds=2e5, velocity=power_law, swirl=0.1, pressure_gradient=0.0
    )
    energy = [liquid.kinetic_energy]
    for _ in range(30):
        assert liquid.advance(0.01).sound
        energy.append(liquid.kinetic_energy)
    assert np.all(np.diff(energy) < 1e-4 * energy[0])
    assert energy[-1] < energy[0]


def test_a_disturbance_loses_most_of_its_energy_within_fifteen_radii():
    """Less than 15 % is left: of a liquid of the mean flow nothing else may be expected."""
    liquid, moving = pipe(across=10, length=0.2, reynolds=2e5, velocity=power_law, swirl=0.1)
    before = np.mean(liquid.velocity[moving, 1:] ** 2)
    run(liquid, time=1.5, step=0.0125)
    assert np.mean(liquid.velocity[moving, 1:] ** 2) < 0.15 * before


def test_friction_does_not_depend_on_the_step():
    """Whatever is done once a step, such as shifting, must go with the step's length."""
    frictions = []
    for courant in (0.8, 0.4):
        liquid, _ = pipe(
            across=10, length=0.2, reynolds=2e5, velocity=power_law, swirl=0.1, courant=courant
        )
        run(liquid, time=1.5, step=0.012)
        frictions.append(np.mean([r.friction for r in run(liquid, time=1.5, step=0.012)]))
    assert frictions[0] == pytest.approx(frictions[1], rel=0.015)


def test_results_do_not_depend_on_threads():
    ends = []
    for threads in (1, 2):
        liquid, _ = pipe(
            across=8, length=0.4, reynolds=2e5, velocity=power_law, swirl=0.1, threads=threads
        )
        run(liquid, time=0.1, step=0.01)
        ends.append((liquid.position, liquid.velocity, liquid.pressure))
    for one, two in zip(*ends, strict=True):
        assert np.array_equal(one, two)


def test_a_restored_liquid_goes_on_to_the_last_bit():
    whole, _ = pipe(across=8, length=0.4, reynolds=2e5, velocity=power_law, swirl=0.1)
    parted, _ = pipe(across=8, length=0.4, reynolds=2e5, velocity=power_law)
    run(whole, time=0.05, step=0.01)
    parted.restore(whole.state())
    for liquid in (whole, parted):
        run(liquid, time=0.05, step=0.01)
    assert np.array_equal(whole.velocity, parted.velocity)
    assert np.array_equal(whole.position, parted.position)


def test_a_state_of_another_liquid_is_refused():
    liquid, _ = pipe(across=8, length=0.4, reynolds=2e5, velocity=power_law)
    other, _ = pipe(across=8, length=0.6, reynolds=2e5, velocity=power_law)
    with pytest.raises(ValueError, match="another liquid"):
        liquid.restore(other.state())


def test_the_velocity_at_a_point_is_that_of_its_surroundings():
    liquid, _ = pipe(across=16, length=0.4, reynolds=50, velocity=parabola)
    points = np.array([[0.0, 0.0, 0.0], [0.2, 0.03, -0.04], [0.399, 0.0, 0.05]])
    got = liquid.velocity_at(points=points, radius=0.03)
    exact = parabola(np.hypot(points[:, 1], points[:, 2]) / RADIUS)
    assert got[:, 0] == pytest.approx(exact, abs=0.1)  # averaging a parabola lowers it
    assert np.array_equal(got[:, 1:], np.zeros((3, 2)))


def test_a_step_too_long_is_parted():
    liquid, _ = pipe(across=8, length=0.4, reynolds=2e5, velocity=power_law)
    report = liquid.advance(0.1)
    assert report.sound
    assert report.substeps >= 5


def test_speeds_that_run_away_are_told_not_followed():
    liquid, _ = pipe(across=8, length=0.4, reynolds=2e5, velocity=lambda s: 1e30 + 0 * s)
    assert not liquid.advance(0.01).sound


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"density": 0.0}, "density must be > 0"),
        ({"courant": 0.0}, "courant must be > 0"),
        ({"tolerance": -1.0}, "tolerance must be > 0"),
        ({"kinematic_viscosity": 0.0}, "kinematic_viscosity must be > 0"),
        ({"threads": 0}, "threads must be >= 1"),
    ],
)
def test_bad_input_names_the_field(change, message):
    with pytest.raises(ValueError, match=message):
        pipe(across=8, length=0.4, reynolds=2e5, velocity=power_law, **change)
