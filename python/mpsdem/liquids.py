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
from mpsdem.geometry import Kind, Layout, lattice_layout, ring_layout
from mpsdem.plan import Plan, clear_gradient, pipe_profile, turbulence

FloatArray = NDArray[np.float64]
Stored = NDArray[Any] | int | float

#: What the particle liquid cuts and counts, by the names of its report and of the results.
CLIPS = ("clamped", "viscosity_capped", "shifts_cut", "deficient", "held_back")

_PROFILE_POINTS = 101  # radii of the prescribed profile in the results
_RINGS = 20  # radial bins of the measured profile
_SMAGORINSKY = 0.1  # [-] C_s, that of shear flows
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
    friction: float = 0.0  # [Pa s/m] taken up by walls and viscosity
    unexplained: float = 0.0  # [Pa s/m] what the solved pressure did along the pipe
    substeps: int = 0
    iterations: int = 0
    residual: float = 0.0
    clamped: int = 0
    viscosity_capped: int = 0
    shifts_cut: int = 0
    deficient: int = 0
    held_back: int = 0

    @property
    def clips(self) -> dict[str, ArrayLike]:
        """Counts of all that was cut, by the names of the results."""
        return {name: getattr(self, name) for name in CLIPS}


@dataclass(slots=True, kw_only=True)
class ParticleLiquid:
    """MPS proper: moving particles in a full, straight, periodic pipe.

    Parameters
    ----------
    particles : mps.LagrangianLiquid
        What moves.
    kind : (n,) int8 ndarray
        2 liquid, -2 wall, -1 ghost.
    pipe_radius, pipe_length : float
        [m].
    sampling_radius : float
        Over which the velocity at a point is averaged [m].
    written : (m,) intp ndarray
        Which particles the results hold.
    """

    particles: mps.LagrangianLiquid
    kind: NDArray[np.int8]
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
        tally.friction += report.friction * dt
        tally.unexplained += report.unexplained * dt
        tally.substeps += report.substeps
        tally.iterations += report.iterations
        tally.residual = max(tally.residual, report.residual)
        for name in CLIPS:
            setattr(tally, name, getattr(tally, name) + getattr(report, name))
        self.sound = report.sound

    @property
    def count_in_bore(self) -> int:
        """Liquid particles that are where liquid can be."""
        x = self.particles.position[self.kind == Kind.LIQUID]
        inside = np.hypot(x[:, 1], x[:, 2]) < self.pipe_radius
        return int((inside & (x[:, 0] >= 0) & (x[:, 0] < self.pipe_length)).sum())

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
        liquid = self.kind == Kind.LIQUID
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
        time = tally.time or math.inf  # nothing has acted yet
        gradient = tally.impulse / tally.time if tally.time else particles.pressure_gradient
        diagnostics: dict[str, ArrayLike] = {
            "bulk_velocity": particles.bulk_velocity,
            "pressure_gradient": gradient,
            "liquid_friction": tally.friction / time,
            "liquid_unexplained": tally.unexplained / time,
            "pressure_iterations": tally.iterations / max(1, tally.substeps),
            "pressure_residual": tally.residual,
            "density_scatter": particles.density_scatter,
            "pressure_noise": particles.pressure_noise,
            "liquid_kinetic_energy": particles.kinetic_energy,
            **tally.clips,
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
    spacing = case.fidelity.resolved_particle_spacing(case.pipe.radius)
    layout = lattice_layout if case.fidelity.layout == "lattice" else ring_layout
    return layout(radius=case.pipe.radius, length=case.pipe.length, spacing=spacing)


def _eddies(case: Case, spacing: float) -> mps.MixingLength | mps.Smagorinsky | None:
    model = turbulence(case)
    if model == "smagorinsky":
        return mps.Smagorinsky(coefficient=_SMAGORINSKY, spacing=spacing)
    return None if model is None else mps.MixingLength(pipe_radius=case.pipe.radius)


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
    if (mean := velocity[moving, 0].mean()) != 0:
        velocity *= liquid.bulk_velocity / mean  # the rings do not sample the profile evenly
    particles = mps.LagrangianLiquid(
        position=layout.position,
        velocity=velocity,
        kind=layout.kind,
        particle_spacing=layout.spacing,
        pipe_radius=pipe.radius,
        pipe_length=pipe.length,
        density=liquid.density,
        kinematic_viscosity=liquid.kinematic_viscosity,
        roughness=pipe.roughness,
        turbulence=_eddies(case, layout.spacing),
        bulk_velocity=liquid.bulk_velocity,
        pressure_gradient=liquid.pressure_gradient,
        courant=case.fidelity.courant,
        tolerance=case.fidelity.pressure_tolerance,
        solver=case.fidelity.pressure_solver,
        threads=plan.threads,
    )
    return ParticleLiquid(
        particles=particles,
        kind=layout.kind,
        pipe_radius=pipe.radius,
        pipe_length=pipe.length,
        sampling_radius=max(plan.smoothing_radius, 2.1 * layout.spacing),
        written=_sample(len(layout.kind), case.output.liquid_stride),
    )
