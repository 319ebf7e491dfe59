"""Solids and the particle liquid: what they exchange, against sums over all pairs, conservation
and flows known in closed form."""

from dataclasses import dataclass

import numpy as np
import pytest

from mpsdem._core import coupling, mps
from mpsdem.geometry import Kind, ring_layout

RADIUS, LENGTH, DENSITY, VISCOSITY = 0.1, 0.5, 1000.0, 1e-6
SMOOTHING = 0.06
BORE = np.pi * RADIUS**2 * LENGTH


def water(*, bulk_velocity=0.5, across=10, **options):
    """Particle liquid in its developed profile, and which of its particles are liquid."""
    layout = ring_layout(radius=RADIUS, length=LENGTH, spacing=2 * RADIUS / across)
    inside = layout.kind == Kind.LIQUID
    profile = mps.PipeProfile(
        pipe_radius=RADIUS,
        bulk_velocity=bulk_velocity,
        kinematic_viscosity=VISCOSITY,
        roughness=0.0,
    )
    velocity = np.where(inside[:, None], profile.velocity(layout.position), 0.0)
    if bulk_velocity:
        velocity *= bulk_velocity / velocity[inside, 0].mean()
    liquid = mps.LagrangianLiquid(
        **{
            "position": layout.position,
            "velocity": velocity,
            "kind": layout.kind,
            "particle_spacing": layout.spacing,
            "pipe_radius": RADIUS,
            "pipe_length": LENGTH,
            "density": DENSITY,
            "kinematic_viscosity": VISCOSITY,
            "roughness": 0.0,
            "turbulence": mps.MixingLength(pipe_radius=RADIUS),
            "bulk_velocity": bulk_velocity,
        }
        | options
    )
    return liquid, inside


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


def new_exchange():
    return coupling.Exchange(smoothing_radius=SMOOTHING, liquid_density=DENSITY)


def go(exchange, liquid, solids, dt, *, impulse=None):
    exchange.begin(liquid, position=solids.position, radius=solids.radius)
    exchange.give(
        position=solids.position,
        mean_velocity=solids.velocity,
        drag=solids.drag,
        impulse=impulse,
        duration=dt,
    )
    report = exchange.advance(liquid, dt)
    assert report.sound
    return report


def weights(points, solids):
    """The footprints, by all pairs: (solids, points)."""
    apart = solids.position[:, None] - points
    apart[..., 0] -= LENGTH * np.round(apart[..., 0] / LENGTH)
    q = np.minimum(np.linalg.norm(apart, axis=2) / SMOOTHING, 1)
    w = 4 * q**5 - 5 * q**4 + 1
    return w / w.sum(axis=1, keepdims=True)


def of_liquid(liquid, inside, field):
    return getattr(liquid, field)[: len(inside)][inside]


def momentum(liquid, inside):
    """Of the liquid, over its density [m4/s]."""
    velocity = of_liquid(liquid, inside, "velocity")
    share = of_liquid(liquid, inside, "void_fraction")
    return BORE / inside.sum() * share @ velocity


def test_solids_sample_and_load_the_liquid_with_the_same_weights():
    liquid, inside = water()
    solids, exchange = crowd(), new_exchange()
    w = weights(of_liquid(liquid, inside, "position"), solids)
    per_point = inside.sum() / BORE
    eps = 1 - per_point * solids.volume @ w

    exchange.begin(liquid, position=solids.position, radius=solids.radius)
    np.testing.assert_allclose(
        exchange.liquid_velocity, w @ of_liquid(liquid, inside, "velocity"), atol=1e-12
    )
    rate = per_point * (solids.drag @ w) / (DENSITY * eps)
    np.testing.assert_allclose(exchange.relaxation(solids.drag), w @ rate, rtol=1e-10)

    go(exchange, liquid, solids, 1e-3)
    np.testing.assert_allclose(of_liquid(liquid, inside, "void_fraction"), eps, rtol=1e-10)
    assert exchange.clipped == 0
    assert abs(exchange.liquid_volume_error) < 1e-12
    share = of_liquid(liquid, inside, "void_fraction").mean()
    assert share * BORE == pytest.approx(BORE - solids.volume.sum(), rel=1e-12)


def test_liquid_and_solids_give_each_other_the_same_impulse():
    liquid, inside = water()
    solids, exchange, rng = crowd(), new_exchange(), np.random.default_rng(2)
    go(exchange, liquid, solids, 5e-3)
    for _ in range(5):
        before, solids.velocity = momentum(liquid, inside), solids.velocity + 0.01
        impulse = rng.uniform(-0.01, 0.01, solids.position.shape)
        report = go(exchange, liquid, solids, 5e-3, impulse=impulse)
        assert exchange.mismatch < 1e-12
        np.testing.assert_allclose(exchange.impulse, impulse, rtol=1e-12)
        driven = report.mean_gradient - report.friction + report.unexplained
        gained = DENSITY * (momentum(liquid, inside) - before)[0]
        assert gained == pytest.approx(5e-3 * driven * BORE - impulse[:, 0].sum(), abs=1e-10)


def test_held_solids_take_what_the_drag_of_the_step_gives():
    liquid, inside = water()
    solids, exchange = crowd(velocity=(0.0, 0.0, 0.0), spread=0.0), new_exchange()
    w = weights(of_liquid(liquid, inside, "position"), solids)
    go(exchange, liquid, solids, 2e-3)
    at_solids = w @ of_liquid(liquid, inside, "velocity")
    np.testing.assert_allclose(
        exchange.impulse, 2e-3 * solids.drag[:, None] * at_solids, rtol=1e-10, atol=1e-15
    )


@pytest.mark.parametrize("stiffness", [0.1, 1.0, 10.0, 400.0])
def test_a_bed_that_is_held_costs_the_drag_on_it(stiffness):
    """However much of its velocity the liquid would lose in a step."""
    step = 4e-3
    liquid, _ = water(bulk_velocity=0.5)
    solids = crowd(900, velocity=(0.0, 0.0, 0.0), spread=0.0)
    fraction = solids.volume.sum() / BORE
    solids.drag[:] = stiffness * DENSITY * (1 - fraction) / step * BORE / len(solids.drag)
    exchange = new_exchange()
    for _ in range(60):
        report = go(exchange, liquid, solids, step)
    drag = exchange.impulse.sum(axis=0) / (step * BORE)
    assert report.mean_gradient == pytest.approx(drag[0] + report.friction, rel=5e-3)
    through = solids.drag.sum() / BORE * exchange.liquid_velocity[:, 0].mean()
    assert drag[0] == pytest.approx(through, rel=1e-2)
    # where solids lie thick there is less of it
    assert 0.5 < exchange.liquid_velocity[:, 0].mean() < 0.5 / (1 - fraction)
    assert liquid.density_scatter < 0.05
    assert liquid.bulk_velocity == pytest.approx(0.5, abs=1e-12)


def test_liquid_flows_over_a_bed_rather_than_through_it():
    liquid, inside = water()
    solids = crowd(350, velocity=(0.0, 0.0, 0.0), spread=0.0, below=-0.02, drag=2.0)
    exchange = new_exchange()
    for _ in range(150):
        report = go(exchange, liquid, solids, 5e-3)
    height = of_liquid(liquid, inside, "position")[:, 2]
    velocity = of_liquid(liquid, inside, "velocity")[:, 0]
    assert velocity[height > 0.03].mean() > 3 * velocity[height < -0.06].mean()
    assert np.abs(of_liquid(liquid, inside, "velocity")[:, 1:]).max() < 0.2
    assert abs(report.unexplained) < 0.02 * report.friction


def test_solids_that_sink_press_the_liquid_up_beside_them():
    """Volume is kept: what goes down in a section must come up in it."""
    liquid, inside = water(bulk_velocity=0.0, speed=0.3)
    solids = crowd(100, velocity=(0.0, 0.0, -0.3), spread=0.0, drag=1e-9)
    solids.position[:, 1:] *= 0.4  # in the middle
    exchange = new_exchange()
    go(exchange, liquid, solids, 1e-3)
    w = weights(of_liquid(liquid, inside, "position"), solids)
    flux = inside.sum() / BORE * w.T @ (solids.volume[:, None] * solids.velocity)
    share = of_liquid(liquid, inside, "void_fraction")
    upward = share * of_liquid(liquid, inside, "velocity")[:, 2]
    assert upward.sum() == pytest.approx(-flux[:, 2].sum(), rel=0.2)


@pytest.mark.parametrize("threads", [2, 3])
def test_the_exchange_does_not_depend_on_the_threads(threads):
    states = []
    for count in (1, threads):
        liquid, _ = water(threads=count)
        solids, exchange = crowd(), new_exchange()
        for _ in range(4):
            go(exchange, liquid, solids, 4e-3)
        states.append(liquid.state())
    for name, values in states[0].items():
        np.testing.assert_array_equal(values, states[1][name])


def test_a_restored_liquid_goes_on_bit_by_bit():
    solids, exchange = crowd(), new_exchange()
    liquid, _ = water()
    for _ in range(3):
        go(exchange, liquid, solids, 4e-3)
    twin, _ = water()
    twin.restore(liquid.state())
    other = new_exchange()
    for _ in range(3):
        go(exchange, liquid, solids, 4e-3)
        go(other, twin, solids, 4e-3)
    for name, values in liquid.state().items():
        np.testing.assert_array_equal(values, twin.state()[name])


def test_more_solids_than_fit_are_clipped_and_counted():
    liquid, inside = water()
    solids = crowd(900)
    solids.radius[:] = 0.014
    exchange = new_exchange()
    go(exchange, liquid, solids, 1e-3)
    assert exchange.clipped > 0
    assert of_liquid(liquid, inside, "void_fraction").min() == pytest.approx(0.3)
    assert exchange.liquid_volume_error > 0


def test_what_cannot_be_is_refused():
    liquid, _ = water()
    solids = crowd(3)
    small = coupling.Exchange(smoothing_radius=1e-4, liquid_density=DENSITY)
    with pytest.raises(ValueError, match="no liquid within the smoothing radius"):
        small.begin(liquid, position=solids.position, radius=solids.radius)
    with pytest.raises(ValueError, match="liquid_density must be > 0"):
        coupling.Exchange(smoothing_radius=0.1, liquid_density=0.0)
    exchange = new_exchange()
    exchange.begin(liquid, position=solids.position, radius=solids.radius)
    with pytest.raises(ValueError, match="one row per solid"):
        exchange.relaxation(np.ones(2))
    with pytest.raises(ValueError, match="duration must be > 0"):
        exchange.give(
            position=solids.position,
            mean_velocity=solids.velocity,
            drag=solids.drag,
            impulse=None,
            duration=0.0,
        )
