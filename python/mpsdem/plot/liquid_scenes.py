"""The liquid's recorded particles as they lie in the pipe: in sections, and lengthwise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mpsdem.plot.drawing import (
    BOTTOM,
    LEFT,
    RIGHT,
    SECTION,
    THINNEST,
    TOP,
    bore_section,
    colour_bar,
    dots_at,
    scene_heading,
    strips_along,
    ticks_in_metres,
)
from mpsdem.plot.frames import chosen_frames, when
from mpsdem.plot.style import PRESSURE_COLOURS, SPEED_COLOURS, axes_at, style
from mpsdem.results import Results

FloatArray = NDArray[np.float64]

_LIQUID = 2  # the kind of a particle of liquid
_FEWEST, _MOST = 300, 900  # particles in a section: to fill it, and to tell them apart
_STRIP_MOST = 5000  # particles in a lengthwise picture
_STRIP_SHARE = 0.15  # of the bore's radius: as far from the middle plane a particle is shown
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
        Seen against the flow, one column per time. Shows the particles within half a bore radius of
        the section; of many the nearest, of few also farther ones. Pressure about its mean over
        the recorded particles, mean gradient and static head apart.
    """
    pipe = results.case.pipe
    frames = chosen_frames(results, times)
    liquids = [_particles(results, frame) for frame in frames]
    slabs = [_slab(liquid.position[:, 0], pipe.length, pipe.radius) for liquid in liquids]
    rows = (
        ("velocity", [x.velocity for x in liquids], SPEED_COLOURS, "axial velocity (m/s)"),
        ("pressure", [x.pressure for x in liquids], PRESSURE_COLOURS, "pressure (Pa)"),
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
                bore_section(axes, pipe.radius)
                dots_at(
                    axes,
                    liquids[column].position[slab, 1:],
                    values[column][slab],
                    norm,
                    colours,
                    area=np.pi * pipe.radius**2,
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
        One strip per time, the earliest on top; shows the particles within 0.15 bore radii of the
        plane, of many the nearest.
    """
    pipe = results.case.pipe
    frames = chosen_frames(results, times)
    liquids = [_particles(results, frame) for frame in frames]
    values = [liquid.velocity for liquid in liquids]
    with style():
        figure, strips = strips_along(results, frames, "liquid in the middle plane", THINNEST)
        norm = _norm(values, even=False)
        for axes, liquid in zip(strips, liquids, strict=True):
            aside = np.abs(liquid.position[:, 1])
            order = np.argsort(aside, kind="stable")
            near = order[aside[order] <= _STRIP_SHARE * pipe.radius][:_STRIP_MOST][::-1]
            dots_at(
                axes,
                liquid.position[near][:, [0, 2]],
                liquid.velocity[near],
                norm,
                SPEED_COLOURS,
                area=2 * pipe.radius * pipe.length,
            )
        colour_bar(
            figure, strips, norm, SPEED_COLOURS, label="axial velocity (m/s)", values=_range(values)
        )
    return figure


@dataclass(frozen=True, slots=True, kw_only=True)
class _Particles:
    """The recorded particles of liquid in one frame, without those of the wall."""

    position: FloatArray  # (m, 3) [m]
    velocity: FloatArray  # (m,) axial [m/s]
    pressure: FloatArray  # (m,) about its mean [Pa]


def _particles(results: Results, frame: int) -> _Particles:
    liquid = results.liquid
    flows = liquid.kind == _LIQUID
    pressure = liquid.pressure[frame][flows]
    return _Particles(
        position=liquid.position[frame][flows],
        velocity=liquid.velocity[frame][flows, 0],
        pressure=pressure - pressure.mean() if pressure.size else pressure,
    )


def _slab(x: FloatArray, length: float, radius: float) -> NDArray[np.intp]:
    """The particles of a section halfway along the pipe, those nearest to it last."""
    away = np.abs(x - length / 2)
    count = np.clip(np.count_nonzero(away <= radius / 2), _FEWEST, _MOST)
    return np.argsort(away, kind="stable")[:count][::-1]


def _range(values: Sequence[FloatArray]) -> tuple[float, float]:
    every = np.concatenate(values)
    return (float(every.min()), float(every.max())) if every.size else (0.0, 0.0)


def _norm(values: Sequence[FloatArray], *, even: bool) -> Normalize:
    """Colours over what is usual, with zero at their end, or in their middle where `even`."""
    every = np.concatenate(values)
    low, high = np.quantile(every, _USUAL) if every.size else (0.0, 0.0)
    low, high = float(min(low, 0.0)), float(max(high, 0.0))
    if even:
        low, high = min(low, -high), max(high, -low)
    return Normalize(low, high) if high > low else Normalize(-1.0 if even else 0.0, 1.0)
