"""The frames of the results, and the ledgers in them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from mpsdem.case import Motion, Pipe
from mpsdem.liquids import section_count
from mpsdem.results import ResultsWriter
from mpsdem.stages.state import FloatArray, SimulationDiverged, State, check

Fields = dict[str, ArrayLike]

# What the state gathers between two frames, by the names of the results, and starts anew.
_SINCE_LAST_FRAME = (
    "largest_overlap",
    "void_fraction_clipped",
    "liquid_void_fraction_clipped",
    "drags",
    "drags_outside",
    "exchange_error",
    "liquid_volume_error",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """Write a frame each time that one is due, after a look whether it is sound."""

    name: ClassVar[str] = "Record"
    writer: ResultsWriter
    steps_per_frame: int
    absurd_speed: float  # [m/s] of mean energy, that no sound run comes to
    pipe: Pipe
    motion: Motion
    gravity: FloatArray  # (3,) [m/s2]
    solids_density: float  # [kg/m3]; 0 where there are none
    liquid_density: float  # [kg/m3]; 0 where there is none

    def __call__(self, state: State, _dt: float) -> None:
        if state.step % self.steps_per_frame:
            return
        solids: Mapping[str, ArrayLike] = {}
        liquid: Mapping[str, ArrayLike] = {}
        diagnostics: Fields = {}
        interval = state.time - state.frame_time
        if state.population is not None:
            check(state, self.pipe.radius)
            solids, diagnostics = self._solids(state, interval)
        if state.liquid is not None:
            liquid, of_liquid = state.liquid.frame()
            diagnostics |= of_liquid
            self._split_gradient(state, diagnostics)
            diagnostics["liquid_flux"] = self._liquid_flux(state, diagnostics)
        if interval > 0:
            self._require_sane(state, diagnostics)
        if state.axis is None:
            self._energy(state, diagnostics, interval)
        if not self.motion.at_rest:
            pipe = self.motion.at(state.time)
            diagnostics["pipe_displacement"] = pipe.displacement
            diagnostics["pipe_velocity"] = pipe.velocity
            diagnostics["pipe_acceleration"] = pipe.acceleration
        self.writer.append(state.time, solids=solids, liquid=liquid, diagnostics=diagnostics)
        state.frame_time = state.time
        for name in _SINCE_LAST_FRAME:
            setattr(state, name, type(getattr(state, name))())

    def _require_sane(self, state: State, numbers: Fields) -> None:
        """Stop a run that is finite, and no physics: with more energy than anything can give it."""
        squares = {"liquid": 2 * np.asarray(numbers.get("liquid_kinetic_energy", 0.0)).item()}
        if state.population is not None:
            energy = np.asarray(numbers["kinetic_energy"]).item()
            squares["solids"] = 2 * energy / float(state.solids.mass.sum())
        whose = max(squares, key=squares.__getitem__)
        if (speed := math.sqrt(squares[whose])) > self.absurd_speed:
            raise SimulationDiverged(
                step=state.step,
                time=state.time,
                field=f"mean speed, {speed:.3g} m/s where {self.absurd_speed:.3g} m/s is absurd,",
                whose=f"the {whose}",
                remedy="let a packed bed in a liquid that flows start with its speed "
                "(solids.arrangement.velocity); else a smaller fidelity.liquid_step and "
                "fidelity.coupling_step",
            )

    def _solids(self, state: State, interval: float) -> tuple[Fields, Fields]:
        """Fields of the solids, and their numbers; forces as means since the last frame."""
        solids = state.solids
        velocity, mass, wall_impulse = solids.velocity, solids.mass, solids.wall_impulse
        seen = state.from_pipe(velocity)
        fields: Fields = {
            "position": state.position,
            "velocity": seen,
            "spin": solids.spin,
            "laps": solids.laps,
            **self._sections(state),
        }
        numbers: Fields = {
            "solids_mean_velocity": np.average(velocity[:, 0], weights=mass),
            "largest_overlap": state.largest_overlap,
            "kinetic_energy": solids.kinetic_energy
            + float(mass @ ((seen**2).sum(axis=1) - (velocity**2).sum(axis=1))) / 2,
            "elastic_energy": solids.elastic_energy,
            "contacts": len(solids.contacts()["first"]),
        }
        drag = wall = np.zeros(3)
        if state.liquid is not None:
            slip = state.liquid_velocity - velocity
            force = (mass * state.drag_rate)[:, None] * slip
            fields["void_fraction"] = state.void_fraction
            fields["liquid_velocity"] = state.from_pipe(state.liquid_velocity)
            fields["drag_force"] = force
            drag = force.sum(axis=0)
            numbers["void_fraction_clipped"] = state.void_fraction_clipped
            numbers["drags"] = state.drags
            numbers["drags_outside"] = state.drags_outside
        if state.exchange is not None:
            for name in ("liquid_void_fraction_clipped", "exchange_error", "liquid_volume_error"):
                numbers[name] = getattr(state, name)
        if interval > 0:
            drag = (state.drag_impulse - state.frame_drag_impulse) / interval
            wall = (wall_impulse - state.frame_wall_impulse) / interval
        state.frame_drag_impulse = state.drag_impulse
        state.frame_wall_impulse = wall_impulse
        return fields, numbers | {"wall_force": wall, "drag_force": drag}

    def _sections(self, state: State) -> Fields:
        """What is where along the pipe: the solids with their centres in equal bins."""
        solids, count = state.solids, section_count(self.pipe.radius, self.pipe.length)
        share = solids.position[:, 0] / self.pipe.length
        section = np.minimum((share * count).astype(np.intp), count - 1)
        volume = 4 / 3 * np.pi * solids.radius**3
        filled = np.bincount(section, weights=volume, minlength=count)
        flux = np.bincount(section, weights=volume * solids.velocity[:, 0], minlength=count)
        velocity = np.full(count, np.nan)
        np.divide(flux, filled, out=velocity, where=filled > 0)
        return {
            "section_solids_fraction": filled * count / self.pipe.bore_volume,
            "section_solids_velocity": velocity,
        }

    def _split_gradient(self, state: State, numbers: Fields) -> None:
        """The loss of pressure as friction of the wall and drag of the solids.

        A liquid that feels the solids spends the loss on both; another one on its friction alone.
        """
        drag = float(np.asarray(numbers.get("drag_force", np.zeros(3)))[0])
        of_solids = drag / self.pipe.bore_volume
        numbers["pressure_gradient_solids"] = of_solids
        if state.exchange is None:
            numbers["pressure_gradient"] = np.add(numbers["pressure_gradient"], of_solids)

    def _liquid_flux(self, state: State, numbers: Fields) -> float:
        """That of the liquid alone [m/s], where what flows through the bore holds solids too."""
        flux = float(np.asarray(numbers["bulk_velocity"]))
        if state.exchange is None:
            return flux
        volume = 4 / 3 * np.pi * state.solids.radius**3
        return flux - float(volume @ state.mean_velocity[:, 0]) / self.pipe.bore_volume

    def _energy(self, state: State, numbers: Fields, interval: float) -> None:
        """What pressure and shaking put in, and what of it is neither motion nor height."""
        per_length = 0.0
        flux = np.asarray(numbers.get("bulk_velocity", 0.0)).item()
        energy = self._stored(state, numbers)
        if state.liquid is not None:
            mean_flux = (flux + state.frame_flux) / 2 if interval > 0 else flux
            section = self.pipe.bore_volume / self.pipe.length
            per_length = mean_flux * section * np.asarray(numbers["pressure_gradient"]).item()
            numbers["power_input"] = per_length
        shaking = 0.0
        if state.population is not None and not self.motion.at_rest:
            work = state.shaking_work - state.frame_shaking_work
            shaking = work / interval / self.pipe.length if interval > 0 else 0.0
            numbers["shaking_power"] = shaking
            state.frame_shaking_work = state.shaking_work
        gained = (energy - state.frame_energy) / interval if interval > 0 else 0.0
        numbers["dissipation"] = per_length + shaking - gained / self.pipe.length
        state.frame_energy, state.frame_flux = energy, flux

    def _stored(self, state: State, numbers: Fields) -> float:
        """Energy of motion, contacts and height of the solids in the liquid [J]."""
        volume, energy = 0.0, 0.0
        if state.population is not None:
            solids = state.solids
            each = 4 / 3 * np.pi * solids.radius**3
            x = solids.position
            x[:, 0] += self.pipe.length * solids.laps
            volume = float(each.sum())
            excess = self.solids_density - self.liquid_density
            energy = solids.kinetic_energy + solids.elastic_energy
            energy -= excess * float(self.gravity @ (each @ x))
        per_mass = float(np.asarray(numbers.get("liquid_kinetic_energy", 0.0)))
        return energy + self.liquid_density * (self.pipe.bore_volume - volume) * per_mass
