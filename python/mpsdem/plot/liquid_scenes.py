"""The liquid's recorded particles as they lie in the pipe: in sections, and lengthwise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import NDArray

from mpsdem.plot.drawing import (
    BOTTOM,
    LEFT,
    RIGHT,
    SECTION,
    THINNEST,
    TOP,
    bore_section,
    cells_at,
    colour_bar,
    scene_heading,
    strips_along,
    ticks_in_metres,
)
from mpsdem.plot.frames import chosen_frames, when
from mpsdem.plot.style import INK, PRESSURE_COLOURS, SPEED_COLOURS, axes_at, style
from mpsdem.results import Results, ResultsError
from mpsdem.results.reader import LIQUID_KIND

FloatArray = NDArray[np.float64]

_FEWEST, _MOST = 300, 900  # particles in a section: to fill it, and to tell them apart
_MOST_LENGTHWISE = 20_000
_USUAL = (0.01, 0.99)  # quantiles between which the colours go


def liquid_sections(results: Results, times: Sequence[float] | None = None) -> Figure:
    """Cross-sections of the liquid halfway along the pipe: axial velocity and pressure.

    Parameters
    ----------
    results : Results
        A run with recorded liquid particles.
    times : sequence of float, optional
        When to look [s]; by default at the start and after successive halves of the run.

    Returns
    -------
    Figure
        Seen against the flow, one column per time; each point has the colour of the nearest
        particle among those within half a bore radius of the section, fewer of many and more of
        few. Pressure less its mean over the recorded particles, mean gradient and head apart. The
        solids that the section cuts, as it cuts them.
    """
    pipe = results.case.pipe
    frames = chosen_frames(results, times)
    liquids = [_particles(results, frame) for frame in frames]
    slabs = [
        _nearest(liquid.position[:, 0] - pipe.length / 2, pipe.radius / 2, _MOST)
        for liquid in liquids
    ]
    rows = (
        ("velocity", [x.velocity for x in liquids], SPEED_COLOURS, "axial velocity\n(m/s)"),
        (
            "pressure",
            [x.pressure for x in liquids],
            PRESSURE_COLOURS,
            "pressure less its\nmean (Pa)",
        ),
    )
    gap, above, between = 0.12, 0.25, 0.25
    with style():
        figure = Figure(
            figsize=(
                LEFT + len(frames) * (SECTION + gap) + RIGHT,
                TOP + above + 2 * SECTION + between + BOTTOM,
            )
        )
        for row, (name, values, colours, label) in enumerate(rows):
            norm = _norm(values, even=name == "pressure")
            row_axes: list[Axes] = []
            for column, frame in enumerate(frames):
                axes = axes_at(
                    figure,
                    LEFT + column * (SECTION + gap),
                    BOTTOM + (1 - row) * (SECTION + between),
                    SECTION,
                    SECTION,
                )
                slab = slabs[column]
                bore = bore_section(axes, pipe.radius)
                centre = liquids[column].position[slab, 1:]
                cells = cells_at(axes, centre, values[column][slab], norm, colours)
                axes.set_aspect("equal")
                cells.set_clip_path(bore)
                colour = INK if name == "pressure" else "white"
                _cut_solids(axes, results, frame, (0, pipe.length / 2), colour)
                axes.add_patch(
                    Circle((0, 0), pipe.radius, fill=False, edgecolor=INK, linewidth=1.0, zorder=3)
                )
                if row == 0:
                    axes.set_title(when(results.time[frame]), loc="center", fontsize=9)
                if column == 0:
                    axes.text(
                        -0.72, 0.5, name, weight="bold", rotation="vertical", va="center",
                        transform=axes.transAxes,
                    )  # fmt: skip
                row_axes.append(axes)
            colour_bar(figure, row_axes, norm, colours, label=label, values=_range(values))
        ticks_in_metres(row_axes[0], pipe.radius)
        scene_heading(figure, results, f"liquid at x = {pipe.length / 2:.3g} m")
    return figure


def liquid_middle_plane(results: Results, times: Sequence[float] | None = None) -> Figure:
    """Axial velocity of the liquid in the upright plane through the axis, at several times.

    Parameters
    ----------
    results : Results
        A run with recorded liquid particles.
    times : sequence of float, optional
        When to look [s]; by default at the start and after successive halves of the run.

    Returns
    -------
    Figure
        One strip per time, the earliest on top; each point has the colour of the nearest particle
        among those within 0.15 bore radii of the plane. The solids that the plane cuts, as it cuts
        them.
    """
    pipe = results.case.pipe
    frames = chosen_frames(results, times)
    liquids = [_particles(results, frame) for frame in frames]
    values = [liquid.velocity for liquid in liquids]
    with style():
        figure, strips = strips_along(results, frames, "liquid in the middle plane", THINNEST)
        norm = _norm(values, even=False)
        for axes, liquid, frame in zip(strips, liquids, frames, strict=True):
            near = _nearest(liquid.position[:, 1], 0.15 * pipe.radius, _MOST_LENGTHWISE)
            centre = liquid.position[near][:, [0, 2]]
            cells_at(axes, centre, liquid.velocity[near], norm, SPEED_COLOURS)
            _cut_solids(axes, results, frame, (1, 0.0), "white")
        colour_bar(
            figure, strips, norm, SPEED_COLOURS, label="axial velocity (m/s)", values=_range(values)
        )
    return figure


def _cut_solids(
    axes: Axes, results: Results, frame: int, plane: tuple[int, float], colour: str
) -> None:
    """Outlines of the solids in a plane, given by the axis across it and its place there [m]."""
    if not results.has_solids:
        return
    across, place = plane
    position, radius = results.solids.position[frame], results.solids.radius
    left = radius**2 - (position[:, across] - place) ** 2
    cut = left > 0
    size = 2 * np.sqrt(left[cut])
    outlines = EllipseCollection(
        widths=size,
        heights=size,
        angles=np.zeros_like(size),
        units="xy",
        offsets=np.delete(position[cut], across, axis=1),
        offset_transform=axes.transData,
        facecolors="none",
        edgecolors=colour,
        linewidths=0.5,
        zorder=2.5,
    )
    axes.add_collection(outlines, autolim=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Particles:
    """The recorded particles of liquid in one frame, without those of the wall."""

    position: FloatArray  # (m, 3) [m]
    velocity: FloatArray  # (m,) axial [m/s]
    pressure: FloatArray  # (m,) about its mean [Pa]


def _particles(results: Results, frame: int) -> _Particles:
    liquid = results.liquid
    if not liquid.has_particles:
        raise ResultsError(f"the run in {results.directory} recorded no particles of liquid")
    position = liquid.position[frame]
    along = (position[:, 0] >= 0) & (position[:, 0] < results.case.pipe.length)
    flows = (liquid.kind == LIQUID_KIND) & along  # with a push plate some are not there
    pressure = liquid.pressure[frame][flows]
    return _Particles(
        position=position[flows],
        velocity=liquid.velocity[frame][flows, 0],
        pressure=pressure - pressure.mean(),
    )


def _nearest(away: FloatArray, reach: float, most: int) -> NDArray[np.intp]:
    """The particles within reach of a plane [m], as long as they are neither few nor many."""
    away = np.abs(away)
    count = np.clip(np.count_nonzero(away <= reach), _FEWEST, most)
    return np.argsort(away, kind="stable")[:count]


def _range(values: Sequence[FloatArray]) -> tuple[float, float]:
    every = np.concatenate(values)
    return float(every.min()), float(every.max())


def _norm(values: Sequence[FloatArray], *, even: bool) -> Normalize:
    """Colours over what is usual; with zero in their middle where `even`."""
    low, high = (float(q) for q in np.quantile(np.concatenate(values), _USUAL))
    if even:
        low, high = min(low, -high), max(high, -low)
    return Normalize(low, high) if high > low else Normalize(low - 0.5, high + 0.5)
