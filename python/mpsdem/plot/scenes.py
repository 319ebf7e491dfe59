"""The solids as they lie in the pipe: from the side, in sections, in outline."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mpsdem.analysis import extent, silhouette
from mpsdem.plot.drawing import (
    BOTTOM,
    LEFT,
    RIGHT,
    SECTION,
    THINNEST,
    TOP,
    bore_section,
    colour_bar,
    scene_heading,
    spheres_at,
    strips_along,
    ticks_in_metres,
)
from mpsdem.plot.frames import chosen_frames, when
from mpsdem.plot.style import SPEED_COLOURS, axes_at, style
from mpsdem.results import Results

FloatArray = NDArray[np.float64]


def side_view(results: Results, times: Sequence[float] | None = None) -> Figure:
    """The whole pipe from the side at several times, solids coloured by their speed.

    Parameters
    ----------
    results : Results
        A run with solids.
    times : sequence of float, optional
        When to look [s]; by default at the start and after successive halves of the run.

    Returns
    -------
    Figure
        One strip per time, the earliest on top; near solids hide far ones.
    """
    pipe, solids = results.case.pipe, results.solids
    frames = chosen_frames(results, times)
    with style():
        figure, strips = strips_along(results, frames, "side view", THINNEST)
        norm = _speed_norm(results, frames)
        for axes, frame in zip(strips, frames, strict=True):
            position, speed = solids.position[frame], _speed(results, frame)
            nearest_last = np.argsort(-position[:, 1], kind="stable")
            spheres_at(
                axes,
                position[nearest_last][:, [0, 2]],
                solids.radius[nearest_last],
                speed[nearest_last],
                norm,
                period=pipe.length,
            )
        _speed_bar(figure, strips, norm, results, frames)
    return figure


def silhouettes(results: Results, times: Sequence[float] | None = None) -> Figure:
    """Lower and upper outline of the solids along the pipe at several times.

    Parameters
    ----------
    results : Results
        A run with solids.
    times : sequence of float, optional
        When to look [s]; by default at the start and after successive halves of the run.

    Returns
    -------
    Figure
        One strip per time, the earliest on top.
    """
    pipe, radius = results.case.pipe, results.solids.radius
    frames = chosen_frames(results, times)
    bins = int(np.clip(pipe.length / radius.mean(), 50, 400))
    with style():
        figure, strips = strips_along(results, frames, "outline of the solids", 0.6)
        for axes, frame in zip(strips, frames, strict=True):
            outline = silhouette(
                results.solids.position[frame], radius, length=pipe.length, bins=bins
            )
            axes.fill_between(
                outline.x,
                outline.lower,
                outline.upper,
                step="mid",
                facecolor="#9fc3d9",
                edgecolor="#2a6f97",
                linewidth=0.8,
            )
    return figure


def cross_sections(results: Results, times: Sequence[float] | None = None) -> Figure:
    """Cross-sections at front, centre and tail of the solids, coloured by speed.

    Parameters
    ----------
    results : Results
        A run with solids.
    times : sequence of float, optional
        When to look [s]; by default at the start and after successive halves of the run.

    Returns
    -------
    Figure
        Seen against the flow; each shows the solids whose centres lie within half a bore radius
        of the section.
    """
    pipe, solids = results.case.pipe, results.solids
    frames = chosen_frames(results, times)
    names = ("front", "centre", "tail") if len(solids) > 2 else ("centre",)
    with style():
        gap, note = 0.12, 0.2
        row_height = SECTION + note + gap
        figure = Figure(
            figsize=(
                LEFT + len(frames) * (SECTION + gap) + RIGHT,
                TOP + 0.25 + len(names) * row_height + BOTTOM,
            )
        )
        norm = _speed_norm(results, frames)
        all_axes = []
        for column, frame in enumerate(frames):
            position, speed = solids.position[frame], _speed(results, frame)
            along = position[:, 0] + pipe.length * solids.laps[frame]
            stations = extent(along[None])
            for row, name in enumerate(names):
                station = float(getattr(stations, name)[0]) % pipe.length
                axes = axes_at(
                    figure,
                    LEFT + column * (SECTION + gap),
                    BOTTOM + (len(names) - 1 - row) * row_height,
                    SECTION,
                    SECTION,
                )
                ahead = np.remainder(position[:, 0] - station + pipe.length / 2, pipe.length)
                ahead -= pipe.length / 2
                shown = np.flatnonzero(np.abs(ahead) <= pipe.radius / 2)
                shown = shown[np.argsort(ahead[shown], kind="stable")]
                bore_section(axes, pipe.radius)
                spheres_at(axes, position[shown, 1:], solids.radius[shown], speed[shown], norm)
                axes.set_title(f"x = {station:.2f} m", loc="center", fontsize=8, weight="normal")
                if row == 0:
                    axes.text(
                        0.5,
                        1.2,
                        when(results.time[frame]),
                        weight="bold",
                        ha="center",
                        transform=axes.transAxes,
                    )
                if column == 0:
                    axes.text(
                        -0.72, 0.5, name, weight="bold", rotation="vertical", va="center",
                        transform=axes.transAxes,
                    )  # fmt: skip
                all_axes.append(axes)
        corner = all_axes[len(names) - 1]
        ticks_in_metres(corner, pipe.radius)
        scene_heading(figure, results, f"sections at the {' / '.join(names)} of the solids")
        _speed_bar(figure, all_axes, norm, results, frames)
    return figure


def _speed(results: Results, frame: int) -> FloatArray:
    return np.asarray(np.linalg.norm(results.solids.velocity[frame], axis=1))


def _speed_norm(results: Results, frames: Sequence[int]) -> Normalize:
    """Colours from rest to the bulk velocity, or to the fastest solid where nothing flows."""
    liquid = results.case.liquid
    top = abs(liquid.bulk_velocity or 0.0) if liquid is not None else 0.0
    fastest = max(float(_speed(results, frame).max()) for frame in frames)
    return Normalize(0.0, top or fastest or 1.0)


def _speed_bar(
    figure: Figure, axes: Sequence[Axes], norm: Normalize, results: Results, frames: Sequence[int]
) -> None:
    fastest = max(float(_speed(results, frame).max()) for frame in frames)
    colour_bar(
        figure, axes, norm, SPEED_COLOURS, label="speed of the solids (m/s)", values=(0.0, fastest)
    )
