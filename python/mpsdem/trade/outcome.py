"""The outcome of a trade: what each setting costs and how far it is off, and what follows."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from mpsdem.trade.quantities import Deviation
from mpsdem.trade.settings import AS_GIVEN, LeftOut

_TOLERABLE = 0.05  # [-] error that the recommendation is content with
_CHEAPER = 0.9  # [-] of the cost, below which a saving is worth a word
_NOTHING = 1e-4  # [-] error below which nobody needs to know more
_UNMOVED = 0.01  # [-] change that does not matter, though it be resolved


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A setting, measured.

    Parameters
    ----------
    knob, value : str
        As in `Setting`.
    number : float
        The value as a number.
    status : str
        Of its run; errors and changes are empty where it did not reach its end.
    reason : str
        Why it did not.
    rate : float
        Processor time of a simulated second [-].
    of_solids : float
        Share of it that the plan gives to the solids [-].
    planned : float
        What the plan says of the rate, on the machine that it was fitted on [-].
    errors : mapping of str to Deviation
        Of each quantity, from the reference or an exact value.
    changes : mapping of str to Deviation
        Of each quantity, from the case as given: what the knob alone does.
    """

    knob: str
    value: str
    number: float
    status: str
    reason: str = ""
    rate: float
    of_solids: float
    planned: float
    errors: Mapping[str, Deviation]
    changes: Mapping[str, Deviation]

    def __str__(self) -> str:
        return self.knob if self.knob == AS_GIVEN else f"{self.knob} {self.value}"

    @property
    def worst(self) -> Deviation | None:
        """The largest error of all quantities; None where none is known."""
        return _largest(self.errors)

    @property
    def largest_change(self) -> Deviation | None:
        """The largest change of all quantities; None where none is known."""
        return _largest(self.changes)


def _largest(deviations: Mapping[str, Deviation]) -> Deviation | None:
    known = [d for d in deviations.values() if math.isfinite(d.value)]
    return max(known, key=lambda d: d.size, default=None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Compared:
    """A quantity that rows are compared by.

    Parameters
    ----------
    unit : str
    reference : float
        Mean of the reference, or the exact value [`unit`].
    bar : float
        Its standard error [`unit`]; 0 of an exact value.
    exact : bool
        Whether it is known from outside the program.
    """

    unit: str
    reference: float
    bar: float
    exact: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """A trade as a whole.

    Parameters
    ----------
    title : str
        Of the case.
    end_time : float
        Of every run [s]; means are over its second half.
    wanted : float
        End time of the case [s].
    reference : str
        The setting that errors count from, where no exact value is known.
    quantities : mapping of str to Compared
    rows : tuple of Row
    left_out : tuple of LeftOut
        What was not run, and why.
    notes : tuple of str
        How it was run.
    """

    title: str
    end_time: float
    wanted: float
    reference: str
    quantities: Mapping[str, Compared]
    rows: tuple[Row, ...]
    left_out: tuple[LeftOut, ...]
    notes: tuple[str, ...] = ()

    @property
    def front(self) -> list[Row]:
        """Rows that no other beats in cost and worst error, the cheapest first."""
        return front(self.rows)

    def recommendation(self) -> list[str]:
        """What follows, in sentences."""
        return list(_recommend(self))


def front(rows: Sequence[Row]) -> list[Row]:
    """Rows that no other beats in both cost and worst error, the cheapest first.

    Parameters
    ----------
    rows : sequence of Row
        Those without an error are never on it.

    Returns
    -------
    list of Row
        Errors are counted as no smaller than their error bars: a difference that cannot be seen
        buys nothing.
    """
    points = [(row.rate, row.worst.size, k) for k, row in enumerate(rows) if row.worst is not None]
    best, kept = math.inf, []
    for _, size, k in sorted(points):
        if size < best:
            best = size
            kept.append(rows[k])
    return kept


def _recommend(outcome: Outcome) -> Iterator[str]:
    rows = {str(row): row for row in outcome.rows}
    given, reference = rows.get(AS_GIVEN), rows.get(outcome.reference)
    known = outcome.front
    if not known:
        yield "No run reached its end: nothing can be said."
        return
    judged = [row for row in known if not _is_its_own_measure(row, outcome)]
    if not judged:
        yield "No run but that of the reference reached its end: nothing can be said."
        return
    good = [row for row in judged if row.worst is not None and row.worst.size <= _TOLERABLE]
    chosen = good[0] if good else judged[-1]
    assert chosen.worst is not None
    cheaper = ""
    if reference is not None and reference is not chosen:
        cheaper = f", {_times(reference.rate / chosen.rate)} cheaper than {outcome.reference}"
    if good:
        yield f"Take {_told(chosen)}: off by {_percent(chosen.worst)}{cheaper}."
    else:
        yield (
            f"No setting comes within {_TOLERABLE:.0%}; the nearest is {_told(chosen)}, off by "
            f"{_percent(chosen.worst)}{cheaper}."
        )
    if given is None:
        return
    if given is not chosen and given.worst is not None:
        yield f"The case as given is off by {_percent(given.worst)}."
    yield from _of_knobs(
        [row for row in outcome.rows if row.knob not in (AS_GIVEN, "level")], given
    )
    for row in outcome.rows:
        if row.status == "diverged":
            yield f"{_told(row).capitalize()} diverges: {row.reason}"


def _is_its_own_measure(row: Row, outcome: Outcome) -> bool:
    """Whether the errors of a row are zero because they count from it."""
    exact = any(compared.exact for compared in outcome.quantities.values())
    return str(row) == outcome.reference and not exact


def _of_knobs(rows: Sequence[Row], given: Row) -> Iterator[str]:
    """What single knobs do to the case as given."""
    free, paid, idle = [], [], []
    for row in rows:
        change = row.largest_change
        if change is None:
            continue
        ratio = row.rate / given.rate
        moved = change.resolved and abs(change.value) > _UNMOVED
        if not moved and ratio < _CHEAPER:
            free.append(f"{_told(row)} ({1 - ratio:.0%} less)")
        elif moved:
            cost = "as dear" if 0.9 < ratio < 1.1 else f"{ratio:.2g} times the cost"
            paid.append(f"{_told(row)} ({_percent(change)}, {cost})")
        elif ratio > 1 / _CHEAPER:
            idle.append(f"{_told(row)} ({_times(ratio)} the cost)")
    if free:
        yield f"Saves time and moves nothing beyond chance or 1 %: {'; '.join(free)}."
    if idle:
        yield f"Costs time and moves nothing beyond chance or 1 %: {'; '.join(idle)}."
    if paid:
        yield f"Moves the results: {'; '.join(paid)}."


def _told(row: Row) -> str:
    return "the case as given" if row.knob == AS_GIVEN else f"{row.knob} {row.value}"


def _times(ratio: float) -> str:
    return f"{ratio:.0f} times" if ratio >= 10 else f"{ratio:.2g} times"


def _percent(deviation: Deviation) -> str:
    if deviation.size < _NOTHING:
        return f"less than {_NOTHING:.2%}"
    if not math.isfinite(deviation.bar):
        return f"{100 * abs(deviation.value):.2g} %"
    return f"{100 * abs(deviation.value):.2g} ± {100 * max(deviation.bar, _NOTHING):.1g} %"


def as_json(outcome: Outcome) -> dict[str, Any]:
    """The outcome in JSON's types."""
    chosen = {str(row) for row in outcome.front}
    return {
        "title": outcome.title,
        "end_time": outcome.end_time,
        "wanted": outcome.wanted,
        "reference": outcome.reference,
        "quantities": {
            name: {
                "unit": q.unit,
                "reference": _digits(q.reference),
                "bar": _digits(q.bar),
                "exact": q.exact,
            }
            for name, q in outcome.quantities.items()
        },
        "rows": [
            {
                "knob": row.knob,
                "value": row.value,
                "number": row.number,
                "status": row.status,
                "reason": row.reason,
                "rate": _digits(row.rate),
                "of_solids": _digits(row.of_solids),
                "planned": _digits(row.planned),
                "on_front": str(row) in chosen,
                "errors": _triples(row.errors),
                "changes": _triples(row.changes),
            }
            for row in outcome.rows
        ],
        "left_out": [{"setting": out.setting, "reason": out.reason} for out in outcome.left_out],
        "recommendation": outcome.recommendation(),
        "notes": list(outcome.notes),
    }


def from_json(table: Mapping[str, Any]) -> Outcome:
    """What `as_json` gave."""
    return Outcome(
        title=table["title"],
        end_time=table["end_time"],
        wanted=table["wanted"],
        reference=table["reference"],
        quantities={
            name: Compared(
                unit=q["unit"],
                reference=_number(q["reference"]),
                bar=_number(q["bar"]),
                exact=q["exact"],
            )
            for name, q in table["quantities"].items()
        },
        rows=tuple(
            Row(
                knob=row["knob"],
                value=row["value"],
                number=row["number"],
                status=row["status"],
                reason=row["reason"],
                rate=_number(row["rate"]),
                of_solids=_number(row["of_solids"]),
                planned=_number(row["planned"]),
                errors=_deviations(row["errors"]),
                changes=_deviations(row["changes"]),
            )
            for row in table["rows"]
        ),
        left_out=tuple(LeftOut(**out) for out in table["left_out"]),
        notes=tuple(table["notes"]),
    )


def _triples(deviations: Mapping[str, Deviation]) -> dict[str, list[float | bool | None]]:
    return {name: [_digits(d.value), _digits(d.bar), d.sure] for name, d in deviations.items()}


def _deviations(triples: Mapping[str, Sequence[Any]]) -> dict[str, Deviation]:
    return {
        name: Deviation(value=_number(value), bar=_number(bar), sure=sure)
        for name, (value, bar, sure) in triples.items()
    }


def _number(value: float | None) -> float:
    return math.nan if value is None else value


def _digits(value: float) -> float | None:
    """Four digits, which is more than is measured; None for what JSON has no word for."""
    return float(f"{value:.4g}") if math.isfinite(value) else None
