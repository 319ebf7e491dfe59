"""One run of a trade, in a directory of its own, and what it came to."""

from __future__ import annotations

import json
import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mpsdem.case import Case, CaseError, load_case
from mpsdem.results import OutputError, Results
from mpsdem.simulation import Simulation, SimulationDiverged
from mpsdem.trade.quantities import Series, series_of

FINISHED, PLUG, DIVERGED = "finished", "plug", "diverged"


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What a run came to.

    Parameters
    ----------
    status : str
        As in ``summary.json``.
    cpu_seconds, wall_seconds : float
        That it took [s].
    time : float
        Simulated time that it reached [s].
    reason : str
        Why it ended early; empty where it did not.
    """

    status: str
    cpu_seconds: float
    wall_seconds: float
    time: float
    reason: str = ""

    @property
    def rate(self) -> float:
        """Processor time of a simulated second [-]."""
        return self.cpu_seconds / self.time if self.time > 0 else math.nan

    @property
    def whole(self) -> bool:
        """Whether it reached its end."""
        return self.status == FINISHED


def carry_out(case: str, directory: str) -> Outcome:
    """Run a case to its end, unless that was done before; go on where it was stopped.

    Parameters
    ----------
    case : str
        In TOML; text, so that it travels to other machines.
    directory : str
        Of the run.

    Returns
    -------
    Outcome
        A run that diverges is an outcome too.
    """
    if (known := known_outcome(case, directory)) is not None:
        return known
    path, parsed = Path(directory), Case.from_toml(case)
    stopped = (path / "checkpoint.h5").exists() and _holds(path, case)
    reason = ""
    try:
        simulation = (
            Simulation.resume(path) if stopped else Simulation(parsed, path, overwrite=True)
        )  # fmt: skip
        simulation.run(bar=False).close()
    except SimulationDiverged as error:
        reason = str(error)
    _note(path, reason)
    outcome = known_outcome(case, directory)
    if outcome is None:
        raise OutputError(f"{path} holds no summary of the run that ended there")
    return outcome


def known_outcome(case: str, directory: str | os.PathLike[str]) -> Outcome | None:
    """What a run came to that ended before; None where none of this case has."""
    path = Path(directory)
    try:
        summary = json.loads((path / "summary.json").read_bytes())
    except (OSError, ValueError):
        return None
    if summary["status"] not in (FINISHED, PLUG, DIVERGED) or not _holds(path, case):
        return None
    note = path / _REASON
    return Outcome(
        status=summary["status"],
        cpu_seconds=summary["cpu_seconds"],
        wall_seconds=summary["wall_seconds"],
        time=summary["time"],
        reason=note.read_text("utf-8").strip() if note.exists() else "",
    )


def quantities_of(directory: str | os.PathLike[str], names: list[str]) -> dict[str, Series]:
    """Series of a run by their names; those that it has."""
    with Results(directory) as results:
        found = {name: series_of(results, name) for name in names}
    return {name: series for name, series in found.items() if series is not None}


def summary_of(directory: str | os.PathLike[str]) -> dict[str, Any]:
    """``summary.json`` of a run."""
    summary: dict[str, Any] = json.loads((Path(directory) / "summary.json").read_bytes())
    return summary


_REASON = "reason.txt"


def _note(path: Path, reason: str) -> None:
    if reason:
        (path / _REASON).write_text(reason + "\n", "utf-8")


def _holds(path: Path, case: str) -> bool:
    """Whether the results in a directory are those of a case."""
    try:
        return load_case(path / "case.toml") == Case.from_toml(case)
    except CaseError:
        return False
