"""What this program must reproduce: exact solutions and published numbers, with their sources.

>>> from mpsdem import validation
>>> validation.run(["impact/glass-pair"])  # doctest: +SKIP
0
"""

from __future__ import annotations

from collections.abc import Iterable

from rich.console import Console

from mpsdem.validation import (
    conveying,
    drag,
    eulerian,
    head_loss,
    impacts,
    motion,
    particle_liquid,
    pipe,
    push_plate,
    rolling,
    two_way,
)
from mpsdem.validation.registry import Check, Outcome, Source, collect, select
from mpsdem.validation.report import report

__all__ = ["CHECKS", "Check", "Outcome", "Source", "run"]

CHECKS = collect(
    impacts.checks(),
    rolling.checks(),
    drag.checks(),
    pipe.checks(),
    head_loss.checks(),
    particle_liquid.checks(),
    eulerian.checks(),
    push_plate.checks(),
    motion.checks(),
    two_way.checks(),
    conveying.checks(),
)
"""All checks by their ids."""


def run(ids: Iterable[str] = ()) -> int:
    """Run checks, print a table of what they gave.

    Parameters
    ----------
    ids : iterable of str
        Ids of checks or of groups such as ``oblique``; all checks if there are none.

    Returns
    -------
    int
        Exit code: 1 if a check fails, 2 if an id names none, else 0.
    """
    console = Console()
    if not console.is_terminal:
        console.width = max(console.width, 132)  # a file has no margin to keep to
    try:
        checks = select(CHECKS, ids)
    except LookupError as error:
        console.print(f"[bold red]error:[/] {error.args[0]}", highlight=False)
        return 2
    return int(any(outcome.failed for outcome in report(checks, console)))
