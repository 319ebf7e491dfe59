"""What changes across the pipe: volume fraction and velocity over height, radius and section."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.ticker import NullLocator
from numpy.typing import NDArray

from mpsdem.analysis import (
    Profile,
    Survey,
    height_edges,
    survey,
    velocity_over_height,
    volume_fraction_over_height,
)
from mpsdem.plot.drawing import legend_beside
from mpsdem.plot.frames import chosen_frames, heading, when
from mpsdem.plot.style import ACCENTS, FAINT, FRACTION_COLOURS, INK, style, time_colours
from mpsdem.results import Results

FloatArray = NDArray[np.float64]

_SLABS = 40


def solids_fraction(
    results: Results, times: Sequence[float] | None = None, found: Survey | None = None
) -> Figure:
    """Volume fraction of the solids over height, over radius and over the section.

    Parameters
    ----------
    results : Results
        A run with solids.
    times : sequence of float, optional
        When to look [s]; by default at the start and after successive halves of the run.
    found : Survey, optional
        The run's survey, if it is there already.

    Returns
    -------
    Figure
        Means over the length of the pipe: one curve per time, and the mean over the window of the
        survey with its standard error as a band.
    """
    pipe, solids = results.case.pipe, results.solids
    found = found or survey(results)
    assert found.solids is not None
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
        figure = Figure(figsize=(12.0, 4.2), layout="constrained")
        figure.suptitle(heading(results, "volume fraction of the solids"), x=0.01, ha="left")
        over_height, over_radius, section = figure.subplots(1, 3, width_ratios=(1.25, 1, 1))
        over_height.set_title("over height")
        height = pipe.radius + (edges[1:] + edges[:-1]) / 2
        _at_times(over_height, results, times, height, profile)
        _band(over_height, found.solids.fraction_over_height, _mean_label(found), upright=True)
        over_height.set(xlabel="volume fraction (-)", ylim=(0, 2 * pipe.radius))
        over_height.set_ylabel("height above the bottom of the bore (m)")
        over_height.set_xlim(left=0)
        over_height.legend(loc="upper right")
        over_radius.set_title(f"over radius, {_mean_label(found)}")
        _band(over_radius, found.solids.fraction_over_radius, None, upright=False)
        over_radius.set(xlabel="distance from the axis (m)", xlim=(0, pipe.radius))
        over_radius.set_ylabel("volume fraction (-)")
        over_radius.set_ylim(bottom=0)
        section.set_title(f"over the section, {_mean_label(found)}")
        _section(figure, section, found.solids.section_edges, found.solids.section, pipe.radius)
    return figure


def velocities(
    results: Results, times: Sequence[float] | None = None, found: Survey | None = None
) -> Figure:
    """Axial velocity of solids and liquid over height, and over radius.

    Parameters
    ----------
    results : Results
        Any run.
    times : sequence of float, optional
        When to look [s]; by default at the start and after successive halves of the run.
    found : Survey, optional
        The run's survey, if it is there already.

    Returns
    -------
    Figure
        Solids as means over slabs and rings, weighted with their volume. A computed liquid
        likewise, dashed, in a second diagram where there are solids; a prescribed one on the
        vertical through the axis.
    """
    radius = results.case.pipe.radius
    found = found or survey(results)
    edges = height_edges(radius, _SLABS)
    layered = results.has_liquid and "layer_velocity" in results.liquid
    both = layered and results.has_solids
    rings = 1 if results.has_solids else 0

    def of_solids(frame: int) -> FloatArray:
        solids = results.solids
        return velocity_over_height(
            solids.position[frame], solids.velocity[frame], solids.radius, edges=edges
        )

    with style():
        count = 1 + both + rings
        figure = Figure(figsize=(6.4 if count == 1 else 4.2 * count, 4.4), layout="constrained")
        diagrams = figure.subplots(1, count, squeeze=False)[0]
        over_height = diagrams[: 1 + both]
        if count > 1:
            figure.suptitle(heading(results, "axial velocity"), x=0.01, ha="left")
            over_height[0].set_title("solids over height" if results.has_solids else "over height")
            over_height[-1].set_title("liquid over height" if both else "over height")
        else:
            over_height[0].set_title(heading(results, "velocity over height"))
        if layered:
            liquid = results.liquid
            _at_times(
                over_height[-1], results, times, radius + liquid.layer_height,
                lambda frame: liquid.layer_velocity[frame], linestyle="--",
            )  # fmt: skip
            _band(over_height[-1], found.liquid_over_height, _mean_label(found), upright=True)
        elif found.liquid_over_height is not None:
            prescribed = found.liquid_over_height
            over_height[0].plot(
                prescribed.mean, prescribed.place, color=INK, linewidth=1.0, linestyle="--",
                label="liquid, prescribed",
            )  # fmt: skip
        if found.solids is not None:
            height = radius + (edges[1:] + edges[:-1]) / 2
            _at_times(over_height[0], results, times, height, of_solids)
            _band(
                over_height[0], found.solids.velocity_over_height, _mean_label(found), upright=True
            )
        for axes in over_height:
            axes.set(xlabel="axial velocity (m/s)", ylim=(0, 2 * radius))
        over_height[0].set_ylabel("height above the bottom of the bore (m)")
        if both:
            lows, highs = zip(*(axes.get_xlim() for axes in over_height), strict=True)
            for axes in over_height:
                axes.set_xlim(min(lows), max(highs))
        legend_beside(over_height[-1])
        if found.solids is not None:
            _over_radius(diagrams[-1], found, radius)
    return figure


def velocity_distribution(results: Results, found: Survey | None = None) -> Figure:
    """How the velocities of the solids are distributed: away from the axis, upwards, along.

    Parameters
    ----------
    results : Results
        A run with solids.
    found : Survey, optional
        The run's survey, if it is there already.

    Returns
    -------
    Figure
        Probability densities over all solids and all frames of the window, on a logarithmic scale.
    """
    found = found or survey(results)
    assert found.solids is not None
    labels = {
        "radial": "radial velocity, outwards (m/s)",
        "vertical": "vertical velocity, upwards (m/s)",
        "horizontal": "horizontal velocity (m/s)",
        "axial": "axial velocity (m/s)",
    }
    with style():
        figure = Figure(figsize=(12.0, 3.6), layout="constrained")
        title = f"velocities of the solids, {_mean_label(found).removeprefix('mean, ')}"
        figure.suptitle(heading(results, title), x=0.01, ha="left")
        for axes, (name, label) in zip(
            figure.subplots(1, len(labels)), labels.items(), strict=True
        ):
            density = found.solids.velocity_densities[name]
            axes.stairs(density.density, density.edges, color=ACCENTS[2], fill=True, alpha=0.25)
            axes.stairs(density.density, density.edges, color=ACCENTS[2], linewidth=1.0)
            axes.axvline(density.mean, color=ACCENTS[0], linewidth=1.0)
            some = density.density[density.density > 0]
            if some.size:
                axes.set_yscale("log")
                axes.yaxis.set_minor_locator(NullLocator())
                axes.set_ylim(some.min() / 2, some.max() * 4)
            axes.set_xlabel(label)
            axes.set_title(
                f"mean {density.mean:.3g}, deviation {density.deviation:.3g} m/s",
                fontsize=8, weight="normal",
            )  # fmt: skip
        figure.axes[0].set_ylabel("probability density (s/m)")
    return figure


def _mean_label(found: Survey) -> str:
    start, end = found.window
    return f"mean, {when(start)} to {when(end)}" if end > start else f"at {when(end)}"


def _band(axes: Axes, profile: Profile | None, label: str | None, *, upright: bool) -> None:
    """A mean with its standard error on either side; the place goes up or to the right."""
    if profile is None:
        return
    error = np.nan_to_num(profile.error)
    low, high = profile.mean - error, profile.mean + error
    if upright:
        axes.fill_betweenx(profile.place, low, high, color=FAINT, alpha=0.6, linewidth=0)
        axes.plot(profile.mean, profile.place, color=FAINT, linewidth=4, zorder=1, label=label)
    else:
        axes.fill_between(profile.place, low, high, color=ACCENTS[2], alpha=0.3, linewidth=0)
        axes.plot(profile.place, profile.mean, color=ACCENTS[2], label=label)


def _at_times(
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
            profile(frame), height, color=colour, linestyle=linestyle, linewidth=1.1,
            label=when(results.time[frame]),
        )  # fmt: skip


def _over_radius(axes: Axes, found: Survey, radius: float) -> None:
    assert found.solids is not None
    axes.set_title(f"over radius, {_mean_label(found)}")
    _band(axes, found.solids.velocity_over_radius, "solids", upright=False)
    if found.liquid_over_radius is not None:
        liquid = found.liquid_over_radius
        known = np.isfinite(liquid.mean)
        axes.plot(
            liquid.place[known], liquid.mean[known], color=INK, linestyle="--", linewidth=1.0,
            label="liquid",
        )  # fmt: skip
        axes.legend(loc="best")
    axes.set(xlabel="distance from the axis (m)", xlim=(0, radius))
    axes.set_ylabel("axial velocity (m/s)")


def _section(
    figure: Figure, axes: Axes, edges: FloatArray, fraction: FloatArray, radius: float
) -> None:
    top = float(np.nanmax(fraction))
    norm = Normalize(0, top or 1.0)
    picture = axes.pcolormesh(edges, edges, fraction.T, cmap=FRACTION_COLOURS, norm=norm)
    bore = Circle((0, 0), radius, fill=False, edgecolor=INK, linewidth=1.0)
    axes.add_patch(bore)
    picture.set_clip_path(bore)
    axes.set_aspect("equal")
    axes.grid(visible=False)
    axes.set(xlim=(-1.03 * radius, 1.03 * radius), ylim=(-1.03 * radius, 1.03 * radius))
    axes.set(xticks=[-radius, 0, radius], yticks=[-radius, 0, radius])
    axes.set(xlabel="y (m)", ylabel="z (m)")
    bar = figure.colorbar(picture, ax=axes, shrink=0.8)
    bar.set_label("volume fraction (-)")
    bar.outline.set_linewidth(0.4)
