"""The stages of a time step. The plan names those that a scene needs; the run calls them in turn.

A stage is a small frozen object: its parameters are fixed before the run, and all that changes
stands in the `State` that it is called with.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mpsdem import case as scene
from mpsdem._core import coupling, dem, geometry
from mpsdem.case import Case, Material, Solids
from mpsdem.contacts import Impact
from mpsdem.geometry import place_solids
from mpsdem.liquids import ComputedLiquid, Liquid, build_liquid
from mpsdem.plan import (
    DRAG_LAWS,
    DragLaw,
    Plan,
    gravity,
    impacts,
    materials,
    mean_diameter,
    spring_stiffness,
)
from mpsdem.results import ResultsWriter

FloatArray = NDArray[np.float64]
ContactLaw = dem.LinearSpring | dem.HertzMindlin | dem.HertzViscoelastic


class SimulationDiverged(RuntimeError):  # noqa: N818 - what happened, not what is wrong
    """The run has no sound state any more; `solid` is None where it was the liquid."""

    def __init__(
        self, *, step: int, time: float, field: str, solid: int | None, remedy: str
    ) -> None:
        self.step, self.time, self.field, self.solid = step, time, field, solid
        whose = "the liquid" if solid is None else f"solid {solid}"
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
    step : int
        Coupling steps since the start, the one under way included.
    time : float
        Time at the end of that step [s].
    liquid_velocity, liquid_acceleration : (n, 3) float64 ndarray
        Liquid at the solids [m/s], and how it changes, drag apart [m/s2].
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
    clipped, liquid_clipped : int
        Void fractions at solids and in the liquid that were raised to the floor, since the start.
    outside, judged : int
        Drags outside the range of their law, and all drags, since the start.
    exchange_error : float
        Largest difference of what solids and liquid gave each other, over what they gave [-].
    volume_error : float
        Largest error of the liquid's volume, over that volume [-].
    drag_impulse : (3,) float64 ndarray
        Momentum that the drag has given to all solids since the start [N s].
    largest_overlap : float
        Over the radius, since the last frame [-].
    frame_time : float
        Time of the last frame [s].
    frame_drag_impulse, frame_wall_impulse : (3,) float64 ndarray
        Momentum that drag and walls had given to all solids by then [N s].
    """

    population: dem.Solids | None = None
    liquid: Liquid | None = None
    exchange: coupling.Exchange | None = None
    step: int = 0
    time: float = 0.0
    liquid_velocity: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    liquid_acceleration: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    void_fraction: FloatArray = field(default_factory=lambda: np.zeros(0))
    drag_rate: FloatArray = field(default_factory=lambda: np.zeros(0))
    begun_at: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    mean_velocity: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    mean_drag: FloatArray = field(default_factory=lambda: np.zeros(0))
    impulse: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    clipped: int = 0
    liquid_clipped: int = 0
    outside: int = 0
    judged: int = 0
    exchange_error: float = 0.0
    volume_error: float = 0.0
    drag_impulse: FloatArray = field(default_factory=lambda: np.zeros(3))
    largest_overlap: float = 0.0
    frame_time: float = 0.0
    frame_drag_impulse: FloatArray = field(default_factory=lambda: np.zeros(3))
    frame_wall_impulse: FloatArray = field(default_factory=lambda: np.zeros(3))

    @property
    def solids(self) -> dem.Solids:
        """The solids, for the stages that need some."""
        assert self.population is not None
        return self.population

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
                remedy = f"a smaller fidelity.liquid_step or a larger smoothing_radius; {remedy}"
            raise SimulationDiverged(
                step=state.step,
                time=state.time,
                field="pressure or velocity",
                solid=None,
                remedy=remedy,
            )

    def _with_solids(self, state: State, dt: float) -> None:
        liquid, exchange = state.partners
        liquid.advance(dt, exchange)
        state.liquid_clipped += exchange.clipped
        state.exchange_error = max(state.exchange_error, exchange.mismatch)
        state.volume_error = max(state.volume_error, abs(exchange.liquid_volume_error))
        if self.held:
            state.drag_impulse = state.drag_impulse + exchange.impulse.sum(axis=0)


@dataclass(frozen=True, slots=True, kw_only=True)
class SampleLiquid:
    """Read the velocity of the liquid at the solids."""

    name: ClassVar[str] = "SampleLiquid"

    def __call__(self, state: State, _dt: float) -> None:
        assert state.liquid is not None
        state.liquid_velocity = state.liquid.velocity_at(state.solids.position)


@dataclass(frozen=True, slots=True, kw_only=True)
class BeginExchange:
    """Find the liquid around each solid, and its velocity, where a step of the liquid begins.

    In later turns of that step it is the solids that know how the liquid around them has changed.
    """

    name: ClassVar[str] = "SampleLiquid"
    turns: int

    def __call__(self, state: State, _dt: float) -> None:
        if state.step > 0 and (state.step - 1) % self.turns:
            return
        _, exchange = state.partners
        state.begun_at = state.solids.position
        begin_exchange(state)
        state.liquid_velocity = exchange.liquid_velocity
        state.liquid_acceleration = exchange.liquid_acceleration
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
            position=solids.position, radius=solids.radius, threads=self.threads
        )
        state.clipped += clipped


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
        state.judged += len(solids)
        state.outside += coupling.count_outside(
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
    """Move the solids by contacts, drag, gravity and buoyancy, in many small steps."""

    name: ClassVar[str] = "AdvanceSolids"
    acceleration: FloatArray  # (n, 3), gravity less buoyancy [m/s2]
    substeps: int
    dry: bool
    pipe_radius: float

    def __call__(self, state: State, dt: float) -> None:
        solids = state.solids
        if self.dry:
            solids.set_forcing(acceleration=self.acceleration)
        elif state.exchange is None:
            solids.set_forcing(
                acceleration=self.acceleration,
                liquid_velocity=state.liquid_velocity,
                drag_rate=state.drag_rate,
            )
        else:
            solids.set_forcing(
                acceleration=self.acceleration,
                liquid_velocity=state.liquid_velocity,
                drag_rate=state.drag_rate,
                liquid_acceleration=state.liquid_acceleration,
                relaxation=state.exchange.relaxation(drag_rate=state.drag_rate, mass=solids.mass),
            )
        report = solids.advance(dt / self.substeps, self.substeps)
        if not report.finite:
            check(state, self.pipe_radius)
        if state.exchange is not None:
            state.liquid_velocity = solids.liquid_velocity
        state.drag_impulse = state.drag_impulse + solids.drag_impulse.sum(axis=0)
        state.largest_overlap = max(state.largest_overlap, report.largest_overlap)


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

    def __call__(self, state: State, _dt: float) -> None:
        solids, (_, exchange) = state.solids, state.partners
        state.mean_drag = state.mean_drag + solids.mass * state.drag_rate / self.turns
        if not self.held:
            state.mean_velocity = state.mean_velocity + solids.mean_velocity / self.turns
            state.impulse = state.impulse + solids.drag_impulse
        if state.step % self.turns:
            return
        exchange.give(
            position=state.begun_at,
            mean_velocity=state.mean_velocity,
            drag=state.mean_drag,
            impulse=state.impulse,
            held=self.held,
        )


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


def check(state: State, pipe_radius: float) -> None:
    """Look whether all solids are in the bore, and all their numbers finite.

    Raises
    ------
    SimulationDiverged
        Naming the first solid for which they are not.
    """
    if state.population is None:
        return
    position = state.solids.position
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


def build_state(case: Case, plan: Plan) -> State:
    """The state at time 0: solids at their places, at rest or with their first velocity."""
    liquid = build_liquid(case, plan)
    if case.solids is None:
        return State(liquid=liquid)
    solids, speed = case.solids, plan.impact_speed
    placement = place_solids(case)
    count = len(placement.radius)
    pair_law, wall_law = _contact_laws(case, speed)
    population = dem.Solids(
        position=placement.position,
        velocity=placement.velocity,
        spin=placement.spin,
        radius=placement.radius,
        density=np.full(count, solids.density),
        pair_law=pair_law,
        wall_law=wall_law,
        pair_rolling_friction=solids.rolling_friction,
        wall_rolling_friction=solids.at_wall.rolling_friction,
        walls=[geometry.Cylinder(radius=case.pipe.radius, velocity=np.zeros(3))],
        period=case.pipe.length,
        threads=plan.threads,
    )
    exchange = None
    if plan.two_way:
        exchange = coupling.Exchange(
            smoothing_radius=plan.smoothing_radius,
            pipe_radius=case.pipe.radius,
            threads=plan.threads,
        )
    return State(
        population=population,
        liquid=liquid,
        exchange=exchange,
        void_fraction=np.ones(count),  # where no stage looks for neighbors, a solid is alone
    )


def build_stages(case: Case, plan: Plan, writer: ResultsWriter) -> Iterator[Stage]:
    """Make the stages that the plan names, in its order."""
    pipe = case.pipe
    for planned in plan.stages:
        match planned.name, case.solids, case.liquid:
            case "AdvanceLiquid", solids, _:
                held = solids is not None and solids.held
                yield AdvanceLiquid(turns=plan.turns_per_liquid_step, held=held)
            case "SampleLiquid", _, _:
                turns = plan.turns_per_liquid_step
                yield BeginExchange(turns=turns) if plan.two_way else SampleLiquid()
            case "FindVoidFraction", _, _:
                average = coupling.VoidFraction(
                    pipe_radius=pipe.radius,
                    period=pipe.length,
                    smoothing_radius=plan.smoothing_radius,
                )
                yield FindVoidFraction(average=average, threads=plan.threads)
            case "DragForce", Solids() as solids, scene.Liquid() as liquid:
                yield DragForce(
                    law=DRAG_LAWS[solids.drag](),
                    solid_density=np.full(case.solids_count, solids.density),
                    liquid_density=liquid.density,
                    kinematic_viscosity=liquid.kinematic_viscosity,
                )
            case "AdvanceSolids", Solids() as solids, liquid:
                lightness = 1 - (liquid.density if liquid else 0.0) / solids.density
                yield AdvanceSolids(
                    acceleration=np.tile(lightness * gravity(case), (case.solids_count, 1)),
                    substeps=plan.clock.substeps,
                    dry=liquid is None,
                    pipe_radius=pipe.radius,
                )
            case "HoldSolids", _, _:
                yield HoldSolids()
            case "ExchangeMomentum", Solids() as solids, _:
                yield ExchangeMomentum(turns=plan.turns_per_liquid_step, held=solids.held)
            case "Record", _, _:
                yield Record(
                    writer=writer,
                    steps_per_frame=plan.clock.steps_per_frame,
                    pipe_radius=pipe.radius,
                    pipe_length=pipe.length,
                )


def _contact_laws(case: Case, speed: float) -> tuple[ContactLaw, ContactLaw]:
    """Law between solids, and at the wall."""
    assert case.solids is not None
    solid, wall = materials(case)
    pair, at_wall = impacts(case, diameter=mean_diameter(case.solids), speed=speed)
    match case.solids.contact:
        case "hertz_mindlin":
            return _hertz_mindlin(solid, solid), _hertz_mindlin(solid, wall)
        case "hertz_viscoelastic":
            return _hertz_viscoelastic(solid, pair), _hertz_viscoelastic(wall, at_wall)
        case "linear_spring":
            between, against = spring_stiffness(case, speed)
            return (
                _linear_spring(case, solid, between, pair.stiffness.ratio),
                _linear_spring(case, wall, against, at_wall.stiffness.ratio),
            )


def _hertz_mindlin(solid: Material, other: Material) -> dem.HertzMindlin:
    """Contact of a solid with another body, which says how they rebound and rub."""
    return dem.HertzMindlin(
        youngs_modulus=solid.youngs_modulus,
        poisson_ratio=solid.poisson_ratio,
        other_youngs_modulus=other.youngs_modulus,
        other_poisson_ratio=other.poisson_ratio,
        restitution=other.restitution,
        friction=other.friction,
    )


def _linear_spring(
    case: Case, other: Material, normal_stiffness: float, ratio: float
) -> dem.LinearSpring:
    solids = case.solids
    assert solids is not None
    tangential_stiffness = ratio * normal_stiffness
    if solids.tangential_stiffness is not None:
        tangential_stiffness = case.fidelity.stiffness_factor * solids.tangential_stiffness
    if solids.normal_damping is None:
        return dem.LinearSpring.with_restitution(
            normal_stiffness=normal_stiffness,
            tangential_stiffness=tangential_stiffness,
            restitution=other.restitution,
            friction=other.friction,
        )
    damping = solids.normal_damping
    return dem.LinearSpring(
        normal_stiffness=normal_stiffness,
        tangential_stiffness=tangential_stiffness,
        normal_damping=damping,
        tangential_damping=(
            damping if solids.tangential_damping is None else solids.tangential_damping
        ),
        friction=other.friction,
    )


def _hertz_viscoelastic(other: Material, impact: Impact) -> dem.HertzViscoelastic:
    """Stiffness of Hertz and Mindlin; damping that returns the restitution at the impact's speed.

    The impact x'' + a x^(1/2) x' + x^(3/2) = 0 is scaled with the time t below, the speed, and
    their product as length.
    """
    normal = 4 / 3 * impact.stiffness.normal  # [Pa]
    root = math.sqrt(impact.reduced_radius * impact.speed)
    t = (impact.reduced_mass / (root * normal)) ** 0.4  # [s]
    damping = dem.damping_factor(other.restitution, 1.5, 0.5) / (root * t**1.5)  # [1/(m s)]
    return dem.HertzViscoelastic(
        normal_stiffness=normal,
        tangential_stiffness=8 * impact.stiffness.tangential,
        normal_damping=damping,
        tangential_damping=damping / 2,  # the usual share, Silbert et al. (2001)
        friction=other.friction,
    )
