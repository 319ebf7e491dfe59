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
from mpsdem.liquids import Liquid, build_liquid
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
    step : int
        Coupling steps since the start, the one under way included.
    time : float
        Time at the end of that step [s].
    liquid_velocity : (n, 3) float64 ndarray
        Liquid at the solids [m/s].
    void_fraction : (n,) float64 ndarray
        Share of liquid around the solids [-].
    drag_rate : (n,) float64 ndarray
        Drag on a solid over its mass and its slip [1/s].
    clipped : int
        Void fractions that were raised to the floor, since the start.
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
    step: int = 0
    time: float = 0.0
    liquid_velocity: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    void_fraction: FloatArray = field(default_factory=lambda: np.zeros(0))
    drag_rate: FloatArray = field(default_factory=lambda: np.zeros(0))
    clipped: int = 0
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


class Stage(Protocol):
    """What the time loop calls."""

    name: ClassVar[str]

    def __call__(self, state: State, dt: float, /) -> None: ...


@dataclass(frozen=True, slots=True, kw_only=True)
class AdvanceLiquid:
    """Move the liquid: viscosity, pressure, and the particles themselves."""

    name: ClassVar[str] = "AdvanceLiquid"
    turns: int  # coupling steps to a step of the liquid, which is taken at the last of them

    def __call__(self, state: State, dt: float) -> None:
        assert state.liquid is not None
        if state.step % self.turns:
            return
        state.liquid.advance(self.turns * dt)
        if not state.liquid.sound:
            raise SimulationDiverged(
                step=state.step,
                time=state.time,
                field="pressure or velocity",
                solid=None,
                remedy="a smaller fidelity.courant; then another fidelity.particle_spacing",
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class SampleLiquid:
    """Read the velocity of the liquid at the solids."""

    name: ClassVar[str] = "SampleLiquid"

    def __call__(self, state: State, _dt: float) -> None:
        assert state.liquid is not None
        state.liquid_velocity = state.liquid.velocity_at(state.solids.position)


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
        else:
            solids.set_forcing(
                acceleration=self.acceleration,
                liquid_velocity=state.liquid_velocity,
                drag_rate=state.drag_rate,
            )
        report = solids.advance(dt / self.substeps, self.substeps)
        if not report.finite:
            check(state, self.pipe_radius)
        state.drag_impulse = state.drag_impulse + solids.drag_impulse.sum(axis=0)
        state.largest_overlap = max(state.largest_overlap, report.largest_overlap)


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
            gradient = np.add(of_liquid["pressure_gradient"], drag[0] / bore)
            diagnostics |= {**of_liquid, "pressure_gradient": gradient}
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
    # Where no stage looks for neighbors, a solid is taken to be alone.
    return State(population=population, liquid=liquid, void_fraction=np.ones(count))


def build_stages(case: Case, plan: Plan, writer: ResultsWriter) -> Iterator[Stage]:
    """Make the stages that the plan names, in its order."""
    pipe = case.pipe
    for planned in plan.stages:
        match planned.name, case.solids, case.liquid:
            case "AdvanceLiquid", _, _:
                yield AdvanceLiquid(turns=plan.turns_per_liquid_step)
            case "SampleLiquid", _, _:
                yield SampleLiquid()
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
