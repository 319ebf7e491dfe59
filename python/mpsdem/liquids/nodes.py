"""The liquid on fixed nodes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mpsdem._core import coupling, mps
from mpsdem.geometry import Kind, NodeLayout
from mpsdem.liquids.bins import LAYERS, bin_means, layer_edges, middles, section_count
from mpsdem.liquids.protocol import FloatArray, Stored


@dataclass(slots=True, kw_only=True)
class NodeTally:
    """What the liquid met since the last frame."""

    time: float = 0.0  # [s]
    impulse: float = 0.0  # [Pa s/m] of the pressure gradient
    friction: float = 0.0  # [Pa s/m] taken up by the walls
    unexplained: float = 0.0  # [Pa s/m] what convection and pressure did along the pipe
    convection_error: float = 0.0  # [Pa s/m] that convection between solids lost, given back
    substeps: int = 0
    divergence: float = 0.0  # [-] largest


@dataclass(slots=True, kw_only=True)
class NodeLiquid:
    """Least-squares MPS on fixed nodes, in a full, straight, rigid, periodic pipe.

    Parameters
    ----------
    nodes : mps.EulerianLiquid
        What flows.
    layout : NodeLayout
        Where it was computed.
    pipe_radius, pipe_length : float
        [m].
    sampling_radius : float
        Over which the velocity at a point is averaged [m].
    written : (m,) intp ndarray
        Which nodes the results hold, counted section by section.
    """

    nodes: mps.EulerianLiquid
    layout: NodeLayout
    pipe_radius: float
    pipe_length: float
    sampling_radius: float
    written: NDArray[np.intp]
    sound: bool = True
    tally: NodeTally = field(default_factory=NodeTally)

    @property
    def core(self) -> mps.EulerianLiquid:
        return self.nodes

    def advance(self, dt: float, exchange: coupling.Exchange | None = None) -> None:
        core = self.nodes
        report = core.advance(dt) if exchange is None else exchange.advance(core, dt)
        tally = self.tally
        tally.time += dt
        tally.impulse += report.mean_gradient * dt
        tally.friction += report.friction * dt
        tally.unexplained += report.unexplained * dt
        tally.convection_error += report.convection_error * dt
        tally.substeps += report.substeps
        tally.divergence = max(tally.divergence, report.divergence)
        self.sound = report.sound

    @property
    def flux_error(self) -> float:
        """Largest difference of a section's flow rate from the mean, over the mean [-]."""
        flux = self.layout.area @ self.nodes.velocity[..., 0]
        mean = float(flux.mean())
        return float(np.abs(flux - mean).max()) / abs(mean) if mean != 0 else 0.0

    def velocity_at(self, position: FloatArray) -> FloatArray:
        velocity: FloatArray = self.nodes.velocity_at(points=position, radius=self.sampling_radius)
        return velocity

    @property
    def _sections(self) -> int:
        return min(section_count(self.pipe_radius, self.pipe_length), self.layout.stations)

    @property
    def _ring(self) -> NDArray[np.intp]:
        """Of every node of a cross-section, counted from the axis."""
        away = np.hypot(*self.layout.place.T)
        ring: NDArray[np.intp] = np.rint(away / self.layout.spacing).astype(np.intp)
        return ring

    def static_fields(self) -> dict[str, ArrayLike]:
        fields: dict[str, ArrayLike] = {
            "layer_height": middles(layer_edges(self.pipe_radius)),
            "profile_radius": np.arange(self._ring.max() + 1) * self.layout.spacing,
            "section_position": (np.arange(self._sections) + 0.5)
            * (self.pipe_length / self._sections),
        }
        if self.written.size:
            kind = np.full(len(self.layout.place), Kind.LIQUID, dtype=np.int8)
            kind[-self.layout.wall_count :] = Kind.WALL
            fields["kind"] = self._written(np.tile(kind[:, None], self.layout.stations))
        return fields

    def _written(self, values: NDArray[Any]) -> NDArray[Any]:
        """What the results hold of (nodes, stations, ...) values."""
        return values.reshape(-1, *values.shape[2:])[self.written]

    def frame(self) -> tuple[dict[str, ArrayLike], dict[str, ArrayLike]]:
        nodes, tally, layout = self.nodes, self.tally, self.layout
        velocity, pressure = nodes.velocity, nodes.pressure
        ring = self._ring
        section = np.arange(layout.stations) * self._sections // layout.stations
        layer = np.digitize(layout.place[:, 1], layer_edges(self.pipe_radius)[1:-1])
        along = velocity[..., 0].mean(axis=1)
        mean_pressure = layout.area @ pressure / layout.area.sum()
        fields: dict[str, ArrayLike] = {
            "velocity_profile": bin_means(ring, along, ring.max() + 1),
            "layer_velocity": bin_means(layer, layout.area * along, LAYERS)
            / bin_means(layer, layout.area, LAYERS),
            "section_pressure": bin_means(section, mean_pressure, self._sections),
        }
        if self.written.size:
            fields |= {
                "position": self._written(layout.position),
                "velocity": self._written(velocity),
                "pressure": self._written(pressure),
            }
        time = tally.time or math.inf  # nothing has acted yet
        gradient = tally.impulse / tally.time if tally.time else nodes.pressure_gradient
        diagnostics: dict[str, ArrayLike] = {
            "bulk_velocity": nodes.bulk_velocity,
            "pressure_gradient": gradient,
            "pressure_gradient_friction": tally.friction / time,
            "liquid_unexplained": tally.unexplained / time,
            "convection_error": tally.convection_error / time,
            "pressure_noise": nodes.pressure_noise,
            "liquid_kinetic_energy": nodes.kinetic_energy,
            "divergence": tally.divergence,
        }
        self.tally = NodeTally()
        return fields, diagnostics

    def state(self) -> dict[str, Stored]:
        tally = {f"tally_{name}": getattr(self.tally, name) for name in NodeTally.__slots__}
        return {**self.nodes.state(), **tally}

    def restore(self, state: Mapping[str, Any]) -> None:
        self.nodes.restore({k: v for k, v in state.items() if not k.startswith("tally_")})
        for name in NodeTally.__slots__:
            kind = type(getattr(self.tally, name))
            setattr(self.tally, name, kind(state[f"tally_{name}"]))
