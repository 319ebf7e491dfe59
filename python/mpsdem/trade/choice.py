"""Which fidelity a time, or an error, allows: by the measured table and the plan's estimate."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

from pydantic_core import PydanticCustomError

from mpsdem.case import Case, CaseError, Problem
from mpsdem.case.units import Quantity
from mpsdem.plan import COMPUTED, Plan, make_plan, pipe_profile
from mpsdem.trade.machine import REFERENCE, Machine
from mpsdem.trade.outcome import Outcome, Row
from mpsdem.trade.settings import LEVELS
from mpsdem.trade.table import Table, shipped_table

# Spacings across the bore that were measured, each with the level that its solids step by.
_ACROSS = {8: "quick", 10: "quick", 12: "balanced", 16: "balanced", 20: "fine", 24: "fine"}
_OF_LEVEL = {10: "quick", 16: "balanced", 24: "fine"}
_STEEP = 0.17  # [rad] of inclination from which a pipe is like the inclined scene


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """A fidelity that a case may have, and what it promises.

    Parameters
    ----------
    setting : str
        In words.
    case : Case
        The case with it.
    plan : Plan
        Of that case.
    seconds : float
        Of wall clock on this machine [s].
    cpu_seconds : float
        Of computing [s].
    errors : mapping of str to float
        Relative error of each quantity [-], as measured in the scene of the table that is nearest;
        empty where none is like the case.
    scene : str
        Title of that scene.
    """

    setting: str
    case: Case
    plan: Plan
    seconds: float
    cpu_seconds: float
    errors: Mapping[str, float] = field(default_factory=dict)
    scene: str = ""

    @property
    def error(self) -> float:
        """The largest error of all quantities [-]; NaN where none is known."""
        return max(self.errors.values(), default=math.nan)

    def as_json(self) -> dict[str, Any]:
        """What ``summary.json`` keeps of it as ``expected``."""
        return {
            "setting": self.setting,
            "wall_seconds": float(f"{self.seconds:.3g}"),
            "cpu_seconds": float(f"{self.cpu_seconds:.3g}"),
            "errors": {name: float(f"{error:.2g}") for name, error in self.errors.items()},
            "errors_as_in": self.scene,
            "left_out": [f"{stage.name}: {stage.reason}" for stage in self.plan.left_out],
        }


def choose(
    case: Case,
    *,
    seconds: float | None = None,
    error: float | None = None,
    machine: Machine | None = None,
    table: Table | None = None,
) -> Candidate:
    """Find the most accurate fidelity for a time, or the cheapest for an error.

    Parameters
    ----------
    case : Case
        Its level, spacing and step of the solids are chosen; all else of it stays.
    seconds : float, optional
        Of wall clock that the run may take [s].
    error : float, optional
        That each quantity of the table may have [-]. Of the two, one.
    machine : Machine, optional
        This one, measured.
    table : Table, optional
        The one that the package ships.

    Raises
    ------
    CaseError
        If no fidelity will do; it names the one that comes nearest.
    """
    known = list(candidates(case, machine=machine, table=table))
    if seconds is not None:
        return _within_time(known, seconds)
    assert error is not None
    return _within_error(known, error)


def expectation(chosen: Candidate) -> Iterator[str]:
    """What a run of a candidate is expected to cost and to be worth, in lines."""
    yield (
        f"{chosen.setting}: about {in_words(chosen.seconds)} by the clock, "
        f"{in_words(chosen.cpu_seconds)} of computing"
    )
    if chosen.errors:
        each = ", ".join(f"{name} {100 * e:.2g} %" for name, e in chosen.errors.items())
        yield f"errors as measured in '{chosen.scene}': {each}"
    else:
        yield "errors: no scene of the table is like this case; `mpsdem trade` measures them"
    if left := [stage.name for stage in chosen.plan.left_out]:
        yield f"left out: {', '.join(left)}"


def in_words(seconds: float) -> str:
    """A time with two digits and the unit that suits it."""
    for unit, size in (("h", 3600.0), ("min", 60.0)):
        if seconds >= 1.5 * size:
            return f"{seconds / size:.2g} {unit}"
    return f"{seconds:.2g} s"


def seconds_of(text: str, field: str) -> float:
    """Read a time such as ``20 min`` or ``90`` [s].

    Raises
    ------
    CaseError
        If it is none; `field` names it.
    """
    return _read(text, field, Quantity("s", above=0.0), "must be a time > 0 s, such as '10 min'")


def share_of(text: str, field: str) -> float:
    """Read a share such as ``5%``, ``5 percent`` or ``0.05`` [-].

    Raises
    ------
    CaseError
        If it is none; `field` names it.
    """
    rule = "must be a share > 0 and < 1, such as 5%"
    return _read(text.replace("%", " percent"), field, Quantity(above=0.0, below=1.0), rule)


def _read(text: str, field: str, quantity: Quantity, rule: str) -> float:
    value: str | float = text.strip()
    with suppress(ValueError):
        value = float(text)
    try:
        return quantity.read(value)
    except PydanticCustomError:
        raise CaseError([Problem(field=field, value=text, rule=rule)]) from None


def _within_time(known: Sequence[Candidate], seconds: float) -> Candidate:
    fitting = [candidate for candidate in known if candidate.seconds <= seconds]
    if not fitting:
        cheapest = min(known, key=lambda candidate: candidate.seconds)
        problem = Problem(
            field="--budget",
            value=f"{seconds:g} s",
            unit="s",
            rule=f"the cheapest setting, {cheapest.setting}, takes about "
            + in_words(cheapest.seconds),
            remedy="allow for it, or shorten the run with --until",
        )
        raise CaseError([problem])
    # where errors are alike, or unknown, the finer one: it takes more of the time
    return min(fitting, key=lambda c: (_or_large(c.error), -c.seconds))


def _within_error(known: Sequence[Candidate], error: float) -> Candidate:
    if all(math.isnan(candidate.error) for candidate in known):
        problem = Problem(
            field="--error",
            value=f"{error:.3g}",
            rule="no scene of the table is like this case, so that no error can be promised",
            remedy="measure it with `mpsdem trade`, or give --budget",
        )
        raise CaseError([problem])
    good = [candidate for candidate in known if candidate.error <= error]
    if not good:
        best = min(known, key=lambda candidate: _or_large(candidate.error))
        worst = max(best.errors, key=lambda name: best.errors[name])
        problem = Problem(
            field="--error",
            value=f"{100 * error:.3g} %",
            rule=f"the most accurate setting, {best.setting}, is known to {100 * best.error:.2g} % "
            f"of {worst}, and takes about {in_words(best.seconds)}",
            remedy="allow for it",
        )
        raise CaseError([problem])
    return min(good, key=lambda candidate: candidate.seconds)


def _or_large(error: float) -> float:
    return math.inf if math.isnan(error) else error


def candidates(
    case: Case, *, machine: Machine | None = None, table: Table | None = None
) -> Iterator[Candidate]:
    """Fidelities that a case may have, the coarsest first, with what each promises."""
    machine = machine or Machine.measured()
    table = table if table is not None else shipped_table()
    plan = make_plan(case)
    scene = table.scenes.get(scene_of(case) or "")
    if plan.liquid_model not in COMPUTED:
        errors = _of_profile(scene) if case.solids is None else {}
        for level in LEVELS if case.solids is not None else LEVELS[:1]:
            changes = {"level": level, "rayleigh_fraction": None, "solid_step": None}
            candidate = _candidate(case, f"level {level}", {"fidelity": changes}, machine)
            yield replace(candidate, errors=errors, scene=scene.title if scene and errors else "")
        return
    if case.liquid is not None and case.liquid.model == "auto" and _may_be_prescribed(case):
        prescribed = {"liquid": {"model": "profile"}, "fidelity": {"level": "quick"}}
        candidate = _candidate(case, "liquid model profile, level quick", prescribed, machine)
        yield _promising(candidate, _of_profile(scene), scene)
    known = errors_by_spacing(scene) if scene else {}
    for across, level in _ACROSS.items():
        changed: dict[str, Any] = {"level": level, "rayleigh_fraction": None, "solid_step": None}
        changed["particle_spacing"] = (
            None if across in _OF_LEVEL else 2 * case.pipe.radius / across
        )  # fmt: skip
        name = f"level {level}" if across in _OF_LEVEL else f"particle spacing D/{across}"
        try:
            candidate = _candidate(case, name, {"fidelity": changed}, machine)
        except CaseError:
            continue  # a spacing that the pipe is too short for
        yield _promising(candidate, known.get(across, {}), scene)


def _may_be_prescribed(case: Case) -> bool:
    """Whether a prescribed profile can stand for the liquid of a case."""
    return (
        case.fidelity.coupling != "two-way"
        and not case.pipe.has_plate
        and case.liquid is not None
        and not case.liquid.computed
    )


def _promising(
    candidate: Candidate, errors: Mapping[str, float], scene: Outcome | None
) -> Candidate:
    title = scene.title if scene is not None and errors else ""
    return replace(candidate, errors=errors, scene=title)


def _candidate(case: Case, setting: str, changes: Mapping[str, Any], machine: Machine) -> Candidate:
    changed = case.with_(**changes)
    plan = make_plan(changed)
    estimate = plan.estimate
    total = estimate.solids_seconds + estimate.liquid_seconds
    share = estimate.solids_seconds / total if total > 0 else 0.0
    slower = machine.slower_than(REFERENCE, of_solids=share)
    return Candidate(
        setting=setting,
        case=changed,
        plan=plan,
        seconds=slower * estimate.wall_seconds,
        cpu_seconds=slower * total,
    )


def scene_of(case: Case) -> str | None:
    """The scene of the table that a case is most like; None if none is."""
    if case.liquid is None:
        return None
    if case.solids is None:
        return "poiseuille" if pipe_profile(case).laminar else "friction"
    if case.solids.held:
        return "packed bed"
    if case.liquid.bulk_velocity == 0:
        return "settling"
    return "case B" if abs(case.pipe.inclination) > _STEEP else "case A"


def errors_by_spacing(scene: Outcome) -> dict[int, dict[str, float]]:
    """Errors of each quantity by the spacings across the bore that were measured [-].

    Where the answer is known they are as measured. Where they count from the finest setting, whose
    own is not known, none is smaller than that of a finer spacing, nor than what a third of the
    spacing less changes, from 16 to 24 across: as much as the finest's own where errors fall with
    the power 1.7 of the spacing.
    """
    rows: dict[int, Row] = {}
    for across in _ACROSS:
        level = _OF_LEVEL.get(across)
        name = f"level {level}" if level else f"particle spacing D/{across}"
        if (row := next((row for row in scene.rows if str(row) == name), None)) is not None:
            rows[across] = row
    finest = max(rows, default=0)
    coarser = max((across for across in rows if across <= finest / 1.5), default=finest)
    least: dict[str, float] = {}
    for name, compared in scene.quantities.items():
        error = rows[coarser].errors.get(name) if rows else None
        if error is not None and not compared.exact and math.isfinite(error.value):
            least[name] = error.size
    found: dict[int, dict[str, float]] = {}
    for across in sorted(rows, reverse=True):
        for name, error in rows[across].errors.items():
            if math.isfinite(error.value):
                floor = 0.0 if scene.quantities[name].exact else least.get(name, 0.0)
                least[name] = max(floor, error.size)
        found[across] = dict(least)
    return dict(sorted(found.items()))


def _of_profile(scene: Outcome | None) -> dict[str, float]:
    """Errors of the prescribed profile in a scene."""
    if scene is None:
        return {}
    row = next((row for row in scene.rows if str(row) == "liquid model profile"), None)
    errors = {} if row is None else row.errors
    return {name: e.size for name, e in errors.items() if math.isfinite(e.value)}
