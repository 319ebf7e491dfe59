"""A pipe whose walls move: what they do to the liquid, and to the solids that touch them."""

import numpy as np
import pytest

from mpsdem import Simulation
from mpsdem._core import dem, geometry
from mpsdem.case import Case, CaseError, Motion, MovingAxis
from mpsdem.liquids import bending
from mpsdem.plan import make_plan

WATER = {
    "model": "lagrangian",
    "density": 1000.0,
    "kinematic_viscosity": 1e-6,
    "bulk_velocity": 1.0,
}
PIPE = {"radius": 0.1, "length": 0.8}
STRONG = {"direction": "y", "amplitude": 20 / (2 * np.pi * 5) ** 2, "period": 0.2}  # 20 m/s2, 5 Hz
NODULE = {
    "diameter": 0.015,
    "density": 2500.0,
    "youngs_modulus": 1e7,
    "arrangement": {"kind": "list", "positions": [[0.2, 0.0, 0.0]]},
}


def case(vibration, *, walls="auto", coupling="one-way", **parts):
    parts = {"end_time": 0.4, "pipe": PIPE, "liquid": WATER} | parts
    return Case(
        motion={"vibration": vibration, "walls": walls},
        fidelity={"level": "quick", "threads": 1, "coupling": coupling},
        output={"every": 0.02, "figures": False},
        **parts,
    )


@pytest.fixture
def run(tmp_path_factory):
    opened = []

    def go(case):
        opened.append(Simulation(case, tmp_path_factory.mktemp("run") / "run").run(bar=False))
        return opened[-1]

    yield go
    for results in opened:
        results.close()


# --- the wall itself ------------------------------------------------------------------------------

FLEXING = Motion(
    vibration=[
        {"direction": "z", "amplitude": 0.05, "period": 1.0, "mode": 2},
        {"direction": "y", "amplitude": 0.02, "period": 0.7, "mode": 4},
        {"direction": [0, 1, 1], "amplitude": 0.01, "period": 0.3},
    ]
)
AXIS = MovingAxis(motion=FLEXING, length=4.0)
ALONG = np.linspace(0.0, 3.9, 14)


def test_the_velocity_of_a_moving_wall_is_the_derivative_of_its_displacement():
    step, h = bending(AXIS, 0.6, 0.62), 1e-5
    for elapsed in (2 * h, 0.007, 0.02 - 2 * h):
        before2, before, after, after2 = (
            step.axis(elapsed + k * h, ALONG)[0] for k in (-2, -1, 1, 2)
        )
        rate = (before2 - 8 * before + 8 * after - after2) / (12 * h)
        velocity = step.axis(elapsed, ALONG)[2]
        assert np.abs(rate - velocity).max() < 1e-6 * np.abs(velocity).max()


def test_a_moving_wall_is_where_the_case_says_at_both_ends_of_a_step_and_near_it_between():
    step = bending(AXIS, 0.6, 0.62)
    for elapsed, tolerance in ((0.0, 0.0), (0.02, 0.0), (0.011, 1e-6)):
        displacement, slope, velocity = step.axis(elapsed, ALONG)
        time = 0.6 + elapsed if elapsed < 0.02 else 0.62
        np.testing.assert_allclose(
            displacement, AXIS.displacement(ALONG, time), atol=1e-15 + tolerance
        )
        np.testing.assert_allclose(slope, AXIS.slope(ALONG, time), atol=1e-14 + tolerance)
        np.testing.assert_allclose(
            velocity, AXIS.velocity(ALONG, time), atol=1e-13 + 100 * tolerance
        )


def test_the_slope_is_the_derivative_along_the_pipe():
    h = 1e-5
    rate = (AXIS.displacement(ALONG + h, 0.8) - AXIS.displacement(ALONG - h, 0.8)) / (2 * h)
    np.testing.assert_allclose(AXIS.slope(ALONG, 0.8), rate, atol=1e-9)


def test_the_distance_from_a_bent_wall_is_that_to_its_nearest_point():
    """Brute force over a dense net of wall points, near the wall where contacts are."""
    wall = geometry.BentCylinder(radius=0.1)
    wall.bend(bending(AXIS, 0.6, 0.62), 0.0)
    x = np.linspace(0.5, 1.5, 801)
    angle = np.linspace(0, 2 * np.pi, 1000, endpoint=False)
    ring = 0.1 * np.column_stack([np.zeros_like(angle), np.cos(angle), np.sin(angle)])
    along = np.outer(x, [1.0, 0.0, 0.0])
    net = (along + AXIS.displacement(x, 0.6))[:, None, :] + ring
    for turn in (0.3, 2.0, 4.4):
        inside = [1.0, 0.0925 * np.cos(turn), 0.0925 * np.sin(turn)]
        point = AXIS.place(np.array([inside]), 0.6)
        nearest = np.linalg.norm(net - point, axis=-1).min()
        assert wall.distance(point)[0] == pytest.approx(nearest, rel=2e-3)


def test_to_the_laboratory_and_back_is_no_way():
    rng = np.random.default_rng(0)
    position, velocity = rng.random((20, 3)), rng.random((20, 3))
    there = AXIS.place(position, 0.7)
    np.testing.assert_allclose(AXIS.position(there, 0.7), position, atol=1e-15)
    seen = AXIS.to_laboratory(velocity, position[:, 0], 0.7)
    np.testing.assert_allclose(AXIS.from_pipe(seen, position[:, 0], 0.7), velocity, atol=1e-15)


def test_a_velocity_seen_from_the_pipe_is_the_rate_of_the_position_seen_from_it():
    place, velocity, h = np.array([[1.3, 0.2, 0.1]]), np.array([[0.9, -0.3, 0.4]]), 1e-6
    before, after = (AXIS.position(place + k * h * velocity, 0.7 + k * h) for k in (-1, 1))
    rate = (after - before) / (2 * h)
    np.testing.assert_allclose(AXIS.from_pipe(velocity, place[:, 0], 0.7), rate, atol=1e-8)


def test_a_plug_that_follows_the_axis_gains_what_its_known_pressure_gives_it():
    """To first order in time du/dt = -grad(p / rho), everywhere but for a mean of the section."""
    time, dt, h = 0.7, 1e-5, 1e-5
    position = np.array([[1.3, 0.05, -0.03], [2.7, -0.02, 0.06]])
    gain = AXIS.plug_gain(position, time, time + dt, 1.0) / dt

    def pressure(place):
        return AXIS.plug_pressure(AXIS.position(place, time), time, 1.0)

    there = AXIS.place(position, time)
    for d in range(3):
        step = h * np.eye(3)[d]
        slope = (pressure(there + step) - pressure(there - step)) / (2 * h)
        np.testing.assert_allclose(gain[:, d], -slope, rtol=1e-2, atol=2e-2)


# --- solids ---------------------------------------------------------------------------------------


def test_a_wall_that_moves_carries_along_what_rests_on_it(run):
    """A solid on the bottom of a pipe swung sideways, in a liquid at rest: it stays on the wall."""
    results = run(
        case(
            {"direction": "y", "amplitude": 0.02, "period": 1.0, "mode": 2},
            liquid=None,
            solids=NODULE | {"arrangement": {"kind": "list", "positions": [[0.01, 0, -0.0925]]}},
            end_time=1.2,
        )
    )
    swung = results.solids.laboratory_position(-1)[0, 1]
    assert swung > 0.01  # the pipe is at 0.02 sin(1.2 x 2 pi) = 0.019 at the inlet
    depth = np.hypot(*results.solids.position[:, 0, 1:].T)
    assert depth[-20:].min() > 0.0915


def test_a_dry_solid_that_touches_nothing_is_left_where_it_is(run):
    results = run(
        case(
            {"direction": "y", "amplitude": 0.02, "period": 0.4, "mode": 2},
            liquid=None,
            gravity=0.0,
            solids=NODULE,
            end_time=0.6,
        )
    )
    for frame in range(len(results.time)):
        place = results.solids.laboratory_position(frame)
        np.testing.assert_allclose(place, [[0.2, 0, 0]], atol=1e-12)


def test_a_solid_rebounds_from_a_wall_that_comes_towards_it_with_its_speed_added():
    """Elastic: v' = 2 W - v, W that of the wall, everywhere along the pipe."""
    speed = 0.5
    law = dem.LinearSpring(
        normal_stiffness=1e4,
        tangential_stiffness=0.0,
        normal_damping=0.0,
        tangential_damping=0.0,
        friction=0.0,
    )
    body = dem.Solids(
        position=np.array([[0.3, 0.0, -0.085]]),
        velocity=np.zeros((1, 3)),
        spin=np.zeros((1, 3)),
        radius=np.array([0.01]),
        density=np.array([2500.0]),
        pair_law=law,
        wall_law=law,
        walls=[geometry.BentCylinder(radius=0.1)],
    )
    duration = 0.04
    one = np.array([[0.0, 0.0, 1.0]])
    body.bend(
        geometry.Bending(
            duration=duration,
            wave_number=np.zeros(1),
            displacement_before=0 * one,
            velocity_before=speed * one,
            displacement_after=speed * duration * one,
            velocity_after=speed * one,
        )
    )
    body.set_forcing(acceleration=np.zeros((1, 3)))
    body.advance(duration / 20000, 20000)
    np.testing.assert_allclose(body.velocity, [[0.0, 0.0, 2 * speed]], atol=1e-3)


# --- liquid ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(("coupling", "apart"), [("one-way", 5e-5), ("two-way", 1e-3)])
def test_moving_walls_and_a_force_in_the_frame_of_the_pipe_are_the_same_motion(
    run, coupling, apart
):
    frame, moved = (
        run(case(STRONG, walls=walls, coupling=coupling, solids=NODULE))
        for walls in ("fixed", "moving")
    )
    a, b = frame.solids.position[:, 0], moved.solids.position[:, 0]
    assert np.ptp(a[:, 1]) > 0.03
    np.testing.assert_allclose(b, a, atol=apart)
    for name in ("pressure_gradient", "pressure_gradient_friction"):
        x, y = (results.diagnostics[name][-10:].mean() for results in (frame, moved))
        assert y == pytest.approx(x, rel=0.01)
    assert moved.summary["momentum_error"] < 1e-3


def test_a_flexing_pipe_keeps_its_liquid_and_its_friction(run):
    flexing = {"direction": "z", "amplitude": 0.01, "period": 0.3, "mode": 2}
    still, bent = (run(case(f, end_time=0.6)) for f in (flexing | {"amplitude": 0.0}, flexing))
    assert bent.summary["mass_error"] == 0
    assert bent.summary["liquid_clips"]["clamped"] == 0
    position = bent.liquid.position[-1][bent.liquid.kind == 2]
    assert np.hypot(*position[:, 1:].T).max() < 0.1
    assert bent.diagnostics["density_scatter"][-1] < 0.03
    a, b = (r.diagnostics["pressure_gradient_friction"][-10:].mean() for r in (still, bent))
    assert b == pytest.approx(a, rel=0.03)


def test_the_liquid_of_a_flexing_pipe_goes_with_it(run):
    """Seen from the pipe it has hardly any velocity across, whatever the pipe's own is."""
    results = run(case({"direction": "z", "amplitude": 0.02, "period": 0.3, "mode": 2}))
    velocity = results.liquid.velocity[-4][results.liquid.kind == 2]
    pipe = np.abs(results.diagnostics["pipe_velocity"][:, 2]).max()
    assert pipe > 0.35
    assert np.sqrt((velocity[:, 1:] ** 2).mean()) < 0.15 * pipe


def test_the_plan_says_why_walls_move_and_takes_the_liquid_that_can():
    flexing = {"direction": "z", "amplitude": 0.01, "period": 1.0, "mode": 2}
    plan = make_plan(case(flexing, liquid=WATER | {"model": "auto"}, solids=NODULE))
    assert plan.liquid_model == "lagrangian"
    (liquid,) = [stage.reason for stage in plan.stages if stage.name == "AdvanceLiquid"]
    assert "the pipe flexes (mode 2) and is at rest in no frame" in liquid
    assert "moving walls" not in [stage.name for stage in plan.left_out]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"liquid": WATER | {"model": "eulerian"}}, "no particles .* set liquid.model = 'lagr"),
        ({"liquid": WATER | {"model": "profile"}}, "no particles .* set liquid.model = 'lagr"),
        ({"pipe": PIPE | {"ends": "push-plate"}}, "the plate's do not; set ends = 'periodic'"),
        (
            {"solids": NODULE | {"held": True}, "coupling": "two-way"},
            "held solids do not go with them",
        ),
    ],
)
def test_what_moving_walls_cannot_have_is_refused_with_its_remedy(change, words):
    for vibration, walls in ((STRONG | {"mode": 2}, "auto"), (STRONG, "moving")):
        with pytest.raises(CaseError, match=words):
            case(vibration, walls=walls, **change)


def test_walls_that_were_to_move_along_the_pipe_are_refused():
    with pytest.raises(CaseError, match="across the pipe only; leave out the motion along x"):
        case(STRONG | {"direction": "x"}, walls="moving")


@pytest.mark.parametrize(
    ("flow", "amplitude", "said"),
    [
        (1.0, 0.004, []),
        (0.0, 0.004, ["without flow"]),
        (1.0, 0.02, ["diverge without flow"]),  # at 0.63 m/s
        (6.0, 0.055, ["curvature of the bore"]),
    ],
)
def test_flexing_beyond_what_particles_bear_is_foreseen(flow, amplitude, said):
    part = {"direction": "y", "amplitude": amplitude, "period": 0.2, "mode": 2}
    plan = make_plan(case([part], liquid=WATER | {"bulk_velocity": flow}))
    warnings = [warning for warning in plan.warnings if "walls that flex" in warning]
    assert len(warnings) == len(said)
    for warning, words in zip(warnings, said, strict=True):
        assert words in warning
