"""The page on trades, made of the table that the package ships.

usage: python -m mpsdem.trade.document DIR      writes DIR/trade.md and DIR/trade.png
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from pathlib import Path

from mpsdem.trade.choice import errors_by_spacing
from mpsdem.trade.figure import draw_trade
from mpsdem.trade.outcome import Outcome
from mpsdem.trade.report import markdown
from mpsdem.trade.table import Table, shipped_table

_SHOWN = "case A"  # whose figure the page has
_LEVELS = {10: "quick", 16: "balanced", 24: "fine"}


def document(table: Table) -> str:
    """The page in Markdown."""
    return "\n".join(_lines(table)) + "\n"


def _lines(table: Table) -> Iterator[str]:
    yield "# Speed against accuracy, measured"
    yield ""
    yield "Written by `python -m mpsdem.trade.document docs` from the table that the package"
    yield "ships, `python/mpsdem/trade/table.json`; `python -m mpsdem.trade.measure` measures that"
    yield "again, in about twenty minutes of computing. `mpsdem trade CASE` does it for your case."
    yield ""
    solids, liquid = 1e3 * table.machine.solids, 1e3 * table.machine.liquid
    yield "Costs are seconds of computing each simulated second, on one thread of a machine that"
    yield f"takes {solids:.3g} ms for the fixed work of the solids and {liquid:.3g} ms for that of"
    yield "the liquid (`mpsdem.trade.machine`)."
    yield "Elsewhere they scale with what the same work takes there: `mpsdem run CASE --budget"
    yield '"10 min"` and `--error 5%` time it, and choose by table and plan.'
    yield ""
    yield "## What a level means"
    yield ""
    yield "Error to count on, in percent, no less than its error bar. Where no exact value is known"
    yield "errors count from `fine`: none is then less than that of a finer level, nor than that"
    yield "of `balanced`, as the error of `fine` itself is not known. It is as large as its"
    yield "distance from `balanced` where errors fall with the power 1.7 of the spacing, and twice"
    yield "that where they fall in proportion. Error bars of runs so short are too small: settings"
    yield "of case A that should agree scatter by one to two percent."
    yield ""
    yield "| scene | quantity | " + " | ".join(_LEVELS.values()) + " |"
    yield "|---|---|" + "---|" * len(_LEVELS)
    for scene in table.scenes.values():
        errors = errors_by_spacing(scene)
        for name, compared in scene.quantities.items():
            cells = [_percent(errors.get(across, {}).get(name, math.nan)) for across in _LEVELS]
            known = ", exact value known" if compared.exact else ""
            yield f"| {scene.title} | {name}{known} | {' | '.join(cells)} |"
    yield ""
    yield from _costs(table)
    yield "![cost against error of case A](trade.png)"
    for scene in table.scenes.values():
        yield ""
        yield f"## {scene.title}"
        yield ""
        yield markdown(scene).rstrip()


def _costs(table: Table) -> Iterator[str]:
    yield "Cost, in seconds of computing a simulated second:"
    yield ""
    yield "| scene | " + " | ".join(_LEVELS.values()) + " |"
    yield "|---|" + "---|" * len(_LEVELS)
    for scene in table.scenes.values():
        rates = {row.value: row.rate for row in scene.rows if row.knob == "level"}
        cells = [f"{rates[level]:.3g}" if level in rates else "-" for level in _LEVELS.values()]
        yield f"| {scene.title} | {' | '.join(cells)} |"
    yield ""


def _percent(share: float) -> str:
    return f"{100 * share:.2g}" if math.isfinite(share) else "-"


def shown(table: Table) -> Outcome:
    """The scene of which the page has a figure."""
    return table.scenes[_SHOWN]


def main() -> None:
    """Entry point of ``python -m mpsdem.trade.document``."""
    folder, table = Path(sys.argv[1]), shipped_table()
    (folder / "trade.md").write_text(document(table), "utf-8")
    draw_trade(shown(table)).savefig(folder / "trade.png")


if __name__ == "__main__":
    main()
