"""Lubrication: one force law, found for every pair and wall within its reach, exact books."""

import numpy as np
import pytest

from mpsdem._core import dem
from slow_dem import LINEAR, STEP, Bore, Flat, SlowSolids, block, scene, unwrapped

RADIUS, DENSITY = 0.01, 2500.0
MASS = DENSITY * 4 / 3 * np.pi * RADIUS**3


def lubricated(start, lubrication, threads=1):
    """The engine's solids of a scene, with lubrication."""
    solids = dem.Solids(
        position=start.position,
        velocity=start.velocity,
        spin=start.spin,
        radius=start.radius,
        density=start.density,
        pair_law=start.pair_law,
        wall_law=start.wall_law,
        walls=[wall.core() for wall in start.walls],
        period=start.period,
        threads=threads,
        lubrication=lubrication,
    )
    if start.acceleration is not None:
        solids.set_forcing(acceleration=start.acceleration)
    return solids


def loose_packing(rng, counts=(4, 3, 3), gap=0.05, speed=0.2, **parts):
    """Solids with gaps of up to `gap` radii and a few overlaps, the upper ones pushed along x."""
    position = block(counts, (2 + gap) * RADIUS, rng, jitter=gap * RADIUS)
    height = position[:, 2] - position[:, 2].mean()
    velocity = rng.uniform(-speed / 4, speed / 4, position.shape)
    velocity[:, 0] += speed * height / abs(height).max()
    spin = rng.uniform(-5, 5, position.shape)
    return scene(position, velocity, spin, RADIUS, DENSITY, pair_law=LINEAR, **parts)


class SlowLubricatedSolids(SlowSolids):
    """The same, every pair, image and wall in every step."""

    def __init__(self, scene, lubrication):
        self.lubrication = lubrication
        super().__init__(scene)

    def find_forces(self, dt):
        super().find_forces(dt)
        s = self.scene
        for image in range(-2, 3) if s.period else (0,):
            d = self.x[:, None] - self.x + [image * s.period, 0, 0]
            distance = np.linalg.norm(d, axis=2)
            near = distance < 5 * s.radius.max()  # far beyond any reach
            for i, j in np.argwhere(np.tril(near, -1)):
                r, n = s.radius[[i, j]], d[i, j] / distance[i, j]
                force = n * self.lubrication.force(
                    gap=distance[i, j] - r.sum(),
                    normal_velocity=(self.v[i] - self.v[j]) @ n,
                    reduced_radius=r.prod() / r.sum(),
                )
                self.force[i] += force
                self.force[j] -= force
        for i in range(len(self.x)):
            for wall in s.walls:
                distance, n = wall.at(self.x[i])
                force = n * self.lubrication.force(
                    gap=distance - s.radius[i],
                    normal_velocity=(self.v[i] - wall.velocity) @ n,
                    reduced_radius=1 / (1 / s.radius[i] + wall.curvature),
                )
                self.force[i] += force
                self.wall_force += force


# --- the force ----------------------------------------------------------------------------------


def test_the_force_is_the_published_one_between_its_bounds_and_nothing_beyond():
    law = dem.Lubrication(viscosity=0.1, least_gap=0.01, cutoff=0.5)
    radius, speed = 2e-3, -0.3

    def force(gap, speed=speed):
        return law.force(gap=gap, normal_velocity=speed, reduced_radius=radius)

    expected = -6 * np.pi * 0.1 * radius**2 * speed * (1 / 1e-4 - 1 / 1e-3)
    assert force(1e-4) == pytest.approx(expected, rel=1e-14)
    assert force(1e-4, -speed) == -force(1e-4)
    assert force(1e-4) > 0  # against the approach
    assert force(1e-6) == force(0.01 * radius) > force(1e-4)
    assert force(0.5 * radius * (1 - 1e-9)) == pytest.approx(0, abs=1e-8 * expected)
    for gap in (0.0, -1e-4, 0.5 * radius, 1.0):
        assert force(gap) == 0


# --- against exact solutions --------------------------------------------------------------------


def speed_at(gap, start_gap, speed, *, factor, radius, law):
    """Integral of dv/dt = -factor v (1/max(h, h_min) - 1/h_c): v falls with the gap."""
    least, cutoff = law["least_gap"] * radius, law["cutoff"] * radius

    def potential(h):
        wide = np.maximum(h, least)
        return np.log(wide) + np.minimum(h - least, 0) / least - h / cutoff

    return speed - factor * (potential(start_gap) - potential(gap))


LAW = {"least_gap": 3e-3, "cutoff": 1.0}


@pytest.mark.parametrize("stokes", [1.5, 3.0, 20.0])
def test_two_spheres_that_near_each_other_slow_down_as_the_exact_solution(stokes):
    """`stokes` is m* v / (6 pi mu R*^2); gaps from the cutoff down to where they stop or touch."""
    reduced_radius, speed = RADIUS / 2, 0.2
    viscosity = MASS / 2 * speed / (6 * np.pi * reduced_radius**2 * stokes)
    law = dem.Lubrication(viscosity=viscosity, **LAW)
    gap = 0.9 * reduced_radius
    start = scene(
        [[0.3, 0.1, 0], [0.3 + 2 * RADIUS + gap, 0.1, 0]],
        [[speed / 2 + 1, 2, 3], [1 - speed / 2, 2, 3]],
        pair_law=LINEAR,
    )
    errors = []
    for dt in (2e-5, 1e-5):
        solids, worst = lubricated(start, law), 0.0
        for _ in range(250):
            solids.advance(dt, round(4e-4 / dt))
            x, v = solids.position, solids.velocity
            now = x[1, 0] - x[0, 0] - 2 * RADIUS
            if now <= 0:
                break
            expected = speed_at(
                now, gap, speed, factor=speed / stokes, radius=reduced_radius, law=LAW
            )
            worst = max(worst, abs(v[0, 0] - v[1, 0] - expected))
            np.testing.assert_array_equal(v[:, 1:], [[2, 3], [2, 3]])
        errors.append(worst / speed)
    assert errors[1] < 2e-3
    assert errors[1] < 0.6 * errors[0]
    assert (now <= 0) == (stokes == 20.0)  # the thick liquid stops them before they touch


@pytest.mark.parametrize("wall", ["plane", "bore"])
def test_a_sphere_that_nears_a_wall_slows_down_as_the_exact_solution(wall):
    bore = 10 * RADIUS
    walls = [Flat()] if wall == "plane" else [Bore(radius=bore)]
    reduced = RADIUS if wall == "plane" else RADIUS / (1 - RADIUS / (2 * bore))
    speed, stokes = 0.2, 10.0
    law = dem.Lubrication(viscosity=MASS * speed / (6 * np.pi * reduced**2 * stokes), **LAW)
    gap = 0.8 * reduced
    height = gap + RADIUS - (0 if wall == "plane" else bore)
    solids = lubricated(scene([0, 0, height], [0, 0, -speed], wall_law=LINEAR, walls=walls), law)
    height, steps = solids.position[0, 2] - gap, 0
    while (now := solids.position[0, 2] - height) > 0:
        expected = speed_at(now, gap, speed, factor=speed / stokes, radius=reduced, law=LAW)
        assert -solids.velocity[0, 2] == pytest.approx(expected, abs=2e-3 * speed)
        solids.advance(1e-5, 10)
        steps += 1
    assert steps > 100
    assert -solids.velocity[0, 2] < 0.6 * speed
    # what the wall gave is all that changed the momentum
    gained = MASS * (solids.velocity[0] - [0, 0, -speed])
    np.testing.assert_allclose(solids.wall_impulse, gained, rtol=1e-12, atol=1e-15)


def test_the_slower_the_impact_the_less_comes_back():
    """Stokes numbers 2/9 rho v R / mu of 5 to 500; a wall without loss returns all when dry."""
    dry = dem.LinearSpring(
        normal_stiffness=1e5,
        tangential_stiffness=0,
        normal_damping=0,
        tangential_damping=0,
        friction=0,
    )
    returned = []
    for stokes in (5.0, 20.0, 100.0, 500.0):
        speed = 0.5
        viscosity = 2 / 9 * DENSITY * speed * RADIUS / stokes
        solids = lubricated(
            scene([0, 0, 2 * RADIUS], [0, 0, -speed], wall_law=dry, walls=[Flat()]),
            dem.Lubrication(viscosity=viscosity),
        )
        solids.advance(2e-6, 50_000)
        returned.append(solids.velocity[0, 2] / speed)
    assert returned[0] == pytest.approx(0, abs=1e-3)  # it stays at the wall
    assert 0 < returned[1] < returned[2] < returned[3] < 1
    assert returned[3] == pytest.approx(1, abs=0.03)


# --- against the slow way -----------------------------------------------------------------------


def wet_pipe(seed, **parts):
    """Solids of two sizes in the shortest period, a bore and a moving floor."""
    rng = np.random.default_rng(seed)
    start = loose_packing(rng, (4, 2, 2), speed=1.0, period=0.084, wall_law=LINEAR)
    position = start.position - [0, *start.position[:, 1:].mean(axis=0)]
    return start.with_(
        position=position,
        velocity=start.velocity + rng.normal(0, 0.3, position.shape),
        radius=start.radius * rng.choice([1.0, 0.6], len(position)),
        walls=[
            Bore(radius=0.0262, velocity=(0.05, 0.0, 0.0)),
            Flat(point=(0, 0, -0.022), velocity=(0.1, 0.2, 0.05)),
        ],
        acceleration=np.tile([2.0, 0.0, -9.81], (len(position), 1)),
        **parts,
    )


@pytest.mark.parametrize("cutoff", [0.1, 1.0, 2.0])
def test_a_wet_packing_in_a_short_pipe_moves_as_the_slow_way_has_it(cutoff):
    law = dem.Lubrication(viscosity=1.0, cutoff=cutoff, least_gap=0.02)
    start = wet_pipe(1)
    slow, solids = SlowLubricatedSolids(start, law), lubricated(start, law)
    prunes = touching = 0
    for _ in range(5):
        prunes += solids.advance(STEP, 20).prunes
        slow.advance(STEP, 20)
        touching += len(slow.history)
        for got, expected in [
            (unwrapped(solids, start.period), slow.x),
            (solids.velocity, slow.v),
            (solids.spin, slow.w),
            (solids.wall_impulse, slow.wall_impulse),
        ]:
            np.testing.assert_allclose(got, expected, rtol=0, atol=1e-9 * abs(expected).max())
    assert prunes > 3
    assert touching > 5


@pytest.mark.parametrize("speed", [0.0, 300.0])
def test_lists_miss_no_gap_whether_made_seldom_or_in_every_step(speed):
    """A solid that rushes by far away has them made anew."""
    rng = np.random.default_rng(2)
    start = loose_packing(rng, speed=2.0)
    rows = {
        name: np.concatenate([getattr(start, name), [value]])
        for name, value in {
            "position": [0, 0, 5.0],
            "velocity": [speed, 0, 0],
            "spin": [0, 0, 0],
            "radius": RADIUS,
            "density": DENSITY,
        }.items()
    }
    law = dem.Lubrication(viscosity=0.7)
    slow = SlowLubricatedSolids(start, law)
    solids = lubricated(start.with_(**rows), law)
    solids.advance(STEP, 60)
    slow.advance(STEP, 60)
    np.testing.assert_allclose(solids.velocity[:-1], slow.v, rtol=0, atol=1e-11)


# --- books, threads, states ---------------------------------------------------------------------


def test_free_solids_keep_their_momentum_to_round_off():
    start = loose_packing(np.random.default_rng(5), speed=1.0)
    solids = lubricated(start, dem.Lubrication(viscosity=0.7))
    mass = solids.mass[:, None]
    before, size = (mass * start.velocity).sum(axis=0), abs(mass * start.velocity).sum()
    energy = solids.kinetic_energy
    solids.advance(STEP, 1000)
    assert solids.kinetic_energy < 0.9 * energy
    np.testing.assert_allclose((mass * solids.velocity).sum(axis=0), before, atol=1e-14 * size)


def big(**parts):
    return loose_packing(
        np.random.default_rng(6),
        (18, 18, 13),
        speed=5.0,
        period=18 * 0.0205,
        wall_law=LINEAR,
        walls=[Flat(point=(0, 0, -0.011))],
        **parts,
    )


BITS = ("position", "velocity", "spin", "wall_impulse")


def test_results_do_not_depend_on_the_number_of_threads():
    start, law = big(), dem.Lubrication(viscosity=0.7)
    one, other = lubricated(start, law), lubricated(start, law, threads=3)
    dry = start.solids()
    for solids in (one, other, dry):
        assert solids.advance(STEP, 40).sorts > 0
    for name in BITS:
        assert getattr(one, name).tobytes() == getattr(other, name).tobytes()
    assert abs(one.velocity - dry.velocity).max() > 1e-2


def test_blocks_that_meet_keep_the_momentum_of_all():
    start = big().with_(walls=[])
    solids = lubricated(start, dem.Lubrication(viscosity=0.7))
    solids.advance(STEP, 40)
    mass = solids.mass[:, None]
    size = abs(mass * start.velocity).sum()
    change = (mass * (solids.velocity - start.velocity)).sum(axis=0)
    np.testing.assert_allclose(change, 0, atol=1e-14 * size)


def test_a_restored_state_goes_on_bit_equal_but_not_without_lubrication():
    start, law = wet_pipe(3), dem.Lubrication(viscosity=0.2)
    solids, restored = lubricated(start, law), lubricated(start, law)
    solids.advance(STEP, 37)
    restored.restore(solids.state())
    for one in (solids, restored):
        one.advance(STEP, 60)
    for name in BITS:
        assert getattr(solids, name).tobytes() == getattr(restored, name).tobytes()
    with pytest.raises(ValueError, match="another population"):
        start.solids().restore(solids.state())
    with pytest.raises(ValueError, match="another population"):
        solids.restore(start.solids().state())


def test_a_liquid_without_viscosity_to_speak_of_changes_nothing():
    start = wet_pipe(4)
    dry, wet = start.solids(), lubricated(start, dem.Lubrication(viscosity=1e-14))
    for solids in (dry, wet):
        solids.advance(STEP, 200)
    np.testing.assert_allclose(wet.velocity, dry.velocity, rtol=0, atol=1e-10)
    np.testing.assert_allclose(wet.spin, dry.spin, rtol=0, atol=1e-8)


# --- refusals -----------------------------------------------------------------------------------


def test_a_step_too_long_for_the_narrowest_gap_is_refused_with_the_one_that_is_not():
    """Half the time 1 / rate, rate = 6 pi mu R / m (1 / least_gap - 1 / cutoff) for equal ones."""
    viscosity = 1.0
    bound = 0.5 * MASS / (6 * np.pi * viscosity * RADIUS * (1 / 3e-3 - 1))
    solids = lubricated(
        scene([[0, 0, 0], [0.0, 0, 0.0201]], walls=[Flat(point=(0, 0, -0.02))]),
        dem.Lubrication(viscosity=viscosity),
    )
    assert solids.longest_step == pytest.approx(bound)
    assert solids.advance(solids.longest_step, 10).finite
    with pytest.raises(ValueError, match=rf"dt must be <= {bound * 1e6:.2f}.*e-6 s.*least_gap"):
        solids.advance(solids.longest_step * 1.001, 1)
    assert scene([0, 0, 0]).solids().longest_step == np.inf


def test_at_the_longest_step_a_squeezed_packing_is_slowed_not_shaken():
    """Neighbours move against each other, at the least gap: none is slowed faster."""
    counts = (6, 6, 6)
    sign = (-1.0) ** np.indices(counts).reshape(3, -1).sum(axis=0)
    position = block(counts, 2.001 * RADIUS, np.random.default_rng(7))
    start = scene(position, sign[:, None] * [1e-6, 2e-6, -3e-6])
    solids = lubricated(start, dem.Lubrication(viscosity=1.0))
    energies = [solids.kinetic_energy]
    for _ in range(50):
        solids.advance(solids.longest_step, 2)
        energies.append(solids.kinetic_energy)
    assert (np.diff(energies) <= 0).all()
    assert energies[-1] < 0.01 * energies[0]


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        *[({"viscosity": v}, "viscosity") for v in (0.0, -1.0, np.nan, np.inf)],
        *[({"viscosity": 1.0, "least_gap": v}, "least_gap") for v in (0.0, -1.0, np.nan)],
        *[({"viscosity": 1.0, "cutoff": v}, "cutoff") for v in (1e-3, 2.1, np.nan)],
    ],
)
def test_bad_parameters_are_refused_by_their_names(parameters, message):
    with pytest.raises(ValueError, match=f"Lubrication: {message}"):
        dem.Lubrication(**parameters)
