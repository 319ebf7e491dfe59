"""Run the extremes: ``python -m mpsdem.validation.extremes [ROW...]``."""

from __future__ import annotations

import sys
from pathlib import Path

from rich.console import Console

from mpsdem.validation.extremes.rows import rows
from mpsdem.validation.extremes.run import Came, run_rows
from mpsdem.validation.extremes.table import markdown

DOCUMENT = Path("docs", "extremes.md")
_TABLE = "<!-- table -->"  # what follows is replaced

_out = Console(soft_wrap=True, markup=False, highlight=False)


def main(names: list[str]) -> int:
    """Run the rows whose names begin so, or all; exit code 1 if one is not as it must be."""
    chosen = [row for row in rows() if not names or any(map(row.id.startswith, names))]
    if not chosen:
        _out.print("no such row; there are\n" + "\n".join(row.id for row in rows()))
        return 2
    outcomes = list(map(_told, run_rows(chosen)))
    if names or not DOCUMENT.exists():
        _out.print(markdown(outcomes))
    else:
        text = DOCUMENT.read_text("utf-8").split(_TABLE)[0]
        DOCUMENT.write_text(f"{text}{_TABLE}\n{markdown(outcomes)}", "utf-8")
    return int(not all(came.as_expected for came in outcomes))


def _told(came: Came) -> Came:
    sane = "" if not came.doubts else f", not sane: {'; '.join(came.doubts)}"
    _out.print(f"{came.row.id}: {came.outcome}{sane}")
    return came


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
