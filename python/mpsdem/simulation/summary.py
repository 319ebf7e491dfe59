"""The run in about twenty numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from mpsdem.analysis import (
    Average,
    Ledgers,
    bed_height,
    extent,
    insitu_concentration,
    ledgers,
    period_of_motion,
    time_average,
)
from mpsdem.liquids import CLIPS, PLATE_COUNTS, NodeLiquid, ParticleLiquid
from mpsdem.plan import COMPUTED, SOFT, Plan, clear_gradient, gravity, pipe_profile
from mpsdem.results import SUMMARY_KEYS, Results
from mpsdem.stages import State

_PARTS = ("pressure_gradient_friction", "pressure_gradient_solids")
# What the summary averages over the second half of the run, where it has it.
_AVERAGED = (
    "bulk_velocity",
    "pressure_gradient",
    "pressure_gradient_friction",
    "pressure_gradient_solids",
    "power_input",
    "dissipation",
    "solids_mean_velocity",
    "convection_error",
    "pressure_iterations",
)


def summarize(plan: Plan, state: State, results: Results) -> tuple[dict[str, Any], dict[str, str]]:
    """What ``summary.json`` says of the physics of a run.

    Parameters
    ----------
    plan : Plan
        What was run.
    state : State
        Where it ended.
    results : Results
        Its frames.

    Returns
    -------
    values : dict
        By name. Means are over the frames of the second half of the time, whole periods of it where
        the pipe moves; ``averages`` holds the error, the window and the number of independent
        samples of each, and whether the run was long enough.
    not_applicable : dict
        Names that mean nothing here, each with the reason.
    """
    values: dict[str, Any] = {
        "time": state.time,
        "steps": state.step,
        "solid_steps": state.step * plan.clock.substeps,
        "liquid_model": plan.liquid_model,
        "coupling": _coupling(plan),
        "solids_count": plan.case.solids_count,
    }
    if state.axis is None:
        values["dissipation"] = _mean(results, "dissipation")
    values |= _of_liquid(plan, state, results) | _of_solids(plan, results)
    if plan.case.liquid is not None and plan.case.solids is not None:
        values |= _of_both(plan, results, values)
    values["averages"] = _averages(plan, results, values)
    if plan.case.solids is not None:
        values["plug_time"] = None if math.isnan(state.plug_time) else state.plug_time
        values["plug_position"] = None if math.isnan(state.plug_time) else state.plug_position
    ledger = _liquid_ledger(plan, results)
    errors = [None if ledger is None else _liquid_momentum_error(ledger)]
    if plan.case.solids is not None and not plan.case.solids.held:
        errors.append(_solids_momentum_error(plan, state, results))
    values["momentum_error"] = max((e for e in errors if e is not None), default=None)
    of_ledger = () if ledger is None else _momentum_warnings(ledger)
    values["warnings"] = [*plan.warnings, *_warnings(plan, values), *of_ledger]
    return values, _reasons(plan, values)


_LIQUID_KEYS = (
    "bulk_velocity",
    "pressure_gradient",
    "pressure_gradient_friction",
    "pressure_gradient_solids",
    "pressure_gradient_static",
    "power_input",
    "friction_factor",
    "delivered_concentration",
)
_SOLIDS_KEYS = (
    "solids_mean_velocity",
    "solids_front_position",
    "insitu_concentration",
    "delivered_concentration",
    "bed_height",
    "largest_overlap",
    "exchange_error",
    "plug_time",
    "plug_position",
)
_LARGEST_MOMENTUM_ERROR = 0.02  # [-] of the friction, above which it is worth a warning
_NOTHING = 1e-30  # [Pa s/m] of momentum, below which nothing moves
# Share of the drags beyond the range of their law that is worth a warning [-].
_FAR_OUTSIDE = 0.05


def _coupling(plan: Plan) -> str | None:
    if plan.case.liquid is None or plan.case.solids is None:
        return None
    return "two-way" if plan.two_way else "one-way"


def _reasons(plan: Plan, values: dict[str, Any]) -> dict[str, str]:
    """Why keys of the summary have no value."""
    reasons: dict[str, str] = {}
    if not plan.two_way:
        reasons |= {"exchange_error": "the liquid takes no impulse from the solids"}
    if plan.liquid_model not in COMPUTED:
        reasons |= dict.fromkeys(("liquid_count", "mass_error"), "the liquid has no particles")
    if plan.case.liquid is None:
        reasons |= dict.fromkeys((*reasons, "liquid_model", "coupling", *_LIQUID_KEYS), "no liquid")
    elif values.get("bulk_velocity") == 0:
        reasons |= {"delivered_concentration": "the liquid is at rest"}
    if plan.case.solids is None:
        reasons |= dict.fromkeys((*_SOLIDS_KEYS, "coupling"), "no solids")
    elif plan.case.gravity == 0:
        reasons |= {"bed_height": "no gravity"}
    if plan.case.solids is not None and values["plug_time"] is None:
        reasons |= dict.fromkeys(("plug_time", "plug_position"), "no plug stood in the pipe")
    if plan.case.motion.moves_walls:
        walls = "the work of moving walls is not counted"
        reasons |= dict.fromkeys(("dissipation", "power_input"), walls)
    if values["momentum_error"] is None:
        reasons |= {"momentum_error": _no_ledger(plan)}
    return reasons


def _warnings(plan: Plan, values: dict[str, Any]) -> Iterator[str]:
    if (since := values.get("plug_time")) is not None:
        yield (
            f"solids stood still and filled the pipe at x = {values['plug_position']:.4g} m from "
            f"{since:.4g} s on: a plug"
        )
    short = [name for name, of in values["averages"].items() if not of["long_enough"]]
    if short := [name for name in short if name in SUMMARY_KEYS]:
        yield (
            f"the run is too short for the mean of {', '.join(short)}: the second half drifts or "
            "holds too few independent samples, and the error bars are too small; a later end_time"
        )
    if (overlap := values.get("largest_overlap", 0.0)) > SOFT:
        yield f"solids overlapped by up to {overlap:.0%} of their radius: contacts are too soft"
    if clipped := values.get("void_fraction_clipped"):
        yield f"{clipped} void fractions fell below the floor and were raised to it"
    if clipped := values.get("liquid_void_fraction_clipped"):
        yield (
            f"{clipped} void fractions of the liquid fell below the floor and were raised to it: a "
            "larger fidelity.smoothing_radius spreads the solids wider"
        )
    if (outside := values.get("drag_outside", 0.0)) > _FAR_OUTSIDE:
        assert plan.case.solids is not None
        yield f"{outside:.0%} of the drags lie outside the range of {plan.case.solids.drag}"


def _average(results: Results, name: str) -> Average:
    recorded = results.diagnostics
    period = period_of_motion(results.case.motion)
    # next to a velocity or a loss of pressure, a part of it may be as good as nothing
    whole = {"solids_mean_velocity": "bulk_velocity", "convection_error": "pressure_gradient"}
    whole |= dict.fromkeys(_PARTS, "pressure_gradient")
    scale = np.abs(recorded[whole[name]]).mean() if whole.get(name) in recorded else 0.0
    return time_average(results.time, recorded[name], period=period, scale=float(scale))


def _mean(results: Results, name: str) -> float:
    return _average(results, name).mean


def _averages(plan: Plan, results: Results, values: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """Every mean of the summary with its error."""
    found = {name: _average(results, name) for name in _AVERAGED if name in values}
    for name, of in (
        ("delivered_concentration", "solids_mean_velocity"),
        ("friction_factor", _loss_of_friction(plan)),
    ):
        averaged = name != "friction_factor" or plan.liquid_model in COMPUTED
        if averaged and values.get(name) is not None and found[of].mean != 0:
            found[name] = found[of].times(values[name] / found[of].mean)
    return {
        name: {
            "mean": average.mean,
            "error": average.error,
            "window": average.window,
            "samples": average.samples,
            "long_enough": average.long_enough,
        }
        for name, average in found.items()
    }


def _loss_of_friction(plan: Plan) -> str:
    """Which loss the friction factor tells of: with solids the loss is theirs too."""
    alone = plan.case.solids is None
    return "pressure_gradient" if alone else "pressure_gradient_friction"


def _sum(results: Results, name: str) -> int:
    return int(results.diagnostics[name].sum())


def _of_liquid(plan: Plan, state: State, results: Results) -> dict[str, Any]:
    case, liquid = plan.case, plan.case.liquid
    if liquid is None:
        return {}
    means = [
        "bulk_velocity",
        "pressure_gradient",
        "pressure_gradient_friction",
        "pressure_gradient_solids",
    ]
    if state.axis is None:
        means.append("power_input")
    values: dict[str, Any] = {
        **{name: _mean(results, name) for name in means},
        "pressure_gradient_static": float(-liquid.density * gravity(case)[0]),
        "friction_factor": pipe_profile(case).friction_factor,
    }
    if isinstance(state.liquid, ParticleLiquid | NodeLiquid):
        if isinstance(state.liquid, ParticleLiquid):
            values |= _of_particles(state.liquid, results)
        else:
            values |= _of_nodes(state.liquid, results)
        velocity = values["bulk_velocity"]
        dynamic = liquid.density * velocity * abs(velocity) / 2
        if dynamic != 0:
            loss = values[_loss_of_friction(plan)]
            values["friction_factor"] = loss * 2 * case.pipe.radius / dynamic
    return values


def _of_particles(liquid: ParticleLiquid, results: Results) -> dict[str, Any]:
    values: dict[str, Any] = {
        "liquid_count": liquid.particles.liquid_count,
        # particles carry the mass, as long as they are in the bore
        "mass_error": 1 - liquid.count_in_bore / liquid.full_count,
        "pressure_iterations": _mean(results, "pressure_iterations"),
        "liquid_clips": {name: _sum(results, name) for name in CLIPS},
    }
    if liquid.has_plate:
        values["push_plate"] = {name: _sum(results, name) for name in PLATE_COUNTS}
    return values


def _of_nodes(liquid: NodeLiquid, results: Results) -> dict[str, Any]:
    return {
        "liquid_count": len(liquid.layout),
        # what goes through one section and not through another
        "mass_error": liquid.flux_error,
        "divergence": float(results.diagnostics["divergence"].max()),
    }


def _of_solids(plan: Plan, results: Results) -> dict[str, Any]:
    case = plan.case
    if case.solids is None:
        return {}
    solids = results.solids
    radius = solids.radius
    x, _, z = np.moveaxis(solids.position[-1], -1, 0)
    unwrapped = x + case.pipe.length * solids.laps[-1]
    return {
        "solids_mean_velocity": _mean(results, "solids_mean_velocity"),
        "solids_front_position": float(extent(unwrapped[None]).front[0]),
        "insitu_concentration": insitu_concentration(
            radius, pipe_radius=case.pipe.radius, length=case.pipe.length
        ),
        "bed_height": bed_height(z, radius, pipe_radius=case.pipe.radius),
        "largest_overlap": float(results.diagnostics["largest_overlap"].max()),
    }


def _of_both(plan: Plan, results: Results, values: dict[str, Any]) -> dict[str, Any]:
    """What solids and liquid do together; the values known so far say how fast they are."""
    of_both: dict[str, Any] = {
        "void_fraction_clipped": _sum(results, "void_fraction_clipped"),
        "drag_outside": _sum(results, "drags_outside") / _sum(results, "drags"),
    }
    if (flux := values["bulk_velocity"]) != 0:
        of_solids = values["insitu_concentration"] * values["solids_mean_velocity"]
        of_both["delivered_concentration"] = of_solids / flux
    if plan.two_way:
        clipped = "liquid_void_fraction_clipped"
        volume_error = float(results.diagnostics["liquid_volume_error"].max())
        of_both |= {
            clipped: _sum(results, clipped),
            "exchange_error": float(results.diagnostics["exchange_error"].max()),
            "mass_error": volume_error,
            # Pa/m that convection between solids lost of the liquid's momentum, and was given back
            "convection_error": _mean(results, "convection_error"),
        }
        if plan.liquid_model == "lagrangian":
            of_both["mass_error"] = max(volume_error, abs(values["mass_error"]))
    return of_both


def _no_ledger(plan: Plan) -> str:
    if plan.case.pipe.has_plate:
        return "plate and outlet act through the pressure"
    if plan.case.motion.flexes:
        return "walls that flex push the liquid along the pipe"
    if plan.case.solids is None and plan.liquid_model == "profile":
        return "this liquid keeps no ledger"
    return "nothing took an impulse at the wall"


def _liquid_ledger(plan: Plan, results: Results) -> Ledgers | None:
    """That of a liquid that keeps one."""
    walls_push = plan.case.pipe.has_plate or plan.case.motion.flexes
    if plan.liquid_model not in COMPUTED or walls_push:
        return None
    # the first step makes room for the solids, whose share in the liquid is not known before
    return ledgers(results, first=1 if plan.two_way and len(results.time) > 2 else 0)


def _liquid_momentum_error(ledger: Ledgers) -> float | None:
    """Axial impulse on the liquid that nothing explains, over that of friction, if any."""
    friction = abs(float(ledger.friction[-1]))
    return abs(float(ledger.unexplained[-1])) / friction if friction > _NOTHING else None


def _momentum_warnings(ledger: Ledgers) -> Iterator[str]:
    lost, friction = abs(ledger.unexplained[-1]), abs(ledger.friction[-1])
    if _NOTHING < friction < lost / _LARGEST_MOMENTUM_ERROR:
        time = ledger.time[-1] - ledger.time[0]
        yield (
            f"{lost / time:.2g} Pa/m of the liquid's momentum is unexplained, of "
            f"{friction / time:.2g} Pa/m of friction and {ledger.exchanged[-1] / time:.2g} Pa/m "
            "of drag of solids"
        )


def _solids_momentum_error(plan: Plan, state: State, results: Results) -> float | None:
    """What solids gained, less what weight, shaking, liquid and walls gave; None without walls."""
    case, liquid, solids = plan.case, plan.case.liquid, state.solids
    assert case.solids is not None
    mass = case.solids.density * 4 / 3 * math.pi * results.solids.radius**3
    start = results.solids.velocity[0]
    if state.axis is not None:
        start = results.solids.laboratory_velocity(0)
    gained = mass @ (solids.velocity - start)
    lightness = 1 - (liquid.density if liquid else 0.0) / case.solids.density
    weight = mass.sum() * lightness * gravity(case) * state.time
    if state.axis is None:
        shaken = np.diff(case.motion.at(np.array([0.0, state.time])).velocity, axis=0)[0]
        weight -= mass.sum() * lightness * shaken
    else:
        weight += state.carried_impulse
    unexplained = gained - weight - state.drag_impulse - solids.wall_impulse
    friction = clear_gradient(case) * case.pipe.bore_volume * state.time
    of_walls = abs(friction) + float(np.linalg.norm(solids.wall_impulse))
    return float(np.linalg.norm(unexplained)) / of_walls if of_walls > 0 else None
