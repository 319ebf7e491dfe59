"""The table of the extremes, for the documents."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from mpsdem.validation.extremes.run import Came

_HEADINGS = {
    "speed": "speed",
    "overlap": "overlap",
    "scatter": "scatter",
    "clips": "clips",
    "momentum_error": "momentum",
    "exchange_error": "exchange",
    "mass_error": "mass",
}


def markdown(outcomes: Sequence[Came]) -> str:
    """One line per row, under a heading per quantity's first."""
    return "\n".join(_lines(outcomes)) + "\n"


def _lines(outcomes: Sequence[Came]) -> Iterator[str]:
    count = Counter(came.outcome for came in outcomes)
    insane = sum(bool(came.doubts) for came in outcomes)
    told = ", ".join(f"{number} {outcome}" for outcome, number in count.items())
    yield f"{len(outcomes)} rows: {told}; of those that survived, {insane} are not sane."
    yield ""
    headings = ["what", "value", "liquid", "outcome", "sane", *_HEADINGS.values(), "ms/step", "MB"]
    yield f"| {' | '.join([*headings, 'reason'])} |"
    yield f"|{'---|' * (len(headings) + 1)}"
    quantity = ""
    for came in outcomes:
        row = came.row
        named = "" if row.quantity == quantity else row.quantity
        quantity = row.quantity
        cells = [named, row.value, row.model, _outcome(came), _sane(came)]
        cells += [_number(came.figures.get(name)) for name in _HEADINGS]
        step = came.step_seconds
        cells += [_number(None if step is None else 1e3 * step), _number(came.memory, digits=0)]
        reason = came.reason or "; ".join(came.doubts)
        yield f"| {' | '.join([*cells, _one_line(reason)])} |"


def _outcome(came: Came) -> str:
    return came.outcome if came.outcome == came.row.outcome else f"**{came.outcome}**"


def _sane(came: Came) -> str:
    if came.outcome != "survived":
        return ""
    return "**no**" if came.doubts else "yes"


def _number(value: float | None, digits: int = 2) -> str:
    if value is None:
        return ""
    if digits == 0 or isinstance(value, int):
        return f"{value:.0f}"
    return f"{value:.{digits}g}"


def _one_line(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")
