"""The particle liquid."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mpsdem._core import coupling, mps
from mpsdem.case import MovingAxis
from mpsdem.geometry import Kind
from mpsdem.liquids.bending import bending
from mpsdem.liquids.bins import (
    LAYERS,
    RINGS,
    bin_means,
    layer_edges,
    middles,
    ring_edges,
    section_count,
)
from mpsdem.liquids.protocol import FloatArray, Stored

#: What the particle liquid cuts and counts, by the names of its report and of the results.
CLIPS = ("clamped", "viscosity_capped", "shifts_cut", "deficient", "held_back")

#: What it counts besides where a plate pushes it.
PLATE_COUNTS = ("plate_returns", "entered", "replaced", "crowded", "left", "pushed")


@dataclass(slots=True, kw_only=True)
class Tally:
    """What the particle liquid met since the last frame."""

    time: float = 0.0  # [s]
    impulse: float = 0.0  # [Pa s/m] of the pressure gradient
    friction: float = 0.0  # [Pa s/m] taken up by walls and viscosity
    unexplained: float = 0.0  # [Pa s/m] what the solved pressure did along the pipe
    convection_error: float = 0.0  # [Pa s/m] that convection between solids lost, given back
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
    axis : MovingAxis or None
        Of a pipe whose walls move; the core then knows places and velocities in the laboratory.
    time : float
        Where a moving pipe is [s].
    """

    particles: mps.LagrangianLiquid
    kind: NDArray[np.int8]
    full_count: int
    has_plate: bool
    pipe_radius: float
    pipe_length: float
    sampling_radius: float
    written: NDArray[np.intp]
    axis: MovingAxis | None = None
    time: float = 0.0
    sound: bool = True
    tally: Tally = field(default_factory=Tally)

    @property
    def core(self) -> mps.LagrangianLiquid:
        return self.particles

    def advance(self, dt: float, exchange: coupling.Exchange | None = None) -> None:
        core = self.particles
        if self.axis is not None:
            core.bend(bending(self.axis, self.time, self.time + dt))
            self.time += dt
        report = core.advance(dt) if exchange is None else exchange.advance(core, dt)
        tally = self.tally
        tally.time += dt
        tally.impulse += report.mean_gradient * dt
        tally.friction += report.friction * dt
        tally.unexplained += report.unexplained * dt
        tally.convection_error += report.convection_error * dt
        tally.substeps += report.substeps
        tally.iterations += report.iterations
        tally.residual = max(tally.residual, report.residual)
        for name in (*CLIPS, *PLATE_COUNTS):
            setattr(tally, name, getattr(tally, name) + getattr(report, name))
        self.sound = report.sound

    @property
    def count_in_bore(self) -> int:
        """Liquid particles that are where liquid can be."""
        return int(self._in_bore(self._position).sum())

    @property
    def _position(self) -> FloatArray:
        """Where particles are, in the pipe."""
        place: FloatArray = self.particles.position
        return place if self.axis is None else self.axis.position(place, self.time)

    def _in_bore(self, x: FloatArray) -> NDArray[np.bool_]:
        """Which are liquid of the bore: none without a position, none at the plate."""
        inside = np.hypot(x[:, 1], x[:, 2]) < self.pipe_radius
        along = (x[:, 0] >= 0) & (x[:, 0] < self.pipe_length)
        result: NDArray[np.bool_] = (self.kind == Kind.LIQUID) & inside & along
        return result

    def velocity_at(self, position: FloatArray) -> FloatArray:
        axis, time = self.axis, self.time
        points = position if axis is None else axis.place(position, time)
        velocity: FloatArray = self.particles.velocity_at(
            points=points, radius=self.sampling_radius
        )
        return velocity if axis is None else axis.from_pipe(velocity, position[:, 0], time)

    @property
    def _edges(self) -> FloatArray:
        return ring_edges(self.pipe_radius)

    @property
    def _sections(self) -> int:
        return section_count(self.pipe_radius, self.pipe_length)

    def static_fields(self) -> dict[str, ArrayLike]:
        fields: dict[str, ArrayLike] = {
            "profile_radius": middles(self._edges),
            "layer_height": middles(layer_edges(self.pipe_radius)),
            "section_position": (np.arange(self._sections) + 0.5)
            * (self.pipe_length / self._sections),
        }
        if self.written.size:
            fields["kind"] = self.kind[self.written]
        return fields

    def frame(self) -> tuple[dict[str, ArrayLike], dict[str, ArrayLike]]:
        particles, tally = self.particles, self.tally
        position, velocity = self._position, particles.velocity
        if self.axis is not None:
            velocity = self.axis.from_pipe(velocity, position[:, 0], self.time)
        pressure = particles.pressure
        liquid = self._in_bore(position)
        ring = np.digitize(np.hypot(*position[liquid, 1:].T), self._edges[1:-1])
        layer = np.digitize(position[liquid, 2], layer_edges(self.pipe_radius)[1:-1])
        share = position[liquid, 0] / self.pipe_length
        section = np.minimum((share * self._sections).astype(np.intp), self._sections - 1)
        fields: dict[str, ArrayLike] = {
            "velocity_profile": bin_means(ring, velocity[liquid, 0], RINGS),
            "layer_velocity": bin_means(layer, velocity[liquid, 0], LAYERS),
            "section_pressure": bin_means(section, pressure[liquid], self._sections),
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
            "pressure_gradient_friction": tally.friction / time,
            "liquid_unexplained": tally.unexplained / time,
            "convection_error": tally.convection_error / time,
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
        return {**self.particles.state(), **tally, "time": self.time}

    def restore(self, state: Mapping[str, Any]) -> None:
        self.particles.restore({k: v for k, v in state.items() if not k.startswith("tally_")})
        self.time = float(state["time"])
        if self.axis is not None:
            self.particles.bend(bending(self.axis, self.time, self.time + 1.0))
        for name in Tally.__slots__:
            kind = type(getattr(self.tally, name))
            setattr(self.tally, name, kind(state[f"tally_{name}"]))
