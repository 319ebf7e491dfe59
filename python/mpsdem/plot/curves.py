"""Curves over time: where the solids are, and what pressure the flow loses."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray

from mpsdem.analysis import Survey, extent, survey
from mpsdem.plot.drawing import curve_figure, legend_beside
from mpsdem.plot.style import ACCENTS, FAINT, INK, style
from mpsdem.results import Results

FloatArray = NDArray[np.float64]


def positions_over_time(results: Results) -> Figure:
    """Axial position of front, centre and tail of the solids against time.

    Parameters
    ----------
    results : Results
        A run with solids.

    Returns
    -------
    Figure
        With the way that the liquid goes at its bulk velocity, and the laps of the pipe.
    """
    case, time = results.case, results.time
    x = results.solids.unwrapped_position[:, :, 0]
    cluster = extent(x)
    with style():
        figure, axes = curve_figure(results, "front, centre and tail of the solids")
        axes.fill_between(
            time, cluster.last, cluster.first, color=FAINT, alpha=0.35, linewidth=0,
            label="all solids",
        )  # fmt: skip
        curves = (
            ("front (95 % behind)", cluster.front),
            ("centre (median)", cluster.centre),
            ("tail (5 % behind)", cluster.tail),
        )
        for (label, curve), colour in zip(curves, ACCENTS, strict=True):
            axes.plot(time, curve, color=colour, label=label)
        if case.liquid is not None and case.liquid.bulk_velocity:
            way = cluster.centre[0] + case.liquid.bulk_velocity * time
            axes.plot(
                time, way, color=INK, linewidth=0.8, linestyle=(0, (2, 3)),
                label="at the bulk velocity",
            )  # fmt: skip
        low, high = min(0.0, float(cluster.last.min())), float(cluster.first.max())
        axes.set(xlim=(time[0], time[-1] or 1.0), ylim=(low, max(high * 1.04, case.pipe.length)))
        laps = high / case.pipe.length
        if laps > 2:
            axes.yaxis.set_major_locator(MultipleLocator(case.pipe.length * -(-laps // 8)))
        axes.axhline(case.pipe.length, color=INK, linewidth=0.8, zorder=1)
        axes.text(time[-1] or 1.0, case.pipe.length, "outlet ", ha="right", va="bottom", size=8)
        axes.set(xlabel="time (s)", ylabel="distance from the inlet, laps added up (m)")
        legend_beside(axes)
    return figure


def pressure_gradient_over_time(results: Results, found: Survey | None = None) -> Figure:
    """Pressure loss along the pipe against time, static head apart.

    Parameters
    ----------
    results : Results
        A run with a liquid.
    found : Survey, optional
        The run's survey, if it is there already.

    Returns
    -------
    Figure
        With the mean over the window of the survey and its standard error, and with solids the
        parts that the walls and the drag of the solids have in it; what is left accelerates the
        liquid. In a pipe that moves, with mean and peak of each period.
    """
    found = found or survey(results)
    time, gradient, numbers = results.time, results.pressure_gradient, results.diagnostics
    average, periods = found.averages["pressure_gradient"], found.pressure_periods
    acted = slice(1, None) if time.size > 1 else slice(None)  # means since the last frame
    with style():
        figure, axes = curve_figure(results, "pressure loss along the pipe")
        axes.plot(time, gradient, color=ACCENTS[2], linewidth=1.0, label="whole")
        parts = [name for name in _PARTS if name in numbers and results.has_solids]
        for name, look in zip(parts, ("-", ":"), strict=False):
            axes.plot(
                time[acted], numbers[name][acted], color=INK, linewidth=0.9, linestyle=look,
                label=_PARTS[name],
            )  # fmt: skip
        error = f" ± {average.error:.2g}" if np.isfinite(average.error) else ""
        short = "" if average.long_enough else "\n(the run is too\nshort for it)"
        axes.hlines(
            average.mean, *average.window, color=ACCENTS[0],
            label=f"mean: {average.mean:.4g}{error}\nPa/m{short}",
        )  # fmt: skip
        if error:
            axes.fill_between(
                average.window, average.mean - average.error, average.mean + average.error,
                color=ACCENTS[0], alpha=0.25, linewidth=0,
            )  # fmt: skip
        if found.period is not None and periods is not None and periods.start.size:
            middle = periods.start + found.period / 2
            axes.plot(middle, periods.peak, "^", color=ACCENTS[0], markersize=4, label="peaks")
            axes.plot(middle, periods.mean, ".", color=ACCENTS[0], label="means of\nthe periods")
        if found.static_gradient:
            axes.plot([], [], " ", label=f"static, apart:\n{found.static_gradient:.4g} Pa/m")
        axes.set(xlim=(time[0], time[-1] or 1.0), xlabel="time (s)")
        axes.set_ylabel("pressure loss, static head apart (Pa/m)")
        _keep_to_the_usual(axes, np.concatenate([gradient, *(numbers[n][acted] for n in parts)]))
        legend_beside(axes)
    return figure


_PARTS = {
    "pressure_gradient_friction": "of the walls",
    "pressure_gradient_solids": "of the solids",
}


def _keep_to_the_usual(axes: Axes, values: FloatArray) -> None:
    """Let the few values of a start-up leave the picture rather than flatten all others."""
    low, high = np.quantile(values, [0.03, 0.97])
    room = 0.4 * (high - low)
    bottom, top = max(values.min(), low - room), min(values.max(), high + room)
    if values.max() - values.min() > 3 * (top - bottom) > 0:
        axes.set_ylim(bottom - 0.1 * room, top + 0.1 * room)
        axes.text(
            0.015,
            0.97,
            f"full range: {values.min():.4g} to {values.max():.4g} Pa/m",
            transform=axes.transAxes,
            va="top",
            size=8,
        )
