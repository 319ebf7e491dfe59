"""Rows run one by one, each in a process of its own: one that hangs or crashes takes none along."""

from __future__ import annotations

import logging
import math
import multiprocessing
import resource
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from mpsdem.case import Case, CaseError
from mpsdem.plan import Plan, make_plan
from mpsdem.results import CheckpointError, OutputError, Results
from mpsdem.simulation import Simulation, SimulationDiverged
from mpsdem.validation.extremes.measure import doubts, faults, measure
from mpsdem.validation.extremes.rows import Row

TIME_LIMIT = 120  # [s] of processor time after which a row hangs
_PATIENCE = 10  # [-] that in wall clock, over it, on a busy machine
_FRAMES = 10
_EVER = 1e6  # [s] so long that no output limits a step
_CROSSING = 0.1  # [-] of the time in which a solid crosses its diameter, as a liquid's turn is


@dataclass(frozen=True, slots=True, kw_only=True)
class Came:
    """What came of a row.

    Attributes
    ----------
    row : Row
        Which.
    outcome : str
        "survived", "refused" or "stopped"; "hangs" or "crashes" where the program has failed.
    reason : str
        Why it was refused, stopped or crashed.
    doubts : tuple of str
        What of a run that survived is wrong; none for one that is sane.
    figures : dict
        By the names of `Figures`; empty where nothing ran.
    step_seconds : float or None
        Processor time of a step of the liquid, output included [s].
    memory : float or None
        Largest resident size of the process [MB].
    """

    row: Row
    outcome: str
    reason: str = ""
    doubts: tuple[str, ...] = ()
    figures: dict[str, float | None] = field(default_factory=dict)
    step_seconds: float | None = None
    memory: float | None = None

    @property
    def as_expected(self) -> bool:
        """Whether it is what the row demands, and sane."""
        return self.outcome == self.row.outcome and not self.doubts


def run_row(row: Row) -> Came:
    """Run a row in this process; whatever is no refusal of the program's own is raised."""
    with tempfile.TemporaryDirectory(prefix="mpsdem-") as directory:
        try:
            case = timed(row.case(), row.steps)
            simulation = Simulation(case, directory)
            with _time_of_steps() as seconds, simulation.run(bar=False) as results:
                if row.then:
                    results = _resumed(case.with_(**row.then), Path(directory))
                return _survived(row, simulation.plan, results, seconds())
        except (CaseError, CheckpointError, OutputError) as refusal:
            return Came(row=row, outcome="refused", reason=str(refusal))
        except SimulationDiverged as stop:
            return Came(row=row, outcome="stopped", reason=str(stop))


def timed(case: Case, steps: int) -> Case:
    """End the case after about so many steps of its liquid, with some frames on the way."""
    longest = make_plan(case.with_(end_time=_EVER, output={"every": _EVER}))
    step = (longest.liquid_step or longest.coupling_step).value
    if case.liquid is None and case.solids is not None:  # nothing but the output limits its turns
        step = _CROSSING * case.solids.smallest_diameter / (longest.impact_speed or 1.0)
    frames = min(_FRAMES, steps)
    end = steps * step
    return case.with_(end_time=end, output={"every": end / frames})


class _Started(logging.Handler):
    """Notes the processor time of the first message of a run, which ends its set-up [s]."""

    time = math.nan

    def emit(self, _record: logging.LogRecord) -> None:
        if math.isnan(self.time):
            self.time = time.process_time()


@contextmanager
def _time_of_steps() -> Iterator[Callable[[], float]]:
    """Give what tells the processor time since the set-up of the run within [s]."""
    log, started = logging.getLogger("mpsdem"), _Started()
    log.addHandler(started)
    try:
        yield lambda: time.process_time() - started.time
    finally:
        log.removeHandler(started)


def _resumed(case: Case, directory: Path) -> Results:
    (directory / "case.toml").write_text(case.to_toml(), encoding="utf-8")
    return Simulation.resume(directory).run(bar=False)


def _survived(row: Row, plan: Plan, results: Results, seconds: float) -> Came:
    figures = measure(plan, results)
    steps = plan.clock.steps
    if plan.liquid_step is not None:
        steps //= plan.turns_per_liquid_step
    return Came(
        row=row,
        outcome="survived",
        doubts=(*faults(plan, results), *doubts(plan, figures, speed=row.speed)),
        figures=asdict(figures),
        step_seconds=seconds / steps,
        memory=_memory(),
    )


def _memory() -> float:
    largest = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return largest / (1e6 if sys.platform == "darwin" else 1e3)


def run_rows(
    rows: Iterable[Row], *, limit: int = TIME_LIMIT, run: Callable[[Row], Came] = run_row
) -> Iterator[Came]:
    """Run rows one after the other, each in a process of its own.

    Parameters
    ----------
    rows : iterable of Row
        Which.
    limit : int
        Processor time after which one hangs, and is killed [s]; ten times that of wall clock.
    run : callable
        What runs one; importable from its module.
    """
    processes = multiprocessing.get_context("forkserver")
    processes.set_forkserver_preload([__name__])
    for row in rows:
        here, there = processes.Pipe(duplex=False)
        child = processes.Process(target=_child, args=(run, row, there, limit))
        child.start()
        there.close()
        yield _awaited(row, child, here, limit)


def _child(run: Callable[[Row], Came], row: Row, to_parent: Connection, limit: int) -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 1))
    try:
        came = run(row)
    except Exception as error:
        came = Came(row=row, outcome="crashes", reason=f"{type(error).__name__}: {error}")
    to_parent.send(came)


def _awaited(row: Row, child: Any, from_child: Connection, limit: int) -> Came:
    hung = Came(row=row, outcome="hangs", reason=f"no end after {limit} s")
    try:
        if from_child.poll(_PATIENCE * limit):
            came: Came = from_child.recv()
            child.join()
            return came
        child.kill()
        child.join()
        return hung
    except EOFError:
        child.join()
        if child.exitcode == -signal.SIGXCPU:
            return hung
        return Came(row=row, outcome="crashes", reason=f"exit code {child.exitcode}")
    finally:
        from_child.close()
