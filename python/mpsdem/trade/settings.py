"""The knobs of the fidelity, each turned alone around what a case says."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from mpsdem.case import Case, CaseError
from mpsdem.plan import COMPUTED, Plan, make_plan

LEVELS = ("quick", "balanced", "fine")
AS_GIVEN = "as given"
# Spacings across the bore between those of the levels, 10, 16 and 24.
_BETWEEN = (8, 12, 20)
# What a level sets.
_BY_LEVEL = ("particle_spacing", "rayleigh_fraction", "solid_step", "coupling_step")


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """A case at one setting of its fidelity.

    Parameters
    ----------
    knob : str
        What was turned, in words.
    value : str
        To what, unit included.
    number : float
        The same as a number, that settings of a knob are ordered by.
    case : Case
        What to run.
    """

    knob: str
    value: str
    number: float
    case: Case

    @property
    def name(self) -> str:
        """Of the setting's directory."""
        return re.sub(r"[^\w.]+", "_", f"{self.knob} {self.value}").strip("_").lower()

    def __str__(self) -> str:
        return self.knob if self.knob == AS_GIVEN else f"{self.knob} {self.value}"


@dataclass(frozen=True, slots=True, kw_only=True)
class LeftOut:
    """A setting that is not run, and the reason."""

    setting: str
    reason: str


def settings_of(case: Case) -> tuple[list[Setting], list[LeftOut]]:
    """List what a trade of a case runs: as given, the levels, and each knob turned alone.

    Parameters
    ----------
    case : Case
        What the trade is about.

    Returns
    -------
    settings : list of Setting
        The first is the case as given. No two of them would run alike, but for the levels, which
        are always named.
    left_out : list of LeftOut
        Settings that the case cannot have.

    Raises
    ------
    CaseError
        If the case as given has no plan.
    """
    plan = make_plan(case)
    kept = [Setting(knob=AS_GIVEN, value="", number=0.0, case=case)]
    left_out = []
    for knob, value, number, changes in _turns(plan):
        name = f"{knob} {value}"
        try:
            turned = case.with_(**changes)
            found = make_plan(turned)
        except CaseError as error:
            reason = str(error.problems[0])
            left_out.append(LeftOut(setting=name, reason=reason))
            continue
        if knob != "level" and _runs_alike(found, plan):
            reason = "changes nothing here: something else is the shorter limit"
            left_out.append(LeftOut(setting=name, reason=reason))
            continue
        kept.append(Setting(knob=knob, value=value, number=number, case=turned))
    return kept, left_out


def _runs_alike(one: Plan, other: Plan) -> bool:
    """Whether the runs of two plans would be the same, up to the digits."""
    fidelity = (one.case.fidelity, other.case.fidelity)
    ignored = dict.fromkeys(("coupling_step", "courant", "liquid_step"))
    same = fidelity[0].model_dump() | ignored == fidelity[1].model_dump() | ignored
    return same and (one.clock, one.case.liquid) == (other.clock, other.case.liquid)


def _turns(plan: Plan) -> Iterator[tuple[str, str, float, dict[str, Any]]]:
    """Knob, value, the value as a number, and the changes to the case."""
    case, fidelity = plan.case, plan.case.fidelity
    for k, level in enumerate(LEVELS):
        yield "level", level, k, {"fidelity": dict.fromkeys(_BY_LEVEL) | {"level": level}}
    if case.liquid is not None:
        for k, model in enumerate(("profile", "eulerian", "lagrangian")):
            if model != plan.liquid_model:
                changes: dict[str, Any] = {"liquid": {"model": model}}
                if model == "profile" and fidelity.coupling == "two-way":
                    changes["fidelity"] = {"coupling": "auto"}
                yield "liquid model", model, k, changes
    if plan.liquid_model in COMPUTED:
        bore = 2 * case.pipe.radius
        given = fidelity.resolved_particle_spacing(case.pipe.radius)
        for across in _BETWEEN:
            spacing = bore / across
            if abs(spacing / given - 1) > 0.05:
                value = f"D/{across}"
                yield (
                    "particle spacing",
                    value,
                    spacing,
                    {"fidelity": {"particle_spacing": spacing}},
                )
        for factor in (0.5, 1.5):
            courant = round(fidelity.courant * factor, 6)
            if courant <= 2:
                yield "Courant number", f"{courant:g}", courant, {"fidelity": {"courant": courant}}
    if plan.liquid_model == "lagrangian":
        for factor in (10.0, 0.1):
            tolerance = fidelity.pressure_tolerance * factor
            changes = {"fidelity": {"pressure_tolerance": tolerance}}
            if tolerance < 1:
                yield "pressure tolerance", f"{tolerance:g}", tolerance, changes
    if case.solids is not None:
        yield from _turns_of_solids(plan)


def _turns_of_solids(plan: Plan) -> Iterator[tuple[str, str, float, dict[str, Any]]]:
    case, fidelity = plan.case, plan.case.fidelity
    assert case.solids is not None
    if not case.solids.held and case.solids_count > 1:
        for factor in (0.1, 0.01):
            softer = fidelity.stiffness_factor * factor
            changes = {"fidelity": {"stiffness_factor": softer}}
            yield "stiffness factor", f"{softer:g}", softer, changes
        if fidelity.solid_step is None:
            for factor in (0.5, 2.0, 3.0, 5.0):
                share = round(fidelity.resolved_rayleigh_fraction * factor, 6)
                changes = {"fidelity": {"rayleigh_fraction": share}}
                if share <= 0.5:
                    yield "Rayleigh fraction", f"{share:g}", share, changes
    if case.liquid is None:
        return
    if not case.solids.held:
        for factor in (0.5, 2.0):
            step = float(f"{plan.coupling_step.value * factor:.3g}")
            yield "coupling interval", f"{step:g} s", step, {"fidelity": {"coupling_step": step}}
    if plan.smoothing_radius > 0:
        for factor in (2 / 3, 1.5):
            radius = float(f"{plan.smoothing_radius * factor:.4g}")
            changes = {"fidelity": {"smoothing_radius": radius}}
            yield "smoothing radius", f"{radius:g} m", radius, changes
