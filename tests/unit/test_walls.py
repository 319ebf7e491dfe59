"""Solids at walls: support, curvature, motion of the wall, and who pays the momentum."""

import numpy as np
import pytest

from mpsdem._core import dem, geometry
from slow_dem import HERTZ, LINEAR, STEP, Bore, Flat, SlowSolids, scene

GRAVITY = np.array([0.0, 0.0, -9.81])
RADIUS = 0.01
MASS = 2500 * 4 / 3 * np.pi * RADIUS**3


def smooth(restitution=1.0, friction=0.0):
    return dem.HertzMindlin(
        youngs_modulus=1e7, poisson_ratio=0.2, restitution=restitution, friction=friction
    )


def settled(wall, *, height, law=HERTZ, steps=20_000, **parts):
    solids = scene([0, 0, height], wall_law=law, walls=[wall], acceleration=GRAVITY, **parts)
    solids = solids.solids()
    solids.advance(STEP, steps)
    return solids


def test_distance_is_positive_inside_and_negative_outside():
    points = np.array([[5.0, 0, 0], [-3, 0.3, 0.4], [0, 0, -2.0]])
    bore = geometry.Cylinder(radius=1.0, velocity=np.zeros(3))
    np.testing.assert_allclose(bore.distance(points), [1.0, 0.5, -1.0])
    floor = geometry.Plane(
        point=np.array([9.0, 9.0, 1.0]), normal=np.array([0, 0, 5.0]), velocity=np.zeros(3)
    )
    np.testing.assert_allclose(floor.distance(points), [-1.0, -0.6, -3.0])


@pytest.mark.parametrize("wall", [Flat(), Bore(radius=0.1)], ids=["flat", "bore"])
def test_a_wall_bears_the_weight_of_a_solid_at_rest(wall):
    solids = settled(wall, height=RADIUS if isinstance(wall, Flat) else -0.09)
    np.testing.assert_allclose(solids.contacts()["force"], [-MASS * GRAVITY], atol=1e-9)
    np.testing.assert_allclose(solids.velocity, 0, atol=1e-9)


def test_the_impulse_of_a_wall_that_bears_a_solid_is_weight_times_time():
    solids = settled(Flat(), height=RADIUS)
    before = solids.wall_impulse
    solids.advance(STEP, 1000)
    np.testing.assert_allclose(
        solids.wall_impulse - before, -MASS * GRAVITY * 1000 * STEP, rtol=1e-9, atol=1e-12
    )


def test_a_solid_sinks_less_into_a_bore_that_hugs_it():
    """Hertz: at one load the overlap goes with R*^(-1/3), and the bore makes R* larger."""
    flat = settled(Flat(), height=RADIUS).contacts()["overlap"][0]
    bore = settled(Bore(radius=2 * RADIUS), height=-RADIUS).contacts()["overlap"][0]
    assert bore / flat == pytest.approx((3 / 4) ** (1 / 3), rel=1e-6)


def period_of(solids, dt, axis):
    """Time from one crossing of the lowest point to the next but one [s]."""
    crossings, time, before = [], 0.0, solids.position[0, axis]
    while len(crossings) < 3:
        solids.advance(dt, 5)
        time += 5 * dt
        now = solids.position[0, axis]
        if before * now < 0:
            crossings.append(time - 5 * dt * now / (now - before))
        before = now
    return crossings[2] - crossings[0]


@pytest.mark.parametrize(("friction", "inertia"), [(0.0, 1.0), (1.0, 1.4)])
def test_a_solid_swings_in_a_bore_as_a_pendulum(friction, inertia):
    """Of length R - r; rolling turns it slower by the root of 7/5."""
    length = 0.1 - RADIUS
    angle = 0.05
    start = [0, length * np.sin(angle), -length * np.cos(angle)]
    law = smooth(friction=friction)
    solids = scene(start, wall_law=law, walls=[Bore(radius=0.1)], acceleration=GRAVITY).solids()
    period = 2 * np.pi * np.sqrt(inertia * length / 9.81) * (1 + angle**2 / 16)
    assert period_of(solids, 2e-5, axis=1) == pytest.approx(period, rel=3e-3)


def test_a_smooth_wall_takes_nothing_along_itself():
    solids = scene(
        [0, 0, -0.09],
        [0.3, 0.5, 0],
        [0, 20, 0],
        wall_law=smooth(),
        walls=[Bore(radius=0.1)],
        period=1.0,
    ).solids()
    energy = solids.kinetic_energy + solids.elastic_energy
    solids.advance(1e-5, 40_000)
    assert solids.velocity[0, 0] == 0.3
    np.testing.assert_allclose(solids.spin, [[0, 20, 0]])
    assert solids.kinetic_energy + solids.elastic_energy == pytest.approx(energy, rel=1e-5)


def test_a_belt_carries_a_solid_until_it_moves_alike():
    belt = Flat(velocity=(0.4, -0.3, 0.0))
    solids = settled(belt, height=RADIUS, wall_rolling_friction=0.1, steps=30_000)
    np.testing.assert_allclose(solids.velocity, [belt.velocity], atol=1e-6)
    np.testing.assert_allclose(solids.spin, 0, atol=1e-4)


def test_without_rolling_friction_a_belt_only_spins_a_solid_up_to_two_sevenths():
    """Angular momentum about the belt's surface is kept: 7/5 v = 2/5 of the belt's speed."""
    solids = settled(Flat(velocity=(0.7, 0.0, 0.0)), height=RADIUS, steps=30_000)
    assert solids.velocity[0, 0] == pytest.approx(0.2, rel=2e-3)
    assert solids.spin[0, 1] == pytest.approx(-0.5 / RADIUS, rel=2e-2)


def test_a_moving_pipe_is_a_moving_frame():
    rng = np.random.default_rng(5)
    start = scene(
        rng.uniform(-0.06, 0.06, (20, 3)),
        rng.normal(0, 0.3, (20, 3)),
        rng.normal(0, 10, (20, 3)),
        wall_law=LINEAR,
        walls=[Bore(radius=0.1)],
        period=0.5,
        acceleration=GRAVITY,
    )
    shift = np.array([2.0, 0, 0])
    moving = start.with_(
        velocity=start.velocity + shift, walls=[Bore(radius=0.1, velocity=tuple(shift))]
    )
    one, other = start.solids(), moving.solids()
    one.advance(STEP, 1000)
    other.advance(STEP, 1000)
    np.testing.assert_allclose(other.velocity - shift, one.velocity, atol=1e-9)
    np.testing.assert_allclose(other.spin, one.spin, atol=1e-7)


def test_a_corner_of_two_planes_holds_a_solid_with_both():
    walls = [Flat(normal=(0, 1, 1)), Flat(normal=(0, -1, 1))]
    start = scene([0, 0, np.sqrt(2) * RADIUS], walls=walls, acceleration=GRAVITY)
    solids = start.with_(wall_law=smooth(restitution=0.3)).solids()
    solids.advance(STEP, 20_000)
    contacts = solids.contacts()
    assert contacts["second"].tolist() == [-1, -2]
    thrust = MASS * 9.81 / 2 * np.array([[0, 1, 1], [0, -1, 1]])
    np.testing.assert_allclose(contacts["force"], thrust, atol=1e-9)


def test_a_solid_flung_through_a_plane_is_pushed_back():
    solids = scene([0, 0, -0.005], wall_law=smooth(), walls=[Flat()]).solids()
    solids.advance(1e-5, 5000)
    assert solids.velocity[0, 2] > 0
    assert solids.position[0, 2] > RADIUS


@pytest.mark.parametrize("bore", [1.001, 1.03, 1.2, 1.5])
def test_a_solid_that_nearly_fills_a_bore_meets_it_on_all_sides(bore):
    start = scene(
        [[0, 0, 0.0], [0.05, 0, 1e-6]],
        [[0.3, 0.5, 0.4], [0.3, -0.5, 0]],
        walls=[Bore(radius=bore * RADIUS)],
        period=0.1,
    )
    slow, solids = SlowSolids(start), start.solids()
    slow.advance(STEP, 200)
    solids.advance(STEP, 200)
    assert np.linalg.norm(slow.wall_impulse) > 0
    np.testing.assert_allclose(solids.velocity, slow.v, atol=1e-12)


@pytest.mark.parametrize(
    ("wall", "field", "value"),
    [
        (geometry.Cylinder, "radius", 0.0),
        (geometry.Cylinder, "radius", -1.0),
        (geometry.Cylinder, "radius", np.nan),
        (geometry.Cylinder, "radius", np.inf),
        (geometry.Cylinder, "velocity", [0.0, np.nan, 0.0]),
        (geometry.Cylinder, "velocity", [0.0, 0.0]),
        (geometry.Plane, "normal", [0.0, 0.0, 0.0]),
        (geometry.Plane, "normal", [0.0, np.nan, 1.0]),
        (geometry.Plane, "normal", [0.0, np.inf, 1.0]),
        (geometry.Plane, "normal", [[0.0, 0.0, 1.0]]),
        (geometry.Plane, "point", [np.nan, 0.0, 0.0]),
        (geometry.Plane, "point", [1.0]),
        (geometry.Plane, "velocity", [np.inf, 0.0, 0.0]),
    ],
)
def test_a_bad_wall_is_refused_by_the_name_of_its_field(wall, field, value):
    good = {
        geometry.Cylinder: {"radius": 1.0, "velocity": np.zeros(3)},
        geometry.Plane: {"point": np.zeros(3), "normal": np.ones(3), "velocity": np.zeros(3)},
    }[wall]
    with pytest.raises(ValueError, match=field):
        wall(**(good | {field: np.array(value)}))
