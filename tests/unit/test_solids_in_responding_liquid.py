"""A liquid that responds to the solids within their steps: one equation for both, exact books."""

import numpy as np
import pytest

from slow_dem import LINEAR, STEP, Flat, scene, sheared_packing

GRAVITY = np.array([2.0, 0.0, -9.81])


def respond(solids, *, drag_rate, relaxation, liquid_velocity=0.0, acceleration=0.0, drive=0.0):
    """Set the forcing from whatever broadcasts to rows of solids; `drive` is the liquid's b."""
    n = len(solids)
    solids.set_forcing(
        acceleration=np.broadcast_to(np.asarray(acceleration, dtype=float), (n, 3)),
        liquid_velocity=np.broadcast_to(np.asarray(liquid_velocity, dtype=float), (n, 3)),
        drag_rate=np.broadcast_to(np.asarray(drag_rate, dtype=float), n),
        liquid_acceleration=np.broadcast_to(np.asarray(drive, dtype=float), (n, 3)),
        relaxation=np.broadcast_to(np.asarray(relaxation, dtype=float), n),
    )
    return solids


def apart(rng, n=5):
    """Solids that never meet."""
    position = np.column_stack([np.zeros(n), np.arange(n), np.zeros(n)])
    return scene(position, rng.normal(size=(n, 3)), density=rng.uniform(500, 8000, n))


def kicks(dt, steps):
    return [dt / 2, *[dt] * (steps - 1), dt / 2]


# --- against what is known ----------------------------------------------------------------------


def relaxed(v, u, *, a, b, k, relaxation, time):
    """Exact velocities of solid and liquid after `time`: their slip is a single decay."""
    rate = k + relaxation
    drift = (b - a) / rate
    slip = drift + (u - v - drift) * np.exp(-rate * time)
    way = drift * time + (u - v - drift) * -np.expm1(-rate * time) / rate
    v = v + a * time + k * way
    return v, v + slip


def test_solid_and_liquid_relax_as_the_exact_solution_to_first_order_in_the_step():
    v, u = np.array([1.0, -2.0, 0.5]), np.array([-0.5, 0.3, 0.7])
    a, b, k, relaxation, time = GRAVITY, np.array([1.0, 4.0, -3.0]), 7.0, 3.0, 0.1
    exact = np.concatenate(relaxed(v, u, a=a, b=b, k=k, relaxation=relaxation, time=time))
    errors = []
    for steps in (10, 20, 40, 80, 160):
        solids = scene([0, 0, 0], v).solids()
        respond(
            solids, drag_rate=k, relaxation=relaxation, liquid_velocity=u, acceleration=a, drive=b
        )
        solids.advance(time / steps, steps)
        got = np.concatenate([solids.velocity[0], solids.liquid_velocity[0]])
        errors.append(abs(got - exact).max())
    assert errors[0] < 0.05
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(orders, 1, atol=0.07)


@pytest.mark.parametrize("relaxation", [0.01, 1.0, 100.0, 1e4])
@pytest.mark.parametrize("rate", [0.01, 1.0, 100.0, 1e4])
def test_at_any_step_the_slip_falls_without_overshoot_to_what_momentum_leaves(rate, relaxation):
    """Rates in units of the step; the common velocity is the mean by inertia."""
    solids = respond(
        scene([0, 0, 0], [1.0, 0, 0]).solids(),
        drag_rate=rate,
        relaxation=relaxation,
        liquid_velocity=[-1.0, 0, 0],
    )
    slip = 2.0
    for _ in range(50):
        solids.advance(1.0, 1)
        v, u = solids.velocity[0, 0], solids.liquid_velocity[0, 0]
        # half kicks at both ends, the roughest: each multiplies the slip by 1 / (1 + rate / 2)
        expected = slip / (1 + (rate + relaxation) / 2) ** 2
        assert v - u == pytest.approx(expected, rel=1e-9, abs=1e-15)
        slip = v - u
    if rate + relaxation >= 1:
        common = (relaxation * 1.0 + rate * -1.0) / (rate + relaxation)
        assert v == pytest.approx(common, abs=1e-12)
        assert u == pytest.approx(common, abs=1e-12)


def test_each_kick_solves_both_equations_at_once():
    """Replay with a 2x2 solver: velocities, the impulse of drag and the mean velocity."""
    rng = np.random.default_rng(0)
    start = apart(rng)
    n = len(start.position)
    k, relaxation = 10 ** rng.uniform(-1, 5, n), 10 ** rng.uniform(-1, 5, n)
    a, b, u = rng.normal(size=(3, n, 3))
    solids = respond(
        start.solids(),
        drag_rate=k,
        relaxation=relaxation,
        liquid_velocity=u,
        acceleration=a,
        drive=b,
    )
    solids.advance(1e-3, 30)
    v, impulse, way = start.velocity.copy(), np.zeros((n, 3)), np.zeros((n, 3))
    for dt in kicks(1e-3, 30):
        for i in range(n):
            both = [[1 + dt * k[i], -dt * k[i]], [-dt * relaxation[i], 1 + dt * relaxation[i]]]
            v[i], u[i] = np.linalg.solve(both, [v[i] + dt * a[i], u[i] + dt * b[i]])
        impulse += dt * (k * start.mass)[:, None] * (u - v)
        way += dt * v
    np.testing.assert_allclose(solids.velocity, v, rtol=1e-11)
    np.testing.assert_allclose(solids.liquid_velocity, u, rtol=1e-11)
    np.testing.assert_allclose(solids.mean_velocity, way / 0.03, rtol=1e-11)
    np.testing.assert_allclose(solids.drag_impulse, impulse, rtol=1e-8, atol=1e-14)


def test_a_solid_held_by_a_wall_lets_the_liquid_settle_at_drive_over_relaxation():
    law = {"wall_law": LINEAR, "walls": [Flat()]}
    solids = respond(
        scene([0, 0, 0.0098], **law).solids(),
        drag_rate=50.0,
        relaxation=200.0,
        acceleration=[0, 0, -30.0],
        drive=[0, 0, 20.0],
    )
    solids.advance(STEP, 20_000)
    np.testing.assert_allclose(solids.velocity, 0, atol=1e-12)
    np.testing.assert_allclose(solids.liquid_velocity, [[0, 0, 20.0 / 200.0]], atol=1e-12)


def test_without_relaxation_and_drive_the_liquid_goes_its_way_as_if_it_did_not_respond():
    rng = np.random.default_rng(1)
    start = apart(rng).with_(
        acceleration=np.tile(GRAVITY, (5, 1)),
        drag_rate=rng.uniform(0, 1e4, 5),
        liquid_velocity=rng.normal(size=(5, 3)),
    )
    plain = start.solids()
    solids = respond(
        start.solids(),
        drag_rate=start.drag_rate,
        relaxation=0.0,
        liquid_velocity=start.liquid_velocity,
        acceleration=GRAVITY,
    )
    for one in (plain, solids):
        one.advance(1e-3, 100)
    np.testing.assert_array_equal(solids.liquid_velocity, start.liquid_velocity)
    np.testing.assert_allclose(solids.velocity, plain.velocity, rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(solids.mean_velocity, plain.mean_velocity, rtol=1e-12)
    np.testing.assert_allclose(solids.drag_impulse, plain.drag_impulse, rtol=1e-9, atol=1e-14)


# --- books of momentum --------------------------------------------------------------------------


@pytest.mark.parametrize("scale", [1e-2, 1.0, 1e2, 1e4, 1e8])
def test_solid_and_liquid_keep_their_momentum_to_round_off(scale):
    rng = np.random.default_rng(2)
    start = apart(rng)
    k, relaxation = scale * rng.uniform(0.1, 10, 5), scale * rng.uniform(0.1, 10, 5)
    inertia = (k * start.mass / relaxation)[:, None]
    u = rng.normal(size=(5, 3))
    solids = respond(start.solids(), drag_rate=k, relaxation=relaxation, liquid_velocity=u)
    solids.advance(1.0, 5)
    mass = solids.mass[:, None]
    before = mass * start.velocity + inertia * u
    after = mass * solids.velocity + inertia * solids.liquid_velocity
    size = abs(mass * start.velocity) + abs(inertia * u)
    assert (abs(after - before) <= 1e-14 * size).all()
    gain = mass * (solids.velocity - start.velocity)
    assert (abs(solids.drag_impulse - gain) <= 1e-14 * size).all()


@pytest.mark.parametrize("threads", [1, 2])
def test_a_touching_packing_accounts_for_all_momentum(threads):
    """Contacts, a wall, gravity and a liquid that is driven: the impulse of drag closes both."""
    rng = np.random.default_rng(3)
    start = sheared_packing(
        rng, (13, 13, 26), pair_law=LINEAR, wall_law=LINEAR, walls=[Flat(point=(0, 0, -0.0095))]
    )
    n = len(start.position)
    assert n > 4096  # more than one block
    k, relaxation = rng.uniform(1, 3000, n), rng.uniform(1, 3000, n)
    u, b = rng.normal(size=(n, 3)), rng.normal(size=(n, 3))
    solids = respond(
        start.solids(threads),
        drag_rate=k,
        relaxation=relaxation,
        liquid_velocity=u,
        acceleration=GRAVITY,
        drive=b,
    )
    solids.advance(STEP, 25)
    time, mass = 25 * STEP, solids.mass[:, None]
    drag = solids.drag_impulse
    size = abs(mass * start.velocity).sum()
    gain = (mass * (solids.velocity - start.velocity)).sum(axis=0)
    expected = mass.sum() * GRAVITY * time + solids.wall_impulse + drag.sum(axis=0)
    np.testing.assert_allclose(gain, expected, rtol=0, atol=1e-12 * size)
    inertia = (k / relaxation)[:, None] * mass
    np.testing.assert_allclose(
        inertia * (solids.liquid_velocity - u - time * b), -drag, rtol=1e-10, atol=1e-12 * size
    )


def test_forcing_anew_starts_the_sums_anew_and_takes_the_liquid_given():
    rng = np.random.default_rng(4)
    solids = respond(apart(rng).solids(), drag_rate=30.0, relaxation=5.0, drive=1.0)
    solids.advance(1e-3, 10)
    assert abs(solids.drag_impulse).min() > 0
    respond(solids, drag_rate=30.0, relaxation=5.0, liquid_velocity=[1, 2, 3])
    np.testing.assert_array_equal(solids.drag_impulse, 0)
    np.testing.assert_array_equal(solids.liquid_velocity, np.tile([1.0, 2, 3], (5, 1)))
    np.testing.assert_array_equal(solids.mean_velocity, solids.velocity)


# --- threads, states, refusals ------------------------------------------------------------------


def moving_block():
    """Two blocks of solids that leave their places fast, so that they are sorted often."""
    return sheared_packing(
        np.random.default_rng(5), (18, 18, 13), period=18 * 0.0196, pair_law=LINEAR, speed=20.0
    )


def forced(solids, seed):
    rng = np.random.default_rng(seed)
    n = len(solids)
    return respond(
        solids,
        drag_rate=rng.uniform(0, 100, n),
        relaxation=rng.uniform(0, 100, n),
        liquid_velocity=rng.normal(size=(n, 3)),
        acceleration=rng.normal(size=(n, 3)),
        drive=rng.normal(size=(n, 3)),
    )


def bits(solids):
    names = ("position", "velocity", "spin", "drag_impulse", "mean_velocity", "liquid_velocity")
    return {name: getattr(solids, name).tobytes() for name in names}


def test_the_liquid_at_each_solid_does_not_depend_on_the_number_of_threads():
    start = moving_block()
    one, other = forced(start.solids(1), 6), forced(start.solids(3), 6)
    assert one.advance(STEP, 30).sorts == other.advance(STEP, 30).sorts > 1
    assert bits(one) == bits(other)


def test_a_restored_state_goes_on_bit_equal_under_the_forcing_that_is_set():
    start = moving_block()
    solids = forced(start.solids(), 7)
    assert solids.advance(STEP, 20).sorts > 0
    state = solids.state()
    forced(solids, 8)
    after, before = start.solids(), forced(start.solids(), 8)
    after.restore(state)
    forced(after, 8)
    before.restore(state)  # its forcing stays with its solids, wherever they stand in the state
    assert bits(before) == bits(after) == bits(solids)
    for one in (solids, after, before):
        one.advance(STEP, 20)
    assert bits(before) == bits(after) == bits(solids)


N3, N = np.zeros((2, 3)), np.zeros(2)


@pytest.mark.parametrize(
    ("response", "message"),
    [
        ({"relaxation": N}, "liquid_acceleration"),
        ({"liquid_acceleration": N3}, "relaxation"),
        ({"liquid_acceleration": N3, "relaxation": np.zeros(3)}, "relaxation"),
        ({"liquid_acceleration": np.zeros((3, 3)), "relaxation": N}, "liquid_acceleration"),
        ({"liquid_acceleration": N3, "relaxation": np.array([1, -1.0])}, "relaxation must be >= 0"),
    ],
)
def test_a_bad_response_is_refused_by_its_name_and_changes_nothing(response, message):
    solids = respond(scene([[0, 0, 0], [1, 0, 0]]).solids(), drag_rate=1.0, relaxation=2.0, drive=1)
    solids.advance(1e-3, 5)
    before = bits(solids)
    with pytest.raises(ValueError, match=message):
        solids.set_forcing(acceleration=N3, liquid_velocity=N3, drag_rate=N, **response)
    assert bits(solids) == before


def test_a_response_without_drag_is_refused():
    solids = scene([0, 0, 0]).solids()
    with pytest.raises(ValueError, match="drag_rate"):
        solids.set_forcing(acceleration=N3[:1], liquid_acceleration=N3[:1], relaxation=N[:1])


@pytest.mark.parametrize("name", ["mean_velocity", "liquid_velocity"])
def test_a_liquid_that_is_not_there_has_no_velocity(name):
    with pytest.raises(ValueError, match=name):
        getattr(scene([0, 0, 0]).solids(), name)


@pytest.mark.parametrize("name", ["drag_rate", "relaxation", "liquid_velocity", "drive"])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_response_that_is_not_finite_is_reported(name, value):
    forcing = {"drag_rate": 1.0, "relaxation": 1.0, "liquid_velocity": 0.0, "drive": 0.0}
    solids = respond(scene([0, 0, 0], [1, 0, 0]).solids(), **forcing | {name: value})
    assert not solids.advance(STEP, 3).finite
