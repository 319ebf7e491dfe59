"""Experiments with one ball or two: impacts, a bounce, and rolling down a plane.

The plane is z = 0. Motion is along x and z, spin about y: a ball that rolls towards +x without
sliding has speed = radius * spin.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from mpsdem._core import dem, geometry

GRAVITY = 9.81  # [m/s2]

_STEPS_PER_IMPACT = 2000  # of the Hertz contact: what is measured converges to 1e-4


@dataclass(frozen=True, slots=True, kw_only=True)
class Ball:
    """A sphere and its material."""

    radius: float  # [m]
    density: float  # [kg/m3]
    youngs_modulus: float  # [Pa]
    poisson_ratio: float  # [-]

    @property
    def mass(self) -> float:
        """[kg]."""
        return self.density * 4 / 3 * math.pi * self.radius**3

    @property
    def compliance(self) -> float:
        """Share of the body in 1 / E* of a contact [1/Pa]."""
        return (1 - self.poisson_ratio**2) / self.youngs_modulus


@dataclass(frozen=True, slots=True, kw_only=True)
class Rebound:
    """The first ball after an impact, and how hard that was."""

    normal: float  # [m/s] away from what it hit
    tangential: float  # [m/s]
    spin: float  # [rad/s]
    patch: float  # [m/s] of its surface at the contact
    largest_overlap: float  # [m]
    largest_force: float  # [N]
    duration: float  # [s]


@cache
def impact_on_plane(
    ball: Ball,
    *,
    normal: float,
    tangential: float = 0.0,
    spin: float = 0.0,
    restitution: float = 1.0,
    friction: float = 0.0,
) -> Rebound:
    """Let a ball hit a rigid plane, without gravity.

    Parameters
    ----------
    ball : Ball
    normal : float
        Speed towards the plane [m/s].
    tangential : float
        [m/s].
    spin : float
        [rad/s].
    restitution, friction : float
        [-].
    """
    solids = _solids(
        [ball],
        _law(ball, rigid=True, restitution=restitution, friction=friction),
        velocity=[[tangential, 0.0, -normal]],
        spin=[spin],
    )
    return _rebound(solids, _contact_time(ball.compliance, ball.radius, ball.mass, normal))


@cache
def impact_on_linear_spring(
    ball: Ball, *, normal: float, stiffness: float, restitution: float = 1.0
) -> Rebound:
    """Let a ball hit a plane head-on, without gravity.

    Parameters
    ----------
    ball : Ball
    normal : float
        Speed towards the plane [m/s].
    stiffness : float
        Of the contact [N/m].
    restitution : float
        [-].
    """
    law = dem.LinearSpring.with_restitution(
        normal_stiffness=stiffness,
        tangential_stiffness=stiffness,
        restitution=restitution,
        friction=0.0,
    )
    solids = _solids([ball], law, velocity=[[0.0, 0.0, -normal]], spin=[0.0])
    return _rebound(solids, math.pi * math.sqrt(ball.mass / stiffness))


@cache
def impact_of_two(
    ball: Ball,
    other: Ball,
    *,
    normal: float,
    other_normal: float = 0.0,
    spin: float = 0.0,
    other_spin: float = 0.0,
    restitution: float = 1.0,
    friction: float = 0.0,
) -> Rebound:
    """Let two balls meet on the z axis, without gravity.

    Parameters
    ----------
    ball, other : Ball
        The first one comes from above.
    normal, other_normal : float
        Speed of each towards the other [m/s].
    spin, other_spin : float
        [rad/s].
    restitution, friction : float
        [-].
    """
    solids = _solids(
        [ball, other],
        _law(ball, other, restitution=restitution, friction=friction),
        velocity=[[0.0, 0.0, -normal], [0.0, 0.0, other_normal]],
        spin=[spin, other_spin],
    )
    radius = 1 / (1 / ball.radius + 1 / other.radius)
    mass = 1 / (1 / ball.mass + 1 / other.mass)
    compliance = ball.compliance + other.compliance
    return _rebound(solids, _contact_time(compliance, radius, mass, normal + other_normal))


@cache
def bounce_height(ball: Ball, *, height: float, restitution: float) -> float:
    """Drop a ball from a height of its lowest point; return the height it comes back to [m]."""
    law = _law(ball, restitution=restitution, friction=0.0)
    solids = _solids([ball], law, velocity=[[0.0, 0.0, 0.0]], spin=[0.0], gap=height)
    solids.set_forcing(acceleration=np.array([[0.0, 0.0, -GRAVITY]]))
    speed = math.sqrt(2 * GRAVITY * height)
    dt = _contact_time(2 * ball.compliance, ball.radius, ball.mass, speed) / _STEPS_PER_IMPACT
    while solids.velocity[0, 2] <= 0:
        solids.advance(dt, 100)
    while solids.velocity[0, 2] > 0:
        solids.advance(dt, 100)
    return float(solids.position[0, 2]) - ball.radius


@dataclass(frozen=True, slots=True, kw_only=True)
class Track:
    """Motion of a ball along a plane, at equal times."""

    time: NDArray[np.float64]  # [s]
    distance: NDArray[np.float64]  # [m]
    speed: NDArray[np.float64]  # [m/s]
    spin: NDArray[np.float64]  # [rad/s]


@cache
def track_on_slope(
    ball: Ball,
    *,
    slope: float = 0.0,
    friction: float,
    rolling_friction: float = 0.0,
    speed: float = 0.0,
    spin: float = 0.0,
    end: float,
    samples: int = 1000,
) -> Track:
    """Let a ball go on a plane of its own material, pressed in by its weight.

    Parameters
    ----------
    ball : Ball
    slope : float
        Of the plane, down towards +x [rad].
    friction, rolling_friction : float
        [-].
    speed : float
        At the start [m/s].
    spin : float
        At the start [rad/s].
    end : float
        [s].
    samples : int
        Times at which the motion is noted, after the start.
    """
    weight = ball.mass * GRAVITY * math.cos(slope)
    hertz = 4 / 3 * math.sqrt(ball.radius) / (2 * ball.compliance)
    overlap = (weight / hertz) ** (2 / 3)
    solids = _solids(
        [ball],
        _law(ball, restitution=0.5, friction=friction),
        velocity=[[speed, 0.0, 0.0]],
        spin=[spin],
        gap=-overlap,
        rolling_friction=rolling_friction,
    )
    solids.set_forcing(acceleration=GRAVITY * np.array([[math.sin(slope), 0.0, -math.cos(slope)]]))
    interval = end / samples
    steps = math.ceil(interval / (0.05 * math.sqrt(ball.mass * overlap / weight)))
    track = np.zeros((samples, 3))
    for row in track:
        solids.advance(interval / steps, steps)
        row[:] = solids.position[0, 0], solids.velocity[0, 0], solids.spin[0, 1]
    distance, speeds, spins = track.T
    time = np.linspace(interval, end, samples)
    return Track(time=time, distance=distance, speed=speeds, spin=spins)


def _law(
    ball: Ball,
    other: Ball | None = None,
    *,
    rigid: bool = False,
    restitution: float,
    friction: float,
) -> dem.HertzMindlin:
    other = other or ball
    return dem.HertzMindlin(
        youngs_modulus=ball.youngs_modulus,
        poisson_ratio=ball.poisson_ratio,
        other_youngs_modulus=math.inf if rigid else other.youngs_modulus,
        other_poisson_ratio=other.poisson_ratio,
        restitution=restitution,
        friction=friction,
    )


def _solids(
    balls: Sequence[Ball],
    law: dem.HertzMindlin | dem.LinearSpring,
    *,
    velocity: list[list[float]],
    spin: list[float],
    gap: float = 0.0,
    rolling_friction: float = 0.0,
) -> dem.Solids:
    """One ball above the plane, or two that touch at the origin, the first one above."""
    height = [balls[0].radius + gap, *(-ball.radius for ball in balls[1:])]
    up = np.array([0.0, 0.0, 1.0])
    plane = geometry.Plane(point=np.zeros(3), normal=up, velocity=np.zeros(3))
    return dem.Solids(
        position=np.array([[0.0, 0.0, z] for z in height]),
        velocity=np.array(velocity),
        spin=np.array([[0.0, s, 0.0] for s in spin]),
        radius=np.array([ball.radius for ball in balls]),
        density=np.array([ball.density for ball in balls]),
        pair_law=law,
        wall_law=law,
        wall_rolling_friction=rolling_friction,
        walls=[plane] if len(balls) == 1 else [],
    )


def _contact_time(compliance: float, radius: float, mass: float, speed: float) -> float:
    """Duration of an elastic Hertz impact [s]; it only sets the step."""
    return float(2.87 * (mass**2 * compliance**2 / (radius * speed)) ** 0.2)


def _rebound(solids: dem.Solids, contact_time: float) -> Rebound:
    dt = contact_time / _STEPS_PER_IMPACT
    overlap = force = duration = 0.0
    for step in range(10 * _STEPS_PER_IMPACT):
        overlap = max(overlap, solids.advance(dt, 1).largest_overlap)
        contacts = solids.contacts()
        if len(contacts["first"]):
            duration += dt
            force = max(force, float(np.linalg.norm(contacts["force"][0])))
        elif step > _STEPS_PER_IMPACT / 10:
            break
    else:
        raise RuntimeError("the impact does not end")
    (tangential, _, normal), spin = solids.velocity[0], solids.spin[0, 1]
    return Rebound(
        normal=float(normal),
        tangential=float(tangential),
        spin=float(spin),
        patch=float(tangential - solids.radius[0] * spin),
        largest_overlap=overlap * float(min(solids.radius)),
        largest_force=force,
        duration=duration,
    )
