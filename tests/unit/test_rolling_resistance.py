"""Rolling resistance: rest at rest, the right stopping distance, the right slope."""

import numpy as np
import pytest

from mpsdem._core import dem
from slow_dem import LAWS, Flat, scene

RADIUS, GRAVITY, STEP = 0.01, 9.81, 2e-5
MASS = 2500 * 4 / 3 * np.pi * RADIUS**3
LAW = dem.HertzMindlin(youngs_modulus=1e7, poisson_ratio=0.2, restitution=0.5, friction=0.5)
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)


def on_slope(angle, *, rolling_friction, law=LAW, velocity=0.0, step=STEP, settle=0.1):
    """A solid that lies on a slope, falling towards +x, pressed in by its weight."""
    gravity = GRAVITY * np.array([np.sin(angle), 0, -np.cos(angle)])
    floor = {"wall_law": law, "wall_rolling_friction": rolling_friction, "walls": [Flat()]}
    # Let it sink in on the level first.
    resting = scene([0, 0, RADIUS], acceleration=[0, 0, gravity[2]], **floor).solids()
    resting.advance(step, round(settle / step))
    return scene(
        resting.position,
        [velocity, 0, 0],
        [0, velocity / RADIUS, 0],
        acceleration=gravity,
        **floor,
    ).solids()


@every_law
def test_a_solid_rests_on_a_slope_below_its_angle_of_rolling(law):
    solids = on_slope(np.arctan(0.1) * 0.9, rolling_friction=0.1, law=law, step=1e-4, settle=4.0)
    solids.advance(1e-4, 5000)
    rest = solids.position
    solids.advance(1e-4, 10_000)
    np.testing.assert_allclose(solids.position, rest, rtol=0, atol=1e-9)
    np.testing.assert_allclose(solids.velocity, 0, atol=1e-9)
    np.testing.assert_allclose(solids.spin, 0, atol=1e-6)


@every_law
def test_a_solid_rolls_down_a_slope_above_its_angle_of_rolling(law):
    solids = on_slope(np.arctan(0.1) * 1.1, rolling_friction=0.1, law=law, step=1e-4, settle=4.0)
    solids.advance(1e-4, 10_000)
    assert solids.velocity[0, 0] > 0.05


@pytest.mark.parametrize("rolling_friction", [0.0, 0.05, 0.2])
def test_acceleration_down_a_slope_is_five_sevenths_of_what_friction_leaves(rolling_friction):
    """Without it 3.50357 m/s2 at 30 degrees."""
    angle = np.radians(30)
    solids = on_slope(angle, rolling_friction=rolling_friction)
    solids.advance(STEP, 5000)
    before = solids.velocity[0, 0]
    solids.advance(STEP, 20_000)
    gained = (solids.velocity[0, 0] - before) / (20_000 * STEP)
    expected = 5 / 7 * GRAVITY * (np.sin(angle) - rolling_friction * np.cos(angle))
    assert gained == pytest.approx(expected, rel=2e-3)
    assert solids.spin[0, 1] * RADIUS == pytest.approx(solids.velocity[0, 0], rel=1e-3)


def test_on_too_steep_a_slope_a_solid_slides_and_spins_as_friction_allows():
    """At 30 degrees and friction 0.1: 4.05543 m/s2 and 424.8 rad/s2 for 5 mm."""
    law = dem.HertzMindlin(youngs_modulus=1e7, poisson_ratio=0.2, restitution=0.5, friction=0.1)
    solids = on_slope(np.radians(30), rolling_friction=0.0, law=law)
    solids.advance(STEP, 5000)
    velocity, spin = solids.velocity[0, 0], solids.spin[0, 1]
    solids.advance(STEP, 10_000)
    assert (solids.velocity[0, 0] - velocity) / 0.2 == pytest.approx(4.05543, rel=1e-3)
    assert (solids.spin[0, 1] - spin) / 0.2 * RADIUS / 0.005 == pytest.approx(424.8, rel=1e-3)


def test_a_solid_that_slides_starts_to_roll_at_five_sevenths_of_its_speed():
    """At 1 m/s and friction 0.3: after 0.097083 s and 0.083214 m."""
    law = dem.HertzMindlin(youngs_modulus=1e7, poisson_ratio=0.2, restitution=0.5, friction=0.3)
    still = on_slope(0.0, rolling_friction=0.0, law=law)
    solids = scene(
        still.position, [1, 0, 0], wall_law=law, walls=[Flat()], acceleration=[0, 0, -GRAVITY]
    ).solids()
    while solids.spin[0, 1] * RADIUS < solids.velocity[0, 0] * (1 - 1e-4):
        solids.advance(STEP, 1)
        assert solids.position[0, 0] < 0.1
    assert solids.position[0, 0] == pytest.approx(0.083214, rel=5e-3)
    solids.advance(STEP, 10_000)
    assert solids.velocity[0, 0] == pytest.approx(5 / 7, rel=1e-3)


@pytest.mark.parametrize("rolling_friction", [0.02, 0.1])
def test_a_rolling_solid_stops_where_its_energy_is_spent(rolling_friction):
    speed = 0.3
    solids = on_slope(0.0, rolling_friction=rolling_friction, velocity=speed)
    distance = speed**2 / (2 * 5 / 7 * rolling_friction * GRAVITY)
    time = 2 * distance / speed
    solids.advance(STEP, round(1.2 * time / STEP))
    assert solids.position[0, 0] == pytest.approx(distance, rel=0.02)
    np.testing.assert_allclose(solids.velocity, 0, atol=1e-5)


def test_without_resistance_a_solid_rolls_on_for_ever():
    solids = on_slope(0.0, rolling_friction=0.0, velocity=0.3)
    solids.advance(STEP, 50_000)
    assert solids.velocity[0, 0] == pytest.approx(0.3, rel=1e-3)


def test_two_solids_in_touch_stop_each_others_rolling_with_opposite_torques():
    """Pressed together by opposite accelerations, spinning against each other."""
    start = scene(
        [[0, 0, -0.00999], [0, 0, 0.00999]],
        0.0,
        [[0, 50.0, 0], [0, -50.0, 0]],
        acceleration=[[0, 0, 10.0], [0, 0, -10.0]],
        pair_law=LAW,
    )
    free, resisted = start.solids(), start.with_(pair_rolling_friction=0.05).solids()
    for solids in (free, resisted):
        solids.advance(STEP, 20_000)
        np.testing.assert_allclose(solids.spin[0], -solids.spin[1], atol=1e-9)
        np.testing.assert_allclose(solids.velocity[0, :2], 0, atol=1e-9)
    # like gears, they do not slip: friction alone leaves the spin as it is
    assert free.spin[0, 1] == pytest.approx(50.0, rel=1e-9)
    # torque mu_r R* F on each, until it stops
    deceleration = 0.05 * RADIUS / 2 * MASS * 10 / (0.4 * MASS * RADIUS**2)
    expected = 50.0 - deceleration * 20_000 * STEP
    assert resisted.spin[0, 1] == pytest.approx(max(expected, 0.0), abs=0.5)


def test_spin_about_the_normal_is_not_rolling():
    solids = on_slope(0.0, rolling_friction=0.3)
    spun = scene(
        solids.position,
        0.0,
        [0, 0, 40.0],
        wall_law=LAW,
        wall_rolling_friction=0.3,
        walls=[Flat()],
        acceleration=[0, 0, -GRAVITY],
    ).solids()
    spun.advance(STEP, 10_000)
    np.testing.assert_allclose(spun.spin, [[0, 0, 40.0]], atol=1e-9)


@pytest.mark.parametrize("name", ["pair_rolling_friction", "wall_rolling_friction"])
@pytest.mark.parametrize("value", [-0.1, np.nan])
def test_bad_rolling_friction_is_refused(name, value):
    with pytest.raises(ValueError, match="rolling_friction must be >= 0"):
        scene([0, 0, 0], **{name: value}).solids()
