"""Cost against error: each knob a line through the case as given, the front beneath them."""

from __future__ import annotations

import math
from collections.abc import Iterator

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from mpsdem.plot.style import DOTS_PER_INCH, FAINT, INK, style
from mpsdem.trade.outcome import Outcome, Row, front
from mpsdem.trade.quantities import Deviation
from mpsdem.trade.settings import AS_GIVEN

_MARKS = {
    "level": ("#222222", "s"),
    "liquid model": ("#c1432e", "D"),
    "particle spacing": ("#2a6f97", "o"),
    "Courant number": ("#5b8e3e", "^"),
    "pressure tolerance": ("#6b4c9a", "v"),
    "stiffness factor": ("#c98a1b", "P"),
    "coupling interval": ("#8a5a9e", "X"),
    "smoothing radius": ("#4aa5a0", "h"),
}
_LEAST = 1e-3  # error that the axis ends at: nobody needs to see less
_CLOSE = 0.08  # decades from the case as given within which values would hide each other
_SHORT = {"pressure_gradient": "loss of pressure"}  # names in words, where not the name's own


def draw_trade(outcome: Outcome) -> Figure:
    """Error over cost, a diagram for each quantity.

    Parameters
    ----------
    outcome : Outcome

    Returns
    -------
    Figure
        Both axes logarithmic. Hollow marks are errors that are no larger than two error bars;
        an error of less than 0.1 % is drawn there. The band is the front: settings that no other
        beats in both.
    """
    names = list(outcome.quantities) or ["no quantity"]
    columns = min(2, len(names))
    lines = math.ceil(len(names) / columns)
    with style():
        figure = Figure(
            figsize=(4.0 * columns + 1.9, 3.1 * lines + 0.5),
            dpi=DOTS_PER_INCH,
            layout="constrained",
        )
        figure.suptitle(f"{outcome.title}: cost against error", x=0.01, ha="left")
        all_axes = figure.subplots(lines, columns, squeeze=False, sharex=True)
        handles = {}
        for k, axes in enumerate(all_axes.flat):
            if k >= len(names):
                axes.set_visible(False)
                continue
            _draw(axes, outcome, names[k])
            for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
                handles[label] = handle
            if k + columns >= len(names):
                axes.set_xlabel("computing per simulated second (s/s, one core)")
                axes.xaxis.set_tick_params(labelbottom=True)
        figure.legend(
            handles.values(), handles.keys(), loc="outside right upper", title="knob, turned alone"
        )
    return figure


def _draw(axes: Axes, outcome: Outcome, name: str) -> None:
    axes.set(xscale="log", yscale="log")
    rows = [row for row in outcome.rows if _of(row, name) is not None]
    axes.set_title(_SHORT.get(name, name.replace("_", " ")))
    compared = outcome.quantities.get(name)
    exact = compared is not None and compared.exact
    axes.set_ylabel("error " + ("from the exact value" if exact else f"from {outcome.reference}"))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{100 * y:g} %"))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=20))
        axis.set_minor_formatter(NullFormatter())
    best = front([_only(row, name) for row in rows])
    if best:
        x = [row.rate for row in best]
        y = [max(row.worst.size, _LEAST) if row.worst else _LEAST for row in best]
        axes.step(x, y, where="post", color=FAINT, linewidth=5, alpha=0.5, label="front", zorder=0)
    given = next((row for row in rows if row.knob == AS_GIVEN), None)
    for knob, line in _by_knob(rows):
        colour, mark = _MARKS.get(knob, (INK, "o"))
        through = sorted([*line, given] if given else line, key=lambda row: row.rate)
        axes.plot(
            [row.rate for row in through], [_height(row, name) for row in through],
            color=colour, linewidth=0.9, alpha=0.8, zorder=1,
        )  # fmt: skip
        for row in line:
            apart = None if given is None else _apart(row, given, name)
            _mark(axes, row, name, colour, mark, knob, apart=apart)
    if given is not None:
        _mark(axes, given, name, INK, "*", AS_GIVEN, size=11)
    axes.set_ylim(bottom=_LEAST * 0.8)


def _mark(
    axes: Axes,
    row: Row,
    name: str,
    colour: str,
    mark: str,
    label: str,
    *,
    size: float = 5.0,
    apart: float | None = None,
) -> None:
    """Draw a row's mark; name its value where it stands `apart` from the case as given."""
    error = _of(row, name)
    assert error is not None
    height = _height(row, name)
    bar = error.bar if math.isfinite(error.bar) else 0.0
    below = min(bar, height - _LEAST * 0.8)
    axes.errorbar(
        row.rate, height, yerr=[[max(below, 0.0)], [bar]], color=colour, marker=mark,
        markersize=size, markerfacecolor=colour if error.resolved else "white", capsize=2,
        elinewidth=0.7, linestyle="none", label=label, zorder=3,
    )  # fmt: skip
    if label != AS_GIVEN and (apart is None or apart > _CLOSE):
        axes.annotate(
            row.value, (row.rate, height), xytext=(4, 3), textcoords="offset points", fontsize=6,
            color=colour,
        )  # fmt: skip


def _apart(row: Row, given: Row, name: str) -> float:
    """How far two marks lie apart, in decades of the one axis and half decades of the other."""
    across = math.log10(row.rate / given.rate)
    return math.hypot(across, 0.5 * math.log10(_height(row, name) / _height(given, name)))


def _by_knob(rows: list[Row]) -> Iterator[tuple[str, list[Row]]]:
    for knob in dict.fromkeys(row.knob for row in rows if row.knob != AS_GIVEN):
        yield knob, sorted((row for row in rows if row.knob == knob), key=lambda row: row.number)


def _of(row: Row, name: str) -> Deviation | None:
    error = row.errors.get(name)
    return error if error is not None and math.isfinite(error.value) else None


def _height(row: Row, name: str) -> float:
    error = _of(row, name)
    return max(abs(error.value), _LEAST) if error else math.nan


def _only(row: Row, name: str) -> Row:
    return Row(
        knob=row.knob, value=row.value, number=row.number, status=row.status, rate=row.rate,
        of_solids=row.of_solids, planned=row.planned, errors={name: row.errors[name]}, changes={},
    )  # fmt: skip
