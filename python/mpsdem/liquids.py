"""The liquids behind one interface: what carries the solids never asks which one it is."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mpsdem._core import mps
from mpsdem.case import Case
from mpsdem.geometry import Kind, Layout, push_plate_layout, ring_layout
from mpsdem.plan import Plan, clear_gradient, outlet_length, pipe_profile

FloatArray = NDArray[np.float64]
Stored = NDArray[Any] | int | float

#: What the particle liquid cuts and counts, by the names of its report and of the results.
CLIPS = ("clamped", "viscosity_capped", "shifts_cut", "deficient", "held_back")

#: What it counts besides where a plate pushes it.
PLATE_COUNTS = ("plate_returns", "entered", "replaced", "crowded", "left", "pushed")

_PROFILE_POINTS = 101  # radii of the prescribed profile in the results
_RINGS = 20  # radial bins of the measured profile
_SLABS = 256  # slabs that fill the gap behind a push plate, until they come again
_MOST_WRITTEN = 10_000  # particles of a frame, unless the case says otherwise


class Liquid(Protocol):
    """What the rest of the program knows of a liquid."""

    @property
    def sound(self) -> bool:
        """Whether all is well after the last advance."""

    def advance(self, dt: float) -> None:
        """Go on by dt [s]."""

    def velocity_at(self, position: FloatArray) -> FloatArray:
        """Velocity at points, (n, 3) [m/s]."""

    def static_fields(self) -> Mapping[str, ArrayLike]:
        """Fields of the results that do not change."""

    def frame(self) -> tuple[Mapping[str, ArrayLike], Mapping[str, ArrayLike]]:
        """Fields and diagnostics for the results, since the last frame."""

    def state(self) -> dict[str, Stored]:
        """All that changes, for a checkpoint."""

    def restore(self, state: Mapping[str, Any]) -> None:
        """Go on from a `state`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProfileLiquid:
    """The developed profile of the pipe, prescribed and steady."""

    profile: mps.PipeProfile
    pipe_radius: float
    bulk_velocity: float
    pressure_gradient: float  # [Pa/m] loss of the liquid alone
    sound: bool = True

    def advance(self, dt: float) -> None:
        """Do nothing: it is steady."""

    def velocity_at(self, position: FloatArray) -> FloatArray:
        return self.profile.velocity(position)

    def static_fields(self) -> dict[str, ArrayLike]:
        radius = np.linspace(0, self.pipe_radius, _PROFILE_POINTS)
        velocity = self.profile.velocity(np.outer(radius, [0.0, 0.0, 1.0]))
        return {"profile_radius": radius, "profile_velocity": velocity[:, 0]}

    def frame(self) -> tuple[dict[str, ArrayLike], dict[str, ArrayLike]]:
        diagnostics: dict[str, ArrayLike] = {
            "bulk_velocity": self.bulk_velocity,
            "pressure_gradient": self.pressure_gradient,
        }
        return {}, diagnostics

    def state(self) -> dict[str, Stored]:
        return {}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Do nothing: nothing changes."""


@dataclass(slots=True, kw_only=True)
class Tally:
    """What the particle liquid met since the last frame."""

    time: float = 0.0  # [s]
    impulse: float = 0.0  # [Pa s/m] of the pressure gradient
    substeps: int = 0
    iterations: int = 0
    residual: float = 0.0
    clamped: int = 0
    viscosity_capped: int = 0
    shifts_cut: int = 0
    deficient: int = 0
    held_back: int = 0
    plate_returns: int = 0
    entered: int = 0
    replaced: int = 0
    crowded: int = 0
    left: int = 0
    pushed: int = 0

    @property
    def plate_counts(self) -> dict[str, ArrayLike]:
        """What the push plate did, by the names of the results."""
        return {name: getattr(self, name) for name in PLATE_COUNTS}

    @property
    def clips(self) -> dict[str, ArrayLike]:
        """Counts of all that was cut, by the names of the results."""
        return {name: getattr(self, name) for name in CLIPS}


@dataclass(slots=True, kw_only=True)
class ParticleLiquid:
    """MPS proper: moving particles in a full, straight pipe, periodic or with a push plate.

    Parameters
    ----------
    particles : mps.LagrangianLiquid
        What moves.
    kind : (n,) int8 ndarray
        Of each place for a particle: 2 liquid, -2 wall, -1 ghost.
    full_count : int
        Liquid particles that fill the bore.
    has_plate : bool
        Whether a plate pushes the liquid.
    pipe_radius, pipe_length : float
        [m].
    sampling_radius : float
        Over which the velocity at a point is averaged [m].
    written : (m,) intp ndarray
        Which particles the results hold.
    """

    particles: mps.LagrangianLiquid
    kind: NDArray[np.int8]
    full_count: int
    has_plate: bool
    pipe_radius: float
    pipe_length: float
    sampling_radius: float
    written: NDArray[np.intp]
    sound: bool = True
    tally: Tally = field(default_factory=Tally)

    def advance(self, dt: float) -> None:
        report = self.particles.advance(dt)
        tally = self.tally
        tally.time += dt
        tally.impulse += report.mean_gradient * dt
        tally.substeps += report.substeps
        tally.iterations += report.iterations
        tally.residual = max(tally.residual, report.residual)
        for name in (*CLIPS, *PLATE_COUNTS):
            setattr(tally, name, getattr(tally, name) + getattr(report, name))
        self.sound = report.sound

    @property
    def count_in_bore(self) -> int:
        """Liquid particles that are where liquid can be."""
        return int(self._in_bore(self.particles.position).sum())

    def _in_bore(self, x: FloatArray) -> NDArray[np.bool_]:
        """Which are liquid of the bore: none without a position, none at the plate."""
        inside = np.hypot(x[:, 1], x[:, 2]) < self.pipe_radius
        along = (x[:, 0] >= 0) & (x[:, 0] < self.pipe_length)
        result: NDArray[np.bool_] = (self.kind == Kind.LIQUID) & inside & along
        return result

    def velocity_at(self, position: FloatArray) -> FloatArray:
        velocity: FloatArray = self.particles.velocity_at(
            points=position, radius=self.sampling_radius
        )
        return velocity

    @property
    def _edges(self) -> FloatArray:
        return np.linspace(0, self.pipe_radius, _RINGS + 1)

    @property
    def _sections(self) -> int:
        return max(1, round(self.pipe_length / self.pipe_radius))

    def static_fields(self) -> dict[str, ArrayLike]:
        edges = self._edges
        fields: dict[str, ArrayLike] = {
            "profile_radius": (edges[1:] + edges[:-1]) / 2,
            "section_position": (np.arange(self._sections) + 0.5)
            * (self.pipe_length / self._sections),
        }
        if self.written.size:
            fields["kind"] = self.kind[self.written]
        return fields

    def frame(self) -> tuple[dict[str, ArrayLike], dict[str, ArrayLike]]:
        particles, tally = self.particles, self.tally
        position, velocity = particles.position, particles.velocity
        pressure = particles.pressure
        liquid = self._in_bore(position)
        ring = np.digitize(np.hypot(*position[liquid, 1:].T), self._edges[1:-1])
        share = position[liquid, 0] / self.pipe_length
        section = np.minimum((share * self._sections).astype(np.intp), self._sections - 1)
        fields: dict[str, ArrayLike] = {
            "velocity_profile": _bin_means(ring, velocity[liquid, 0], _RINGS),
            "section_pressure": _bin_means(section, pressure[liquid], self._sections),
        }
        if self.written.size:
            fields |= {
                "position": position[self.written],
                "velocity": velocity[self.written],
                "pressure": pressure[self.written],
            }
        gradient = tally.impulse / tally.time if tally.time else particles.pressure_gradient
        diagnostics: dict[str, ArrayLike] = {
            "bulk_velocity": particles.bulk_velocity,
            "pressure_gradient": gradient,
            "pressure_iterations": tally.iterations / max(1, tally.substeps),
            "pressure_residual": tally.residual,
            "density_scatter": particles.density_scatter,
            "pressure_noise": particles.pressure_noise,
            "liquid_kinetic_energy": particles.kinetic_energy,
            **tally.clips,
            **(tally.plate_counts if self.has_plate else {}),
        }
        self.tally = Tally()
        return fields, diagnostics

    def state(self) -> dict[str, Stored]:
        tally = {f"tally_{name}": getattr(self.tally, name) for name in Tally.__slots__}
        return {**self.particles.state(), **tally}

    def restore(self, state: Mapping[str, Any]) -> None:
        self.particles.restore({k: v for k, v in state.items() if not k.startswith("tally_")})
        for name in Tally.__slots__:
            setattr(self.tally, name, state[f"tally_{name}"])


def _bin_means(bins: NDArray[np.intp], values: FloatArray, count: int) -> FloatArray:
    """Mean of the values in each bin; NaN in an empty one."""
    number = np.bincount(bins, minlength=count)
    mean = np.full(count, np.nan)
    np.divide(
        np.bincount(bins, weights=values, minlength=count), number, out=mean, where=number > 0
    )
    return mean


def _sample(count: int, stride: int | None) -> NDArray[np.intp]:
    """Choose one of every `stride` particles.

    At random: a regular choice would take whole rings and leave others out.
    """
    if stride is None:
        stride = math.ceil(count / _MOST_WRITTEN)
    if stride == 0:
        return np.zeros(0, dtype=np.intp)
    chosen = np.random.default_rng(0).choice(count, size=math.ceil(count / stride), replace=False)
    return np.sort(chosen)


def particle_layout(case: Case) -> Layout:
    """Where the particles of a case's liquid start."""
    pipe = case.pipe
    spacing = case.fidelity.resolved_particle_spacing(pipe.radius)
    if not pipe.has_plate:
        return ring_layout(radius=pipe.radius, length=pipe.length, spacing=spacing)
    return push_plate_layout(
        radius=pipe.radius,
        length=pipe.length,
        spacing=spacing,
        upstream=pipe.resolved_stroke + pipe.settling_length,
        downstream=outlet_length(case),
    )


def _push_plate(case: Case) -> mps.PushPlate | None:
    pipe = case.pipe
    if case.liquid is None or not pipe.has_plate:
        return None
    return mps.PushPlate(
        velocity=case.liquid.bulk_velocity,
        stroke=pipe.resolved_stroke,
        settling=pipe.settling_length,
        outlet=outlet_length(case),
        draws=np.random.default_rng(0).random((_SLABS, 2)),
    )


def build_liquid(case: Case, plan: Plan) -> Liquid | None:
    """Make the liquid that the plan chose, with the developed profile for a start."""
    liquid, pipe = case.liquid, case.pipe
    if liquid is None:
        return None
    profile = pipe_profile(case)
    if plan.liquid_model == "profile":
        return ProfileLiquid(
            profile=profile,
            pipe_radius=pipe.radius,
            bulk_velocity=liquid.bulk_velocity,
            pressure_gradient=clear_gradient(case),
        )
    layout = particle_layout(case)
    moving = layout.kind == Kind.LIQUID
    velocity = np.where(moving[:, None], profile.velocity(layout.position), 0.0)
    particles = mps.LagrangianLiquid(
        position=layout.position,
        velocity=velocity,
        kind=layout.kind,
        particle_spacing=layout.spacing,
        pipe_radius=pipe.radius,
        pipe_length=pipe.length,
        plate=_push_plate(case),
        density=liquid.density,
        kinematic_viscosity=liquid.kinematic_viscosity,
        roughness=pipe.roughness,
        turbulent=not profile.laminar,
        bulk_velocity=liquid.bulk_velocity,
        pressure_gradient=liquid.pressure_gradient,
        courant=case.fidelity.courant,
        tolerance=case.fidelity.pressure_tolerance,
        threads=plan.threads,
    )
    vacant = len(particles) - len(layout.kind)  # places for what a plate may bring in
    kind = np.concatenate([layout.kind, np.full(vacant, Kind.LIQUID, dtype=np.int8)])
    return ParticleLiquid(
        particles=particles,
        kind=kind,
        full_count=particles.count_in_bore,
        has_plate=pipe.has_plate,
        pipe_radius=pipe.radius,
        pipe_length=pipe.length,
        sampling_radius=max(plan.smoothing_radius, 2.1 * layout.spacing),
        written=_sample(len(kind), case.output.liquid_stride),
    )
