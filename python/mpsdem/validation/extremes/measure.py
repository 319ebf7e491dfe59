"""What came of a run: figures, and what no run may do whatever its case says."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from typing import Any

import h5py  # type: ignore[import-untyped]
import numpy as np

from mpsdem.analysis import ledgers
from mpsdem.liquids import CLIPS
from mpsdem.plan import Plan, fastest_flow
from mpsdem.results import Results

#: Fields that hold NaN where nothing is.
_MAY_BE_EMPTY = {
    "velocity_profile",
    "layer_velocity",
    "section_pressure",
    "section_solids_velocity",
}
LARGEST_EXCHANGE_ERROR = 1e-12  # [-] round-off
LARGEST_MASS_ERROR = 1e-9  # [-] round-off, unless a particle is lost
LARGEST_MOMENTUM_ERROR = 0.02  # [-] of the friction, as validation asks for
LARGEST_SCATTER = 0.05  # [-] of the density; twice that of developed flow
LARGEST_OVERLAP = 0.5  # [-] of the radius
ABSURD = 5.0  # [-] speed over the fastest that the case names


@dataclass(frozen=True, slots=True, kw_only=True)
class Figures:
    """Numbers of a run, None where they mean nothing.

    Attributes
    ----------
    speed : float
        Largest of solids and liquid over the fastest that the case names [-].
    overlap : float or None
        Largest over the radius [-].
    scatter : float or None
        Largest of the liquid's number density [-].
    clips : int
        Whatever was cut to its bounds, solids and liquid together.
    momentum_error : float or None
        Impulse that nothing explains, over what walls or solids give, the larger [-].
    exchange_error, mass_error : float or None
        As in the summary [-].
    """

    speed: float
    overlap: float | None
    scatter: float | None
    clips: int
    momentum_error: float | None
    exchange_error: float | None
    mass_error: float | None


def measure(plan: Plan, results: Results) -> Figures:
    """Take the figures of a run from what it left."""
    summary, numbers = results.summary, results.diagnostics
    scatter = numbers["density_scatter"].max() if "density_scatter" in numbers else None
    overlap = numbers["largest_overlap"].max() if "largest_overlap" in numbers else None
    return Figures(
        speed=_fastest(results) / (named_speed(plan) or 1.0),
        overlap=None if overlap is None else float(overlap),
        scatter=None if scatter is None else float(scatter),
        clips=_clips(summary),
        momentum_error=_momentum_error(results),
        exchange_error=summary["exchange_error"],
        mass_error=summary["mass_error"],
    )


def _momentum_error(results: Results) -> float | None:
    """What the summary has over friction, over what walls or solids give, if that is larger [-].

    Solids that fall through a liquid at rest stir it with their drag across the pipe, while the
    friction along the pipe is a small difference of eddies.
    """
    error: float | None = results.summary["momentum_error"]
    if error is None or "pressure_gradient_friction" not in results.diagnostics:
        return error
    kept = ledgers(results)
    friction = abs(float(kept.friction[-1]))
    given = max(friction, float(kept.exchanged[-1]))
    return error * friction / given if given > 0 else error


def named_speed(plan: Plan) -> float:
    """Fastest that the case names: of its flow, its settling or its start [m/s]."""
    flow = 0.0 if plan.case.liquid is None else fastest_flow(plan.case)
    return max(plan.impact_speed, flow)


def _fastest(results: Results) -> float:
    fastest = 0.0
    if results.has_solids:
        fastest = float(np.linalg.norm(results.solids.velocity[:], axis=-1).max())
    if results.has_liquid and "velocity" in results.liquid:
        speed = np.linalg.norm(results.liquid.velocity[:], axis=-1)
        fastest = max(fastest, float(np.nanmax(speed)))
    elif results.has_liquid and "velocity_profile" in results.liquid:
        fastest = max(fastest, float(np.nanmax(np.abs(results.liquid.velocity_profile[:]))))
    return fastest


def _clips(summary: Mapping[str, Any]) -> int:
    of_liquid: Mapping[str, int] = summary.get("liquid_clips", {})
    names = ("void_fraction_clipped", "liquid_void_fraction_clipped")
    of_both: int = sum(summary.get(name, 0) for name in names)
    return of_both + sum(of_liquid.get(name, 0) for name in CLIPS)


def faults(plan: Plan, results: Results) -> Iterator[str]:
    """Yield what no run may do, whatever its case says."""
    case, clock = plan.case, plan.clock
    yield from (f"{name} is not finite" for name in _not_finite(results))
    if len(results.time) != clock.frames + 1 or not math.isclose(results.time[-1], case.end_time):
        yield f"{len(results.time)} frames up to {results.time[-1]:g} s"
    if results.has_solids:
        solids = results.solids
        if len(solids) != case.solids_count:
            yield f"{len(solids)} solids of {case.solids_count}"
        x, y, z = np.moveaxis(solids.position[:], -1, 0)
        if (np.hypot(y, z) >= case.pipe.radius).any() or (x < 0).any():
            yield "a solid is outside the bore"
        if (x >= case.pipe.length).any():
            yield "a solid is beyond the outlet"
    summary = results.summary
    exchange = summary["exchange_error"]
    if exchange is not None and not exchange <= LARGEST_EXCHANGE_ERROR:
        yield f"exchange_error {exchange:.2g}"
    mass = summary["mass_error"]
    if mass is not None and not case.pipe.has_plate and not abs(mass) <= LARGEST_MASS_ERROR:
        yield f"mass_error {mass:.2g}"


def doubts(plan: Plan, figures: Figures, *, speed: float = 0.0) -> Iterator[str]:
    """Yield what is finite, and yet no physics.

    Parameters
    ----------
    plan : Plan
        What was run.
    figures : Figures
        Of its run.
    speed : float
        Above which a velocity is absurd [m/s]; 0 for `ABSURD` times the fastest named.
    """
    bounds = {
        "speed": speed / (named_speed(plan) or 1.0) or ABSURD,
        "overlap": LARGEST_OVERLAP,
        "scatter": LARGEST_SCATTER,
        "momentum_error": LARGEST_MOMENTUM_ERROR,
    }
    for name, bound in bounds.items():
        value = getattr(figures, name)
        if value is not None and not value <= bound:
            yield f"{name} {value:.2g}, above {bound:.2g}"


def _not_finite(results: Results) -> Iterator[str]:
    names: list[str] = []

    def visit(path: str, item: Any) -> None:
        name = path.split("/")[-1]
        placeless = results.case.pipe.has_plate and path.startswith("liquid/")
        if (
            isinstance(item, h5py.Dataset)
            and item.dtype.kind == "f"
            and name not in _MAY_BE_EMPTY
            and not placeless
            and not np.isfinite(item[()]).all()
        ):
            names.append(path)

    results._run.file.visititems(visit)
    yield from names


FIGURES = tuple(f.name for f in fields(Figures))
