"""All that changes in a run, and whether it is sound."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from mpsdem._core import coupling, dem
from mpsdem.case import MovingAxis
from mpsdem.liquids import ComputedLiquid, Liquid

FloatArray = NDArray[np.float64]


class SimulationDiverged(RuntimeError):  # noqa: N818 - what happened, not what is wrong
    """The run has no sound state any more; `solid` is that of which it was seen, if of one."""

    def __init__(
        self,
        *,
        step: int,
        time: float,
        field: str,
        remedy: str,
        solid: int | None = None,
        whose: str = "the liquid",
    ) -> None:
        self.step, self.time, self.field, self.solid = step, time, field, solid
        whose = whose if solid is None else f"solid {solid}"
        super().__init__(
            f"diverged at t = {time:.6g} s (step {step}): the {field} of {whose} is out of bounds. "
            f"Remedy: {remedy}"
        )


@dataclass(slots=True, kw_only=True)
class State:
    """All that changes in a run.

    Attributes
    ----------
    population : dem.Solids or None
        Positions, velocities, spins and contacts; None in clear liquid.
    liquid : Liquid or None
        What carries them; None in a dry scene.
    exchange : coupling.Exchange or None
        Between the two; None where the liquid does not feel the solids.
    axis : MovingAxis or None
        Of a pipe whose walls move; the solids then know places and velocities in the laboratory.
    step : int
        Coupling steps since the start, the one under way included.
    time : float
        Time at the end of that step [s].
    solids_time : float
        Time at which the solids stand [s].
    liquid_velocity : (n, 3) float64 ndarray
        Liquid at the solids [m/s].
    void_fraction : (n,) float64 ndarray
        Share of liquid around the solids [-].
    drag_rate : (n,) float64 ndarray
        Drag on a solid over its mass and its slip [1/s].
    begun_at : (n, 3) float64 ndarray
        Where the solids were when the step of the liquid began [m].
    mean_velocity : (n, 3) float64 ndarray
        Of the solids in it, so far: each turn has its share of the whole step [m/s].
    mean_drag : (n,) float64 ndarray
        Drag over slip in it, likewise [kg/s].
    impulse : (n, 3) float64 ndarray
        Of the liquid on each solid in it, so far [N s].
    drag_impulse : (3,) float64 ndarray
        Momentum that the liquid has given to all solids since the start, buoyancy apart [N s].
    largest_overlap : float
        Over the radius, since the last frame [-].
    void_fraction_clipped, liquid_void_fraction_clipped : int
        Void fractions raised to the floor since then, at solids and in the liquid.
    drags, drags_outside : int
        Drags found since then, and those of them outside the range of their law.
    exchange_error : float
        Largest difference since then of what solids and liquid gave each other, over what they
        gave [-].
    liquid_volume_error : float
        Largest error since then of the liquid's volume, over that volume [-].
    carried_impulse : (3,) float64 ndarray
        Of the pressure that turns the liquid with moving walls, on all solids since the start
        [N s].
    shaking_work : float
        Work of the pipe's motion on the solids since the start, seen from the pipe [J].
    frame_time : float
        Time of the last frame [s].
    frame_drag_impulse, frame_wall_impulse : (3,) float64 ndarray
        Momentum that liquid and walls had given to all solids by then [N s].
    frame_energy, frame_flux, frame_shaking_work : float
        Energy [J], volume flux along the pipe [m/s] and work of its motion [J] then.
    standing_since : (s,) float64 ndarray
        Since when each section of the pipe has been full of solids at rest [s]; NaN where not.
    plug_time, plug_position : float
        Since when [s] and where [m] solids block the pipe; NaN while none do.
    """

    population: dem.Solids | None = None
    liquid: Liquid | None = None
    exchange: coupling.Exchange | None = None
    axis: MovingAxis | None = None
    step: int = 0
    time: float = 0.0
    solids_time: float = 0.0
    liquid_velocity: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    void_fraction: FloatArray = field(default_factory=lambda: np.zeros(0))
    drag_rate: FloatArray = field(default_factory=lambda: np.zeros(0))
    begun_at: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    mean_velocity: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    mean_drag: FloatArray = field(default_factory=lambda: np.zeros(0))
    impulse: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    drag_impulse: FloatArray = field(default_factory=lambda: np.zeros(3))
    largest_overlap: float = 0.0
    void_fraction_clipped: int = 0
    liquid_void_fraction_clipped: int = 0
    drags: int = 0
    drags_outside: int = 0
    exchange_error: float = 0.0
    liquid_volume_error: float = 0.0
    carried_impulse: FloatArray = field(default_factory=lambda: np.zeros(3))
    shaking_work: float = 0.0
    frame_time: float = 0.0
    frame_drag_impulse: FloatArray = field(default_factory=lambda: np.zeros(3))
    frame_wall_impulse: FloatArray = field(default_factory=lambda: np.zeros(3))
    frame_energy: float = 0.0
    frame_flux: float = 0.0
    frame_shaking_work: float = 0.0
    standing_since: FloatArray = field(default_factory=lambda: np.zeros(0))
    plug_time: float = math.nan
    plug_position: float = math.nan

    @property
    def solids(self) -> dem.Solids:
        """The solids, for the stages that need some."""
        assert self.population is not None
        return self.population

    @property
    def position(self) -> FloatArray:
        """Centres of the solids, seen from the pipe (n, 3) [m]."""
        place: FloatArray = self.solids.position
        return place if self.axis is None else self.axis.position(place, self.solids_time)

    def from_pipe(self, velocity: FloatArray) -> FloatArray:
        """Velocities at the solids, seen from the pipe (n, 3) [m/s]."""
        if self.axis is None:
            return velocity
        return self.axis.from_pipe(velocity, self.solids.position[:, 0], self.solids_time)

    def to_laboratory(self, velocity: FloatArray) -> FloatArray:
        """The way back (n, 3) [m/s]; the same where no wall moves."""
        if self.axis is None:
            return velocity
        return self.axis.to_laboratory(velocity, self.solids.position[:, 0], self.solids_time)

    @property
    def partners(self) -> tuple[ComputedLiquid, coupling.Exchange]:
        """Liquid and exchange, for the stages that need both."""
        assert isinstance(self.liquid, ComputedLiquid)
        assert self.exchange is not None
        return self.liquid, self.exchange


class Stage(Protocol):
    """What the time loop calls."""

    name: ClassVar[str]

    def __call__(self, state: State, dt: float, /) -> None: ...


def check(state: State, pipe_radius: float) -> None:
    """Look whether all solids are in the bore, and all their numbers finite.

    Raises
    ------
    SimulationDiverged
        Naming the first solid for which they are not.
    """
    if state.population is None:
        return
    position = state.position
    inside = np.hypot(position[:, 1], position[:, 2]) < pipe_radius
    sound = {
        "velocity": np.isfinite(state.solids.velocity).all(axis=1),
        "spin": np.isfinite(state.solids.spin).all(axis=1),
        "position": np.isfinite(position[:, 0]) & inside,
    }
    for name, good in sound.items():
        if not good.all():
            solid = int(np.argmin(good))
            raise SimulationDiverged(
                step=state.step,
                time=state.time,
                field=name,
                solid=solid,
                remedy="a smaller fidelity.rayleigh_fraction or fidelity.coupling_step; then a "
                "larger fidelity.stiffness_factor",
            )
