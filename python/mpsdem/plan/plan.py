"""The plan: what a case requires, and why. Pure functions of a case; nothing is run."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from mpsdem import _core
from mpsdem.analysis.correlations import durand_deposition_velocity
from mpsdem.case import Case, CaseError, Problem
from mpsdem.plan.clock import Clock
from mpsdem.plan.limits import (
    SOLID_RATE,
    Limit,
    Step,
    coupling_limits,
    liquid_limits,
    solid_limits,
)
from mpsdem.plan.scales import (
    COMPUTED,
    DILUTE,
    density_ratio,
    drag_rate,
    fastest_flow,
    fastest_profile,
    has_added_mass,
    has_lubrication,
    impact_speed,
    impact_stokes,
    impacts,
    is_two_way,
    lightness,
    liquid_model,
    mean_diameter,
    needs_void_fraction,
    particle_count,
    pipe_profile,
    smoothing_radius,
    solids_of,
    spring_stiffness,
    terminal_velocity,
    turbulence,
)

SOFT = 0.05  # [-] overlap over radius above which contacts lose their meaning
# Up to as many solids and particles, or nodes, threads cost more than they gain.
_SERIAL, _SERIAL_NODES = 5000, 30_000
_HARDEST = 1000.0  # [m/s2] of shaking, the largest that was found sane by all figures
# Walls that flex: their speed over the liquid's, and the curvature over that of the bore, up to
# which particles scatter by less than 0.05 [-]. Found at 0.5 of that speed and 0.35 of that
# curvature: 0.05; at 0.45: 0.08; without flow runs diverge.
_FLEXING_SPEED, _FLEXING_BEND = 0.35, 0.3
_LONG_SETUP = 20.0  # [s] before the first step, that is worth a warning
_FRAMES = 8  # of a period of motion, that show it
# What the estimate is made of, in processor time of a machine on which `mpsdem.trade.machine`
# takes 0.031 s for its solids and 0.027 s for its liquid; fitted to runs of twenty kinds.
_CALL_TIME = {True: 5e-4, False: 4e-4}  # [s] one turn of the time loop, with solids and without
_SOLID_TIME = 6e-7  # [s] what a turn does with one solid but moving it: void fraction, drag
_NEIGHBOR_TIME = 9e-9  # [s] one neighbor of one solid, for the void fraction
# [s] exchange of one solid with one point of the liquid: in a step of the liquid, in a turn, and
# its memory
_FOOTPRINT_TIME, _RESPONSE_TIME, _FOOTPRINT_BYTES = 4.5e-8, 5e-9, 24
_SAMPLE_TIME = 2e-8  # [s] one point of a computed liquid at one solid that it does not feel
_SOLID_BYTES = 2000  # memory of one solid with its contacts and neighbors
# [s] one step of one liquid particle or node, its pressure included; and where it feels solids, for
# which nodes part a step in two.
_PARTICLE_TIME = {"lagrangian": (2e-6, 3.4e-6), "eulerian": (0.22e-6, 0.45e-6)}
# Spacings across from which on each further one makes a step on nodes dearer, and by how much [-]:
# its pressure goes through a basis of all nodes of a section, and solids make it part more often.
_FINE_SECTION = {False: (24, 0.036), True: (16, 0.075)}
_LAMINAR = 3.0  # [-] a laminar step of particles over a turbulent one: viscosity by least squares
_PARTICLE_BYTES = {"lagrangian": 1100, "eulerian": 400}
_SETUP_TIME = 2e-6  # [s] of one particle or node, once
_BASIS_TIME, _BASIS_BYTES = 2.6e-10, 45  # [s] times the cube of a section's nodes; of their square
# [s] of a frame, more with solids, and more with a liquid that is written out
_FRAME_TIME, _SOLIDS_FRAME_TIME, _WRITTEN_FRAME_TIME = 3.5e-3, 6e-3, 5e-3
_PARTICLE_FRAME_TIME = {"lagrangian": 2.5e-6, "eulerian": 1e-7}  # [s] of a particle or node in it
_LIQUID_KINDS = {"lagrangian": "particles", "eulerian": "fixed nodes"}  # of computed liquids
_LIVELY = 300  # [-] Reynolds number up to which laminar particles damp a swirl
# Wall units from the wall below which the nodes' friction is 4 % high: 4.3 % at 15, 3.6 % at 26.
_LEAST_PLUS = 20
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
class Estimate:
    """What the run will take on the machine that it was fitted on.

    Within a factor of 1.5 for clear turbulent flow and for conveying; twice off where nodes need
    not part their steps (settling) and in small laminar runs, and far too little where walls move
    and turns are many.

    Attributes
    ----------
    wall_seconds : float
        By the clock [s].
    solids_seconds, liquid_seconds : float
        Of computing: what the solids and the time loop take, and what the liquid and its exchange
        with solids take [s].
    memory_bytes, disk_bytes : float
    """

    wall_seconds: float
    solids_seconds: float
    liquid_seconds: float
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
    liquid_model : {"profile", "eulerian", "lagrangian"} or None
        How the liquid is computed; None without any.
    two_way : bool
        Whether the liquid feels the solids.
    added_mass, lubrication : bool
        Whether solids carry liquid along, and whether it damps their impacts.
    smoothing_radius : float
        Radius over which void fraction and exchange are averaged [m]; 0 without solids.
    solid_step : Step or None
        Step of the solids; None where none moves.
    coupling_step : Step
        Time between two looks at the liquid.
    liquid_step : Step or None
        Step of a liquid that is computed; None for any other.
    turns_per_liquid_step : int
        Coupling steps to a liquid step.
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
    liquid_model: str | None
    two_way: bool
    added_mass: bool
    lubrication: bool
    smoothing_radius: float
    solid_step: Step | None
    coupling_step: Step
    liquid_step: Step | None
    turns_per_liquid_step: int
    clock: Clock
    threads: int
    estimate: Estimate
    warnings: tuple[str, ...]


def make_plan(case: Case) -> Plan:
    """Decide what a case requires.

    Raises
    ------
    CaseError
        If a step given in ``fidelity`` exceeds its limit, a limit cannot be found, or the
        smoothing radius is too small for what liquid and solids exchange.
    """
    speed = impact_speed(case)
    _require_contacts_that_hold(case, speed)
    of_solids = solid_limits(case, speed)
    of_coupling = coupling_limits(case, of_solids)
    of_liquid = tuple(liquid_limits(case))
    liquid_steps = _whole(case.output.every / _shortest(of_liquid)) if of_liquid else 1
    turns = _whole(case.output.every / liquid_steps / _shortest(of_coupling))
    threads = case.fidelity.threads or (_core.available_threads() if _is_large(case) else 1)
    steps_per_frame = liquid_steps * turns
    coupling_step = case.output.every / steps_per_frame
    substeps = _whole(coupling_step / _shortest(of_solids)) if of_solids else 0
    clock = Clock(
        end_time=case.end_time,
        every=case.output.every,
        steps_per_frame=steps_per_frame,
        substeps=substeps,
    )
    return Plan(
        case=case,
        numbers=tuple(_numbers(case)),
        stages=tuple(_stages(case, clock, turns)),
        left_out=tuple(_left_out(case)),
        impact_speed=speed,
        liquid_model=liquid_model(case),
        two_way=is_two_way(case),
        added_mass=has_added_mass(case),
        lubrication=has_lubrication(case),
        smoothing_radius=smoothing_radius(case),
        solid_step=Step(value=coupling_step / substeps, limits=of_solids) if of_solids else None,
        coupling_step=Step(value=coupling_step, limits=of_coupling),
        liquid_step=Step(value=turns * coupling_step, limits=of_liquid) if of_liquid else None,
        turns_per_liquid_step=turns,
        clock=clock,
        threads=threads,
        estimate=_estimate(case, clock, turns, threads),
        warnings=tuple(_warnings(case, speed)),
    )


def _is_large(case: Case) -> bool:
    nodes = liquid_model(case) == "eulerian"
    return case.solids_count >= _SERIAL or particle_count(case) >= (
        _SERIAL_NODES if nodes else _SERIAL
    )


def _shortest(limits: Iterable[Limit]) -> float:
    return min(limit.value for limit in limits)


def _whole(ratio: float) -> int:
    """Smallest whole number of steps that does the work of `ratio` steps, round-off forgiven."""
    return max(1, math.ceil(ratio * (1 - 1e-12)))


def _numbers(case: Case) -> Iterator[Number]:
    pipe, liquid, solids = case.pipe, case.liquid, case.solids
    bore = 2 * pipe.radius
    if liquid is not None:
        reynolds = fastest_flow(case) * bore / liquid.kinematic_viscosity
        regime = "laminar" if fastest_profile(case).laminar else "turbulent"
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
    crowd = "dilute" if fraction <= DILUTE else "a liquid notices the solids"
    yield Number(name="mean solid fraction", value=fraction, unit="", meaning=crowd)
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
    slip = max(fastest_flow(case), settling)
    stokes = fastest_flow(case) / bore / drag_rate(case, diameter=diameter, slip=slip)
    yield Number(
        name="Stokes number",
        value=stokes,
        unit="",
        meaning="solids lag the liquid" if stokes > 0.1 else "solids follow the liquid",
    )
    if not solids.held:
        damped = "the liquid between damps them" if has_lubrication(case) else "as if dry"
        yield Number(
            name="Stokes number of impacts", value=impact_stokes(case), unit="", meaning=damped
        )
        carried = (
            "the solids carry liquid along" if has_added_mass(case) else "of solids and liquid"
        )
        yield Number(
            name="density ratio",
            value=density_ratio(case),
            unit="",
            meaning=carried,
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
        moving = fastest_flow(case) > deposition
        yield Number(
            name="deposition velocity",
            value=deposition,
            unit="m/s",
            meaning=("below the bulk velocity: carried" if moving else "above it: a bed is likely")
            + " (Durand, level pipe)",
        )


def _flow(case: Case) -> str:
    model = turbulence(case)
    if model is None:
        return "laminar, no-slip walls"
    chosen = "as was asked for"
    if case.fidelity.turbulence == "auto":
        laminar = fastest_profile(case).laminar
        chosen = "as the solids stir the liquid" if laminar else "as the flow is turbulent"
    return f"{model.replace('_', ' ')} and log-law wall function, {chosen}"


def _stages(case: Case, clock: Clock, turns: int) -> Iterator[Planned]:
    solids, two_way = case.solids, is_two_way(case)
    if liquid_model(case) in COMPUTED and not two_way:
        yield _liquid_stage(case)
    if solids is not None:
        yield from _coupling_stages(case, turns)
        if not solids.held:
            reason = f"{case.solids_count} solids, {solids.contact}: {clock.substeps} steps a turn"
            if has_lubrication(case):
                reason += "; the liquid in narrow gaps damps impacts"
            if not case.motion.at_rest:
                reason += f"; {_frame(case)}"
            yield Planned(name="AdvanceSolids", reason=reason)
        elif not two_way:
            yield Planned(name="HoldSolids", reason="they take up the drag, and stay (solids.held)")
    if two_way:
        yield _exchange_stage(case, turns)
        yield _liquid_stage(case)
    reason = f"{clock.frames + 1} frames, one every {clock.every:g} s"
    yield Planned(name="Record", reason=reason)


def _frame(case: Case) -> str:
    """In which frame the solids move, and why."""
    if case.motion.moves_walls:
        return f"{_moving_walls(case)}, which carry along what touches them"
    body = "the pipe is shaken as one body, and all is seen from it: solids feel"
    if case.liquid is None:
        return f"{body} its acceleration as a force"
    return (
        f"{body} {lightness(case):.2g} of its acceleration as a force, as the pressure of the full "
        "pipe balances the rest"
    )


def _moving_walls(case: Case) -> str:
    """Why walls move."""
    if case.motion.flexes:
        modes = ", ".join(str(mode) for mode in case.motion.modes if mode > 0)
        return f"the pipe flexes (mode {modes}) and is at rest in no frame, so its walls move"
    return "walls move, as was asked for"


def _liquid_stage(case: Case) -> Planned:
    model, liquid, pipe = liquid_model(case), case.liquid, case.pipe
    assert model is not None
    assert liquid is not None
    if pipe.has_plate:
        asked = (
            f"move, as a plate pushes them in strokes of {pipe.resolved_stroke:g} m, and "
            f"works in {pipe.resolved_stroke + pipe.settling_length:g} m of pipe upstream"
        )
    elif liquid.model == "auto":
        why = "it feels the solids" if is_two_way(case) else "its pressure gradient is given"
        asked = (
            f"as the liquid must be computed ({why}), and the pipe is straight, full, rigid and "
            "periodic"
        )
    else:
        asked = "were asked for"
    if case.motion.moves_walls:
        asked = f"give way to the walls: {_moving_walls(case)}"
    reason = f"about {particle_count(case)} {_LIQUID_KINDS[model]} {asked}; {_flow(case)}"
    return Planned(name="AdvanceLiquid", reason=reason)


def _coupling_stages(case: Case, turns: int) -> Iterator[Planned]:
    """What finds the drag of the liquid on the solids."""
    if case.liquid is None:
        return
    solids = solids_of(case)
    if is_two_way(case):
        reason = (
            "the velocity of the liquid at a solid, averaged over "
            f"{smoothing_radius(case):g} m as the exchange is, {_once_in(turns)}"
        )
    else:
        flow = "parabola" if pipe_profile(case).laminar else "turbulent profile"
        kind = _LIQUID_KINDS.get(liquid_model(case) or "")
        reason = "the velocity of the liquid: " + (
            f"of the {kind} near a solid" if kind else f"it is a prescribed {flow}"
        )
    yield Planned(name="SampleLiquid", reason=reason)
    if needs_void_fraction(case):
        reason = f"the drag law {solids.drag} depends on the share of liquid at a solid"
        yield Planned(name="FindVoidFraction", reason=reason)
    verb = "drags at" if solids.held else "carries"
    reason = f"the liquid {verb} the solids: {solids.drag}"
    if has_added_mass(case):
        reason += "; they carry half their volume of it along"
    yield Planned(name="DragForce", reason=reason)


def _once_in(turns: int) -> str:
    return "every turn" if turns == 1 else f"once in {turns} turns"


def _exchange_stage(case: Case, turns: int) -> Planned:
    asked = case.fidelity.coupling == "two-way"
    why = (
        "as was asked for"
        if asked
        else f"as the solids fill {case.solids_fraction:.2g} of the bore, above {DILUTE:g}"
    )
    reason = f"the liquid feels the solids, {why}: it gets what it gave them, {_once_in(turns)}"
    return Planned(name="ExchangeMomentum", reason=reason)


def _left_out(case: Case) -> Iterator[Planned]:
    solids, liquid = case.solids, case.liquid
    yield from _left_out_of_the_shaking(case)
    if liquid is None:
        yield Planned(name="liquid", reason="the case has no [liquid]: dry")
    elif liquid_model(case) == "profile":
        yield Planned(name="AdvanceLiquid", reason="the profile is prescribed, and steady")
    elif turbulence(case) is None:
        yield Planned(name="turbulence", reason="the Reynolds number is below 2300")
    if solids is None:
        yield Planned(name="solids", reason="the case has no [solids]: clear liquid")
        return
    if solids.held:
        yield Planned(name="AdvanceSolids", reason="the solids are held")
    if liquid is not None:
        if not is_two_way(case):
            yield Planned(name="ExchangeMomentum", reason=_why_one_way(case))
        if not needs_void_fraction(case):
            alone = "a lone solid has no neighbors"
            reason = alone if case.solids_count == 1 else f"{solids.drag} takes no notice of it"
            yield Planned(name="FindVoidFraction", reason=reason)
        if not solids.held:
            yield from _left_out_of_the_motion(case)
    if solids.rolling_friction == 0 == solids.at_wall.rolling_friction:
        yield Planned(name="rolling resistance", reason="solids.rolling_friction = 0")


def _left_out_of_the_shaking(case: Case) -> Iterator[Planned]:
    """What a pipe that is shaken as one body does without."""
    if case.motion.at_rest:
        yield Planned(name="motion", reason="the pipe is at rest")
    elif case.liquid is not None and not case.motion.moves_walls:
        reason = (
            "a pipe that is full and shaken as one body moves no liquid in it: the pressure takes "
            "up the shaking as it does gravity"
        )
        yield Planned(name="moving walls", reason=reason)


def _why_one_way(case: Case) -> str:
    if case.fidelity.coupling == "one-way":
        why = "one-way coupling was asked for"
    elif liquid_model(case) not in COMPUTED:
        why = "a prescribed profile does not feel the solids"
    elif case.pipe.has_plate:
        why = "a liquid that a push plate moves does not feel the solids"
    else:
        why = f"the solids fill no more than {DILUTE:g} of the bore"
    return f"{why}; the pressure gradient counts their drag"


def _left_out_of_the_motion(case: Case) -> Iterator[Planned]:
    if not has_added_mass(case):
        ratio = density_ratio(case)
        off = case.fidelity.added_mass == "off"
        reason = "switched off" if off else f"the solids are {ratio:.3g} times as dense"
        yield Planned(name="added mass", reason=reason)
    if not has_lubrication(case):
        off = case.fidelity.lubrication == "off"
        reason = f"the Stokes number of impacts is {impact_stokes(case):.3g}, above 100"
        yield Planned(name="lubrication", reason="switched off" if off else reason)


def _estimate(case: Case, clock: Clock, turns: int, threads: int) -> Estimate:
    count, steps = case.solids_count, clock.steps
    particles, model = particle_count(case), liquid_model(case) or ""
    frame = _FRAME_TIME + (_SOLIDS_FRAME_TIME if count else 0.0)
    if particles and case.output.liquid_stride != 0:
        frame += _WRITTEN_FRAME_TIME
    loop = steps * _CALL_TIME[count > 0] + (clock.frames + 1) * frame
    moving = count * steps * clock.substeps / SOLID_RATE
    around, of_liquid, solid_bytes = 0.0, 0.0, float(_SOLID_BYTES)
    if count and case.liquid is not None:
        neighbors = (
            case.solids_fraction
            * (2 * smoothing_radius(case) / mean_diameter(solids_of(case))) ** 3
        )
        around = count * steps * (_SOLID_TIME + neighbors * _NEIGHBOR_TIME)
    exchange, apart = 0.0, 0.0  # apart: set-up and frames, on one thread
    if count and particles:
        spacing = case.fidelity.resolved_particle_spacing(case.pipe.radius)
        footprint = 4 / 3 * math.pi * (smoothing_radius(case) / spacing) ** 3
        if is_two_way(case):
            if not solids_of(case).held:
                around += count * footprint * steps * _RESPONSE_TIME
            exchange = count * footprint * steps / turns * _FOOTPRINT_TIME
            solid_bytes += footprint * _FOOTPRINT_BYTES
        else:
            around += count * footprint * steps * _SAMPLE_TIME
    if particles:
        of_liquid = particles * steps / turns * _PARTICLE_TIME[model][is_two_way(case)]
        if model == "lagrangian" and turbulence(case) is None:
            of_liquid *= _LAMINAR
        if model == "eulerian":
            across = (
                2 * case.pipe.radius / case.fidelity.resolved_particle_spacing(case.pipe.radius)
            )
            fine, dearer = _FINE_SECTION[is_two_way(case)]
            of_liquid *= 1 + dearer * max(0.0, across - fine)
        frames = clock.frames * _PARTICLE_FRAME_TIME[model]
        apart = _basis_time(case) + particles * (_SETUP_TIME + frames)
    of_basis = _BASIS_BYTES * _section_nodes(case) ** 2
    frame_bytes = count * 8 * (9 + (7 if case.liquid else 0)) + 100
    return Estimate(
        wall_seconds=loop + around + apart + (moving + exchange + of_liquid) / threads,
        solids_seconds=loop + around + moving,
        liquid_seconds=exchange + of_liquid + apart,
        memory_bytes=_BASE_BYTES
        + of_basis
        + count * solid_bytes
        + particles * _PARTICLE_BYTES.get(model, 0),
        disk_bytes=frame_bytes * (clock.frames + 1),
    )


def _section_nodes(case: Case) -> float:
    """Nodes of a cross-section, about; 0 unless the liquid has such."""
    if liquid_model(case) != "eulerian":
        return 0.0
    spacing = case.fidelity.resolved_particle_spacing(case.pipe.radius)
    return math.pi * (case.pipe.radius / spacing) ** 2


def _basis_time(case: Case) -> float:
    """What it takes to find the eigenbasis that a liquid on nodes solves its pressure with [s]."""
    return _BASIS_TIME * _section_nodes(case) ** 3


def _wall_law_warnings(case: Case) -> Iterator[str]:
    profile = fastest_profile(case)
    assert case.liquid is not None
    spacing = case.fidelity.resolved_particle_spacing(case.pipe.radius)
    plus = spacing * profile.friction_velocity / case.liquid.kinematic_viscosity
    if not profile.laminar and plus < _LEAST_PLUS:
        yield (
            f"the nodes next to the wall lie {plus:.0f} wall units from it, in the buffer layer, "
            "where the log law is off: the friction comes out 4 % high and more; take a wider "
            "fidelity.particle_spacing"
        )


def _flexing_warnings(case: Case) -> Iterator[str]:
    motion, liquid = case.motion, case.liquid
    if liquid is None or not motion.flexes:
        return
    flow = fastest_flow(case)
    if motion.peak_speed > _FLEXING_SPEED * flow:
        yield (
            f"walls that flex move at up to {motion.peak_speed:.3g} m/s in a liquid that flows at "
            f"{flow:.3g} m/s: beyond {_FLEXING_SPEED:g} of that the particles fall into disorder, "
            "and diverge without flow; shake it more slowly"
        )
    bend = motion.sharpest(case.pipe.length) * case.pipe.radius
    if bend > _FLEXING_BEND:
        yield (
            f"walls that flex bend the axis to {bend:.2g} of the curvature of the bore: beyond "
            f"{_FLEXING_BEND:g} the number density of the particles scatters by 0.05 and more; "
            "take a smaller amplitude, a lower mode or a longer pipe"
        )


def _warnings(case: Case, speed: float) -> Iterator[str]:
    solids, liquid = case.solids, case.liquid
    period = case.motion.shortest_period
    if _FRAMES * case.output.every > period:
        yield (
            f"a period of the pipe's motion, {period:.3g} s, has {period / case.output.every:.2g} "
            f"frames: take output.every <= {period / _FRAMES:.3g} s to see it"
        )
    yield from _flexing_warnings(case)
    if (shaking := case.motion.peak_acceleration) > _HARDEST and solids is not None:
        yield (
            f"the pipe's acceleration reaches {shaking:.3g} m/s2: contacts went 0.12 of the radius "
            f"deep at {_HARDEST:g} m/s2 and 0.44 at ten times that; shake it more gently, or take "
            "stiffer solids and a smaller fidelity.rayleigh_fraction"
        )
    if liquid is not None and liquid_model(case) == "lagrangian" and turbulence(case) is None:
        reynolds = fastest_flow(case) * 2 * case.pipe.radius / liquid.kinematic_viscosity
        if reynolds > _LIVELY:
            yield (
                f"at a Reynolds number of {reynolds:.0f} the particles do not damp a swirl, as "
                "laminar flow should: take liquid.model = 'eulerian' where it is disturbed"
            )
    if liquid_model(case) == "lagrangian" and turbulence(case) == "smagorinsky":
        yield (
            "fidelity.turbulence = smagorinsky leaves the mean flow to eddies that the particles "
            "do not carry: friction comes out too low, 8 % at 16 spacings across the bore"
        )
    if liquid is not None:
        reynolds = fastest_flow(case) * 2 * case.pipe.radius / liquid.kinematic_viscosity
        if 2300 <= reynolds <= 4000:
            yield f"the flow is intermittent at a Reynolds number of {reynolds:.0f}; no law holds"
        if (seconds := _basis_time(case)) > _LONG_SETUP:
            yield (
                f"the nodes of a section, {_section_nodes(case):.0f}, take {seconds / 60:.1f} min "
                "before the first step, as the cube of their number does: take a wider "
                "fidelity.particle_spacing, or liquid.model = 'lagrangian'"
            )
        if liquid_model(case) == "eulerian":
            yield from _wall_law_warnings(case)
    if solids is None:
        return
    if liquid is not None and case.solids_fraction > DILUTE and not is_two_way(case):
        consequence = "it flows through them" if solids.held else "they are carried too fast"
        yield (
            f"the mean solid fraction {case.solids_fraction:.2g} is above {DILUTE:g}: "
            f"a real liquid would yield to the solids, so {consequence} here"
        )
    if solids.held:
        return
    share = _depth(case, speed)
    if share > SOFT:
        stiffer = "solids.youngs_modulus" if solids.contact != "linear_spring" else "the stiffness"
        if case.fidelity.stiffness_factor < 1:
            stiffer = "fidelity.stiffness_factor"
        yield f"a collision at {speed:.3g} m/s goes {share:.0%} of the radius deep: raise {stiffer}"


def _depth(case: Case, speed: float) -> float:
    """Depth of a collision of the largest solids at a speed [m/s], over their radius [-]."""
    solids = solids_of(case)
    pair, wall = impacts(case, diameter=solids.largest_diameter, speed=speed)
    overlap = max(pair.overlap, wall.overlap)
    if solids.contact == "linear_spring":
        pair_stiffness, wall_stiffness = spring_stiffness(case, speed)
        overlap = max(pair.on_spring(pair_stiffness)[0], wall.on_spring(wall_stiffness)[0])
    return overlap / (solids.largest_diameter / 2)


def _require_contacts_that_hold(case: Case, speed: float) -> None:
    """Refuse contacts so soft that a solid would go through what it hits.

    In a dry case the speed is an upper bound, that of a fall along the whole pipe.
    """
    solids = case.solids
    if solids is None or solids.held or case.liquid is None:
        return
    if (share := _depth(case, speed)) <= 1:
        return
    given = solids.normal_stiffness is not None
    field = "normal_stiffness" if given else "youngs_modulus"
    least = getattr(solids, field) * share ** (2.0 if given else 2.5)  # spring; Hertz
    unit = "N/m" if given else "Pa"
    problem = Problem(
        field=f"solids.{field}",
        value=getattr(solids, field),
        unit=unit,
        rule=f"must be >= {least:.2g} {unit}: a collision at {speed:.3g} m/s would go {share:.0%} "
        "of the radius deep, through what it hits",
        remedy="raise it, or fidelity.stiffness_factor if that is below 1",
    )
    raise CaseError([problem])
