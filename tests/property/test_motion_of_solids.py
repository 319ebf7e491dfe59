"""What the motion of solids must not depend on, and what it must keep, in any scene."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mpsdem._core import dem
from slow_dem import LAWS, STEP, Bore, Flat, block, rotation, scene, unwrapped

seeds = st.integers(0, 2**32 - 1)
laws = st.sampled_from(list(LAWS.values()))
few = settings(max_examples=15)
ROWS = ("position", "velocity", "spin", "radius", "density")


def cloud(rng, *, law, period=0.0, walls=True, speed=0.5, rolling_friction=0.05, **parts):
    """Solids of several sizes that rush together, in a bore with a floor or free."""
    pitch = 0.0125
    counts = (max(3, round((period or 0.05) / pitch)), 3, 3)
    position = block(counts, pitch, rng, jitter=2e-4)
    position[:, 1:] -= position[:, 1:].mean(axis=0)
    inward = position.mean(axis=0) - position
    if period:
        inward[:, 0] = 0
    return scene(
        position,
        rng.normal(0, speed, position.shape) + 20 * inward,
        rng.normal(0, 30, position.shape),
        rng.uniform(0.003, 0.006, len(position)),
        rng.uniform(1000, 8000, len(position)),
        pair_law=law,
        wall_law=law,
        pair_rolling_friction=rolling_friction,
        wall_rolling_friction=rolling_friction,
        walls=[Bore(radius=0.027), Flat(point=(0, 0, -0.019))] if walls else [],
        period=period,
        **parts,
    )


def close(got, expected, tolerance=1e-8):
    np.testing.assert_allclose(got, expected, rtol=0, atol=tolerance * abs(expected).max())


@few
@given(seed=seeds, law=laws)
def test_momentum_of_free_solids_is_kept_to_round_off(seed, law):
    solids = cloud(np.random.default_rng(seed), law=law, walls=False).solids()
    mass = solids.mass[:, None]
    before, size = (mass * solids.velocity).sum(axis=0), abs(mass * solids.velocity).sum()
    assert solids.advance(STEP, 400).largest_overlap > 0
    np.testing.assert_allclose((mass * solids.velocity).sum(axis=0), before, atol=1e-13 * size)


@few
@given(seed=seeds, law=laws, period=st.sampled_from([0.0, 0.05, 0.2]))
def test_walls_gravity_and_drag_account_for_all_momentum(seed, law, period):
    rng = np.random.default_rng(seed)
    start = cloud(rng, law=law, period=period, acceleration=[3.0, 1.0, -9.81])
    n = len(start.position)
    start = start.with_(liquid_velocity=rng.normal(size=(n, 3)), drag_rate=rng.uniform(0, 100, n))
    solids = start.solids()
    mass = solids.mass[:, None]
    before, size = (mass * solids.velocity).sum(axis=0), abs(mass * solids.velocity).sum()
    solids.advance(STEP, 400)
    gained = (mass * solids.velocity).sum(axis=0) - before
    gravity = mass.sum() * start.acceleration[0] * STEP * 400
    expected = gravity + solids.wall_impulse + solids.drag_impulse.sum(axis=0)
    np.testing.assert_allclose(gained, expected, rtol=0, atol=1e-12 * size)


@few
@given(seed=seeds, law=laws, rolling_friction=st.sampled_from([0.0, 0.1]))
def test_energy_never_grows_without_work(seed, law, rolling_friction):
    rng = np.random.default_rng(seed)
    start = cloud(rng, law=law, period=0.1, rolling_friction=rolling_friction)
    solids = start.solids()
    before = solids.kinetic_energy + solids.elastic_energy
    # the viscoelastic law stores a little of its damping in the tangential spring
    growth = 1e-3 if law is LAWS["viscoelastic"] else 1e-9
    scale, touched = before, 0.0
    for _ in range(100):
        touched = max(touched, solids.advance(STEP / 10, 100).largest_overlap)
        now = solids.kinetic_energy + solids.elastic_energy
        assert now <= before + growth * scale
        before = now
    assert touched > 0
    assert now < 0.9 * scale


@few
@given(seed=seeds)
def test_smooth_elastic_solids_keep_their_energy(seed):
    law = dem.HertzMindlin(youngs_modulus=1e6, poisson_ratio=0.2, restitution=1, friction=0)
    rng = np.random.default_rng(seed)
    start = cloud(rng, law=law, period=0.1, rolling_friction=0.0)
    solids = start.solids()
    before = solids.kinetic_energy + solids.elastic_energy
    for _ in range(20):
        assert solids.advance(STEP / 20, 500).finite
        assert solids.kinetic_energy + solids.elastic_energy == pytest.approx(before, rel=1e-4)
    np.testing.assert_allclose(solids.spin, start.spin, rtol=1e-12)


@few
@given(seed=seeds, law=laws)
def test_friction_stays_in_the_coulomb_cone_in_every_contact(seed, law):
    rng = np.random.default_rng(seed)
    solids = cloud(rng, law=law, period=0.05, speed=1.0).solids()
    friction = dict(zip(LAWS.values(), (0.4, 0.3, 0.5, 0.4), strict=True))[law]
    met = 0
    for _ in range(40):
        solids.advance(STEP, 10)
        contacts = solids.contacts()
        along = (contacts["force"] * contacts["normal"]).sum(axis=1)
        across = np.linalg.norm(contacts["force"] - along[:, None] * contacts["normal"], axis=1)
        assert np.all(across <= friction * abs(along) * (1 + 1e-9) + 1e-14)
        met += len(along)
    assert met > 0


@few
@given(seed=seeds, law=laws, period=st.sampled_from([0.0, 0.1]))
def test_the_order_of_the_solids_does_not_matter(seed, law, period):
    rng = np.random.default_rng(seed)
    start = cloud(rng, law=law, period=period, acceleration=[1.0, 0.0, -9.81])
    order = rng.permutation(len(start.position))
    other = start.with_(**{name: getattr(start, name)[order] for name in ROWS})
    one, other = start.solids(), other.solids()
    one.advance(STEP, 300)
    other.advance(STEP, 300)
    close(other.velocity, one.velocity[order])
    close(other.spin, one.spin[order])
    close(other.wall_impulse, one.wall_impulse)


def turned(start, turn):
    return start.with_(
        **{name: getattr(start, name) @ turn.T for name in ("position", "velocity", "spin")}
    )


@few
@given(seed=seeds, law=laws)
def test_a_free_cloud_turned_moves_alike(seed, law):
    rng = np.random.default_rng(seed)
    start = cloud(rng, law=law, walls=False)
    turn = rotation(rng)
    one, other = start.solids(), turned(start, turn).solids()
    assert one.advance(STEP, 300).largest_overlap > 0
    other.advance(STEP, 300)
    close(other.position, one.position @ turn.T)
    close(other.velocity, one.velocity @ turn.T)
    close(other.spin, one.spin @ turn.T)


@few
@given(seed=seeds, law=laws)
def test_a_pipe_turned_about_its_axis_moves_alike(seed, law):
    rng = np.random.default_rng(seed)
    start = cloud(rng, law=law, period=0.1, walls=False, acceleration=[0.0, 0.0, -9.81])
    start = start.with_(walls=[Bore(radius=0.027)], velocity=start.velocity * [1, 4, 4])
    turn = rotation(rng, axis=(1, 0, 0))
    other = turned(start, turn).with_(acceleration=start.acceleration @ turn.T)
    one, other = start.solids(), other.solids()
    one.advance(STEP, 300)
    other.advance(STEP, 300)
    assert np.linalg.norm(one.wall_impulse) > 0
    close(other.velocity, one.velocity @ turn.T)
    close(other.spin, one.spin @ turn.T)
    close(other.wall_impulse, turn @ one.wall_impulse)


@few
@given(seed=seeds, law=laws)
def test_mirrored_solids_move_as_their_mirror_image(seed, law):
    """Spin is an axial vector: it turns the other way in a mirror."""
    rng = np.random.default_rng(seed)
    start = cloud(rng, law=law, period=0.1, acceleration=[0.0, 0.0, -9.81])
    mirror = np.array([1, -1, 1])
    other = start.with_(
        position=start.position * mirror,
        velocity=start.velocity * mirror,
        spin=-start.spin * mirror,
    )
    one, other = start.solids(), other.solids()
    one.advance(STEP, 300)
    other.advance(STEP, 300)
    close(other.velocity, one.velocity * mirror)
    close(other.spin, -one.spin * mirror)


@few
@given(seed=seeds, law=laws, speed=st.floats(-30, 30), shift=st.floats(-1, 1))
def test_a_moving_pipe_with_moving_solids_is_a_pipe_at_rest(seed, law, speed, shift):
    rng = np.random.default_rng(seed)
    start = cloud(rng, law=law, period=0.1, acceleration=[0.0, 0.0, -9.81])
    along = np.array([1.0, 0, 0])
    velocity = tuple(speed * along)
    other = start.with_(
        position=start.position + shift * along,
        velocity=start.velocity + velocity,
        walls=[
            Bore(radius=0.027, velocity=velocity),
            Flat(point=(0, 0, -0.019), velocity=velocity),
        ],
    )
    one, other = start.solids(), other.solids()
    report, other_report = one.advance(STEP, 300), other.advance(STEP, 300)
    assert abs(other_report.sorts - report.sorts) <= 1
    close(other.velocity - velocity, one.velocity)
    close(other.spin, one.spin)
    travelled = unwrapped(other, 0.1) - unwrapped(one, 0.1)
    np.testing.assert_allclose(travelled[:, 0], shift + speed * 300 * STEP, atol=1e-9)


@few
@given(
    seed=seeds,
    metre=st.floats(0.1, 10),
    kilogram=st.floats(0.1, 10),
    second=st.floats(0.1, 10),
)
def test_the_motion_does_not_depend_on_the_units(seed, metre, kilogram, second):
    rng = np.random.default_rng(seed)
    start = cloud(rng, law=hertz(1e6), period=0.1, acceleration=[0.0, 0.0, -9.81])
    n = len(start.position)
    start = start.with_(liquid_velocity=rng.normal(size=(n, 3)), drag_rate=rng.uniform(0, 100, n))
    law = hertz(1e6 * kilogram / metre / second**2)
    speed = metre / second
    other = start.with_(
        position=start.position * metre,
        velocity=start.velocity * speed,
        spin=start.spin / second,
        radius=start.radius * metre,
        density=start.density * kilogram / metre**3,
        pair_law=law,
        wall_law=law,
        walls=[Bore(radius=0.027 * metre), Flat(point=(0, 0, -0.019 * metre))],
        period=0.1 * metre,
        acceleration=start.acceleration * speed / second,
        liquid_velocity=start.liquid_velocity * speed,
        drag_rate=start.drag_rate / second,
    )
    one, other = start.solids(), other.solids()
    report, other_report = one.advance(STEP, 300), other.advance(STEP * second, 300)
    close(other.velocity / speed, one.velocity)
    close(other.spin * second, one.spin)
    close(other.drag_impulse / kilogram / speed, one.drag_impulse)
    joule = kilogram * speed**2
    assert other.kinetic_energy / joule == pytest.approx(one.kinetic_energy, rel=1e-8)
    assert other.elastic_energy / joule == pytest.approx(one.elastic_energy, rel=1e-6, abs=1e-12)
    assert (other_report.prunes, other_report.sorts) == (report.prunes, report.sorts)


def hertz(youngs_modulus):
    return dem.HertzMindlin(
        youngs_modulus=youngs_modulus, poisson_ratio=0.2, restitution=0.7, friction=0.4
    )


@few
@given(seed=seeds, law=laws, period=st.sampled_from([0.0, 0.05]), cut=st.integers(0, 300))
def test_a_state_taken_at_any_moment_goes_on_bit_equal(seed, law, period, cut):
    start = cloud(np.random.default_rng(seed), law=law, period=period, speed=1.0)
    solids = start.solids()
    solids.advance(STEP, cut)
    restored = start.solids()
    restored.restore(solids.state())
    report, restored_report = solids.advance(STEP, 150), restored.advance(STEP, 150)
    assert report.prunes == restored_report.prunes
    for name in ("position", "velocity", "spin", "laps", "wall_impulse"):
        assert getattr(restored, name).tobytes() == getattr(solids, name).tobytes()
    state, restored_state = solids.state(), restored.state()
    for name in state:
        np.testing.assert_array_equal(state[name], restored_state[name])
