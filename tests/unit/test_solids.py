"""The engine of the solids: the same motion as the slow way, exact books, exact states."""

from itertools import pairwise

import numpy as np
import pytest

from mpsdem._core import dem
from slow_dem import (
    LAWS,
    LINEAR,
    STEP,
    Bore,
    Flat,
    SlowSolids,
    block,
    scene,
    sheared_packing,
    unwrapped,
)

GRAVITY = np.array([2.0, 0.0, -9.81])
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
BEAD = {"radius": 0.01, "density": 2500.0}


def in_a_pipe(seed=0, *, law=LINEAR, rolling_friction=0.0, counts=(4, 2, 2), **parts):
    """A sheared packing that fills the shortest period, in a bore with a moving floor."""
    rng = np.random.default_rng(seed)
    packing = sheared_packing(
        rng,
        counts,
        period=counts[0] * 0.0197,
        acceleration=GRAVITY,
        pair_law=law,
        wall_law=law,
        pair_rolling_friction=rolling_friction,
        wall_rolling_friction=rolling_friction,
        walls=[
            Bore(radius=0.0232, velocity=(0.05, 0.0, 0.0)),
            Flat(point=(0, 0, -0.019), velocity=(0.1, 0.2, 0)),
        ],
    )
    position = packing.position - [0, *packing.position[:, 1:].mean(axis=0)]
    radius = packing.radius * rng.uniform(0.9, 1.0, len(packing.radius))
    return packing.with_(position=position, radius=radius, **parts)


def big_packing(n=4104, seed=0, **parts):
    """More solids than one block holds, touching across its border, in no order."""
    rng = np.random.default_rng(seed)
    start = sheared_packing(rng, (19, 18, 12), period=19 * 0.0196, pair_law=LINEAR, speed=1.0)
    keep = rng.permutation(len(start.position))[:n]
    rows = {name: getattr(start, name)[keep] for name in ROWS}
    return start.with_(**rows, **parts)


ROWS = ("position", "velocity", "spin", "radius", "density")


def state_of(solids):
    return {
        name: getattr(solids, name)
        for name in ("position", "velocity", "spin", "laps", "wall_impulse", "drag_impulse")
    } | {"energy": np.array([solids.kinetic_energy, solids.elastic_energy])}


def assert_equal_bits(one, other):
    for name, value in state_of(one).items():
        assert value.tobytes() == state_of(other)[name].tobytes(), name


# --- against the slow way ----------------------------------------------------------------------


def assert_same_motion(start, *, steps):
    """Compare after each of five parts; returns all contacts there were, and counts of lists."""
    slow, solids = SlowSolids(start), start.solids()
    contacts, prunes, sorts = set(), 0, 0
    for _ in range(5):
        report = solids.advance(STEP, steps // 5)
        slow.advance(STEP, steps // 5)
        for got, expected in [
            (unwrapped(solids, start.period), slow.x),
            (solids.velocity, slow.v),
            (solids.spin, slow.w),
            (solids.wall_impulse, slow.wall_impulse),
        ]:
            scale = abs(expected).max() or 1.0
            np.testing.assert_allclose(got, expected, rtol=0, atol=1e-9 * scale)
        assert len(solids.contacts()["first"]) == len(slow.history)
        contacts |= slow.history.keys()
        prunes += report.prunes
        sorts += report.sorts
    return contacts, prunes, sorts


@every_law
@pytest.mark.parametrize("rolling_friction", [0.0, 0.1])
def test_a_packing_in_a_short_pipe_moves_as_the_slow_way_has_it(law, rolling_friction):
    contacts, prunes, sorts = assert_same_motion(
        in_a_pipe(law=law, rolling_friction=rolling_friction), steps=250
    )
    assert prunes > sorts > 0
    at_walls = {key[1] for key in contacts if len(key) == 2}
    images = {key[2] for key in contacts if len(key) == 3}
    assert at_walls == {-1, -2}
    assert {-1, 0} <= images
    assert len(contacts) > 30


def test_sizes_from_1_to_10_move_as_the_slow_way_has_it():
    rng = np.random.default_rng(2)
    position = block((3, 3, 3), 0.0205, rng, jitter=0.001)
    radius = 0.01 * 10 ** rng.uniform(-1, 0, len(position))
    radius[:4] = 0.01
    inward = position.mean(axis=0) - position
    start = scene(
        position,
        20 * inward + rng.normal(0, 0.1, position.shape),
        rng.normal(0, 30, position.shape),
        radius,
        rng.uniform(1000, 8000, len(position)),
        period=0.0615,
    )
    contacts, *_ = assert_same_motion(start, steps=300)
    assert len(contacts) > 10


def test_drag_and_gravity_move_solids_as_the_slow_way_has_it():
    rng = np.random.default_rng(3)
    start = in_a_pipe(
        3, drag_rate=rng.uniform(0, 300, 16), liquid_velocity=rng.normal(0, 1, (16, 3))
    )
    assert_same_motion(start, steps=200)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_a_solid_rushing_by_far_away_changes_nothing(law):
    """It makes every list anew, again and again: displacements of the others must survive that."""
    in_floor = in_a_pipe(4, law=law, rolling_friction=0.1)
    starts = [in_floor.with_(period=0.0, walls=in_floor.walls[1:])]
    if law is LINEAR:
        starts.append(big_packing(period=0.0))
    passer = {
        "position": [[0.0, 0.0, 5.0]],
        "velocity": [[300.0, 0.0, 0.0]],
        "spin": [[0.0, 0.0, 0.0]],
        "radius": [0.01],
        "density": [2500.0],
    }
    for start in starts:
        rows = {name: np.concatenate([getattr(start, name), passer[name]]) for name in ROWS}
        hurried = start.with_(**rows, acceleration=np.zeros_like(rows["position"])).solids()
        calm = start.with_(acceleration=None).solids()
        few, many = calm.advance(STEP, 80), hurried.advance(STEP, 80)
        assert many.sorts > 70 > 5 >= few.sorts
        np.testing.assert_allclose(hurried.velocity[:-1], calm.velocity, rtol=0, atol=1e-11)
        np.testing.assert_allclose(hurried.spin[:-1], calm.spin, rtol=0, atol=1e-8)


STICKY = dem.HertzViscoelastic(  # parts under tension: its spring is not empty then
    normal_stiffness=1e9,
    tangential_stiffness=8e8,
    normal_damping=2e6,
    tangential_damping=1e6,
    friction=0.4,
)


@pytest.mark.parametrize("hurried", [False, True])
def test_a_contact_that_parts_forgets_its_displacement(hurried):
    """Bounces on a wall and on another solid; lists are made seldom, or in every step."""
    start = scene(
        [[0, 0, 0.010005], [0.1, 0, 0.010002], [0.1, 0, 0.030005], [0, 9, 0.1]],
        [[0.01, 0, 0], [0.01, 0.005, 0], [-0.01, 0, 0], [3e3 * hurried, 0, 0]],
        pair_law=STICKY,
        wall_law=STICKY,
        walls=[Flat()],
        acceleration=[[0, 0, -9.81]] * 3 + [[0, 0, 0]],
    )
    slow, solids = SlowSolids(start), start.solids()
    prunes, touches, before = 0, 0, set()
    for _ in range(500):
        prunes += solids.advance(1e-5, 1).prunes
        slow.advance(1e-5, 1)
        touches += len(slow.history.keys() - before)
        before = set(slow.history)
    assert touches > 5
    assert prunes == 500 if hurried else prunes < 5
    np.testing.assert_allclose(solids.velocity, slow.v, rtol=0, atol=1e-11)
    np.testing.assert_allclose(solids.spin, slow.w, rtol=0, atol=1e-9)


def test_a_contact_that_parts_at_a_bound_forgets_its_displacement():
    """A single long step after it touched it is far off, and off all lists; then it is back."""
    law = dem.LinearSpring(
        normal_stiffness=1e3,
        tangential_stiffness=7e2,
        normal_damping=0,
        tangential_damping=0,
        friction=0.5,
    )
    start = scene(
        [[0, 0, 0.0099], [0, 0, 1.0], [0, 0, 1.0199], [0, 9, 9]],
        [[0.01, 0, 10.0], [0, 0, 0], [0.01, 0, 10.0], [-0.02, 0, -20.0]],
        pair_law=law,
        wall_law=law,
        walls=[Flat()],
        acceleration=[[0, 0, -1e4], [0, 0, 0], [0, 0, -1e4], [0, 0, 0]],
    )
    slow, solids = SlowSolids(start), start.solids()
    for dt, steps in [(1e-8, 100), *[(5e-4, 1)] * 4, (1e-5, 50)]:
        solids.advance(dt, steps)
        slow.advance(dt, steps)
    assert slow.history.keys() == {(0, -1), (1, 2, 0)}
    np.testing.assert_allclose(solids.velocity, slow.v, rtol=0, atol=1e-11)
    np.testing.assert_allclose(solids.spin, slow.w, rtol=0, atol=1e-9)


# --- books of momentum and energy ---------------------------------------------------------------


@every_law
def test_free_solids_keep_their_momentum_to_round_off(law):
    start = sheared_packing(np.random.default_rng(5), pair_law=law, pair_rolling_friction=0.1)
    solids = start.solids()
    mass = solids.mass[:, None]
    before, size = (mass * start.velocity).sum(axis=0), abs(mass * start.velocity).sum()
    solids.advance(STEP, 1000)
    np.testing.assert_allclose((mass * solids.velocity).sum(axis=0), before, atol=1e-14 * size)


@pytest.mark.parametrize("threads", [1, 2])
def test_gravity_walls_and_drag_account_for_all_momentum(threads):
    rng = np.random.default_rng(6)
    start = in_a_pipe(
        6, drag_rate=rng.uniform(0, 300, 16), liquid_velocity=rng.normal(0, 1, (16, 3))
    )
    solids = start.solids(threads)
    mass = solids.mass[:, None]
    momentum, time = (mass * start.velocity).sum(axis=0), 0.0
    gravity = mass.sum() * GRAVITY
    drag = np.zeros(3)
    for steps, dt in [(1, STEP), (200, STEP), (33, STEP / 3), (500, STEP / 2)]:
        solids.advance(dt, steps)
        time += dt * steps
        drag_now = solids.drag_impulse.sum(axis=0)
        got = (mass * solids.velocity).sum(axis=0) - momentum
        expected = gravity * time + solids.wall_impulse + drag + drag_now
        np.testing.assert_allclose(got, expected, rtol=0, atol=1e-12 * abs(gravity * time).max())
        # forcing anew starts the books of drag anew
        drag += drag_now
        solids.set_forcing(
            acceleration=start.acceleration,
            liquid_velocity=start.liquid_velocity,
            drag_rate=start.drag_rate,
        )
        np.testing.assert_array_equal(solids.drag_impulse, 0)


def test_drag_impulse_is_told_for_each_solid():
    rng = np.random.default_rng(8)
    start = scene(
        [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
        rng.normal(size=(3, 3)),
        drag_rate=[0.0, 5.0, 500.0],
        liquid_velocity=rng.normal(size=(3, 3)),
    )
    solids = start.solids()
    solids.advance(1e-3, 300)
    change = solids.mass[:, None] * (solids.velocity - start.velocity)
    np.testing.assert_allclose(solids.drag_impulse, change, rtol=1e-11, atol=1e-16)


def test_a_free_fall_is_exact():
    solids = scene([0, 0, 0], [1, 2, 3], acceleration=GRAVITY).solids()
    solids.advance(1e-3, 1000)
    np.testing.assert_allclose(solids.velocity, [GRAVITY + np.array([1, 2, 3])], rtol=1e-12)
    np.testing.assert_allclose(solids.position, [GRAVITY / 2 + np.array([1, 2, 3])], rtol=1e-12)


def test_a_stack_keeps_its_energy():
    """Two solids pressed together on a floor, without damping: MFIX DEM03 in another size."""
    law = dem.LinearSpring(
        normal_stiffness=1e3,
        tangential_stiffness=1e3,
        normal_damping=0,
        tangential_damping=0,
        friction=0.3,
    )
    start = scene(
        [[0, 0, 0.009], [0, 0, 0.027]],
        density=[20_000, 10_000],
        pair_law=law,
        wall_law=law,
        walls=[Flat()],
        acceleration=[0, 0, -9.81],
    )
    solids = start.solids()

    def energy():
        height = solids.mass @ solids.position[:, 2]
        return solids.kinetic_energy + solids.elastic_energy + 9.81 * height

    before = energy()
    for _ in range(50):
        solids.advance(1e-5, 400)
        assert energy() == pytest.approx(before, rel=1e-5)


# --- drag ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("rate", [1e3, 1e6, 1e12, 1e100])
def test_a_solid_in_stiff_drag_goes_with_the_liquid_at_any_step(rate):
    liquid = np.array([0.7, -0.2, 0.1])
    solids = scene([0, 0, 0], [-5, 3, 8], drag_rate=rate, liquid_velocity=liquid).solids()
    solids.advance(1.0, 100)
    np.testing.assert_allclose(solids.velocity, [liquid], rtol=1e-12)
    before = solids.position
    solids.advance(1.0, 100)
    np.testing.assert_allclose(solids.position - before, [100 * liquid], rtol=1e-11)


def test_in_stiff_drag_gravity_gives_just_the_settling_velocity():
    solids = scene(
        [0, 0, 0], drag_rate=1e6, liquid_velocity=0.0, acceleration=[0, 0, -9.81]
    ).solids()
    solids.advance(1e-2, 50)
    np.testing.assert_allclose(solids.velocity, [[0, 0, -9.81e-6]], rtol=1e-12)


def test_a_solid_relaxes_to_the_liquid_without_overshoot():
    solids = scene([0, 0, 0], [1, 0, 0], drag_rate=10.0, liquid_velocity=0.0).solids()
    speeds = [1.0]
    for _ in range(2000):
        solids.advance(1e-3, 1)
        speeds.append(solids.velocity[0, 0])
    assert all(0 < after < before for before, after in pairwise(speeds))
    # exp(-k t) to first order in the step
    assert speeds[100] == pytest.approx(np.exp(-1), rel=0.01)
    # and v falls by k times the way that was made
    assert 1 - speeds[-1] == pytest.approx(10 * solids.position[0, 0], rel=0.01)


def test_without_drag_a_liquid_is_not_felt():
    dry = in_a_pipe(9)
    wet = dry.with_(drag_rate=np.zeros(16), liquid_velocity=np.ones((16, 3)))
    one, other = dry.solids(), wet.solids()
    one.advance(STEP, 300)
    other.advance(STEP, 300)
    np.testing.assert_allclose(other.velocity, one.velocity, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(other.drag_impulse, 0)


# --- laps ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("speed", [3.7, -3.7, 200.0, -200.0])
def test_laps_are_counted_forwards_and_backwards(speed):
    period = 0.5
    velocity = np.array([[speed, 0, 0], [speed * 0.3, 0, 0], [-speed, 0, 0]])
    start = scene([[0.1, 0, 0], [0.2, 1, 0], [0.3, 2, 0]], velocity, period=period)
    solids = start.solids()
    for k in range(1, 200):
        solids.advance(1e-3, 7)
        assert np.all((solids.position[:, 0] >= 0) & (solids.position[:, 0] < period))
        expected = start.position + velocity * 7e-3 * k
        np.testing.assert_allclose(unwrapped(solids, period), expected, rtol=1e-12)


def test_laps_of_the_start_count_too():
    solids = scene([[-0.1, 0, 0], [1.3, 1, 0], [0.2, 2, 0]], period=0.5).solids()
    assert solids.laps.tolist() == [-1, 2, 0]
    np.testing.assert_allclose(solids.position[:, 0], [0.4, 0.3, 0.2])


def test_without_a_period_nothing_laps():
    solids = scene([0, 0, 0], [1e3, 0, 0]).solids()
    solids.advance(1e-2, 100)
    assert solids.laps.tolist() == [0]
    assert solids.position[0, 0] == pytest.approx(1e3)


# --- threads, lists, states ---------------------------------------------------------------------


def test_results_do_not_depend_on_the_number_of_threads():
    start = big_packing(acceleration=np.tile(GRAVITY, (4104, 1)), walls=[Flat(point=(0, 0, -0.01))])
    one = start.solids(1)
    reports = [one.advance(STEP, 40)]
    for threads in (2, 3):
        other = start.solids(threads)
        reports.append(other.advance(STEP, 40))
        assert_equal_bits(one, other)
    assert len({(r.largest_overlap, r.prunes, r.sorts) for r in reports}) == 1
    assert reports[0].sorts > 0


def test_few_solids_do_not_depend_on_the_number_of_threads():
    one, other = in_a_pipe(1).solids(1), in_a_pipe(1).solids(3)
    one.advance(STEP, 300)
    other.advance(STEP, 300)
    assert_equal_bits(one, other)


@pytest.mark.parametrize("n", [1, 7, 8, 9, 17])
def test_solids_that_keep_their_places_need_no_new_lists(n):
    solids = scene(block((n, 1, 1), 0.05, np.random.default_rng(0)), [3.0, 0, 0]).solids()
    report = solids.advance(STEP, 1000)
    assert report.prunes == report.sorts == 0


def test_rows_stay_in_the_callers_order():
    rng = np.random.default_rng(10)
    position = rng.permutation(block((5, 5, 5), 0.05, rng))
    radius = rng.uniform(0.001, 0.02, len(position))
    solids = scene(position, position * 2, position * 3, radius, 1000 + position[:, 0]).solids()
    assert len(solids) == len(position)
    np.testing.assert_array_equal(solids.position, position)
    np.testing.assert_array_equal(solids.velocity, position * 2)
    np.testing.assert_allclose(solids.spin, position * 3, rtol=1e-15)
    np.testing.assert_array_equal(solids.radius, radius)
    volume = 4 / 3 * np.pi * radius**3
    np.testing.assert_allclose(solids.mass, (1000 + position[:, 0]) * volume, rtol=1e-14)


def test_energies_are_those_of_rigid_spheres_and_springs():
    solids = scene([[0, 0, 0], [0, 0, 0.019]], [1, 2, 3], [4, 5, 6], pair_law=LINEAR).solids()
    mass = solids.mass.sum()
    assert solids.kinetic_energy == pytest.approx(mass * (14 / 2 + 0.2 * 1e-4 * 77))
    assert solids.elastic_energy == pytest.approx(1e3 / 2 * 0.001**2)


def test_the_report_tells_the_largest_overlap_over_the_smaller_radius():
    solids = scene([[0, 0, 0], [0, 0, 0.0149]], radius=[0.01, 0.005], pair_law=LINEAR).solids()
    assert solids.advance(1e-9, 1).largest_overlap == pytest.approx(0.02, rel=1e-4)
    assert solids.advance(STEP, 10_000).largest_overlap < 0.021
    assert solids.advance(STEP, 1).largest_overlap == 0


def test_advancing_by_no_steps_changes_nothing():
    solids, untouched = in_a_pipe().solids(), in_a_pipe().solids()
    assert solids.advance(STEP, 0).finite
    assert_equal_bits(solids, untouched)


@pytest.mark.parametrize("big", [False, True])
def test_a_restored_state_goes_on_bit_equal(big):
    start = big_packing() if big else in_a_pipe(rolling_friction=0.1)
    solids = start.solids()
    solids.advance(STEP, 37)
    state = solids.state()
    restored = start.solids()
    restored.restore(state)
    assert_equal_bits(restored, solids)
    for _ in range(20):
        report, restored_report = solids.advance(STEP, 1), restored.advance(STEP, 1)
        assert restored_report.prunes == report.prunes
        assert restored_report.sorts == report.sorts
    assert_equal_bits(restored, solids)
    solids.restore(state)
    for _ in range(20):
        solids.advance(STEP, 1)
    assert_equal_bits(restored, solids)


def foreign_states():
    start = in_a_pipe()
    rows = {name: getattr(start, name) for name in ROWS}
    forcing = {"acceleration": None}
    yield "fewer", start.with_(**{name: v[:-1] for name, v in rows.items()}, **forcing)
    yield "larger", start.with_(radius=start.radius * 1.01)
    yield "heavier", start.with_(density=start.density * 2)
    yield "another order", start.with_(**{name: v[::-1].copy() for name, v in rows.items()})
    yield "fewer walls", start.with_(walls=start.walls[:1])
    yield "longer", start.with_(period=start.period * 2)


@pytest.mark.parametrize(
    "foreign", [f for _, f in foreign_states()], ids=[name for name, _ in foreign_states()]
)
def test_the_state_of_other_solids_is_refused_and_nothing_is_changed(foreign):
    state = foreign.solids().state()
    solids, untouched = in_a_pipe().solids(), in_a_pipe().solids()
    with pytest.raises(ValueError, match="restore: the snapshot belongs to another population"):
        solids.restore(state)
    solids.advance(STEP, 50)
    untouched.advance(STEP, 50)
    assert_equal_bits(solids, untouched)


def damages():
    rng = np.random.default_rng(11)
    for name in ("reals", "integers"):
        yield f"{name} cut short", name, lambda a: a[:-1]
        yield f"{name} empty", name, lambda a: a[:0]
        yield f"{name} too long", name, lambda a: np.append(a, a[-1])
        for where in rng.random(6):

            def flip(a, where=where):
                damaged = a.copy()
                bits = damaged.view(np.uint64)
                bits[int(where * len(a))] ^= np.uint64(1 << int(where * 1e6) % 64)
                return damaged

            yield f"{name} bit at {where:.3f}", name, flip


@pytest.mark.parametrize(
    ("name", "damage"), [d[1:] for d in damages()], ids=[d[0] for d in damages()]
)
def test_a_damaged_state_is_refused_and_nothing_is_changed(name, damage):
    solids, untouched = in_a_pipe().solids(), in_a_pipe().solids()
    state = solids.state()
    with pytest.raises(ValueError, match="restore: the snapshot is damaged"):
        solids.restore(state | {name: damage(state[name])})
    solids.advance(STEP, 50)
    untouched.advance(STEP, 50)
    assert_equal_bits(solids, untouched)


# --- what goes wrong ----------------------------------------------------------------------------


@pytest.mark.parametrize("period", [0.0, 0.5])
@pytest.mark.parametrize("value", [1e153, 1e100, 1e30])
def test_a_monstrous_velocity_ends_in_a_report_not_in_a_crash(value, period):
    solids = scene(
        block((3, 3, 3), 0.05, np.random.default_rng(0)),
        np.linspace(-1, 1, 81).reshape(27, 3) * value,
        period=period,
        walls=[Bore(radius=1.0), Flat(point=(0, 0, -1))],
    ).solids()
    reports = [solids.advance(STEP, 20) for _ in range(3)]
    assert not reports[-1].finite
    for name in ("position", "velocity", "spin", "laps", "kinetic_energy"):
        getattr(solids, name)
    solids.contacts()


def test_a_stiffness_far_beyond_the_step_is_reported():
    law = dem.LinearSpring(
        normal_stiffness=1e12,
        tangential_stiffness=1e12,
        normal_damping=1e6,
        tangential_damping=1e6,
        friction=1.0,
    )
    walls = [Flat(), Flat(point=(0, 0, 0.1), normal=(0, 0, -1))]
    solids = scene([0, 0, 0.05], [1, 0, 1], wall_law=law, walls=walls).solids()
    assert not all(solids.advance(1.0, 1000).finite for _ in range(5))


@pytest.mark.parametrize("name", ["acceleration", "liquid_velocity", "drag_rate"])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_forcing_that_is_not_finite_is_reported(name, value):
    start = in_a_pipe(2, drag_rate=np.ones(16), liquid_velocity=np.zeros((16, 3)))
    forcing = getattr(start, name).copy()
    forcing.flat[5] = value
    solids = start.with_(**{name: forcing}).solids()
    assert not solids.advance(STEP, 300).finite


def test_a_step_that_is_infinite_is_reported():
    assert not in_a_pipe().solids().advance(np.inf, 3).finite


@pytest.mark.parametrize("distance", [1e9, 1e30, 1e150])
def test_a_solid_flung_far_away_costs_neither_memory_nor_the_others(distance):
    rng = np.random.default_rng(12)
    near = block((6, 6, 6), 0.0199, rng)
    solids = scene(np.vstack([near, [[0, distance, -distance]]]), pair_law=LINEAR).solids()
    alone = scene(near, pair_law=LINEAR).solids()
    assert solids.advance(STEP, 500).finite
    alone.advance(STEP, 500)
    np.testing.assert_allclose(solids.velocity[:-1], alone.velocity, rtol=0, atol=1e-10)
    np.testing.assert_array_equal(solids.position[-1], [0, distance, -distance])


@pytest.mark.parametrize(
    ("name", "value"),
    [
        *[("radius", [0.01, v]) for v in (0.0, -1.0, np.nan, np.inf)],
        *[("density", [2500.0, v]) for v in (0.0, -1.0, np.nan, np.inf)],
        *[(name, [[0, 0, 0], [1, v, 0]]) for name in ROWS[:3] for v in (np.nan, np.inf, 1e300)],
        *[("period", v) for v in (-1.0, np.nan, np.inf, 0.0399)],
        ("walls", [Bore(radius=0.01)]),
        ("walls", [Flat(), Bore(radius=0.005)]),
    ],
)
def test_a_bad_field_is_refused_by_its_name(name, value):
    start = scene([[0, 0, 0], [1, 0, 0]], radius=0.01)
    value = np.array(value) if name in ROWS else value
    with pytest.raises(ValueError, match="radius" if name == "walls" else name):
        start.with_(**{name: value}).solids()


def test_no_thread_at_all_is_refused():
    for threads in (0, -1):
        with pytest.raises(ValueError, match="threads must be >= 1"):
            scene([0, 0, 0]).solids(threads)


def test_no_solid_at_all_is_refused():
    with pytest.raises(ValueError, match="at least one solid"):
        scene(np.zeros((0, 3))).solids()


@pytest.mark.parametrize("name", ROWS)
def test_rows_of_another_number_or_shape_are_refused(name):
    start = scene([[0, 0, 0], [1, 0, 0]])
    rows = getattr(start, name)
    for wrong in (rows[:1], rows.reshape(-1, 1), np.float64(1.0)):
        with pytest.raises(ValueError, match=name):
            start.with_(**{name: np.array(wrong)}).solids()


def test_no_law_at_all_is_refused():
    for name in ("pair_law", "wall_law"):
        with pytest.raises(ValueError, match="law must not be None"):
            scene([0, 0, 0]).with_(**{name: None}).solids()


@pytest.mark.parametrize(
    ("forcing", "message"),
    [
        ({"acceleration": np.zeros((2, 3))}, "acceleration"),
        ({"acceleration": np.zeros(3)}, "acceleration"),
        ({"liquid_velocity": np.zeros((3, 3))}, "drag_rate"),
        ({"drag_rate": np.zeros(3)}, "liquid_velocity"),
        ({"drag_rate": np.zeros(2), "liquid_velocity": np.zeros((2, 3))}, "drag_rate"),
        ({"drag_rate": np.array([0, -1.0, 0]), "liquid_velocity": np.zeros((3, 3))}, "drag_rate"),
    ],
)
def test_bad_forcing_is_refused_by_its_name(forcing, message):
    solids = scene([[0, 0, 0], [1, 0, 0], [2, 0, 0]]).solids()
    with pytest.raises(ValueError, match=message):
        solids.set_forcing(**({"acceleration": np.zeros((3, 3))} | forcing))


@pytest.mark.parametrize("dt", [0.0, -1e-3, np.nan])
def test_a_step_that_is_not_positive_is_refused(dt):
    with pytest.raises(ValueError, match="dt must be > 0"):
        scene([0, 0, 0]).solids().advance(dt, 1)


def test_steps_cannot_be_negative():
    with pytest.raises(TypeError):
        scene([0, 0, 0]).solids().advance(1e-3, -1)
