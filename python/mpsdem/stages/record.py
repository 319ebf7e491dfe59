"""The frames of the results, and the ledgers in them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from mpsdem.results import ResultsWriter
from mpsdem.stages.state import FloatArray, State, check


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """Write a frame each time that one is due, after a look whether it is sound."""

    name: ClassVar[str] = "Record"
    writer: ResultsWriter
    steps_per_frame: int
    pipe_radius: float
    pipe_length: float

    def __call__(self, state: State, _dt: float) -> None:
        if state.step % self.steps_per_frame:
            return
        solids: Mapping[str, ArrayLike] = {}
        liquid: Mapping[str, ArrayLike] = {}
        diagnostics: dict[str, ArrayLike] = {}
        drag: FloatArray = np.zeros(3)
        if state.population is not None:
            check(state, self.pipe_radius)
            solids, numbers, drag = self._solids(state)
            diagnostics |= numbers
        if state.liquid is not None:
            bore = math.pi * self.pipe_radius**2 * self.pipe_length
            liquid, of_liquid = state.liquid.frame()
            diagnostics |= of_liquid
            if state.exchange is None:  # a liquid that feels them spends it on the solids too
                gradient = np.add(of_liquid["pressure_gradient"], drag[0] / bore)
                diagnostics["pressure_gradient"] = gradient
        self.writer.append(state.time, solids=solids, liquid=liquid, diagnostics=diagnostics)
        state.frame_time = state.time
        state.largest_overlap = 0.0

    def _solids(
        self, state: State
    ) -> tuple[dict[str, ArrayLike], dict[str, ArrayLike], FloatArray]:
        """Fields, numbers, and the mean drag on all solids since the last frame [N]."""
        solids = state.solids
        velocity, mass, wall_impulse = solids.velocity, solids.mass, solids.wall_impulse
        fields: dict[str, ArrayLike] = {
            "position": solids.position,
            "velocity": velocity,
            "spin": solids.spin,
            "laps": solids.laps,
        }
        drag: FloatArray = np.zeros(3)
        if state.liquid is not None:
            slip = state.liquid_velocity - velocity
            force = (mass * state.drag_rate)[:, None] * slip
            fields["void_fraction"] = state.void_fraction
            fields["liquid_velocity"] = state.liquid_velocity
            fields["drag_force"] = force
            drag = force.sum(axis=0)
        wall = np.zeros(3)
        if state.step > 0:
            interval = state.time - state.frame_time
            drag = (state.drag_impulse - state.frame_drag_impulse) / interval
            wall = (wall_impulse - state.frame_wall_impulse) / interval
        state.frame_drag_impulse = state.drag_impulse
        state.frame_wall_impulse = wall_impulse
        numbers: dict[str, ArrayLike] = {
            "solids_mean_velocity": np.average(velocity[:, 0], weights=mass),
            "largest_overlap": state.largest_overlap,
            "kinetic_energy": solids.kinetic_energy,
            "elastic_energy": solids.elastic_energy,
            "contacts": len(solids.contacts()["first"]),
            "wall_force": wall,
            "drag_force": drag,
        }
        return fields, numbers, drag
