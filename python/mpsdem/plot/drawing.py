"""What several figures share: strips along the pipe, sections, spheres, scales, legends."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import EllipseCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patches import Circle
from numpy.typing import NDArray
from scipy.spatial import cKDTree  # type: ignore[import-untyped, unused-ignore]

from mpsdem.plot.frames import heading, when
from mpsdem.plot.style import BORE, INK, SPEED_COLOURS, axes_at
from mpsdem.results import Results

FloatArray = NDArray[np.float64]

STRIP_WIDTH = 8.4  # [in] of a pipe seen from the side
THINNEST, THICKEST = 0.32, 1.6  # [in] heights of such a strip
SECTION = 1.35  # [in] diameter of a cross-section
LEFT, RIGHT, TOP, BOTTOM = 1.2, 0.9, 0.45, 0.6  # [in] margins
_FINENESS = 150  # pixels of a picture per inch


def strips_along(
    results: Results, frames: Sequence[int], subject: str, thinnest: float
) -> tuple[Figure, list[Axes]]:
    """A strip per frame of the pipe seen from the side, the earliest on top, in one figure."""
    pipe = results.case.pipe
    true_height = STRIP_WIDTH * 2 * pipe.radius / pipe.length
    height = float(np.clip(true_height, thinnest, THICKEST))
    width = STRIP_WIDTH * min(1.0, height / true_height)
    gap = 0.14
    figure = Figure(figsize=(LEFT + width + RIGHT, TOP + len(frames) * (height + gap) + BOTTOM))
    strips = []
    for k, frame in enumerate(frames):
        bottom = BOTTOM + (len(frames) - 1 - k) * (height + gap)
        axes = axes_at(figure, LEFT, bottom, width, height)
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
    scene_heading(figure, results, subject + note)
    return figure, strips


def scene_heading(figure: Figure, results: Results, subject: str) -> None:
    """The title of a figure of several pictures, over the leftmost."""
    height = figure.get_size_inches()[1]
    left = LEFT / figure.get_size_inches()[0]
    figure.text(left, 1 - 0.32 / height, heading(results, subject), weight="bold", size=10)


def bore_section(axes: Axes, radius: float) -> Circle:
    """An empty cross-section of the bore, of equal scale both ways; returns its outline."""
    bore = Circle((0, 0), radius, facecolor=BORE, edgecolor=INK, linewidth=1.0)
    axes.add_patch(bore)
    axes.set(xlim=(-1.03 * radius, 1.03 * radius), ylim=(-1.03 * radius, 1.03 * radius))
    axes.set_aspect("equal")
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.set(xticks=[], yticks=[])
    return bore


def ticks_in_metres(axes: Axes, radius: float) -> None:
    """Scales of a cross-section, at its lower left."""
    axes.spines["left"].set(visible=True, bounds=(-radius, radius))
    axes.spines["bottom"].set(visible=True, bounds=(-radius, radius))
    axes.set(
        xticks=[-radius, 0, radius], yticks=[-radius, 0, radius], xlabel="y (m)", ylabel="z (m)"
    )


def spheres_at(
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


def cells_at(
    axes: Axes, centre: FloatArray, values: FloatArray, norm: Normalize, colours: str
) -> AxesImage:
    """A picture over the whole axes in which each point has the colour of the nearest particle."""
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    box = axes.get_window_extent()
    columns, rows = (
        max(2, round(_FINENESS * s / axes.figure.dpi)) for s in (box.width, box.height)
    )
    x = left + (np.arange(columns) + 0.5) * (right - left) / columns
    y = bottom + (np.arange(rows) + 0.5) * (top - bottom) / rows
    points = np.stack(np.meshgrid(x, y), axis=-1)
    nearest = cKDTree(centre).query(points)[1]
    return axes.imshow(
        values[nearest], cmap=colours, norm=norm, extent=(left, right, bottom, top), origin="lower",
        interpolation="nearest", aspect="auto", zorder=2,
    )  # fmt: skip


def colour_bar(
    figure: Figure,
    axes: Sequence[Axes],
    norm: Normalize,
    colours: str,
    *,
    label: str,
    values: tuple[float, float],
) -> None:
    """A scale to the right of all the axes, pointed where it ends before the values do."""
    across, up = figure.get_size_inches()
    boxes = [a.get_position() for a in axes]
    right, bottom = max(b.x1 for b in boxes), min(b.y0 for b in boxes)
    top = max(b.y1 for b in boxes)
    height = min(top - bottom, 3.0 / up)
    place = (right + 0.15 / across, (top + bottom - height) / 2, 0.12 / across, height)
    low, high = float(norm.vmin or 0.0), float(norm.vmax or 0.0)
    room = 1e-3 * (high - low)
    ends = (values[0] < low - room, values[1] > high + room)
    bar = figure.colorbar(
        ScalarMappable(norm=norm, cmap=colours),
        cax=figure.add_axes(place),
        extend={(True, True): "both", (True, False): "min", (False, True): "max"}.get(
            ends, "neither"
        ),
    )
    bar.set_label(label)
    bar.outline.set_linewidth(0.4)


def curve_figure(
    results: Results, subject: str, size: tuple[float, float] = (8.0, 4.0)
) -> tuple[Figure, Axes]:
    """A figure of one diagram, with its title."""
    figure = Figure(figsize=size, layout="constrained")
    axes = figure.add_subplot()
    axes.set_title(heading(results, subject))
    return figure, axes


def legend_beside(axes: Axes) -> None:
    """A legend to the right of a diagram, where it hides nothing."""
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
