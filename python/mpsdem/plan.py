"""The plan: what a case requires, and why. Pure functions of a case; nothing is run."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from mpsdem import _core
from mpsdem._core import coupling, mps
from mpsdem.analysis.correlations import durand_deposition_velocity
from mpsdem.case import Case, CaseError, List, Material, Problem, Solids
from mpsdem.contacts import Impact, effective_modulus, rayleigh_time

FloatArray = NDArray[np.float64]
DragLaw = coupling.SchillerNaumann | coupling.WenYu | coupling.ErgunWenYu | coupling.DiFelice
DRAG_LAWS: Mapping[str, type[DragLaw]] = {
    "schiller_naumann": coupling.SchillerNaumann,
    "wen_yu": coupling.WenYu,
    "ergun_wen_yu": coupling.ErgunWenYu,
    "di_felice": coupling.DiFelice,
}

# A step given by the user may take this share of a time that it has to resolve [-]: the restitution
# is then off by 0.014, and bulk flow still unmoved (512 spheres collapsing in a cylinder).
_LARGEST_SHARE = 0.5
# Errors were measured where a collision lasts three Rayleigh times (1 m/s, E = 1e8 Pa, d = 20 mm);
# a faster one is shorter, and is resolved by as many steps.
_COLLISION_WORTH = 1 / 3
_COUPLING_SHARE = 0.1  # [-] of the times over which the forces on a solid change
_DILUTE = 1e-3  # [-] solid fraction above which the liquid notices the solids
SOFT = 0.05  # [-] overlap over radius above which contacts lose their meaning
_SERIAL = 5000  # solids up to which threads cost more than they gain
_SOLID_RATE = 3e7  # solids x steps per second on one thread, dense: 2.4e7 to 1.4e8 were measured
_SAMPLE_TIME = 1e-6  # [s] liquid, void fraction and drag of one solid, once
_CALL_TIME = 1e-4  # [s] one turn of the time loop
_SOLID_BYTES = 2000  # memory of one solid with its contacts and neighbors
_BASE_BYTES = 150_000_000  # memory of the program before any solid


@dataclass(frozen=True, slots=True, kw_only=True)
class Number:
    """A number that decides something, and what it decides."""

    name: str
    value: float
    unit: str
    meaning: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Planned:
    """A stage of the time step, or one left out, and the reason."""

    name: str
    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """The longest step [s] that something allows."""

    name: str
    value: float


@dataclass(frozen=True, slots=True, kw_only=True)
class _Scale:
    """A time [s] that a step has to resolve, and how much of it counts [-]."""

    name: str
    time: float
    worth: float = 1.0

    @property
    def limit(self) -> float:
        return self.worth * self.time


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """A time step [s], at or below the smallest of its limits."""

    value: float
    limits: tuple[Limit, ...]

    @property
    def binding(self) -> Limit:
        """The smallest limit."""
        return min(self.limits, key=lambda limit: limit.value)


@dataclass(frozen=True, slots=True, kw_only=True)
class Clock:
    """Time as a function of the number of coupling steps, so that no sum of steps can drift.

    Frames stand at whole multiples of `every`, the last one at `end_time`; each is reached by
    `steps_per_frame` coupling steps of `substeps` solid steps. The last ones may be shorter.
    """

    end_time: float
    every: float
    steps_per_frame: int
    substeps: int

    @property
    def frames(self) -> int:
        """Frames after the first one, which stands at time 0."""
        return math.ceil(self.end_time / self.every * (1 - 1e-12))

    @property
    def steps(self) -> int:
        """Coupling steps in all."""
        return self.frames * self.steps_per_frame

    def time(self, step: int) -> float:
        """Time after `step` coupling steps [s]."""
        frame, part = divmod(step, self.steps_per_frame)
        if frame == self.frames:
            return self.end_time
        return frame * self.every + part * self.length(step + 1)

    def length(self, step: int) -> float:
        """Length of the coupling step that is counted as `step`, from 1 on [s]."""
        frame = (step - 1) // self.steps_per_frame
        interval = min(self.every, self.end_time - frame * self.every)
        if math.isclose(interval, self.every, rel_tol=1e-9):
            interval = self.every  # not the round-off of a difference, so that the end may be moved
        return interval / self.steps_per_frame


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """What the run will take, within a factor of about two."""

    wall_seconds: float
    memory_bytes: float
    disk_bytes: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """The shortest list of stages that a case requires, and all that was decided with it.

    Attributes
    ----------
    case : Case
        What is planned for.
    numbers : tuple of Number
        The dimensionless numbers that decided.
    stages, left_out : tuple of Planned
        In the order of the time step.
    impact_speed : float
        Speed of the collisions that the contacts are judged by [m/s]; 0 without solids.
    solid_step : Step or None
        Step of the solids; None without any.
    coupling_step : Step
        Time between two looks at the liquid.
    clock : Clock
        Both steps, in whole numbers.
    threads : int
        Threads of the kernels.
    estimate : Estimate
        Time, memory and disk.
    warnings : tuple of str
        What the user should know before trusting the results.
    """

    case: Case
    numbers: tuple[Number, ...]
    stages: tuple[Planned, ...]
    left_out: tuple[Planned, ...]
    impact_speed: float
    solid_step: Step | None
    coupling_step: Step
    clock: Clock
    threads: int
    estimate: Estimate
    warnings: tuple[str, ...]

    @property
    def smoothing_radius(self) -> float:
        """Radius over which the void fraction is averaged [m]; 0 without solids."""
        return _smoothing_radius(self.case)


def make_plan(case: Case) -> Plan:
    """Decide what a case requires.

    Raises
    ------
    CaseError
        If a step given in ``fidelity`` exceeds its limit, or a limit cannot be found.
    """
    speed = _impact_speed(case)
    solid_limits = _solid_limits(case, speed)
    coupling_limits = _coupling_limits(case, solid_limits)
    coupling_step = min(limit.value for limit in coupling_limits)
    steps_per_frame = _whole(case.output.every / coupling_step)
    coupling_step = case.output.every / steps_per_frame
    substeps = 0
    if solid_limits:
        substeps = _whole(coupling_step / min(limit.value for limit in solid_limits))
    clock = Clock(
        end_time=case.end_time,
        every=case.output.every,
        steps_per_frame=steps_per_frame,
        substeps=substeps,
    )
    threads = case.fidelity.threads or (
        1 if case.solids_count < _SERIAL else _core.available_threads()
    )
    return Plan(
        case=case,
        numbers=tuple(_numbers(case)),
        stages=tuple(_stages(case, clock)),
        left_out=tuple(_left_out(case)),
        impact_speed=speed,
        solid_step=(
            Step(value=coupling_step / substeps, limits=solid_limits) if solid_limits else None
        ),
        coupling_step=Step(value=coupling_step, limits=coupling_limits),
        clock=clock,
        threads=threads,
        estimate=_estimate(case, clock, threads),
        warnings=tuple(_warnings(case, speed)),
    )


def materials(case: Case) -> tuple[Material, Material]:
    """Material between solids, and at the wall, softened by the stiffness factor."""
    solids = _solids(case)

    def softened(material: Material) -> Material:
        values = material.model_dump(include=set(Material.model_fields))
        values["youngs_modulus"] *= case.fidelity.stiffness_factor
        return Material(**values)

    return softened(solids), softened(solids.at_wall)


def impacts(case: Case, *, diameter: float, speed: float) -> tuple[Impact, Impact]:
    """Impact of two solids, and of one on the wall, of a diameter [m] at a speed [m/s]."""
    density = _solids(case).density
    solid, wall = (
        effective_modulus(youngs_modulus=m.youngs_modulus, poisson_ratio=m.poisson_ratio)
        for m in materials(case)
    )
    return (
        Impact.between(diameter=diameter, density=density, modulus=solid, speed=speed),
        Impact.at_wall(diameter=diameter, density=density, modulus=wall, speed=speed),
    )


def spring_stiffness(case: Case, speed: float) -> tuple[float, float]:
    """Normal stiffness between solids, and at the wall, of the linear spring [N/m].

    As given, or with the largest overlap of the Hertz contact for a solid of mean volume that
    collides at `speed` [m/s].

    Raises
    ------
    CaseError
        If it is to be derived, and nothing in the case moves.
    """
    solids = _solids(case)
    if solids.normal_stiffness is not None:
        stiffness = case.fidelity.stiffness_factor * solids.normal_stiffness
        return stiffness, stiffness
    if speed == 0:
        rule = "cannot be derived, as neither gravity, liquid nor a first velocity moves the solids"
        raise CaseError([Problem(field="solids.impact_speed", rule=rule, remedy="give it, in m/s")])
    pair, wall = impacts(case, diameter=mean_diameter(solids), speed=speed)
    return pair.linear_stiffness, wall.linear_stiffness


def terminal_velocity(case: Case) -> float:
    """Speed at which a lone solid of mean volume settles in the liquid at rest [m/s]."""
    solids, liquid = case.solids, case.liquid
    if solids is None or liquid is None:
        return 0.0
    diameter = mean_diameter(solids)
    weight = abs(1 - liquid.density / solids.density) * case.gravity  # [m/s2]
    # No drag law gives less than half of Stokes's drag.
    fastest = 2 * weight / drag_rate(case, diameter=diameter, slip=0.0)
    if fastest == 0:
        return 0.0
    return float(
        brentq(
            lambda slip: slip * drag_rate(case, diameter=diameter, slip=slip) - weight,
            0.0,
            fastest,
        )
    )


def drag_rate(case: Case, *, diameter: float, slip: float) -> float:
    """Drag over mass and slip of a lone solid [1/s], at a slip [m/s]."""
    solids, liquid = _solids(case), case.liquid
    assert liquid is not None
    rate = coupling.drag_rate(
        DRAG_LAWS[solids.drag](),
        liquid_velocity=np.array([[slip, 0.0, 0.0]]),
        velocity=np.zeros((1, 3)),
        void_fraction=np.ones(1),
        diameter=np.array([diameter]),
        density=np.array([solids.density]),
        liquid_density=liquid.density,
        kinematic_viscosity=liquid.kinematic_viscosity,
    )
    return float(rate[0])


def _solids(case: Case) -> Solids:
    assert case.solids is not None
    return case.solids


def mean_diameter(solids: Solids) -> float:
    """Diameter of the solid of mean volume [m]."""
    return float(np.cbrt(6 / math.pi * solids.mean_volume))


def _smoothing_radius(case: Case) -> float:
    if case.solids is None:
        return 0.0
    return case.fidelity.smoothing_radius or 2.5 * case.solids.largest_diameter


def _whole(ratio: float) -> int:
    """Smallest whole number of steps that does the work of `ratio` steps, round-off forgiven."""
    return max(1, math.ceil(ratio * (1 - 1e-12)))


def _impact_speed(case: Case) -> float:
    """Speed of the hardest collisions to expect [m/s], unless given."""
    solids, pipe = case.solids, case.pipe
    if solids is None:
        return 0.0
    if solids.impact_speed is not None:
        return solids.impact_speed
    if isinstance(solids.arrangement, List):
        starts = np.array(solids.arrangement.velocities or [(0.0, 0.0, 0.0)])
    else:
        starts = np.array([solids.arrangement.velocity])
    start = float(np.linalg.norm(starts, axis=1).max())
    if case.liquid is not None:
        return max(start, abs(case.liquid.bulk_velocity), terminal_velocity(case))
    drop = 2 * pipe.radius * math.cos(pipe.inclination)
    drop += pipe.length * abs(math.sin(pipe.inclination))
    return math.hypot(start, math.sqrt(2 * case.gravity * drop))


def _solid_limits(case: Case, speed: float) -> tuple[Limit, ...]:
    if case.solids is None:
        return ()
    return _limits(
        "solid_step",
        given=case.fidelity.solid_step,
        share=case.fidelity.resolved_rayleigh_fraction,
        times=_contact_scales(case, speed),
    )


def _contact_scales(case: Case, speed: float) -> Iterator[_Scale]:
    """What a step of the solids has to resolve."""
    solids = _solids(case)
    diameter = solids.smallest_diameter
    pair, wall = impacts(case, diameter=diameter, speed=speed)
    collision = f"a collision at {speed:.3g} m/s"
    if solids.contact == "linear_spring":
        between, at_wall = spring_stiffness(case, speed)
        duration = min(pair.on_spring(between)[1], wall.on_spring(at_wall)[1])
        yield _Scale(name=collision, time=duration, worth=_COLLISION_WORTH)
        if solids.normal_damping:
            time = 2 * pair.reduced_mass / solids.normal_damping
            yield _Scale(name="the damping time 2 m*/c of a pair", time=time)
        return
    rayleigh = min(
        rayleigh_time(
            diameter=diameter,
            density=solids.density,
            youngs_modulus=material.youngs_modulus,
            poisson_ratio=material.poisson_ratio,
        )
        for material in materials(case)
    )
    yield _Scale(name="the smallest solid's Rayleigh time", time=rayleigh)
    duration = min(pair.duration, wall.duration)
    yield _Scale(name=collision, time=duration, worth=_COLLISION_WORTH)


def _coupling_limits(case: Case, solid_limits: tuple[Limit, ...]) -> tuple[Limit, ...]:
    every = Limit(name="output.every", value=case.output.every)
    if case.solids is None:
        return (every,)
    work = _SOLID_RATE / case.solids_count * min(limit.value for limit in solid_limits)
    prompt = Limit(name="a second of computing, so that a signal is obeyed", value=work)
    times = []
    if case.liquid is not None:
        diameter = case.solids.smallest_diameter
        slip = max(abs(case.liquid.bulk_velocity), terminal_velocity(case))
        relaxation = 1 / drag_rate(case, diameter=diameter, slip=slip)
        times = [_Scale(name=f"the drag's relaxation time at {slip:.3g} m/s", time=relaxation)]
        if slip > 0:
            crossing = f"the time to cross a diameter at {slip:.3g} m/s"
            times.append(_Scale(name=crossing, time=diameter / slip))
    given = case.fidelity.coupling_step
    limits = _limits("coupling_step", given=given, share=_COUPLING_SHARE, times=times)
    return (*limits, every, prompt)


def _limits(
    name: str, *, given: float | None, share: float, times: Iterable[_Scale]
) -> tuple[Limit, ...]:
    """Limit a step to a share of each time, or to what is given where that is not too long."""
    if given is None:
        return tuple(
            Limit(name=f"{share * scale.worth:.3g} of {scale.name}", value=share * scale.limit)
            for scale in times
        )
    for scale in times:
        longest = _LARGEST_SHARE * scale.limit
        if given > longest:
            share = _LARGEST_SHARE * scale.worth
            problem = Problem(
                field=f"fidelity.{name}",
                value=given,
                unit="s",
                rule=f"must be <= {longest:.4g} s, {share:.3g} of {scale.name}",
                remedy="leave it out, and the plan chooses",
            )
            raise CaseError([problem])
    return (Limit(name=f"fidelity.{name}, as given", value=given),)


def _numbers(case: Case) -> Iterator[Number]:
    pipe, liquid, solids = case.pipe, case.liquid, case.solids
    bore = 2 * pipe.radius
    if liquid is not None:
        reynolds = abs(liquid.bulk_velocity) * bore / liquid.kinematic_viscosity
        regime = "laminar" if pipe_profile(case).laminar else "turbulent"
        yield Number(name="Reynolds number of the pipe", value=reynolds, unit="", meaning=regime)
    if solids is None:
        return
    diameter = mean_diameter(solids)
    fraction = case.solids_fraction
    yield Number(
        name="diameter of the solids over the bore",
        value=diameter / bore,
        unit="",
        meaning="coarse: the bore sees single solids" if diameter > 0.02 * bore else "fine",
    )
    yield Number(
        name="mean solid fraction",
        value=fraction,
        unit="",
        meaning="the liquid notices the solids" if fraction > _DILUTE else "dilute",
    )
    if liquid is None:
        return
    settling = terminal_velocity(case)
    yield Number(
        name="terminal velocity",
        value=settling,
        unit="m/s",
        meaning="of a lone solid in the liquid at rest",
    )
    yield Number(
        name="Reynolds number of the solids",
        value=settling * diameter / liquid.kinematic_viscosity,
        unit="",
        meaning="at the terminal velocity",
    )
    slip = max(abs(liquid.bulk_velocity), settling)
    stokes = abs(liquid.bulk_velocity) / bore / drag_rate(case, diameter=diameter, slip=slip)
    yield Number(
        name="Stokes number",
        value=stokes,
        unit="",
        meaning="solids lag the liquid" if stokes > 0.1 else "solids follow the liquid",
    )
    if solids.density > liquid.density and case.gravity > 0:
        deposition = durand_deposition_velocity(
            pipe_diameter=bore,
            diameter=diameter,
            density=solids.density,
            liquid_density=liquid.density,
            volume_fraction=fraction,
            gravity=case.gravity,
        )
        moving = abs(liquid.bulk_velocity) > deposition
        yield Number(
            name="deposition velocity",
            value=deposition,
            unit="m/s",
            meaning=("below the bulk velocity: carried" if moving else "above it: a bed is likely")
            + " (Durand, level pipe)",
        )


def pipe_profile(case: Case) -> mps.PipeProfile:
    """Developed profile of the liquid in the pipe."""
    assert case.liquid is not None
    return mps.PipeProfile(
        pipe_radius=case.pipe.radius,
        bulk_velocity=case.liquid.bulk_velocity,
        kinematic_viscosity=case.liquid.kinematic_viscosity,
        roughness=case.pipe.roughness,
    )


def gravity(case: Case) -> FloatArray:
    """Gravity in the axes of the pipe, (3,) [m/s2]."""
    rise = case.pipe.inclination
    return case.gravity * np.array([-math.sin(rise), 0.0, -math.cos(rise)])


def clear_gradient(case: Case) -> float:
    """Pressure loss of the liquid alone along the pipe, static head apart [Pa/m]."""
    if case.liquid is None:
        return 0.0
    velocity = case.liquid.bulk_velocity
    dynamic = case.liquid.density * velocity * abs(velocity) / 2
    return float(pipe_profile(case).friction_factor * dynamic / (2 * case.pipe.radius))


def _needs_void_fraction(case: Case) -> bool:
    return case.solids_count > 1 and _solids(case).drag != "schiller_naumann"


def _stages(case: Case, clock: Clock) -> Iterator[Planned]:
    solids, liquid = case.solids, case.liquid
    if solids is not None:
        if liquid is not None:
            flow = "parabola" if pipe_profile(case).laminar else "turbulent profile"
            yield Planned(name="SampleLiquid", reason=f"the liquid is a prescribed {flow}")
            if _needs_void_fraction(case):
                reason = f"the drag law {solids.drag} depends on the share of liquid at a solid"
                yield Planned(name="FindVoidFraction", reason=reason)
            yield Planned(name="DragForce", reason=f"the liquid carries the solids: {solids.drag}")
        reason = f"{case.solids_count} solids, {solids.contact}: {clock.substeps} steps a turn"
        yield Planned(name="AdvanceSolids", reason=reason)
    reason = f"{clock.frames + 1} frames, one every {clock.every:g} s"
    yield Planned(name="Record", reason=reason)


def _left_out(case: Case) -> Iterator[Planned]:
    solids, liquid = case.solids, case.liquid
    if liquid is None:
        yield Planned(name="liquid", reason="the case has no [liquid]: dry")
    else:
        reason = "the profile is prescribed, and steady"
        yield Planned(name="PredictLiquid, ProjectPressure", reason=reason)
    if solids is None:
        yield Planned(name="solids", reason="the case has no [solids]: clear liquid")
        return
    if liquid is not None:
        reason = "a prescribed liquid cannot yield; the pressure gradient counts the solids' drag"
        yield Planned(name="ExchangeMomentum", reason=reason)
        if not _needs_void_fraction(case):
            alone = "a lone solid has no neighbors"
            reason = alone if case.solids_count == 1 else f"{solids.drag} takes no notice of it"
            yield Planned(name="FindVoidFraction", reason=reason)
    if solids.rolling_friction == 0 == solids.at_wall.rolling_friction:
        yield Planned(name="rolling resistance", reason="solids.rolling_friction = 0")


def _estimate(case: Case, clock: Clock, threads: int) -> Estimate:
    count, steps = case.solids_count, clock.steps
    frame_bytes = count * 8 * (9 + (7 if case.liquid else 0)) + 100
    return Estimate(
        wall_seconds=(
            count * steps * (clock.substeps / _SOLID_RATE / threads + _SAMPLE_TIME)
            + steps * _CALL_TIME
        ),
        memory_bytes=_BASE_BYTES + count * _SOLID_BYTES,
        disk_bytes=frame_bytes * (clock.frames + 1),
    )


def _warnings(case: Case, speed: float) -> Iterator[str]:
    solids, liquid = case.solids, case.liquid
    if liquid is not None:
        reynolds = abs(liquid.bulk_velocity) * 2 * case.pipe.radius / liquid.kinematic_viscosity
        if 2300 <= reynolds <= 4000:
            yield f"the flow is intermittent at a Reynolds number of {reynolds:.0f}; no law holds"
    if solids is None:
        return
    if liquid is not None and case.solids_fraction > _DILUTE:
        yield (
            f"the mean solid fraction {case.solids_fraction:.2g} is above {_DILUTE:g}: "
            "a real liquid would yield to the solids, so they are carried too fast here"
        )
    pair, wall = impacts(case, diameter=solids.largest_diameter, speed=speed)
    overlap = max(pair.overlap, wall.overlap)
    if solids.contact == "linear_spring":
        pair_stiffness, wall_stiffness = spring_stiffness(case, speed)
        overlap = max(pair.on_spring(pair_stiffness)[0], wall.on_spring(wall_stiffness)[0])
    share = overlap / (solids.largest_diameter / 2)
    if share > SOFT:
        yield (
            f"a collision at {speed:.3g} m/s overlaps by {share:.0%} of the radius: "
            "raise fidelity.stiffness_factor or solids.youngs_modulus"
        )
    if liquid is not None and _smoothing_radius(case) < 1.5 * solids.largest_diameter:
        yield (
            f"fidelity.smoothing_radius = {_smoothing_radius(case):g} m is below 1.5 diameters: "
            "the void fraction will be noisy"
        )
