"""Experiments with the particle liquid in a full pipe.

The diameter of the pipe, the bulk velocity and the density are 1: a pressure is over rho U^2, a
time over D / U. The axis is x. Checks of one experiment share its run.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache

import numpy as np
from numpy.typing import NDArray

from mpsdem._core import mps
from mpsdem.geometry import Kind, ring_layout
from mpsdem.validation import exact_flows as exact

FloatArray = NDArray[np.float64]

RADIUS = 0.5  # [D]
LAMINAR_REYNOLDS = 50.0

_SLOWEST = 5.783  # [nu / R^2] rate at which the slowest laminar disturbance decays: 2.4048^2
_SHORTEST = 5  # [spacings] of a periodic pipe: two reaches of 2.1, and some
_FASTEST = 1.25  # [U] in a developed turbulent flow, for the length of a step


class ParticlePipe:
    """A full pipe of particles.

    Parameters
    ----------
    across : int
        Spacings across the bore.
    length : float
        Of the period [D].
    reynolds : float
        Of bulk velocity and diameter [-].
    velocity : callable
        Axial velocity at the start, of the radii over the pipe's [U].
    swirl : float
        A disturbance across the pipe that turns once a diameter [U].
    roughness : float
        Sand grains [D].
    gradient : float, optional
        Loss of pressure along the pipe [rho U^2 / D]; else the bulk velocity is held.
    courant : float
        [-].
    """

    def __init__(
        self,
        *,
        across: int,
        length: float,
        reynolds: float,
        velocity: Callable[[FloatArray], FloatArray],
        swirl: float = 0.0,
        roughness: float = 0.0,
        gradient: float | None = None,
        courant: float = 0.8,
    ) -> None:
        layout = ring_layout(radius=RADIUS, length=length, spacing=1 / across)
        self.moving = layout.kind == Kind.LIQUID
        x = layout.position[self.moving]
        share = _share(x)
        start = np.zeros_like(layout.position)
        turn = 2 * np.pi * x[:, 0] * max(1, round(length)) / length
        across_flow = swirl * (1 - share**2)
        start[self.moving] = np.column_stack(
            [velocity(share), across_flow * np.sin(turn), across_flow * np.cos(turn)]
        )
        self.liquid = mps.LagrangianLiquid(
            position=layout.position,
            velocity=start,
            kind=layout.kind,
            particle_spacing=layout.spacing,
            pipe_radius=RADIUS,
            pipe_length=length,
            density=1.0,
            kinematic_viscosity=1 / reynolds,
            roughness=roughness,
            turbulent=reynolds > 2300,
            bulk_velocity=1.0,
            pressure_gradient=gradient,
            courant=courant,
        )

    def advance(self, step: float) -> mps.LiquidReport:
        """Go on by a step [D / U], and make sure that all is well."""
        report = self.liquid.advance(step)
        if not report.sound:
            raise ArithmeticError("the particle liquid diverged")
        return report

    @property
    def share(self) -> FloatArray:
        """Distance of each liquid particle from the axis over the pipe's radius, (n,) [-]."""
        return _share(self.liquid.position[self.moving])

    @property
    def velocity(self) -> FloatArray:
        """Of each liquid particle, (n, 3) [U]."""
        velocity: FloatArray = self.liquid.velocity[self.moving]
        return velocity


def _share(position: FloatArray) -> FloatArray:
    share: FloatArray = np.hypot(position[:, 1], position[:, 2]) / RADIUS
    return share


def _viscous_step(across: int) -> float:
    """Longest step of a laminar flow, so that a call is one step of the liquid [D / U]."""
    return min(0.1 * LAMINAR_REYNOLDS / across**2, 0.8 / across / 2.2)


@dataclass(frozen=True, slots=True, kw_only=True)
class Laminar:
    """A laminar flow beside the exact one.

    Attributes
    ----------
    error : float
        Root mean square of the whole difference in velocity over that of the velocity [-].
    axial_error : float
        The same of the axial velocity alone [-].
    bulk : float
        Flow rate over the exact one [-]: the exact mean over the bore, plus the mean difference
        of the particles. So the few places at which they sample the profile do not count.
    mean_of_particles : float
        What the program calls the bulk velocity, over the exact one [-].
    """

    error: float
    axial_error: float
    bulk: float
    mean_of_particles: float


def _beside(pipe: ParticlePipe, exact_axial: FloatArray, exact_bulk: float) -> Laminar:
    difference = pipe.velocity
    difference[:, 0] -= exact_axial
    size = float(np.linalg.norm(exact_axial))
    return Laminar(
        error=float(np.linalg.norm(difference)) / size,
        axial_error=float(np.linalg.norm(difference[:, 0])) / size,
        bulk=1 + float(difference[:, 0].mean()) / exact_bulk,
        mean_of_particles=pipe.liquid.bulk_velocity / exact_bulk,
    )


def _mean(flows: list[Laminar]) -> Laminar:
    return Laminar(
        **{
            name: float(np.mean([getattr(flow, name) for flow in flows]))
            for name in Laminar.__slots__
        }
    )


@cache
def poiseuille(across: int) -> Laminar:
    """A parabola under its own gradient, while a disturbance of it would die out twice.

    The mean over the last 15 % of that time.
    """
    gradient = 32 / LAMINAR_REYNOLDS
    pipe = ParticlePipe(
        across=across,
        length=_SHORTEST / across,
        reynolds=LAMINAR_REYNOLDS,
        velocity=exact.parabola,
        gradient=gradient,
    )
    step = _viscous_step(across)
    steps = math.ceil(2 * RADIUS**2 * LAMINAR_REYNOLDS / _SLOWEST / step)
    flows = []
    for k in range(steps):
        pipe.advance(step)
        if k >= 0.85 * steps:
            flows.append(_beside(pipe, exact.parabola(pipe.share), 1.0))
    return _mean(flows)


@cache
def start_up(across: int) -> Laminar:
    """From rest under a given gradient, at 0.15 R^2 / nu: half of the way to the parabola."""
    time = 0.15  # [R^2 / nu]
    pipe = ParticlePipe(
        across=across,
        length=_SHORTEST / across,
        reynolds=LAMINAR_REYNOLDS,
        velocity=np.zeros_like,
        gradient=32 / LAMINAR_REYNOLDS,
    )
    end = time * RADIUS**2 * LAMINAR_REYNOLDS
    steps = math.ceil(end / _viscous_step(across))
    for _ in range(steps):
        pipe.advance(end / steps)
    points = np.sqrt((np.arange(1000) + 0.5) / 1000)  # of equal shares of the bore
    bulk = float(exact.start_up(points, time).mean())
    return _beside(pipe, exact.start_up(pipe.share, time), bulk)


@dataclass(frozen=True, slots=True, kw_only=True)
class Oscillation:
    """A flow that oscillates beside the exact one: complex ratios of got to exact phasors."""

    flow_rate: complex
    axis: complex


@cache
def oscillation(womersley: float, across: int) -> Oscillation:
    """A flow in a gradient K cos(w t), started as the exact one; its largest bulk velocity is 1.

    Measured at every step of a cycle, or of R^2 / nu where that is shorter, after a quarter of
    R^2 / nu: six times, and one and a half times, as long as the slowest disturbance lives.
    """
    mean = exact.mean_oscillation(womersley)
    nu = 1 / LAMINAR_REYNOLDS
    frequency = womersley**2 * nu / RADIUS**2
    gradient = 8 * nu / RADIUS**2 / abs(mean)
    axis = complex(2 / abs(mean) * exact.oscillation(np.zeros(1), womersley)[0])
    bulk = mean / abs(mean)

    def axial(share: FloatArray, time: float) -> FloatArray:
        phasor = 2 / abs(mean) * exact.oscillation(share, womersley)
        return np.real(phasor * np.exp(1j * frequency * time))

    pipe = ParticlePipe(
        across=across,
        length=_SHORTEST / across,
        reynolds=LAMINAR_REYNOLDS,
        velocity=lambda share: axial(share, 0.0),
        gradient=0.0,
    )
    cycle = 2 * math.pi / frequency
    in_cycle = math.ceil(cycle / _viscous_step(across))
    step = cycle / in_cycle
    diffusion = RADIUS**2 / nu
    measured = math.ceil(min(cycle, diffusion) / step)
    steps = measured + math.ceil(0.25 * diffusion / step)
    times, differences = [], []
    for k in range(steps):
        # The force of the middle of the step: the error of this splitting is of second order.
        pipe.liquid.drive(
            bulk_velocity=1.0,
            pressure_gradient=gradient * math.cos(frequency * (k + 0.5) * step),
        )
        pipe.advance(step)
        if k >= steps - measured:
            time = (k + 1) * step
            share = pipe.share
            difference = pipe.velocity[:, 0] - axial(share, time)
            times.append(time)
            differences.append((difference.mean(), difference[share < 0.2].mean()))
    phase = frequency * np.array(times)
    waves = np.column_stack([np.cos(phase), -np.sin(phase)])  # real part of (a + b i) exp(i w t)
    (a, c), (b, d) = np.linalg.lstsq(waves, np.array(differences), rcond=None)[0]
    return Oscillation(flow_rate=1 + complex(a, b) / bulk, axis=1 + complex(c, d) / axis)


@dataclass(frozen=True, slots=True, kw_only=True)
class Turbulent:
    """A turbulent flow whose bulk velocity is held, over the second half of its run.

    Attributes
    ----------
    across : int
        Spacings across the bore.
    friction : float
        Darcy friction factor of the mean pressure gradient [-].
    wall_friction : float
        That of the wall function's mean shear [-].
    change : float
        Of the bulk velocity, as a friction factor [-].
    unexplained : float
        What p' did to the axial momentum, as a friction factor [-].
    profile : (across / 2,) float64 ndarray
        Mean axial velocity in rings of one spacing, from the axis outwards [U].
    kinetic_energy : (steps,) float64 ndarray
        Of the whole run, over that at the start [-].
    largest_scatter : float
        Of the number density over its mean [-], of the whole run.
    noise : float
        Root mean square change of the pressure in a step [rho U^2], of the second half.
    outside : int
        Most liquid particles that were outside of the wall at once.
    mass : float
        Of the liquid inside the bore at the end, over that at the start [-].
    clips : int
        Pressures and eddy viscosities that were cut.
    """

    across: int
    friction: float
    wall_friction: float
    change: float
    unexplained: float
    profile: FloatArray = field(repr=False)
    kinetic_energy: FloatArray = field(repr=False)
    largest_scatter: float
    noise: float
    outside: int
    mass: float
    clips: int

    @property
    def ring_middles(self) -> FloatArray:
        """Where the rings of the profile are, over the pipe's radius [-]."""
        rings = len(self.profile)
        middles: FloatArray = (np.arange(rings) + 0.5) / rings
        return middles

    @property
    def growth(self) -> float:
        """Mean kinetic energy of the last quarter over that of the second, less 1; not below 0."""
        quarter = len(self.kinetic_energy) // 4
        late = self.kinetic_energy[-quarter:].mean()
        return max(0.0, float(late / self.kinetic_energy[quarter : 2 * quarter].mean()) - 1)


@cache
def turbulent(
    reynolds: float, *, across: int, length: float, time: float, roughness: float = 0.0
) -> Turbulent:
    """A flow from a power law with a swirl of a tenth of the bulk velocity, at Courant 0.8.

    Parameters
    ----------
    reynolds : float
        [-].
    across : int
        Spacings across the bore.
    length : float
        Of the period [D].
    time : float
        Of the run [D / U].
    roughness : float
        Sand grains [D].
    """
    pipe = ParticlePipe(
        across=across,
        length=length,
        reynolds=reynolds,
        velocity=lambda share: 1.2245 * (1 - share) ** (1 / 7),
        swirl=0.1,
        roughness=roughness,
    )
    liquid = pipe.liquid
    step = 0.8 / across / _FASTEST
    steps = round(time / step)
    energy = [liquid.kinetic_energy]
    ledger, scatter, noise = [], [], []
    outside = clips = 0
    rings = across // 2
    count, total = np.zeros(rings), np.zeros(rings)
    for k in range(steps):
        before = liquid.bulk_velocity
        report = pipe.advance(step)
        energy.append(liquid.kinetic_energy)
        clips += report.clamped + report.viscosity_capped
        share = pipe.share
        outside = max(outside, int((share >= 1).sum()))
        scatter.append(liquid.density_scatter)
        if 2 * k < steps:
            continue
        noise.append(liquid.pressure_noise)
        change = (liquid.bulk_velocity - before) / step
        ledger.append((report.mean_gradient, 4 * liquid.wall_shear, change, report.unexplained))
        ring = np.minimum((share * rings).astype(np.intp), rings - 1)
        count += np.bincount(ring, minlength=rings)
        total += np.bincount(ring, weights=pipe.velocity[:, 0], minlength=rings)
    friction, wall, change, unexplained = 2 * np.mean(ledger, axis=0)
    x = liquid.position[pipe.moving]
    inside = (_share(x) < 1) & (x[:, 0] >= 0) & (x[:, 0] < length)
    return Turbulent(
        across=across,
        friction=friction,
        wall_friction=wall,
        change=change,
        unexplained=unexplained,
        profile=total / count,
        kinetic_energy=np.array(energy) / energy[0],
        largest_scatter=max(scatter),
        noise=math.sqrt(np.mean(np.square(noise))),
        outside=outside,
        mass=float(inside.sum() / pipe.moving.sum()),
        clips=clips,
    )
