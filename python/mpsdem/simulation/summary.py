"""The run in about twenty numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from mpsdem.analysis import extent
from mpsdem.liquids import CLIPS, PLATE_COUNTS, NodeLiquid, ParticleLiquid
from mpsdem.plan import SOFT, Plan, clear_gradient, gravity, pipe_profile
from mpsdem.results import Results
from mpsdem.stages import State

# Share of the solids that lie in the bed, whole [-]; the rest is in motion above it.
_BED_SHARE = 0.95


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
        By name. Means are over the frames of the second half of the time.
    not_applicable : dict
        Names that mean nothing here, each with the reason.
    """
    values: dict[str, Any] = {
        "time": state.time,
        "steps": state.step,
        "solid_steps": state.step * plan.clock.substeps,
        "liquid_model": plan.liquid_model,
        "solids_count": plan.case.solids_count,
    }
    parts = (_of_liquid(plan, state, results), _of_solids(plan, state, results))
    values |= parts[0] | parts[1]
    errors = [part["momentum_error"] for part in parts if part.get("momentum_error") is not None]
    values["momentum_error"] = max(errors, default=None)
    values["warnings"] = [*plan.warnings, *_warnings(values)]
    reasons = {"exchange_error": "the liquid takes no impulse from the solids"}
    if plan.liquid_model not in ("eulerian", "lagrangian"):
        reasons |= dict.fromkeys(("liquid_count", "mass_error"), "the liquid has no particles")
    if plan.case.liquid is None:
        reasons |= dict.fromkeys((*reasons, "liquid_model", *_LIQUID_KEYS), "no liquid")
    elif plan.case.liquid.bulk_velocity == 0:
        reasons |= {"delivered_concentration": "the liquid is at rest"}
    if plan.case.solids is None:
        reasons |= dict.fromkeys(_SOLIDS_KEYS, "no solids")
    elif plan.case.gravity == 0:
        reasons |= {"bed_height": "no gravity"}
    if not errors:
        reasons |= {"momentum_error": _no_ledger(plan)}
    return values, reasons


_LIQUID_KEYS = (
    "bulk_velocity",
    "pressure_gradient",
    "pressure_gradient_static",
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
)


def _warnings(values: dict[str, Any]) -> Iterator[str]:
    if (overlap := values.get("largest_overlap", 0.0)) > SOFT:
        yield f"solids overlapped by up to {overlap:.0%} of their radius: contacts are too soft"
    if clipped := values.get("void_fraction_clipped"):
        yield f"{clipped} void fractions fell below the floor and were raised to it"


def _mean(results: Results, name: str) -> float:
    second_half = results.time >= results.time[-1] / 2
    return float(results.diagnostics[name][second_half].mean())


def _of_liquid(plan: Plan, state: State, results: Results) -> dict[str, Any]:
    case, liquid = plan.case, plan.case.liquid
    if liquid is None:
        return {}
    values = {
        "bulk_velocity": _mean(results, "bulk_velocity"),
        "pressure_gradient": _mean(results, "pressure_gradient"),
        "pressure_gradient_static": float(-liquid.density * gravity(case)[0]),
        "friction_factor": pipe_profile(case).friction_factor,
    }
    if isinstance(state.liquid, ParticleLiquid | NodeLiquid):
        if isinstance(state.liquid, ParticleLiquid):
            values |= _of_particles(state.liquid, results)
        else:
            values |= _of_nodes(state.liquid, results)
        velocity = values["bulk_velocity"]
        if case.solids is None and velocity != 0:
            dynamic = liquid.density * velocity * abs(velocity) / 2
            values["friction_factor"] = values["pressure_gradient"] * 2 * case.pipe.radius / dynamic
    return values


def _of_particles(liquid: ParticleLiquid, results: Results) -> dict[str, Any]:
    def total(names: Iterable[str]) -> dict[str, int]:
        return {name: int(results.diagnostics[name].sum()) for name in names}

    values: dict[str, Any] = {
        "liquid_count": liquid.particles.liquid_count,
        # particles carry the mass, as long as they are in the bore
        "mass_error": 1 - liquid.count_in_bore / liquid.full_count,
        "pressure_iterations": _mean(results, "pressure_iterations"),
        "liquid_clips": total(CLIPS),
    }
    if liquid.has_plate:  # plate and outlet act through the pressure: no ledger without it
        values["push_plate"] = total(PLATE_COUNTS)
    else:
        values["momentum_error"] = _liquid_momentum_error(results)
    return values


def _of_nodes(liquid: NodeLiquid, results: Results) -> dict[str, Any]:
    return {
        "liquid_count": len(liquid.layout),
        # what goes through one section and not through another
        "mass_error": liquid.flux_error,
        "divergence": float(results.diagnostics["divergence"].max()),
    }


def _of_solids(plan: Plan, state: State, results: Results) -> dict[str, Any]:
    case, liquid = plan.case, plan.case.liquid
    if case.solids is None:
        return {}
    solids = results.solids
    radius = solids.radius
    x, _, z = np.moveaxis(solids.position[-1], -1, 0)
    unwrapped = x + case.pipe.length * solids.laps[-1]
    mean_velocity = _mean(results, "solids_mean_velocity")
    concentration = float(4 / 3 * math.pi * (radius**3).sum() / case.pipe.bore_volume)
    values = {
        "solids_mean_velocity": mean_velocity,
        "solids_front_position": float(extent(unwrapped[None]).front[0]),
        "insitu_concentration": concentration,
        "bed_height": float(np.quantile(z + radius, _BED_SHARE) + case.pipe.radius),
        "largest_overlap": float(results.diagnostics["largest_overlap"].max()),
        "momentum_error": _solids_momentum_error(plan, state, results),
        "void_fraction_clipped": state.clipped,
    }
    if liquid is not None and liquid.bulk_velocity != 0:
        delivered = concentration * mean_velocity / liquid.bulk_velocity
        values["delivered_concentration"] = delivered
    return values


def _no_ledger(plan: Plan) -> str:
    if plan.case.pipe.has_plate:
        return "plate and outlet act through the pressure"
    if plan.case.solids is None and plan.liquid_model in ("profile", "eulerian"):
        return "this liquid keeps no ledger"
    return "nothing took an impulse at the wall"


def _liquid_momentum_error(results: Results) -> float | None:
    """Axial impulse on the liquid that nothing explains, over that of friction, if any."""
    unexplained = results.diagnostics["liquid_unexplained"].sum()
    friction = results.diagnostics["liquid_friction"].sum()
    return float(abs(unexplained / friction)) if friction != 0 else None


def _solids_momentum_error(plan: Plan, state: State, results: Results) -> float | None:
    """Impulse on the solids that nothing explains, over that of wall friction; None without any."""
    case, liquid, solids = plan.case, plan.case.liquid, state.solids
    assert case.solids is not None
    mass = solids.mass
    gained = mass @ (solids.velocity - results.solids.velocity[0])
    lightness = 1 - (liquid.density if liquid else 0.0) / case.solids.density
    weight = mass.sum() * lightness * gravity(case) * state.time
    unexplained = gained - weight - state.drag_impulse - solids.wall_impulse
    friction = clear_gradient(case) * case.pipe.bore_volume * state.time
    of_walls = abs(friction) + float(np.linalg.norm(solids.wall_impulse))
    return float(np.linalg.norm(unexplained)) / of_walls if of_walls > 0 else None
