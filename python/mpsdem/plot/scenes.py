"""The solids as they lie in the pipe: from the side, in sections, in outline."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import EllipseCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import NDArray

from mpsdem.analysis import extent, silhouette
from mpsdem.plot.frames import chosen_frames, heading, when
from mpsdem.plot.style import BORE, INK, SPEED_COLOURS, axes_at, style
from mpsdem.results import Results

FloatArray = NDArray[np.float64]

_STRIP_WIDTH = 8.4  # [in] of a pipe seen from the side
_THINNEST, _THICKEST = 0.32, 1.6  # [in] heights of such a strip
_SECTION = 1.35  # [in] diameter of a cross-section
_LEFT, _RIGHT, _TOP, _BOTTOM = 1.2, 0.9, 0.45, 0.6  # [in] margins


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
        figure, strips = _strips(results, frames, "side view", _THINNEST)
        norm = _speed_norm(results, frames)
        for axes, frame in zip(strips, frames, strict=True):
            position, speed = solids.position[frame], _speed(results, frame)
            nearest_last = np.argsort(-position[:, 1], kind="stable")
            _spheres(
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
        figure, strips = _strips(results, frames, "outline of the solids", 0.6)
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
        row_height = _SECTION + note + gap
        figure = Figure(
            figsize=(
                _LEFT + len(frames) * (_SECTION + gap) + _RIGHT,
                _TOP + 0.25 + len(names) * row_height + _BOTTOM,
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
                    _LEFT + column * (_SECTION + gap),
                    _BOTTOM + (len(names) - 1 - row) * row_height,
                    _SECTION,
                    _SECTION,
                )
                ahead = np.remainder(position[:, 0] - station + pipe.length / 2, pipe.length)
                ahead -= pipe.length / 2
                shown = np.flatnonzero(np.abs(ahead) <= pipe.radius / 2)
                shown = shown[np.argsort(ahead[shown], kind="stable")]
                _bore_section(axes, pipe.radius)
                _spheres(axes, position[shown, 1:], solids.radius[shown], speed[shown], norm)
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
        _ticks_in_metres(corner, pipe.radius)
        _heading(figure, results, f"sections at the {' / '.join(names)} of the solids")
        _speed_bar(figure, all_axes, norm, results, frames)
    return figure


def _strips(
    results: Results, frames: Sequence[int], subject: str, thinnest: float
) -> tuple[Figure, list[Axes]]:
    pipe = results.case.pipe
    true_height = _STRIP_WIDTH * 2 * pipe.radius / pipe.length
    height = float(np.clip(true_height, thinnest, _THICKEST))
    width = _STRIP_WIDTH * min(1.0, height / true_height)
    gap = 0.14
    figure = Figure(figsize=(_LEFT + width + _RIGHT, _TOP + len(frames) * (height + gap) + _BOTTOM))
    strips = []
    for k, frame in enumerate(frames):
        bottom = _BOTTOM + (len(frames) - 1 - k) * (height + gap)
        axes = axes_at(figure, _LEFT, bottom, width, height)
        axes.set(xlim=(0, pipe.length), ylim=(-1.04 * pipe.radius, 1.04 * pipe.radius))
        axes.axhspan(-pipe.radius, pipe.radius, color=BORE, zorder=0)
        for wall in (-pipe.radius, pipe.radius):
            axes.axhline(wall, color=INK, linewidth=1.0, zorder=3)
        axes.grid(visible=False)
        axes.spines[:].set_visible(False)
        axes.set_yticks([])
        axes.tick_params(bottom=False, labelbottom=False)
        axes.text(
            -0.62 / width, 0.5, when(results.time[frame]), transform=axes.transAxes, ha="right",
            va="center", weight="bold",
        )  # fmt: skip
        strips.append(axes)
    lowest = strips[-1]
    lowest.tick_params(bottom=True, labelbottom=True)
    lowest.set(xlabel="distance from the inlet x (m)", yticks=[-pipe.radius, pipe.radius])
    lowest.set_ylabel("z (m)", rotation="horizontal", va="center", labelpad=-8)
    stretch = height / (width * 2 * pipe.radius / pipe.length)
    note = "" if stretch < 1.01 else f" (heights drawn {stretch:.3g} times as large as lengths)"
    _heading(figure, results, subject + note)
    return figure, strips


def _heading(figure: Figure, results: Results, subject: str) -> None:
    height = figure.get_size_inches()[1]
    left = _LEFT / figure.get_size_inches()[0]
    figure.text(left, 1 - 0.32 / height, heading(results, subject), weight="bold", size=10)


def _bore_section(axes: Axes, radius: float) -> None:
    axes.add_patch(Circle((0, 0), radius, facecolor=BORE, edgecolor=INK, linewidth=1.0))
    axes.set(xlim=(-1.03 * radius, 1.03 * radius), ylim=(-1.03 * radius, 1.03 * radius))
    axes.set_aspect("equal")
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.set(xticks=[], yticks=[])


def _ticks_in_metres(axes: Axes, radius: float) -> None:
    axes.spines["left"].set(visible=True, bounds=(-radius, radius))
    axes.spines["bottom"].set(visible=True, bounds=(-radius, radius))
    axes.set(
        xticks=[-radius, 0, radius], yticks=[-radius, 0, radius], xlabel="y (m)", ylabel="z (m)"
    )


def _spheres(
    axes: Axes,
    centre: FloatArray,
    radius: FloatArray,
    speed: FloatArray,
    norm: Normalize,
    *,
    period: float | None = None,
) -> None:
    """Spheres at their true size; those across a periodic end are drawn at both."""
    if period is not None:
        shifted = [centre + np.array([shift, 0.0]) for shift in (-period, 0.0, period)]
        seen = [(c[:, 0] > -radius) & (c[:, 0] < period + radius) for c in shifted]
        centre = np.concatenate([c[s] for c, s in zip(shifted, seen, strict=True)])
        radius, speed = (np.concatenate([a[s] for s in seen]) for a in (radius, speed))
    size = 2 * radius
    left, right = axes.get_xlim()
    points_per_metre = 72 * axes.get_window_extent().width / axes.figure.dpi / (right - left)
    spheres = EllipseCollection(
        widths=size,
        heights=size,
        angles=np.zeros_like(size),
        units="xy",
        offsets=centre,
        offset_transform=axes.transData,
        edgecolors=(0, 0, 0, 0.6),
        linewidths=np.minimum(0.05 * size * points_per_metre, 0.4),
        cmap=SPEED_COLOURS,
        norm=norm,
        zorder=2,
    )
    spheres.set_array(speed)
    axes.add_collection(spheres, autolim=False)


def _speed(results: Results, frame: int) -> FloatArray:
    return np.asarray(np.linalg.norm(results.solids.velocity[frame], axis=1))


def _speed_norm(results: Results, frames: Sequence[int]) -> Normalize:
    """Colours from rest to the bulk velocity, or to the fastest solid where nothing flows."""
    liquid = results.case.liquid
    top = abs(liquid.bulk_velocity) if liquid is not None else 0.0
    fastest = max(float(_speed(results, frame).max()) for frame in frames)
    return Normalize(0.0, top or fastest or 1.0)


def _speed_bar(
    figure: Figure, axes: Sequence[Axes], norm: Normalize, results: Results, frames: Sequence[int]
) -> None:
    across, up = figure.get_size_inches()
    boxes = [a.get_position() for a in axes]
    right, bottom = max(b.x1 for b in boxes), min(b.y0 for b in boxes)
    top = max(b.y1 for b in boxes)
    height = min(top - bottom, 3.0 / up)
    place = (right + 0.15 / across, (top + bottom - height) / 2, 0.12 / across, height)
    beyond = max(float(_speed(results, frame).max()) for frame in frames) > (norm.vmax or 0) * 1.001
    bar = figure.colorbar(
        ScalarMappable(norm=norm, cmap=SPEED_COLOURS),
        cax=figure.add_axes(place),
        extend="max" if beyond else "neither",
    )
    bar.set_label("speed of the solids (m/s)")
    bar.outline.set_linewidth(0.4)
