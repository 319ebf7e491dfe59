"""A trade on disk: JSON, CSV and Markdown tables, and the figure."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterator
from pathlib import Path

from mpsdem.results.files import write_atomically
from mpsdem.trade.figure import draw_trade
from mpsdem.trade.outcome import Outcome, as_json
from mpsdem.trade.quantities import Deviation


def save(outcome: Outcome, directory: Path) -> list[Path]:
    """Write ``trade.json``, ``trade.csv``, ``trade.md`` and ``trade.png``; give their paths."""
    texts = {
        "trade.json": json.dumps(as_json(outcome), indent=1, ensure_ascii=False) + "\n",
        "trade.csv": _csv(outcome),
        "trade.md": f"# {outcome.title}\n\n{markdown(outcome)}\n![cost against error](trade.png)\n",
    }
    for name, text in texts.items():
        write_atomically(directory / name, text.encode())
    figure = io.BytesIO()
    draw_trade(outcome).savefig(figure, format="png")
    write_atomically(directory / "trade.png", figure.getvalue())
    return [directory / name for name in (*texts, "trade.png")]


def _csv(outcome: Outcome) -> str:
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    names = list(outcome.quantities)
    table.writerow(
        ["knob", "value", "status", "cpu_seconds_per_second", "on_front"]
        + [f"{name}_{what}" for name in names for what in ("error", "error_bar", "change")]
    )
    chosen = outcome.front
    for row in outcome.rows:
        line = [row.knob, row.value, row.status, _plain(row.rate), int(row in chosen)]
        for name in names:
            error, change = row.errors.get(name), row.changes.get(name)
            line += [
                _plain(error.value) if error else "",
                _plain(error.bar) if error else "",
                _plain(change.value) if change else "",
            ]
        table.writerow(line)
    return text.getvalue()


def _plain(value: float) -> str:
    return f"{value:.4g}" if math.isfinite(value) else ""


def markdown(outcome: Outcome) -> str:
    """The table and what follows from it.

    Errors are signed, in percent, with one standard error; **bold** rows are on the front.
    """
    return "\n".join(_lines(outcome)) + "\n"


def _lines(outcome: Outcome) -> Iterator[str]:
    of = [f"{name} is known" for name, q in outcome.quantities.items() if q.exact]
    measured = [name for name, q in outcome.quantities.items() if not q.exact]
    if measured:
        of.append(f"{', '.join(measured)}: from {outcome.reference}")
    part = "" if outcome.end_time >= outcome.wanted else f" of the {outcome.wanted:g} s wanted"
    yield f"Runs of {outcome.end_time:.3g} s{part}, means over the second half. Errors in percent"
    doubt = any(not error.sure for row in outcome.rows for error in row.errors.values())
    too_short = ", too small at a ?, as the run is too short" if doubt else ""
    yield f"({'; '.join(of)}), ± one standard error{too_short}; the front in bold.\n"
    names = list(outcome.quantities)
    yield f"| setting | s of computing a second | {' | '.join(names)} |"
    yield "|---|---|" + "---|" * len(names)
    chosen = outcome.front
    for row, (setting, *cells) in zip(outcome.rows, report_rows(outcome), strict=True):
        mark = "**" if row in chosen else ""
        yield f"| {mark}{setting}{mark} | {' | '.join(cells)} |"
    yield ""
    for sentence in outcome.recommendation():
        yield f"- {sentence}"
    if outcome.left_out:
        yield "\nNot run:\n"
        for out in outcome.left_out:
            yield f"- {out.setting}: {out.reason}"


def percent(deviation: Deviation | None) -> str:
    """A deviation in percent, signed, with its error bar; "?" where that is too small."""
    if deviation is None or not math.isfinite(deviation.value):
        return "-"
    if deviation.value == deviation.bar == 0:
        return "0"
    value = _rounded(100 * deviation.value)
    if not math.isfinite(deviation.bar):
        return value
    doubt = "" if deviation.sure else "?"
    return f"{value} ± {_rounded(100 * deviation.bar).lstrip('+')}{doubt}"


def _rounded(percent: float) -> str:
    """Two digits, and none beyond a hundredth of a percent."""
    digits = 0 if abs(percent) >= 10 else 1 if abs(percent) >= 1 else 2
    return f"{percent:+.{digits}f}"


def report_rows(outcome: Outcome) -> Iterator[list[str]]:
    """Cells of a table: setting, cost, and the error of each quantity."""
    names = list(outcome.quantities)
    for row in outcome.rows:
        cells = [percent(row.errors.get(name)) for name in names]
        if not row.errors and cells:
            cells[0] = row.status
        yield [str(row), f"{row.rate:.3g}", *cells]
