"""The liquid on fixed nodes over long times and in long pipes: minutes."""

import fluids
import numpy as np
import pytest

from mpsdem._core import mps
from mpsdem.geometry import node_layout

pytestmark = pytest.mark.slow

RADIUS = 0.1
DENSITY = 1000.0


def water(*, across, diameters, reynolds, noise, **options):
    """Turbulent flow at 1 m/s from a power law, with noise in every component."""
    length = 2 * RADIUS * diameters
    nodes = node_layout(radius=RADIUS, length=length, spacing=2 * RADIUS / across)
    share = np.hypot(*nodes.place.T)[:, None] / RADIUS
    velocity = noise * np.random.default_rng(1).standard_normal(nodes.position.shape)
    velocity[..., 0] += 1.2245 * np.maximum(1 - share, 0) ** (1 / 7)
    return mps.EulerianLiquid(
        place=nodes.place,
        area=nodes.area,
        wall_count=nodes.wall_count,
        stations=nodes.stations,
        spacing=nodes.spacing,
        velocity=velocity,
        pipe_radius=RADIUS,
        pipe_length=length,
        density=DENSITY,
        kinematic_viscosity=2 * RADIUS / reynolds,
        roughness=0.0,
        turbulent=True,
        bulk_velocity=1.0,
        **options,
    )


def friction_factor(report):
    return report.mean_gradient * 2 * RADIUS / (DENSITY / 2)


@pytest.mark.parametrize("scheme", ["rk2", "rk3"])
@pytest.mark.parametrize("diameters", [3, 20])
def test_twenty_seconds_are_stable_and_quiet(diameters, scheme):
    """A hundred diameters of travel, from 5 % of noise."""
    liquid = water(across=16, diameters=diameters, reynolds=2e5, noise=0.05, scheme=scheme)
    for _ in range(20):
        report = liquid.advance(1.0)
        assert report.sound
    assert np.abs(liquid.velocity[..., 1:]).max() < 1e-3
    assert report.divergence < 1e-5
    assert abs(report.unexplained) < 1e-3 * report.mean_gradient
    expected = fluids.friction_factor(Re=2e5, Method="Colebrook")
    assert friction_factor(report) == pytest.approx(expected, rel=0.04)


@pytest.mark.parametrize("reynolds", [1e4, 5e4, 2e5, 5e5])
def test_friction_does_not_drift_with_the_resolution(reynolds):
    """24 spacings across: no further from Colebrook than 10 and 16 are, within 4 %."""
    liquid = water(across=24, diameters=0.5, reynolds=reynolds, noise=0.0)
    liquid.advance(9.0)
    report = liquid.advance(1.0)  # developed
    expected = fluids.friction_factor(Re=reynolds, Method="Colebrook")
    assert friction_factor(report) == pytest.approx(expected, rel=0.04)
