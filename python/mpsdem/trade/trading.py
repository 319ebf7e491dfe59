"""The trade itself: pilots, a schedule, the runs, and what they came to."""

from __future__ import annotations

import json
import logging
import math
import os
import shutil
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mpsdem.case import Case, CaseError
from mpsdem.case.errors import nearest
from mpsdem.plan import Plan, clear_gradient, make_plan
from mpsdem.results import OutputError
from mpsdem.results.fields import DIAGNOSTICS
from mpsdem.results.files import write_atomically
from mpsdem.trade.outcome import Compared, Outcome, Row
from mpsdem.trade.quantities import (
    QUANTITIES,
    Deviation,
    Series,
    applicable,
    deviation,
    mean_of,
)
from mpsdem.trade.report import save
from mpsdem.trade.runs import Outcome as Run
from mpsdem.trade.runs import carry_out, known_outcome, quantities_of, summary_of
from mpsdem.trade.schedule import Schedule, finest, least_time, make_schedule, shortened
from mpsdem.trade.settings import AS_GIVEN, LeftOut, Setting, settings_of
from mpsdem.trade.workers import Workers, workers

LOG = logging.getLogger("mpsdem.trade")

_PILOT_SHARE = 0.01  # of the time there is, for each pilot
_SHORTEST_PILOT, _LONGEST_PILOT = 1.0, 10.0  # [s] of computing
_PILOT_STEPS = 5  # coupling steps, at least
Tell = Callable[[str], None]


def trade(
    case: Case,
    output: str | os.PathLike[str],
    *,
    quantities: Sequence[str] | None = None,
    exact: Mapping[str, float] | None = None,
    seconds: float = 1200.0,
    scheduler: str | None = None,
    cores: int | None = None,
    tell: Tell = LOG.info,
) -> Outcome:
    """Measure what each knob of a case's fidelity costs, and how far it moves the results.

    Parameters
    ----------
    case : Case
        What the trade is about; its fidelity is the point that knobs are turned around.
    output : path-like
        Directory for table, figure and runs. A trade that was stopped goes on in it: runs that
        ended are not run again.
    quantities : sequence of str, optional
        Names of ``summary.json``; by default those of `QUANTITIES` that mean something in the case.
    exact : mapping of str to float, optional
        Values that are known [the quantity's unit]; the loss of clear liquid always is.
    seconds : float
        Of wall clock that there are [s]. The end time is chosen so that the runs fit in.
    scheduler : str, optional
        Address of a Dask scheduler whose workers run the cases, and see the same files.
    cores : int, optional
        Of this machine to use; all by default.
    tell : callable
        Is told what happens, in sentences.

    Returns
    -------
    Outcome
        Also written as ``trade.json``, ``trade.csv``, ``trade.md`` and ``trade.png``.

    Raises
    ------
    CaseError
        If the case has no plan.
    OutputError
        If `output` holds the trade of another case.
    """
    began, directory = time.monotonic(), Path(output)
    names = list(quantities) if quantities is not None else applicable(case)
    settings, left_out = settings_of(case)
    directory.mkdir(parents=True, exist_ok=True)
    with workers(scheduler, cores=cores) as crew:
        tell(f"runs go {crew.said}")
        schedule = _known_schedule(directory, case, settings)
        if schedule is None:
            schedule = _new_schedule(directory, case, settings, seconds, crew, tell)
            _keep(directory, case, schedule)
        left_out += schedule.left_out
        cases = {s.name: shortened(s.case, schedule.end_time) for s in schedule.kept}
        end_time = next(iter(cases.values())).end_time
        tell(
            f"{len(schedule.kept)} runs of {end_time:.3g} s, {schedule.cpu_seconds:.0f} s of "
            f"computing; the case itself lasts {case.end_time:g} s"
        )
        runs, late = _run_all(
            directory, schedule, cases, crew, deadline=began + seconds, tell=tell
        )  # fmt: skip
    left_out += late
    done = [setting for setting in schedule.kept if setting.name in runs]
    outcome = _compare(
        directory / "runs", _homes(cases), case, done, runs, names, dict(exact or {}), end_time,
        left_out, crew.said,
    )  # fmt: skip
    save(outcome, directory)
    return outcome


def _new_schedule(
    directory: Path,
    case: Case,
    settings: Sequence[Setting],
    seconds: float,
    crew: Workers,
    tell: Tell,
) -> Schedule:
    """Choose the end time by what pilots take, one for each kind of run."""
    plans = {
        setting.name: make_plan(shortened(setting.case, case.end_time)) for setting in settings
    }
    budget = seconds * crew.count
    off: dict[tuple[Any, ...], float] = {}
    for kind in dict.fromkeys(_kind(plan) for plan in plans.values()):
        cheapest = min(
            (name for name, plan in plans.items() if _kind(plan) == kind),
            key=lambda name: _planned_rate(plans[name]),
        )
        off[kind] = _pilot(directory / "pilots" / cheapest, plans[cheapest], budget)
        tell(f"pilot: {cheapest} takes {off[kind]:.2g} times what the plan says")
    rates = {name: off[_kind(plan)] * _planned_rate(plan) for name, plan in plans.items()}
    return make_schedule(
        settings,
        rates,
        seconds=seconds,
        workers=crew.count,
        longest=case.end_time,
        shortest=least_time(case),
    )


def _kind(plan: Plan) -> tuple[Any, ...]:
    """What decides how far the plan's estimate is off."""
    return plan.liquid_model, plan.two_way


def _planned_rate(plan: Plan) -> float:
    estimate = plan.estimate
    return (estimate.solids_seconds + estimate.liquid_seconds) / plan.case.end_time


def _pilot(directory: Path, plan: Plan, budget: float) -> float:
    """What a short run takes, over what the plan says that it takes."""
    seconds = min(max(_PILOT_SHARE * budget, _SHORTEST_PILOT), _LONGEST_PILOT)
    shortest = _PILOT_STEPS * plan.turns_per_liquid_step * plan.coupling_step.value
    end_time = min(max(seconds / _planned_rate(plan), shortest), plan.case.end_time)
    every = min(plan.case.output.every, end_time)
    case = plan.case.with_(end_time=end_time, output={"every": every})
    shutil.rmtree(directory, ignore_errors=True)
    run = carry_out(case.to_toml(), str(directory))
    planned = _planned_rate(make_plan(case)) * run.time
    return run.cpu_seconds / planned if run.time > 0 and planned > 0 else 1.0


def _run_all(
    directory: Path,
    schedule: Schedule,
    cases: Mapping[str, Case],
    crew: Workers,
    *,
    deadline: float,
    tell: Tell,
) -> tuple[dict[str, Run], list[LeftOut]]:
    """Runs by the names of their settings, and those that there was no time for."""
    runs: dict[str, Run] = {}
    late, homes = [], _homes(cases)
    waiting = [(s, cases[s.name].to_toml()) for s in schedule.kept if homes[s.name] == s.name]
    expected = schedule.cpu_seconds / max(1, len(schedule.kept))
    slowest = 0.0
    while waiting or crew.busy:
        while waiting and crew.busy < crew.count:
            setting, text = waiting.pop(0)
            where = str(directory / "runs" / setting.name)
            ended = known_outcome(text, where) is not None
            if runs and not ended and time.monotonic() + min(expected, slowest) > deadline:
                reason = "the time was over before its turn came: start again to go on"
                late.append(LeftOut(setting=str(setting), reason=reason))
                continue
            crew.start(setting.name, text, where)
        if not crew.busy:
            break
        name, run = crew.wait()
        runs[name] = run
        slowest = max(slowest, run.wall_seconds)
        tell(f"{name}: {run.status}, {run.rate:.3g} s of computing a second")
    return {name: runs[home] for name, home in homes.items() if home in runs}, late


def _homes(cases: Mapping[str, Case]) -> dict[str, str]:
    """The setting in whose directory each setting's run lies: the first of those with its case."""
    first: dict[str, str] = {}
    return {name: first.setdefault(case.to_toml(), name) for name, case in cases.items()}


def _compare(
    directory: Path,
    homes: Mapping[str, str],
    case: Case,
    done: Sequence[Setting],
    runs: Mapping[str, Run],
    names: Sequence[str],
    exact: Mapping[str, float],
    end_time: float,
    left_out: Sequence[LeftOut],
    said: str,
) -> Outcome:
    whole = [setting for setting in done if runs[setting.name].whole]
    series = {s.name: quantities_of(directory / homes[s.name], list(names)) for s in whole}
    reference = finest(whole) if whole else None
    known = dict(_known(case)) | dict(exact)
    compared: dict[str, Compared] = {}
    against: dict[str, Series | float] = {}
    for name in names:
        of_reference = series[reference.name].get(name) if reference else None
        if name in known:
            compared[name] = Compared(unit=_unit(name), reference=known[name], bar=0.0, exact=True)
            against[name] = known[name]
        elif of_reference is not None and np.isfinite(mean_of(of_reference).value):
            mean = mean_of(of_reference)
            compared[name] = Compared(
                unit=_unit(name), reference=mean.value, bar=mean.bar, exact=False
            )  # fmt: skip
            against[name] = of_reference
        else:
            left_out = [
                *left_out,
                LeftOut(setting=name, reason=_no_such(directory, homes, done, name)),
            ]
    given = next((s for s in whole if s.knob == AS_GIVEN), None)
    base = series[given.name] if given else {}
    rows = tuple(
        _row(setting, runs[setting.name], series.get(setting.name, {}), against, base, reference)
        for setting in done
    )
    return Outcome(
        title=case.title or "Case",
        end_time=end_time,
        wanted=case.end_time,
        reference=str(reference) if reference else "",
        quantities=compared,
        rows=rows,
        left_out=tuple(left_out),
        notes=(f"runs went {said}",),
    )


def _row(
    setting: Setting,
    run: Run,
    series: Mapping[str, Series],
    against: Mapping[str, Series | float],
    base: Mapping[str, Series],
    reference: Setting | None,
) -> Row:
    plan = make_plan(shortened(setting.case, run.time) if run.time > 0 else setting.case)
    estimate = plan.estimate
    total = estimate.solids_seconds + estimate.liquid_seconds
    errors: dict[str, Deviation] = {}
    for name, other in against.items():
        if name not in series:
            continue
        if setting == reference and not isinstance(other, float):
            errors[name] = Deviation(value=0.0, bar=0.0)
        else:
            errors[name] = deviation(series[name], other)
    changes = {
        name: deviation(series[name], base[name])
        for name in against
        if name in series and name in base and setting.knob != AS_GIVEN
    }
    return Row(
        knob=setting.knob,
        value=setting.value,
        number=setting.number,
        status=run.status,
        reason=run.reason,
        rate=run.rate,
        of_solids=estimate.solids_seconds / total if total > 0 else 0.0,
        planned=total / plan.case.end_time,
        errors=errors,
        changes=changes,
    )


def _known(case: Case) -> Iterator[tuple[str, float]]:
    """Values that theory gives: the loss of clear liquid, by Hagen and Poiseuille or Colebrook."""
    if case.solids is None and case.liquid is not None and case.liquid.pressure_gradient is None:
        loss = clear_gradient(case)
        if loss != 0 and math.isfinite(loss):
            yield "pressure_gradient", loss


def _unit(name: str) -> str:
    if name in DIAGNOSTICS:
        return DIAGNOSTICS[name].unit
    return "m" if name in ("bed_height", "solids_front_position") else "1"


def _no_such(directory: Path, homes: Mapping[str, str], done: Sequence[Setting], name: str) -> str:
    if not done:
        return "no run reached its end"
    summary = summary_of(directory / homes[done[0].name])
    if name not in summary:
        return f"is no name of summary.json; {nearest(name, [*QUANTITIES, *summary])}"
    return str(summary["not_applicable"].get(name, "has no number in this case"))


def _keep(directory: Path, case: Case, schedule: Schedule) -> None:
    """Note what was chosen, so that a trade that is started again does the same."""
    kept = {
        "case": case.to_toml(),
        "end_time": schedule.end_time,
        "kept": [setting.name for setting in schedule.kept],
        "left_out": [[out.setting, out.reason] for out in schedule.left_out],
        "cpu_seconds": schedule.cpu_seconds,
    }
    write_atomically(directory / _SCHEDULE, json.dumps(kept, indent=1).encode())


def _known_schedule(
    directory: Path, case: Case, settings: Sequence[Setting]
) -> Schedule | None:  # fmt: skip
    path = directory / _SCHEDULE
    if not path.exists():
        return None
    try:
        kept = json.loads(path.read_bytes())
        same = Case.from_toml(kept["case"]) == case
    except (ValueError, KeyError, CaseError):
        same = False
    if not same:
        raise OutputError(
            f"{directory} holds the trade of another case: choose another directory, or remove it"
        )
    by_name = {setting.name: setting for setting in settings}
    return Schedule(
        end_time=kept["end_time"],
        kept=tuple(by_name[name] for name in kept["kept"] if name in by_name),
        left_out=tuple(LeftOut(setting=s, reason=r) for s, r in kept["left_out"]),
        cpu_seconds=kept["cpu_seconds"],
    )


_SCHEDULE = "schedule.json"
