"""Solids and the liquids that feel them: what they exchange, against sums over all pairs, against
conservation and flows known in closed form."""

from dataclasses import dataclass

import numpy as np
import pytest

from mpsdem._core import coupling, mps
from mpsdem.geometry import Kind, node_layout, ring_layout

RADIUS, LENGTH, DENSITY, VISCOSITY = 0.1, 0.5, 1000.0, 1e-6
SMOOTHING = 0.06
BORE = np.pi * RADIUS**2 * LENGTH


class Particles:
    """Particle liquid in its developed profile."""

    def __init__(self, *, bulk_velocity=0.5, across=10, **options):
        layout = ring_layout(radius=RADIUS, length=LENGTH, spacing=2 * RADIUS / across)
        self.inside = layout.kind == Kind.LIQUID
        velocity = np.where(self.inside[:, None], start(layout.position, bulk_velocity), 0.0)
        if bulk_velocity:
            velocity *= bulk_velocity / velocity[self.inside, 0].mean()
        self.core = mps.LagrangianLiquid(
            **{
                "position": layout.position,
                "velocity": velocity,
                "kind": layout.kind,
                "particle_spacing": layout.spacing,
                "turbulence": mps.MixingLength(pipe_radius=RADIUS),
                "bulk_velocity": bulk_velocity,
            }
            | PIPE
            | options
        )
        count = self.inside.sum()
        self.volume = np.full(count, BORE / count)

    @property
    def position(self):
        return self.core.position[: len(self.inside)][self.inside]

    @property
    def velocity(self):
        return self.core.velocity[: len(self.inside)][self.inside]

    @property
    def void_fraction(self):
        return self.core.void_fraction[: len(self.inside)][self.inside]


class Nodes:
    """Liquid on nodes in its developed profile; those inside the bore."""

    def __init__(self, *, bulk_velocity=0.5, across=10, **options):
        layout = node_layout(radius=RADIUS, length=LENGTH, spacing=2 * RADIUS / across)
        points = layout.position
        self.inner = len(layout.place) - layout.wall_count
        self.core = mps.EulerianLiquid(
            **{
                "place": layout.place,
                "area": layout.area,
                "wall_count": layout.wall_count,
                "stations": layout.stations,
                "spacing": layout.spacing,
                "velocity": start(points.reshape(-1, 3), bulk_velocity).reshape(points.shape),
                "turbulent": True,
                "bulk_velocity": bulk_velocity,
            }
            | PIPE
            | options
        )
        self.position = points[: self.inner].reshape(-1, 3)
        share = np.repeat(layout.area[: self.inner], layout.stations)
        self.volume = BORE * share / share.sum()  # the inner nodes share the bore

    @property
    def velocity(self):
        return self.core.velocity[: self.inner].reshape(-1, 3)

    @property
    def void_fraction(self):
        return self.core.void_fraction[: self.inner].ravel()


PIPE = {
    "pipe_radius": RADIUS,
    "pipe_length": LENGTH,
    "density": DENSITY,
    "kinematic_viscosity": VISCOSITY,
    "roughness": 0.0,
}
EVERY_LIQUID = pytest.mark.parametrize("water", [Particles, Nodes])


def start(position, bulk_velocity):
    profile = mps.PipeProfile(
        pipe_radius=RADIUS,
        bulk_velocity=bulk_velocity,
        kinematic_viscosity=VISCOSITY,
        roughness=0.0,
    )
    return profile.velocity(position)


@dataclass
class Crowd:
    """Solids that go their way whatever the liquid does, and their drag [kg/s]."""

    position: np.ndarray
    velocity: np.ndarray
    radius: np.ndarray
    drag: np.ndarray

    @property
    def volume(self):
        return 4 / 3 * np.pi * self.radius**3


def crowd(count=300, *, seed=1, drag=0.5, velocity=(0.2, 0.0, 0.0), spread=0.1, below=RADIUS):
    rng = np.random.default_rng(seed)
    position = rng.uniform([0, -RADIUS, -RADIUS], [LENGTH, RADIUS, RADIUS], (40 * count, 3))
    away = np.hypot(position[:, 1], position[:, 2])
    position = position[(away < 0.9 * RADIUS) & (position[:, 2] < below)][:count]
    return Crowd(
        position=position,
        velocity=velocity + rng.uniform(-spread, spread, position.shape),
        radius=rng.uniform(0.008, 0.01, len(position)),
        drag=drag * rng.uniform(0.5, 1.5, len(position)),
    )


def new_exchange(**options):
    return coupling.Exchange(smoothing_radius=SMOOTHING, liquid_density=DENSITY, **options)


def go(exchange, liquid, solids, dt, *, impulse=None):
    exchange.begin(liquid.core, position=solids.position, radius=solids.radius)
    exchange.give(
        position=solids.position,
        mean_velocity=solids.velocity,
        drag=solids.drag,
        impulse=impulse,
        duration=dt,
    )
    report = exchange.advance(liquid.core, dt)
    assert report.sound
    return report


def weights(liquid, solids):
    """The footprints, by all pairs: (solids, points)."""
    apart = solids.position[:, None] - liquid.position
    apart[..., 0] -= LENGTH * np.round(apart[..., 0] / LENGTH)
    q = np.minimum(np.linalg.norm(apart, axis=2) / SMOOTHING, 1)
    w = liquid.volume * (4 * q**5 - 5 * q**4 + 1)
    return w / w.sum(axis=1, keepdims=True)


def momentum(liquid):
    """Of the liquid, over its density [m4/s]."""
    return (liquid.volume * liquid.void_fraction) @ liquid.velocity


@EVERY_LIQUID
def test_solids_sample_and_load_the_liquid_with_the_same_weights(water):
    liquid, solids, exchange = water(), crowd(), new_exchange()
    w = weights(liquid, solids)
    eps = 1 - solids.volume @ w / liquid.volume

    exchange.begin(liquid.core, position=solids.position, radius=solids.radius)
    np.testing.assert_allclose(exchange.liquid_velocity, w @ liquid.velocity, atol=1e-12)
    inertia = DENSITY * liquid.volume * eps
    rate = solids.drag @ w / inertia
    by_drag = (solids.drag[:, None] * solids.velocity).T @ w / inertia - rate * liquid.velocity.T
    slip = w @ liquid.velocity - solids.velocity
    acceleration, relaxation = exchange.response(drag=solids.drag, velocity=solids.velocity)
    np.testing.assert_allclose(relaxation, w @ rate, rtol=1e-10)
    expected = w @ by_drag.T + (w @ rate)[:, None] * slip  # nothing else has acted yet
    np.testing.assert_allclose(acceleration, expected, atol=1e-10 * np.abs(expected).max())

    go(exchange, liquid, solids, 1e-3)
    np.testing.assert_allclose(liquid.void_fraction, eps, rtol=1e-10)
    assert exchange.clipped == 0
    assert abs(exchange.liquid_volume_error) < 1e-12
    of_liquid = liquid.void_fraction @ liquid.volume
    assert of_liquid == pytest.approx(BORE - solids.volume.sum(), rel=1e-12)


@EVERY_LIQUID
def test_liquid_and_solids_give_each_other_the_same_impulse(water):
    liquid, solids, exchange = water(), crowd(), new_exchange()
    rng = np.random.default_rng(2)
    go(exchange, liquid, solids, 5e-3)
    for _ in range(5):
        before, solids.velocity = momentum(liquid), solids.velocity + 0.01
        impulse = rng.uniform(-0.01, 0.01, solids.position.shape)
        report = go(exchange, liquid, solids, 5e-3, impulse=impulse)
        assert exchange.mismatch < 1e-12
        np.testing.assert_allclose(exchange.impulse, impulse, rtol=1e-12)
        driven = report.mean_gradient - report.friction + report.unexplained
        gained = DENSITY * (momentum(liquid) - before)[0]
        assert gained == pytest.approx(5e-3 * driven * BORE - impulse[:, 0].sum(), abs=1e-10)


@EVERY_LIQUID
def test_held_solids_take_the_drag_of_the_step(water):
    liquid, exchange = water(), new_exchange()
    solids = crowd(velocity=(0.0, 0.0, 0.0), spread=0.0)
    w = weights(liquid, solids)
    for _ in range(30):
        go(exchange, liquid, solids, 2e-3)
    if isinstance(liquid, Particles):
        w = weights(liquid, solids)
    np.testing.assert_allclose(
        exchange.impulse[:, 0], 2e-3 * solids.drag * (w @ liquid.velocity)[:, 0], rtol=0.02
    )


@EVERY_LIQUID
@pytest.mark.parametrize(("stiffness", "steps"), [(0.1, 60), (1.0, 60), (10.0, 60), (400.0, 200)])
def test_a_bed_that_is_held_costs_the_drag_on_it(water, stiffness, steps):
    """However much of its velocity the liquid would lose in a step."""
    step, liquid, exchange = 4e-3, water(bulk_velocity=0.5), new_exchange()
    solids = crowd(900, velocity=(0.0, 0.0, 0.0), spread=0.0)
    fraction = solids.volume.sum() / BORE
    solids.drag[:] = stiffness * DENSITY * (1 - fraction) / step * BORE / len(solids.drag)
    for _ in range(steps):
        report = go(exchange, liquid, solids, step)
    drag = exchange.impulse.sum(axis=0) / (step * BORE)
    assert report.mean_gradient == pytest.approx(drag[0] + report.friction, rel=5e-3)
    through = solids.drag @ exchange.liquid_velocity[:, 0] / BORE
    # The pressure that nodes keep finds its field in as many steps as the bed is stiff.
    assert drag[0] == pytest.approx(through, rel=0.015 if stiffness > 100 else 0.01)
    # where solids lie thick there is less of it
    assert 0.5 < exchange.liquid_velocity[:, 0].mean() < 0.5 / (1 - fraction)
    assert liquid.core.bulk_velocity == pytest.approx(0.5, abs=1e-9)
    if isinstance(liquid, Particles):
        assert liquid.core.density_scatter < 0.06


@EVERY_LIQUID
@pytest.mark.parametrize("stiffness", [0.1, 1.5, 20.0])
def test_a_given_gradient_pushes_a_bed_s_liquid_until_its_drag_is_as_large(water, stiffness):
    step, exchange = 4e-3, new_exchange()
    liquid = water(bulk_velocity=0.01, pressure_gradient=1000.0)
    solids = crowd(900, velocity=(0.0, 0.0, 0.0), spread=0.0)
    fraction = solids.volume.sum() / BORE
    solids.drag[:] = stiffness * DENSITY * (1 - fraction) / step * BORE / len(solids.drag)
    for _ in range(300):
        report = go(exchange, liquid, solids, step)
    drag = exchange.impulse.sum(axis=0) / (step * BORE)
    assert report.mean_gradient == pytest.approx(1000.0, rel=1e-6)
    assert drag[0] + report.friction == pytest.approx(1000.0, rel=0.02)


@EVERY_LIQUID
def test_a_stiff_plug_in_a_part_of_the_pipe_is_no_pump(water):
    liquid, exchange, step = water(bulk_velocity=0.05), new_exchange(), 4e-3
    solids = crowd(900, velocity=(0.0, 0.0, 0.0), spread=0.0)
    solids.position[:, 0] *= 0.3
    fraction = solids.volume.sum() / (0.3 * BORE)
    solids.drag[:] = 10 * DENSITY * (1 - fraction) / step * 0.3 * BORE / len(solids.drag)
    for _ in range(60):
        go(exchange, liquid, solids, step)
    assert np.linalg.norm(liquid.velocity, axis=1).max() < 0.3


@EVERY_LIQUID
def test_liquid_flows_over_a_bed_rather_than_through_it(water):
    liquid, exchange = water(), new_exchange()
    solids = crowd(350, velocity=(0.0, 0.0, 0.0), spread=0.0, below=-0.02, drag=2.0)
    for _ in range(150):
        report = go(exchange, liquid, solids, 5e-3)
    height, velocity = liquid.position[:, 2], liquid.velocity
    assert velocity[height > 0.03, 0].mean() > 3 * velocity[height < -0.06, 0].mean()
    assert np.abs(velocity[:, 1:]).max() < 0.2
    assert abs(report.unexplained) < 0.02 * report.friction


def test_liquid_deep_in_a_bed_creeps_beside_the_wall_as_it_does_within():
    """The wall rubs on the fast liquid over the bed, and takes nothing from the liquid in it."""
    liquid, exchange = Nodes(across=12), new_exchange()
    solids = crowd(900, velocity=(0.0, 0.0, 0.0), spread=0.0, below=0.0)
    solids.radius[:] = 0.006
    solids.drag[:] = 2.0
    for _ in range(120):
        report = go(exchange, liquid, solids, 4e-3)
    beta = solids.drag @ weights(liquid, solids) / liquid.volume
    deep = liquid.position[:, 2] < -0.6 * RADIUS
    beside = np.hypot(liquid.position[:, 1], liquid.position[:, 2]) > 0.8 * RADIUS
    driven = liquid.velocity[:, 0] * beta / report.mean_gradient  # Darcy: 1
    assert driven[deep & beside].mean() == pytest.approx(driven[deep & ~beside].mean(), rel=5e-3)


def test_viscous_liquid_over_a_bed_parts_its_steps_until_they_are_stable():
    """Where little liquid lies beside much the viscous terms are stiffest."""
    viscous = {"kinematic_viscosity": 0.02, "turbulent": False}
    liquid, exchange = Nodes(bulk_velocity=0.1, **viscous), new_exchange()
    solids = crowd(900, velocity=(0.0, 0.0, 0.0), spread=0.0, below=-0.01, drag=1e-3)
    solids.radius[:] = 0.0115
    for _ in range(40):
        report = go(exchange, liquid, solids, 1e-2)
    assert report.limit == "viscosity"
    assert liquid.void_fraction.min() == pytest.approx(0.3)  # the least there is
    assert np.abs(liquid.velocity[:, 0]).max() < 0.5  # a parabola's is 0.2 in twice the room
    assert np.abs(liquid.velocity[:, 1:]).max() < 0.1


@EVERY_LIQUID
def test_solids_that_sink_press_the_liquid_up_beside_them(water):
    """Volume is kept: what goes down in a section must come up in it."""
    options = {"speed": 0.3} if water is Particles else {}
    liquid, exchange = water(bulk_velocity=0.0, **options), new_exchange()
    solids = crowd(100, velocity=(0.0, 0.0, -0.3), spread=0.0, drag=1e-9)
    solids.position[:, 1:] *= 0.4  # in the middle
    go(exchange, liquid, solids, 1e-3)
    downward = (solids.volume * solids.velocity[:, 2]).sum()
    assert momentum(liquid)[2] == pytest.approx(-downward, rel=0.2)


@EVERY_LIQUID
@pytest.mark.parametrize("threads", [2, 3])
def test_the_exchange_does_not_depend_on_the_threads(water, threads):
    states = []
    for count in (1, threads):
        liquid, solids, exchange = water(threads=count), crowd(), new_exchange(threads=count)
        for _ in range(4):
            go(exchange, liquid, solids, 4e-3, impulse=0.1 * solids.velocity)
        exchange.begin(liquid.core, position=solids.position, radius=solids.radius)
        foreseen = exchange.response(drag=solids.drag, velocity=solids.velocity)
        seen = dict(zip(("acceleration", "relaxation"), foreseen, strict=True))
        states.append(liquid.core.state() | seen | {"impulse": exchange.impulse})
    for name, values in states[0].items():
        np.testing.assert_array_equal(values, states[1][name])


@EVERY_LIQUID
def test_a_restored_liquid_goes_on_bit_by_bit(water):
    liquid, solids, exchange = water(), crowd(), new_exchange()
    for _ in range(3):
        go(exchange, liquid, solids, 4e-3)
    twin, other = water(), new_exchange()
    twin.core.restore(liquid.core.state())
    for _ in range(3):
        go(exchange, liquid, solids, 4e-3)
        go(other, twin, solids, 4e-3)
    for name, values in liquid.core.state().items():
        np.testing.assert_array_equal(values, twin.core.state()[name])


@EVERY_LIQUID
def test_more_solids_than_fit_are_clipped_and_counted(water):
    liquid, solids, exchange = water(), crowd(900), new_exchange()
    solids.radius[:] = 0.015
    go(exchange, liquid, solids, 1e-3)
    assert exchange.clipped > 0
    assert liquid.void_fraction.min() == pytest.approx(0.3)
    assert exchange.liquid_volume_error > 0


@EVERY_LIQUID
def test_what_cannot_be_is_refused(water):
    liquid, solids = water(), crowd(3)
    small = coupling.Exchange(smoothing_radius=1e-5, liquid_density=DENSITY)
    with pytest.raises(ValueError, match="no liquid within the smoothing radius"):
        small.begin(liquid.core, position=solids.position, radius=solids.radius)
    with pytest.raises(ValueError, match="liquid_density must be > 0"):
        coupling.Exchange(smoothing_radius=0.1, liquid_density=0.0)
    exchange = new_exchange()
    exchange.begin(liquid.core, position=solids.position, radius=solids.radius)
    with pytest.raises(ValueError, match="one row per solid"):
        exchange.response(drag=np.ones(2), velocity=solids.velocity)
    with pytest.raises(ValueError, match="duration must be > 0"):
        exchange.give(
            position=solids.position,
            mean_velocity=solids.velocity,
            drag=solids.drag,
            impulse=None,
            duration=0.0,
        )
