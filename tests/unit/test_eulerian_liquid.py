"""The liquid on fixed nodes, held to exact flows, to conservation and to published friction."""

import fluids
import numpy as np
import pytest
from scipy.special import jn_zeros, jv

from mpsdem._core import mps
from mpsdem.geometry import node_layout

RADIUS = 0.1
DENSITY = 1000.0


def pipe(*, across, length, reynolds, velocity, swirl=0.0, noise=0.0, **options):
    """Liquid with a given start, at a bulk velocity of 1 m/s; velocity(s) over s = r / R.

    The swirl is a disturbance across the pipe that turns about the axis once a diameter.
    """
    nodes = node_layout(radius=RADIUS, length=length, spacing=2 * RADIUS / across)
    x, y, z = np.moveaxis(nodes.position, -1, 0)
    share = np.hypot(y, z) / RADIUS
    start = np.zeros_like(nodes.position)
    start[..., 0] = velocity(share)
    start[..., 1] = swirl * (1 - share**2) * np.sin(np.pi * x / RADIUS)
    start[..., 2] = swirl * (1 - share**2) * np.cos(np.pi * x / RADIUS)
    start += noise * np.random.default_rng(1).standard_normal(start.shape)
    return mps.EulerianLiquid(
        **{
            "place": nodes.place,
            "area": nodes.area,
            "wall_count": nodes.wall_count,
            "stations": nodes.stations,
            "spacing": nodes.spacing,
            "velocity": start,
            "pipe_radius": RADIUS,
            "pipe_length": length,
            "density": DENSITY,
            "kinematic_viscosity": 2 * RADIUS / reynolds,
            "roughness": 0.0,
            "turbulent": reynolds > 2300,
            "bulk_velocity": 1.0,
        }
        | options
    ), nodes


def parabola(share):
    return 2 * (1 - share**2)


def power_law(share):
    return 1.2245 * np.maximum(1 - share, 0) ** (1 / 7)


def still(share):
    return 0 * share


def run(liquid, *, time, step):
    reports = [liquid.advance(step) for _ in range(round(time / step))]
    assert all(report.sound for report in reports)
    return reports


def friction_factor(report):
    return report.mean_gradient * 2 * RADIUS / (DENSITY / 2)


@pytest.mark.parametrize("scheme", ["rk2", "rk3"])
@pytest.mark.parametrize("convection", ["upwind", "muscl"])
@pytest.mark.parametrize("across", [6, 10])
def test_poiseuille_flow_is_exact(across, convection, scheme):
    """From rest, the drive 64 / Re leads to the parabola to round-off."""
    reynolds = 20
    gradient = 64 / reynolds * DENSITY / 2 / (2 * RADIUS)
    liquid, nodes = pipe(
        across=across,
        length=0.1,
        reynolds=reynolds,
        velocity=still,
        pressure_gradient=gradient,
        convection=convection,
        scheme=scheme,
    )
    viscous_time = RADIUS**2 * reynolds / (2 * RADIUS)
    run(liquid, time=5 * viscous_time, step=viscous_time)
    exact = parabola(np.hypot(*nodes.place.T) / RADIUS)
    assert np.abs(liquid.velocity[..., 0] - exact[:, None]).max() < 1e-10
    assert np.abs(liquid.velocity[..., 1:]).max() < 1e-12


def test_holding_the_bulk_velocity_takes_the_gradient_of_poiseuille():
    liquid, _ = pipe(across=10, length=0.1, reynolds=50, velocity=parabola)
    (report,) = run(liquid, time=0.5, step=0.5)
    assert report.mean_gradient == pytest.approx(64 / 50 * DENSITY / 2 / (2 * RADIUS), rel=1e-10)
    assert report.friction == pytest.approx(report.mean_gradient, rel=1e-10)


def decayed(across, *, across_the_pipe):
    """Relative error of a Bessel mode after it has fallen by 1 - 1/e, axial or turning."""
    order = 1 if across_the_pipe else 0
    zero = jn_zeros(order, 1)[0]
    reynolds = 10
    time = RADIUS**2 / (2 * RADIUS / reynolds) / zero**2
    liquid, nodes = pipe(
        across=across,
        length=0.1,
        reynolds=reynolds,
        velocity=lambda s: (not across_the_pipe) * jv(0, zero * s),
        pressure_gradient=0.0,
    )
    y, z = nodes.place.T
    s = np.hypot(y, z) / RADIUS
    exact = np.zeros((len(s), 3))
    if across_the_pipe:
        turning = jv(1, zero * s) / np.maximum(s * RADIUS, 1e-12)
        exact[:, 1], exact[:, 2] = -turning * z, turning * y
        state = liquid.state()
        state["velocity"] = np.repeat(exact, nodes.stations, axis=0)
        liquid.restore(state)
    else:
        exact[:, 0] = jv(0, zero * s)
    run(liquid, time=time, step=time)
    exact *= np.exp(-1)
    error = liquid.velocity - exact[:, None]
    weight = nodes.area[:, None, None]
    return np.sqrt(
        (weight * error**2).sum() / (weight * exact[:, None] ** 2 * np.ones_like(error)).sum()
    )


@pytest.mark.parametrize("across_the_pipe", [False, True])
def test_a_decaying_mode_converges_to_second_order(across_the_pipe):
    """J0 along the pipe; J1 about its axis, where the pressure bears the centrifugal force."""
    errors = [decayed(n, across_the_pipe=across_the_pipe) for n in (10, 16, 24)]
    assert np.all(-np.diff(np.log(errors)) > 1.9 * np.diff(np.log([10, 16, 24])))
    assert errors[-1] < (0.01 if across_the_pipe else 0.005)


def test_the_pressure_of_a_swirl_bears_its_centrifugal_force():
    """Of u = J1(a s) about the axis: p = rho (1 - J0(a s)^2 - J1(a s)^2) / 2."""
    liquid, nodes = pipe(
        across=16, length=0.1, reynolds=1000, velocity=still, pressure_gradient=0.0
    )
    y, z = nodes.place.T
    s = np.hypot(y, z) / RADIUS
    zero = jn_zeros(1, 1)[0]
    turning = jv(1, zero * s) / np.maximum(s * RADIUS, 1e-12)
    state = liquid.state()
    state["velocity"] = np.repeat(
        np.stack([0 * y, -turning * z, turning * y], axis=1), nodes.stations, axis=0
    )
    liquid.restore(state)
    run(liquid, time=1e-3, step=1e-3)
    exact = DENSITY * (1 - jv(0, zero * s) ** 2 - jv(1, zero * s) ** 2) / 2
    error = liquid.pressure[:, 0] - exact
    assert np.ptp(error) < 0.04 * np.ptp(exact)


def torsion(nodes, *, wave, shift=0.0):
    """Turn about the axis as J1(a s) cos(wave (x - shift)); no pressure and no flux go with it."""
    x, y, z = np.moveaxis(nodes.position, -1, 0)
    zero = jn_zeros(1, 1)[0]
    s = np.hypot(y, z) / RADIUS
    rate = jv(1, zero * s) / np.maximum(s * RADIUS, 1e-12) * np.cos(wave * (x - shift))
    return np.stack([0 * y, -rate * z, rate * y], axis=-1)


def start_from(liquid, velocity):
    liquid.restore(liquid.state() | {"velocity": velocity.reshape(-1, 3)})


SMALL = 1e-6  # of the bulk velocity: a wave that does nothing to itself


def test_a_torsional_wave_decays_by_its_shear_along_the_pipe_too():
    """At the rate nu (a^2 / R^2 + k^2), for a wave of one diameter along the pipe."""
    viscosity, length = 0.02, 0.2
    wave, zero = 2 * np.pi / length, jn_zeros(1, 1)[0]
    liquid, nodes = pipe(
        across=16, length=length, reynolds=10, velocity=still, pressure_gradient=0.0
    )
    first = SMALL * torsion(nodes, wave=wave)
    start_from(liquid, first)
    time = 1 / (viscosity * ((zero / RADIUS) ** 2 + wave**2))
    run(liquid, time=time, step=time)
    assert liquid.velocity == pytest.approx(first * np.exp(-1), abs=0.02 * SMALL)


@pytest.mark.parametrize("convection", ["upwind", "muscl"])
def test_a_torsional_wave_is_carried_along_by_the_flow(convection):
    """Each ring of it at its own velocity, through a fifth of its length on the axis."""
    length, time = 0.4, 0.04
    wave = 2 * np.pi / length
    liquid, nodes = pipe(
        across=16, length=length, reynolds=2000, velocity=parabola, convection=convection
    )
    s = np.hypot(*np.moveaxis(nodes.position[..., 1:], -1, 0)) / RADIUS
    along = parabola(s)[..., None] * [1.0, 0.0, 0.0]
    start_from(liquid, along + SMALL * torsion(nodes, wave=wave))
    run(liquid, time=time, step=time)
    turning = (liquid.velocity - along) / SMALL
    exact = torsion(nodes, wave=wave, shift=parabola(s) * time)
    assert np.linalg.norm(turning - exact) < 0.04 * np.linalg.norm(exact)


def test_a_force_that_is_a_gradient_makes_pressure_and_no_flow():
    """Of psi = cos(k x) (1 - s^2)^2 and of y^2 - z^2: flat at the wall, and not."""
    length = 0.4
    wave = 2 * np.pi / length
    liquid, nodes = pipe(
        across=24, length=length, reynolds=50, velocity=still, pressure_gradient=0.0
    )
    x, y, z = np.moveaxis(nodes.position, -1, 0)
    well = 1 - (y**2 + z**2) / RADIUS**2
    slope = -4 * well / RADIUS**2 * np.cos(wave * x)
    force = np.stack(
        [-wave * well**2 * np.sin(wave * x), slope * y + 200 * y, slope * z - 200 * z], axis=-1
    )
    liquid.momentum_source(force)
    run(liquid, time=1e-3, step=1e-3)
    psi = well**2 * np.cos(wave * x) + 100 * (y**2 - z**2)
    assert liquid.pressure == pytest.approx(DENSITY * (psi - psi.mean()), abs=0.02 * DENSITY)
    assert np.abs(liquid.velocity).max() < 0.03 * np.abs(force).max() * 1e-3


def test_a_flow_starts_up_as_theory_says():
    """Under a sudden gradient, series of Bessel functions; at t nu / R^2 = 0.1 and 0.5."""
    reynolds = 10
    viscosity = 2 * RADIUS / reynolds
    liquid, nodes = pipe(
        across=16,
        length=0.1,
        reynolds=reynolds,
        velocity=still,
        pressure_gradient=8 * DENSITY * viscosity / RADIUS**2,
    )
    s = np.hypot(*nodes.place.T) / RADIUS
    zeros = jn_zeros(0, 40)
    now = 0.0
    for time, tolerance in ((0.1, 0.008), (0.5, 0.003)):
        run(liquid, time=(time - now) * RADIUS**2 / viscosity, step=0.05 * RADIUS**2 / viscosity)
        now = time
        lag = sum(8 * jv(0, a * s) / (a**3 * jv(1, a)) * np.exp(-(a**2) * time) for a in zeros)
        exact = 2 * (1 - s**2 - lag)
        error = liquid.velocity[:, 0, 0] - exact
        assert np.linalg.norm(error) < tolerance * np.linalg.norm(exact)


@pytest.mark.parametrize("scheme", ["rk2", "rk3"])
@pytest.mark.parametrize(
    ("across", "reynolds", "relative_roughness"),
    [
        (10, 1e4, 0.0),
        (10, 5e4, 0.0),
        (10, 2e5, 0.0),
        (10, 5e5, 0.0),
        (16, 2e5, 0.0),
        (10, 1e5, 0.002),
        (10, 1e6, 0.002),
    ],
)
def test_turbulent_friction_is_that_of_colebrook(across, reynolds, relative_roughness, scheme):
    liquid, _ = pipe(
        across=across,
        length=0.16,
        reynolds=reynolds,
        velocity=power_law,
        roughness=relative_roughness * 2 * RADIUS,
        scheme=scheme,
    )
    report = run(liquid, time=8.0, step=2.0)[-1]
    expected = fluids.friction_factor(Re=reynolds, eD=relative_roughness, Method="Colebrook")
    assert friction_factor(report) == pytest.approx(expected, rel=0.04)
    assert report.friction == pytest.approx(report.mean_gradient, rel=1e-3)


def test_the_turbulent_profile_follows_the_log_law():
    liquid, nodes = pipe(across=24, length=0.08, reynolds=2e5, velocity=power_law)
    run(liquid, time=8.0, step=2.0)
    u_star = np.sqrt(liquid.wall_shear / DENSITY)
    away = RADIUS - np.hypot(*nodes.place.T)
    layer = (away > 0.5 * nodes.spacing) & (away < 0.4 * RADIUS)
    plus = away[layer] * u_star / 1e-6
    law = np.log(plus) / 0.41 + 5.2
    assert liquid.velocity[layer, 0, 0] / u_star == pytest.approx(law, rel=0.02)


def test_eddies_feel_shear_and_no_rotation():
    """nu_t = l^2 |S| of a shear across and a torsion along the pipe; rigid turns vanish in |S|."""
    liquid, nodes = pipe(across=24, length=0.4, reynolds=2e5, velocity=power_law)
    x, y, z = np.moveaxis(nodes.position, -1, 0)
    s = np.hypot(y, z) / RADIUS
    wave, turn = 2 * np.pi / 0.4, 7.0
    rate = turn * np.cos(wave * x)
    start_from(liquid, np.stack([1 + 3 * y + 4 * z, -rate * z, rate * y], axis=-1))
    run(liquid, time=1e-7, step=1e-7)
    slope = turn * wave * np.sin(wave * x)
    strain = np.hypot(3 + slope * z, 4 - slope * y)
    length = RADIUS * (0.14 - 0.08 * s**2 - 0.06 * s**4)
    core = s[:, 0] < 0.7  # what the wall's slip does not reach
    assert liquid.viscosity[core] == pytest.approx((1e-6 + strain * length**2)[core], rel=2e-3)
    assert liquid.largest_viscosity >= liquid.viscosity.max() * (1 - 1e-12)


def test_eddies_feel_a_stretching():
    """On the axis of psi = c (1 - s^2)^2 y z, |S| = 2 c; the fit flattens it by its curvature."""
    liquid, nodes = pipe(across=24, length=0.1, reynolds=2e5, velocity=power_law)
    _, y, z = np.moveaxis(nodes.position, -1, 0)
    well = 1 - (y**2 + z**2) / RADIUS**2
    fold = 4 * well * y * z / RADIUS**2
    rate = 2.0
    stretch = np.stack([1 + 0 * y, y * well**2 - fold * z, -z * well**2 + fold * y], axis=-1)
    start_from(liquid, stretch * [1.0, rate, rate])
    run(liquid, time=1e-7, step=1e-7)
    assert liquid.viscosity[0] == pytest.approx(2 * rate * (0.14 * RADIUS) ** 2, rel=0.15)


@pytest.mark.parametrize(("reynolds", "start"), [(2e5, power_law), (50, parabola)])
def test_shaking_a_full_pipe_moves_nothing(reynolds, start):
    """20 m/s^2 across the pipe at 5 Hz, with a disturbance in the liquid."""
    ends = []
    for shake in (0.0, 20.0):
        liquid, _ = pipe(across=10, length=0.4, reynolds=reynolds, velocity=start, swirl=0.1)
        for k in range(40):
            a = shake * np.cos(2 * np.pi * 5 * 0.005 * k)
            liquid.body_force([0.0, a, -a])
            assert liquid.advance(0.005).sound
        ends.append(liquid.velocity)
    assert np.abs(ends[1] - ends[0]).max() < 1e-12


def test_a_uniform_source_at_the_nodes_is_a_body_force():
    ends = []
    for as_source in (False, True):
        liquid, nodes = pipe(across=10, length=0.2, reynolds=50, velocity=parabola, swirl=0.1)
        push = np.array([1.0, 2.0, -3.0])
        if as_source:
            liquid.momentum_source(np.broadcast_to(push, nodes.position.shape).copy())
        else:
            liquid.body_force(push)
        run(liquid, time=0.02, step=0.005)
        ends.append((liquid.velocity, liquid.pressure))
    for one, two in zip(*ends, strict=True):
        assert one == pytest.approx(two, abs=1e-9)


def test_an_axial_force_replaces_a_pressure_gradient():
    pushed, _ = pipe(across=10, length=0.1, reynolds=20, velocity=still, pressure_gradient=0.0)
    pushed.body_force([0.1, 0.0, 0.0])
    driven, _ = pipe(
        across=10, length=0.1, reynolds=20, velocity=still, pressure_gradient=0.1 * DENSITY
    )
    for liquid in (pushed, driven):
        run(liquid, time=0.2, step=0.1)
    assert pushed.velocity == pytest.approx(driven.velocity, abs=1e-14)


@pytest.mark.parametrize("convection", ["upwind", "muscl"])
def test_disturbed_laminar_flow_calms_down(convection):
    """At Re 2000 every disturbance of a pipe flow that is not finite-sized decays."""
    liquid, _ = pipe(
        across=10, length=0.6, reynolds=2000, velocity=parabola, noise=0.02, convection=convection
    )
    run(liquid, time=12.0, step=1.0)
    assert np.abs(liquid.velocity[..., 1:]).max() < 1e-3
    assert liquid.pressure_gradient == pytest.approx(
        64 / 2000 * DENSITY / 2 / (2 * RADIUS), rel=0.01
    )


@pytest.mark.parametrize("convection", ["upwind", "muscl"])
def test_water_without_eddy_viscosity_is_survived(convection):
    """Re 2e5 with walls that hold, far below what the nodes resolve: quiet, no blow-up."""
    liquid, _ = pipe(
        across=10,
        length=0.4,
        reynolds=2e5,
        velocity=power_law,
        noise=0.05,
        turbulent=False,
        convection=convection,
    )
    report = run(liquid, time=5.0, step=1.0)[-1]
    assert np.abs(liquid.velocity[..., 1:]).max() < 0.05
    assert abs(friction_factor(report)) < 0.02


def test_a_long_pipe_is_as_quiet_as_a_short_one():
    liquid, _ = pipe(across=8, length=4.0, reynolds=2e5, velocity=power_law, noise=0.05)
    run(liquid, time=2.0, step=1.0)
    before = np.abs(liquid.velocity[..., 1:]).max()
    report = run(liquid, time=2.0, step=1.0)[-1]
    assert np.abs(liquid.velocity[..., 1:]).max() < before < 0.03
    assert report.divergence < 1e-4
    assert liquid.pressure_noise < 0.001 * DENSITY


def test_a_flow_the_other_way_is_the_same_the_other_way():
    there, _ = pipe(across=10, length=0.2, reynolds=2e5, velocity=power_law)
    back, _ = pipe(
        across=10,
        length=0.2,
        reynolds=2e5,
        velocity=lambda s: -power_law(s),
        bulk_velocity=-1.0,
    )
    for liquid in (there, back):
        run(liquid, time=0.5, step=0.1)
    assert back.pressure_gradient == pytest.approx(-there.pressure_gradient, rel=1e-9)
    assert back.velocity[..., 0] == pytest.approx(-there.velocity[..., 0], abs=1e-12)


def test_a_liquid_at_rest_stays_at_rest():
    for turbulent in (False, True):
        liquid, _ = pipe(
            across=10,
            length=0.2,
            reynolds=2e5,
            velocity=still,
            bulk_velocity=0.0,
            turbulent=turbulent,
        )
        liquid.body_force([0.0, 0.0, -9.81])
        run(liquid, time=0.5, step=0.25)
        assert np.abs(liquid.velocity).max() < 1e-12


def test_the_bulk_velocity_is_held_and_every_section_carries_it():
    liquid, nodes = pipe(across=8, length=0.4, reynolds=2e5, velocity=power_law, swirl=0.1)
    for _ in range(10):
        liquid.advance(0.02)
        assert liquid.bulk_velocity == pytest.approx(1.0, rel=1e-13)
    flux = nodes.area @ liquid.velocity[..., 0] / nodes.area.sum()
    assert np.abs(flux - 1).max() < 1e-3


def test_momentum_is_accounted_for():
    liquid, _ = pipe(across=10, length=0.4, reynolds=2e5, velocity=power_law, swirl=0.1)
    run(liquid, time=4.0, step=0.5)
    report = liquid.advance(1.0)
    assert abs(report.unexplained) < 0.005 * report.mean_gradient


def test_energy_does_not_grow_without_drive():
    liquid, _ = pipe(
        across=8, length=0.4, reynolds=2e5, velocity=power_law, swirl=0.1, pressure_gradient=0.0
    )
    energy = [liquid.kinetic_energy]
    for _ in range(20):
        run(liquid, time=0.05, step=0.05)
        energy.append(liquid.kinetic_energy)
    assert np.all(np.diff(energy) < 0)


@pytest.mark.parametrize("options", [{}, {"convection": "muscl", "scheme": "rk3"}])
def test_results_do_not_depend_on_threads(options):
    ends = []
    for threads in (1, 2, 3):
        liquid, _ = pipe(
            across=8,
            length=2.0,
            reynolds=2e5,
            velocity=power_law,
            swirl=0.1,
            threads=threads,
            **options,
        )
        liquid.body_force([0.0, 1.0, 0.0])
        run(liquid, time=0.1, step=0.05)
        ends.append((liquid.velocity, liquid.pressure))
    for other in ends[1:]:
        for one, two in zip(ends[0], other, strict=True):
            assert np.array_equal(one, two)


@pytest.mark.parametrize("reynolds", [50, 2e5])
def test_a_restored_liquid_goes_on_to_the_last_bit(reynolds):
    whole, _ = pipe(across=8, length=0.4, reynolds=reynolds, velocity=power_law, swirl=0.1)
    parted, _ = pipe(across=8, length=0.4, reynolds=reynolds, velocity=power_law)
    run(whole, time=0.05, step=0.01)
    parted.restore(whole.state())
    assert np.array_equal(whole.pressure, parted.pressure)
    for liquid in (whole, parted):
        run(liquid, time=0.05, step=0.01)
    assert np.array_equal(whole.velocity, parted.velocity)
    assert np.array_equal(whole.pressure, parted.pressure)
    assert whole.pressure_gradient == parted.pressure_gradient


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


def test_sampling_knows_where_the_pipe_goes_on():
    """A velocity that waves once along the pipe, read beside both of its ends."""
    liquid, nodes = pipe(across=16, length=0.4, reynolds=50, velocity=still)
    state = liquid.state()
    wave = np.cos(2 * np.pi * nodes.position[..., 0] / 0.4)
    state["velocity"] = (wave[..., None] * [0.0, 1.0, 0.0]).reshape(-1, 3)
    liquid.restore(state)
    at = np.array([0.0, 0.001, 0.1, 0.2, 0.399])
    got = liquid.velocity_at(points=at[:, None] * [1.0, 0.0, 0.0], radius=0.02)
    assert got[:, 1] == pytest.approx(np.cos(2 * np.pi * at / 0.4), abs=0.02)


@pytest.mark.parametrize(
    ("reynolds", "limit", "step"),
    [(2e5, "courant", 0.8 * 0.0125 / 1.2245), (1.0, "viscosity", 1.6 / (12 * 0.2 / 0.0125**2))],
)
def test_a_step_too_long_is_parted_and_the_limit_named(reynolds, limit, step):
    liquid, _ = pipe(across=16, length=0.4, reynolds=reynolds, velocity=power_law)
    report = liquid.advance(100 * step)
    assert report.sound
    assert report.substeps >= 80
    assert report.limit == limit
    assert report.shortest == pytest.approx(step, rel=0.15)
    report = liquid.advance(step / 2)
    assert (report.substeps, report.limit) == (1, "none")


def test_speeds_that_run_away_are_told_not_followed():
    liquid, _ = pipe(across=8, length=0.4, reynolds=2e5, velocity=lambda s: 1e30 + 0 * s)
    assert not liquid.advance(0.01).sound
    liquid, _ = pipe(across=8, length=0.4, reynolds=2e5, velocity=lambda s: np.nan * s)
    assert not liquid.advance(0.01).sound
    liquid, _ = pipe(across=8, length=0.4, reynolds=2e5, velocity=power_law)
    liquid.body_force([0.0, np.inf, 0.0])
    assert not liquid.advance(0.001).sound


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"density": 0.0}, "density must be > 0"),
        ({"courant": 0.0}, "courant must be > 0"),
        ({"kinematic_viscosity": 0.0}, "kinematic_viscosity must be > 0"),
        ({"threads": 0}, "threads must be >= 1"),
        ({"pipe_length": 0.0}, "pipe_length must be > 0"),
        ({"stations": 6}, "stations must be a multiple of 4"),
        ({"stations": 36}, "one vector per node and station"),
        ({"convection": "central"}, "convection must be one of upwind, muscl, not central"),
        ({"scheme": "euler"}, "scheme must be one of rk2, rk3, not euler"),
    ],
)
def test_bad_input_names_the_field(change, message):
    with pytest.raises(ValueError, match=message):
        pipe(across=8, length=0.4, reynolds=2e5, velocity=power_law, **change)
