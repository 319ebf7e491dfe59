"""What moves liquid and solids on by a step, and what they do to each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from mpsdem._core import coupling, dem
from mpsdem.case import Motion, MovingAxis, Pipe
from mpsdem.liquids import bending
from mpsdem.plan import DragLaw
from mpsdem.stages.state import FloatArray, SimulationDiverged, State, check


@dataclass(frozen=True, slots=True, kw_only=True)
class AdvanceLiquid:
    """Move the liquid: viscosity, pressure, and the particles themselves."""

    name: ClassVar[str] = "AdvanceLiquid"
    turns: int  # coupling steps to a step of the liquid, which is taken at the last of them
    held: bool = False  # whether the solids stay where they are

    def __call__(self, state: State, dt: float) -> None:
        assert state.liquid is not None
        if state.step % self.turns:
            return
        if state.exchange is None:
            state.liquid.advance(self.turns * dt)
        else:
            self._with_solids(state, self.turns * dt)
        if not state.liquid.sound:
            remedy = "a smaller fidelity.courant; then another fidelity.particle_spacing"
            if state.exchange is not None:
                wider = "a larger fidelity.smoothing_radius"
                remedy = f"a smaller fidelity.liquid_step, or {wider}; {remedy}"
            raise SimulationDiverged(
                step=state.step,
                time=state.time,
                field="pressure or velocity",
                remedy=remedy,
            )

    def _with_solids(self, state: State, dt: float) -> None:
        liquid, exchange = state.partners
        liquid.advance(dt, exchange)
        state.liquid_void_fraction_clipped += exchange.clipped
        state.exchange_error = max(state.exchange_error, exchange.mismatch)
        volume_error = abs(exchange.liquid_volume_error)
        state.liquid_volume_error = max(state.liquid_volume_error, volume_error)
        if self.held:
            state.drag_impulse = state.drag_impulse + exchange.impulse.sum(axis=0)


@dataclass(frozen=True, slots=True, kw_only=True)
class SampleLiquid:
    """Read the velocity of the liquid at the solids."""

    name: ClassVar[str] = "SampleLiquid"

    def __call__(self, state: State, _dt: float) -> None:
        assert state.liquid is not None
        state.liquid_velocity = state.to_laboratory(state.liquid.velocity_at(state.position))


@dataclass(frozen=True, slots=True, kw_only=True)
class BeginExchange:
    """Find the liquid around each solid, and its velocity, where a step of the liquid begins.

    In later turns of that step it is the solids that know how the liquid around them has changed.
    """

    name: ClassVar[str] = "SampleLiquid"
    turns: int
    pipe_radius: float

    def __call__(self, state: State, _dt: float) -> None:
        if state.step > 0 and (state.step - 1) % self.turns:
            return
        check(state, self.pipe_radius)  # no liquid is found around a solid outside the bore
        _, exchange = state.partners
        state.begun_at = state.solids.position
        begin_exchange(state)
        state.liquid_velocity = exchange.liquid_velocity
        state.mean_velocity = np.zeros_like(state.begun_at)
        state.mean_drag = np.zeros(len(state.begun_at))
        state.impulse = np.zeros_like(state.begun_at)


def begin_exchange(state: State) -> None:
    """Let the exchange begin from what the state holds: anew in a run that is resumed."""
    liquid, exchange = state.partners
    exchange.begin(liquid.core, position=state.begun_at, radius=state.solids.radius)


@dataclass(frozen=True, slots=True, kw_only=True)
class FindVoidFraction:
    """Find the share of liquid around each solid from its neighbors."""

    name: ClassVar[str] = "FindVoidFraction"
    average: coupling.VoidFraction
    threads: int

    def __call__(self, state: State, _dt: float) -> None:
        solids = state.solids
        state.void_fraction, clipped = self.average.at_solids(
            position=state.position, radius=solids.radius, threads=self.threads
        )
        state.void_fraction_clipped += clipped


@dataclass(frozen=True, slots=True, kw_only=True)
class DragForce:
    """Find the drag rate of each solid from its slip and the void fraction."""

    name: ClassVar[str] = "DragForce"
    law: DragLaw
    solid_density: FloatArray
    liquid_density: float
    kinematic_viscosity: float

    def __call__(self, state: State, _dt: float) -> None:
        solids = state.solids
        state.drags += len(solids)
        state.drags_outside += coupling.count_outside(
            self.law,
            liquid_velocity=state.liquid_velocity,
            velocity=solids.velocity,
            void_fraction=state.void_fraction,
            diameter=2 * solids.radius,
            kinematic_viscosity=self.kinematic_viscosity,
        )
        state.drag_rate = coupling.drag_rate(
            self.law,
            liquid_velocity=state.liquid_velocity,
            velocity=solids.velocity,
            void_fraction=state.void_fraction,
            diameter=2 * solids.radius,
            density=self.solid_density,
            liquid_density=self.liquid_density,
            kinematic_viscosity=self.kinematic_viscosity,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class AdvanceSolids:
    """Move the solids by contacts, drag, gravity and buoyancy, in many small steps.

    Seen from a pipe that is shaken as one body, its acceleration acts as gravity does: on solids in
    a liquid with what buoyancy leaves of it. Over a step it is constant, of the same impulse.
    Where walls move, the pressure that turns the liquid with them pushes the solids, too.
    """

    name: ClassVar[str] = "AdvanceSolids"
    gravity: FloatArray  # (3,) [m/s2]
    lightness: float  # share of its weight that a solid has left in the liquid [-]
    motion: Motion
    added_mass: float  # over the mass of a solid [-]
    substeps: int
    dry: bool
    pipe: Pipe
    bulk_velocity: float  # [m/s] of the liquid

    def __call__(self, state: State, dt: float) -> None:
        if state.axis is not None:
            self._with_walls(state, state.axis, dt)
        elif self.motion.at_rest:
            self._advance(state, dt, np.zeros(3))
        else:
            shaking, length = self._shaking(state.time, dt), self.pipe.length
            before = _first_moment(state.solids, length)
            self._advance(state, dt, shaking)
            way = _first_moment(state.solids, length) - before
            state.shaking_work += float(shaking @ way)

    def _with_walls(self, state: State, axis: MovingAxis, dt: float) -> None:
        """Between walls that move, seen from the laboratory."""
        start, end = state.solids_time, state.time
        state.solids.bend(bending(axis, start, end))
        gain = axis.plug_gain(state.position, start, end, self.bulk_velocity)
        push = (1 - self.lightness) * gain
        state.carried_impulse = state.carried_impulse + state.solids.mass @ push
        self._advance(state, dt, push / dt, gain / dt)

    def _advance(
        self, state: State, dt: float, push: FloatArray, gain: FloatArray | None = None
    ) -> None:
        """Under a further force over mass, in a liquid that gains velocity, both [m/s2]."""
        solids = state.solids
        acceleration = np.tile(self.lightness * self.gravity, (len(solids), 1)) + push
        self._force(state, acceleration, gain)
        report = solids.advance(dt / self.substeps, self.substeps)
        state.solids_time = state.time
        if not report.finite:
            check(state, self.pipe.radius)
        if state.exchange is not None:
            state.liquid_velocity = solids.liquid_velocity
        state.drag_impulse = state.drag_impulse + solids.drag_impulse.sum(axis=0)
        state.largest_overlap = max(state.largest_overlap, report.largest_overlap)

    def _shaking(self, time: float, dt: float) -> FloatArray:
        """Force of the motion on a solid over its mass, mean over the step that ends at `time`."""
        before, after = self.motion.at(np.array([time - dt, time])).velocity
        force: FloatArray = -self.lightness * (after - before) / dt
        return force

    def _force(self, state: State, acceleration: FloatArray, gain: FloatArray | None) -> None:
        solids = state.solids
        if self.dry:
            solids.set_forcing(acceleration=acceleration)
        elif state.exchange is None:
            solids.set_forcing(
                acceleration=acceleration,
                liquid_velocity=state.liquid_velocity,
                drag_rate=state.drag_rate,
                added_mass=self.added_mass,
                liquid_acceleration=gain,
                relaxation=None if gain is None else np.zeros(len(solids)),
            )
        else:
            of_liquid, relaxation = state.exchange.response(
                drag=solids.mass * state.drag_rate, velocity=solids.velocity
            )
            solids.set_forcing(
                acceleration=acceleration,
                liquid_velocity=state.liquid_velocity,
                drag_rate=state.drag_rate,
                liquid_acceleration=of_liquid,
                relaxation=relaxation,
                added_mass=self.added_mass,
            )


def _first_moment(solids: dem.Solids, period: float) -> FloatArray:
    """Sum of mass and place, laps counted, (3,) [kg m]."""
    moment: FloatArray = solids.mass @ solids.position
    moment[0] += period * float(solids.mass @ solids.laps)
    return moment


@dataclass(frozen=True, slots=True, kw_only=True)
class HoldSolids:
    """Count what the drag gives to solids that stay where they are."""

    name: ClassVar[str] = "HoldSolids"

    def __call__(self, state: State, dt: float) -> None:
        drag = state.solids.mass * state.drag_rate
        state.drag_impulse = state.drag_impulse + dt * (drag @ state.liquid_velocity)


@dataclass(frozen=True, slots=True, kw_only=True)
class ExchangeMomentum:
    """Sum up what the liquid gave to the solids, for it to get back in its step."""

    name: ClassVar[str] = "ExchangeMomentum"
    turns: int
    held: bool
    pipe_radius: float

    def __call__(self, state: State, dt: float) -> None:
        solids, (_, exchange) = state.solids, state.partners
        state.mean_drag = state.mean_drag + solids.mass * state.drag_rate / self.turns
        if not self.held:
            state.mean_velocity = state.mean_velocity + solids.mean_velocity / self.turns
            state.impulse = state.impulse + solids.drag_impulse
        if state.step % self.turns:
            return
        check(state, self.pipe_radius)
        exchange.give(
            position=state.begun_at,
            mean_velocity=state.mean_velocity,
            drag=state.mean_drag,
            impulse=None if self.held else state.impulse,
            duration=self.turns * dt,
        )
