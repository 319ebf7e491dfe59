"""Fill the tables of docs/reproduction.md: ``python -m mpsdem.validation.reproduction RUNS``."""

from __future__ import annotations

import sys
from pathlib import Path

from rich.console import Console

from mpsdem.validation.reproduction.figures import of_horizontal, of_inclined
from mpsdem.validation.reproduction.horizontal import HORIZONTAL
from mpsdem.validation.reproduction.inclined import INCLINED
from mpsdem.validation.reproduction.page import costs, table
from mpsdem.validation.reproduction.reasons import REASONS
from mpsdem.validation.reproduction.runs import FINEST, LEVELS, scenes

DOCUMENT = Path("docs", "reproduction.md")
AS_IS, ALSO_FINEST = "--as-is", "--finest"

_out = Console(soft_wrap=True, markup=False, highlight=False)


def main(arguments: list[str]) -> int:
    """Read the runs in a directory, make those that are missing, and write the tables."""
    options = {argument for argument in arguments if argument.startswith("--")}
    if len(arguments) - len(options) != 1 or options - {AS_IS, ALSO_FINEST}:
        _out.print(
            "usage: python -m mpsdem.validation.reproduction RUNS_DIRECTORY "
            f"[{AS_IS}: make no runs] [{ALSO_FINEST}: make that of an hour too]"
        )
        return 2
    directory = Path(next(argument for argument in arguments if argument not in options))
    of = {}
    for level in LEVELS:
        make = AS_IS not in options and (level != FINEST or ALSO_FINEST in options)
        of[level] = scenes(level, directory, Path("cases"), make=make)
    tables = {
        "A": table(HORIZONTAL, of),
        "B": table(INCLINED, of),
        "why": table(REASONS, of),
        "cost": costs(of),
    }
    for name, lines in tables.items():
        _out.print(f"{name}\n{lines}")
    if DOCUMENT.exists():
        DOCUMENT.write_text(filled(DOCUMENT.read_text("utf-8"), tables), "utf-8")
        for name, figure in (("horizontal", of_horizontal(of)), ("inclined", of_inclined(of))):
            figure.savefig(DOCUMENT.with_name(f"reproduction_{name}.png"), dpi=150)
    return 0


def filled(text: str, tables: dict[str, str]) -> str:
    """A page, with what stands between the marks of each table replaced by the table."""
    for name, lines in tables.items():
        begin, end = f"<!-- table {name} -->", f"<!-- end {name} -->"
        before, rest = text.split(begin)
        text = f"{before}{begin}\n{lines}{end}{rest.split(end)[1]}"
    return text


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
