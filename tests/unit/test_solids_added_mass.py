"""Added mass: what inviscid theory says, the transient of a settling sphere, exact books."""

import numpy as np
import pytest

from slow_dem import LINEAR, STEP, Flat, scene, sheared_packing

G = 9.81
RATIOS = [0.5, 1.0, 1.05, 10.0]  # of densities, solid over liquid
COEFFICIENT = 0.5  # of a sphere


def submerge(solids, *, added_mass, drag_rate=0.0, liquid_velocity=0.0, acceleration=0.0, **rest):
    """Set the forcing from whatever broadcasts; `drive` and `relaxation` if the liquid responds."""
    n = len(solids)

    def rows(values, *shape):
        return np.broadcast_to(np.asarray(values, dtype=float), (n, *shape))

    response = {}
    if rest:
        response = {
            "liquid_acceleration": rows(rest.get("drive", 0.0), 3),
            "relaxation": rows(rest.get("relaxation", 0.0)),
        }
    solids.set_forcing(
        acceleration=rows(acceleration, 3),
        liquid_velocity=rows(liquid_velocity, 3),
        drag_rate=rows(drag_rate),
        added_mass=added_mass,
        **response,
    )
    return solids


# --- against what is known ----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("added_mass", "published"),
    [
        (0.0, [0.05690, 0.10678, 0.20422, 0.25638, 0.26734]),
        (0.5 * 998.2 / 2500, [0.04783, 0.09112, 0.18445, 0.24739, 0.26661]),
    ],
)
def test_a_glass_sphere_in_water_gains_speed_as_it_must(added_mass, published):
    """2 mm, drag of Schiller and Naumann made anew every five steps; times in seconds.

    The speeds are those of an integration of high order of the same equation.
    """
    diameter, density, liquid, viscosity = 2e-3, 2500.0, 998.2, 1.004e-6
    solids = scene([0, 0, 0], radius=diameter / 2, density=density).solids()
    dt, k, speeds = 2e-5, 5, {}
    times = [0.01, 0.02, 0.05, 0.1, 0.2]
    for step in range(round(times[-1] / dt) // k):
        reynolds = abs(solids.velocity[0, 2]) * diameter / viscosity
        stokes = 18 * viscosity * liquid / (density * diameter**2)
        submerge(
            solids,
            added_mass=added_mass,
            drag_rate=stokes * (1 + 0.15 * reynolds**0.687),
            acceleration=[0, 0, -G * (1 - liquid / density)],
        )
        solids.advance(dt, k)
        speeds[round((step + 1) * k * dt, 9)] = -solids.velocity[0, 2]
    np.testing.assert_allclose([speeds[t] for t in times], published, rtol=3e-4)


@pytest.mark.parametrize("ratio", [1e-3, *RATIOS])
def test_in_an_inviscid_liquid_that_accelerates_a_sphere_goes_as_theory_has_it(ratio):
    """dv/dt over du/dt is 3 / (1 + 2 ratio): a bubble goes ahead threefold (Batchelor 1967)."""
    solids = scene([0, 0, 0], density=1000 * ratio).solids()
    b = np.array([1.0, -2.0, 3.0])
    submerge(solids, added_mass=COEFFICIENT / ratio, acceleration=b / ratio, drive=b)
    solids.advance(1e-2, 100)
    np.testing.assert_allclose(solids.velocity, [3 / (1 + 2 * ratio) * b], rtol=1e-10)
    np.testing.assert_allclose(solids.liquid_velocity, [b], rtol=1e-12)


def exact(v, u, *, a, b, k, relaxation, added_mass, time):
    """Velocities after `time`: the slip s obeys (1 + (1 + L/k) c) s' = b - a - (k + L) s."""
    drift = (b - a) / (k + relaxation)
    rate = (k + relaxation) / (1 + (1 + relaxation / k) * added_mass)
    slip = drift + (u - v - drift) * np.exp(-rate * time)
    way = drift * time + (u - v - drift) * -np.expm1(-rate * time) / rate
    v = v + a * time + k * way + added_mass * (slip - (u - v))
    return np.concatenate([v, v + slip])


@pytest.mark.parametrize("ratio", RATIOS)
def test_solid_and_liquid_relax_as_the_exact_solution_to_first_order_in_the_step(ratio):
    v, u = np.array([1.0, -2.0, 0.5]), np.array([-0.5, 0.3, 0.7])
    forcing = {"k": 7.0, "relaxation": 13.0, "added_mass": COEFFICIENT / ratio}
    a, b = np.array([2.0, 0.0, -G]), np.array([1.0, 4.0, -3.0])
    expected = exact(v, u, a=a, b=b, time=0.1, **forcing)
    errors = []
    for steps in (20, 40, 80, 160):
        solids = submerge(
            scene([0, 0, 0], v).solids(),
            added_mass=forcing["added_mass"],
            drag_rate=forcing["k"],
            relaxation=forcing["relaxation"],
            liquid_velocity=u,
            acceleration=a,
            drive=b,
        )
        solids.advance(0.1 / steps, steps)
        got = np.concatenate([solids.velocity[0], solids.liquid_velocity[0]])
        errors.append(abs(got - expected).max())
    assert errors[0] < 0.05
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 1, atol=0.07)


def test_without_drag_a_solid_moves_as_one_that_is_heavier():
    """Bounces included: of the wall's impulse a part goes to the liquid."""
    law = {"wall_law": LINEAR, "pair_law": LINEAR, "walls": [Flat()]}
    position, velocity = [[0, 0, 0.011], [0, 0, 0.033]], [[0, 0, -0.5], [0, 0, -0.2]]
    c = 0.4
    heavier = scene(position, velocity, density=2500 * (1 + c), **law, acceleration=[0, 0, -5.0])
    heavier = heavier.solids()
    solids = scene(position, velocity, **law).solids()
    submerge(solids, added_mass=c, acceleration=[0, 0, -5.0 * (1 + c)])
    for one in (heavier, solids):
        one.advance(STEP / 10, 5000)
    assert heavier.wall_impulse[2] > 0.01
    np.testing.assert_allclose(solids.velocity, heavier.velocity, rtol=1e-9)
    np.testing.assert_allclose(solids.position, heavier.position, rtol=1e-10)
    np.testing.assert_allclose(solids.wall_impulse, heavier.wall_impulse, rtol=1e-9)
    taken = -c * solids.mass[:, None] * (solids.velocity - velocity)
    np.testing.assert_allclose(solids.drag_impulse, taken, rtol=1e-9, atol=1e-15)


def test_no_added_mass_is_the_same_as_none_to_the_bit():
    rng = np.random.default_rng(0)
    start = sheared_packing(rng, pair_law=LINEAR)
    n = len(start.position)
    forcing = {
        "drag_rate": rng.uniform(0, 100, n),
        "relaxation": rng.uniform(0, 100, n),
        "liquid_velocity": rng.normal(size=(n, 3)),
    }
    zero, zeros = start.solids(), start.solids()
    submerge(zero, added_mass=0.0, **forcing)
    submerge(zeros, added_mass=np.zeros(n), **forcing)
    for one in (zero, zeros):
        one.advance(STEP, 100)
    for name in ("position", "velocity", "spin", "drag_impulse", "liquid_velocity"):
        assert getattr(zero, name).tobytes() == getattr(zeros, name).tobytes()


# --- stability and books ------------------------------------------------------------------------


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("load", [0.0, 1.0, 100.0])
@pytest.mark.parametrize("rate", [1e-3, 1.0, 1e3])
def test_at_any_step_the_slip_falls_without_overshoot_and_momentum_stays(ratio, load, rate):
    """Rates in units of the step; `load` is the solid's mass over the liquid's inertia."""
    solids = scene([0, 0, 0], [1.0, 2.0, 3.0], density=1000 * ratio).solids()
    submerge(
        solids,
        added_mass=COEFFICIENT / ratio,
        drag_rate=rate,
        relaxation=load * rate,
        liquid_velocity=[-1.0, 0, 1.0],
    )
    slip, momentum = np.array([-2.0, -2.0, -2.0]), load * np.array([1.0, 2.0, 3.0]) + [-1.0, 0, 1.0]
    for _ in range(100):
        solids.advance(1.0, 1)
        after = solids.liquid_velocity[0] - solids.velocity[0]
        assert (abs(after) <= abs(slip) + 1e-14).all()
        assert (after * slip >= -1e-14).all()
        slip = after
        now = load * solids.velocity[0] + solids.liquid_velocity[0]
        np.testing.assert_allclose(now, momentum, rtol=0, atol=1e-13 * (1 + load))


@pytest.mark.parametrize("responds", [False, True])
def test_a_touching_packing_accounts_for_all_momentum(responds):
    rng = np.random.default_rng(3)
    start = sheared_packing(
        rng, pair_law=LINEAR, wall_law=LINEAR, walls=[Flat(point=(0, 0, -0.0095))]
    )
    n, gravity, time = len(start.position), np.array([2.0, 0, -G]), 200 * STEP
    k, relaxation = rng.uniform(1, 3000, n), rng.uniform(1, 3000, n) * responds
    u, b = rng.normal(size=(n, 3)), rng.normal(size=(n, 3)) * responds
    response = {"relaxation": relaxation, "drive": b} if responds else {}
    solids = submerge(
        start.solids(),
        added_mass=rng.uniform(0, 1, n),
        drag_rate=k,
        liquid_velocity=u,
        acceleration=gravity,
        **response,
    )
    solids.advance(STEP, 200)
    mass, given = solids.mass[:, None], solids.drag_impulse
    size = abs(mass * start.velocity).sum()
    gain = (mass * (solids.velocity - start.velocity)).sum(axis=0)
    expected = mass.sum() * gravity * time + solids.wall_impulse + given.sum(axis=0)
    np.testing.assert_allclose(gain, expected, rtol=0, atol=1e-12 * size)
    taken = k[:, None] * mass * (solids.liquid_velocity - u - time * b)  # times 1 / relaxation
    np.testing.assert_allclose(
        taken, -relaxation[:, None] * given, rtol=1e-10, atol=1e-12 * size * 3000
    )


# --- refusals -----------------------------------------------------------------------------------


@pytest.mark.parametrize("added_mass", [-0.1, np.array([0.1, -0.1]), np.zeros(3), np.zeros((2, 1))])
def test_a_bad_added_mass_is_refused_by_its_name(added_mass):
    solids = scene([[0, 0, 0], [1, 0, 0]]).solids()
    with pytest.raises(ValueError, match="added_mass"):
        submerge(solids, added_mass=added_mass)


def test_added_mass_without_a_liquid_is_refused():
    with pytest.raises(ValueError, match=r"added_mass .* comes with drag_rate"):
        scene([0, 0, 0]).solids().set_forcing(acceleration=np.zeros((1, 3)), added_mass=0.5)


def test_added_mass_that_is_not_finite_is_reported():
    solids = submerge(scene([0, 0, 0], [1, 0, 0]).solids(), added_mass=np.nan)
    assert not solids.advance(STEP, 3).finite
