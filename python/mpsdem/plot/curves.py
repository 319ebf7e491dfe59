"""Curves: positions against time, and what changes with the height in the pipe."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray

from mpsdem.analysis import (
    extent,
    height_edges,
    velocity_over_height,
    volume_fraction_over_height,
)
from mpsdem.plot.drawing import curve_figure, legend_beside
from mpsdem.plot.frames import chosen_frames, heading, mean_of, second_half, when
from mpsdem.plot.style import ACCENTS, FAINT, INK, style, time_colours
from mpsdem.results import Results

FloatArray = NDArray[np.float64]

_SLABS = 40


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


def solids_velocity_over_height(results: Results, times: Sequence[float] | None = None) -> Figure:
    """Axial velocity of solids and liquid over the height in the pipe.

    Parameters
    ----------
    results : Results
        Any run.
    times : sequence of float, optional
        When to look [s]; by default at the start and after successive halves of the run.

    Returns
    -------
    Figure
        Solids as means over slabs. A computed liquid likewise, dashed, in a second diagram where
        there are solids; a prescribed one on the vertical through the axis.
    """
    radius = results.case.pipe.radius
    edges = height_edges(radius, _SLABS)
    layered = results.has_liquid and "layer_velocity" in results.liquid
    both = layered and results.has_solids

    def of_solids(frame: int) -> FloatArray:
        solids = results.solids
        return velocity_over_height(
            solids.position[frame], solids.velocity[frame], solids.radius, edges=edges
        )

    with style():
        figure = Figure(figsize=(9.6 if both else 6.4, 4.4), layout="constrained")
        diagrams = figure.subplots(1, 2 if both else 1, sharex=True, sharey=True, squeeze=False)[0]
        if both:
            figure.suptitle(heading(results, "velocity over height"), x=0.01, ha="left")
            diagrams[0].set_title("solids")
            diagrams[1].set_title("liquid")
        else:
            diagrams[0].set_title(heading(results, "velocity over height"))
        if layered:
            liquid = results.liquid
            _over_height(
                diagrams[-1], results, times, radius + liquid.layer_height,
                lambda frame: liquid.layer_velocity[frame], linestyle="--",
            )  # fmt: skip
        elif results.has_liquid:
            _liquid_on_the_vertical(diagrams[0], results)
        if results.has_solids:
            height = radius + (edges[1:] + edges[:-1]) / 2
            _over_height(diagrams[0], results, times, height, of_solids)
        for axes in diagrams:
            axes.set_xlabel("axial velocity (m/s)")
            axes.set_ylim(0, 2 * radius)
        diagrams[0].set_ylabel("height above the bottom of the bore (m)")
        legend_beside(diagrams[-1])
    return figure


def solids_fraction_over_height(results: Results, times: Sequence[float] | None = None) -> Figure:
    """Volume fraction of the solids over the height in the pipe, mean over its length.

    Parameters
    ----------
    results : Results
        A run with solids.
    times : sequence of float, optional
        When to look [s]; by default at the start and after successive halves of the run.

    Returns
    -------
    Figure
        One curve per time, and the mean of the second half of the run.
    """
    pipe, solids = results.case.pipe, results.solids
    edges = height_edges(pipe.radius, _SLABS)

    def profile(frame: int) -> FloatArray:
        return volume_fraction_over_height(
            solids.position[frame],
            solids.radius,
            pipe_radius=pipe.radius,
            length=pipe.length,
            edges=edges,
        )

    with style():
        figure, axes = curve_figure(results, "volume fraction over height", size=(6.4, 4.4))
        height = pipe.radius + (edges[1:] + edges[:-1]) / 2
        _over_height(axes, results, times, height, profile)
        axes.set_xlabel("volume fraction of the solids, mean over the pipe (-)")
        axes.set_xlim(left=0)
        _finish_height(axes, pipe.radius)
    return figure


def pressure_gradient_over_time(results: Results) -> Figure:
    """Pressure loss along the pipe against time, static head apart.

    Parameters
    ----------
    results : Results
        A run with a liquid.

    Returns
    -------
    Figure
        With the mean of the second half of the run, and with solids the parts that the walls and
        the drag of the solids have in it; what is left accelerates the liquid.
    """
    time, gradient, numbers = results.time, results.pressure_gradient, results.diagnostics
    second_half = time >= time[-1] / 2
    mean = float(gradient[second_half].mean())
    acted = slice(1, None) if time.size > 1 else slice(None)  # means since the last frame
    with style():
        figure, axes = curve_figure(results, "pressure loss along the pipe")
        axes.plot(time, gradient, color=ACCENTS[2], linewidth=1.0, label="whole")
        axes.hlines(
            mean, time[second_half][0], time[-1], color=ACCENTS[0],
            label=f"mean of the\nsecond half:\n{mean:.4g} Pa/m",
        )  # fmt: skip
        parts = [name for name in _PARTS if name in numbers and results.has_solids]
        for name, look in zip(parts, ("-", ":"), strict=False):
            axes.plot(
                time[acted], numbers[name][acted], color=INK, linewidth=0.9, linestyle=look,
                label=_PARTS[name],
            )  # fmt: skip
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


def _liquid_on_the_vertical(axes: Axes, results: Results) -> None:
    radius, r = results.case.pipe.radius, results.liquid.profile_radius
    u, label = _liquid_profile(results)
    known = np.isfinite(u)  # no particle may be in a thin ring round the axis
    r, u = r[known], u[known]
    height = radius + np.concatenate([-r[::-1], r])
    axes.plot(
        np.concatenate([u[::-1], u]), height, color=INK, linewidth=1.0, linestyle="--", label=label
    )


def _liquid_profile(results: Results) -> tuple[FloatArray, str]:
    liquid = results.liquid
    if liquid.is_prescribed:
        return liquid.profile_velocity, "liquid, prescribed"
    profile = liquid.velocity_profile
    mean, span = mean_of(results, second_half(results), lambda frame: profile[frame])
    return mean, f"liquid, mean,\n{span}"


def _over_height(
    axes: Axes,
    results: Results,
    times: Sequence[float] | None,
    height: FloatArray,
    profile: Callable[[int], FloatArray],
    linestyle: str = "-",
) -> None:
    frames = chosen_frames(results, times)
    for frame, colour in zip(frames, time_colours(len(frames)), strict=True):
        axes.plot(
            profile(frame), height, color=colour, linestyle=linestyle,
            label=when(results.time[frame]),
        )  # fmt: skip
    later = second_half(results)
    if len(later) > 1:
        mean, span = mean_of(results, later, profile)
        axes.plot(mean, height, color=FAINT, linewidth=5, zorder=1, label=f"mean, {span}")


def _finish_height(axes: Axes, radius: float) -> None:
    axes.set(ylim=(0, 2 * radius), ylabel="height above the bottom of the bore (m)")
    legend_beside(axes)
