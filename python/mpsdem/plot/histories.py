"""How the transport goes over time, and where along the pipe."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mpsdem.analysis import Survey, survey
from mpsdem.plot.drawing import legend_beside
from mpsdem.plot.frames import heading
from mpsdem.plot.style import ACCENTS, FAINT, FRACTION_COLOURS, INK, SPEED_COLOURS, style
from mpsdem.results import Results

FloatArray = NDArray[np.float64]


def transport_history(results: Results, found: Survey | None = None) -> Figure:
    """Velocities, concentrations and bed over time.

    Parameters
    ----------
    results : Results
        A run with solids.
    found : Survey, optional
        The run's survey, if it is there already.

    Returns
    -------
    Figure
        Mean velocities of solids, bed and liquid; concentration in situ and delivered; height
        below which 95 % of the solids lie; share of the solids in the bed. Means with their
        standard error as bands over the window, and the regime in the title.
    """
    found = found or survey(results)
    solids, recorded = found.solids, results.diagnostics
    assert solids is not None
    insitu, time = solids.insitu_concentration, solids.time
    bulk = (
        np.interp(time, results.time, recorded["bulk_velocity"])
        if "bulk_velocity" in recorded
        else None
    )
    with style():
        figure = Figure(figsize=(9.0, 7.4), layout="constrained")
        velocity, concentration, height, share = figure.subplots(
            4, 1, sharex=True, height_ratios=(3, 2, 2, 1.5)
        )
        regime = f", {found.regime.regime}" if found.regime is not None else ""
        velocity.set_title(heading(results, f"transport over time{regime}"))
        if "liquid_flux" in recorded:
            liquid = recorded["liquid_flux"] / (1 - insitu)
            velocity.plot(results.time, liquid, color=ACCENTS[2], label="liquid")
            _mark(velocity, found, "liquid_mean_velocity", ACCENTS[2])
        velocity.plot(time, solids.mean_velocity, color=INK, label="solids")
        _mark(velocity, found, "solids_mean_velocity", INK)
        if np.isfinite(solids.bed_velocity).any():
            velocity.plot(
                time, solids.bed_velocity, color=ACCENTS[0], linewidth=1.0, linestyle="--",
                label="bed",
            )  # fmt: skip
        velocity.set_ylabel("mean axial\nvelocity (m/s)")
        concentration.axhline(insitu, color=INK, label="in situ")
        if bulk is not None and bulk.all():
            delivered = insitu * solids.mean_velocity / bulk
            concentration.plot(time, delivered, color=ACCENTS[2], label="delivered")
            _mark(concentration, found, "delivered_concentration", ACCENTS[2])
        concentration.set_ylabel("concentration\n(-)")
        concentration.set_ylim(bottom=min(0.0, concentration.get_ylim()[0]))
        height.plot(time, solids.bed_height, color=ACCENTS[0], label="95 % of solids\nlie below")
        _mark(height, found, "bed_height", ACCENTS[0])
        height.set(ylim=(0, 2 * results.case.pipe.radius), ylabel="height above\nbottom (m)")
        share.plot(time, solids.bed_share, color=INK, label="in the bed")
        _mark(share, found, "bed_share", INK)
        share.set(ylim=(-0.03, 1.03), ylabel="share of the\nsolids (-)")
        share.set(xlim=(time[0], time[-1] or 1.0), xlabel="time (s)")
        for axes in (velocity, concentration, height, share):
            legend_beside(axes)
        figure.align_ylabels()
    return figure


def along_the_pipe(results: Results, found: Survey | None = None) -> Figure:
    """Volume fraction, velocity and bed of the solids over time and along the pipe.

    Parameters
    ----------
    results : Results
        A run with solids.
    found : Survey, optional
        The run's survey, if it is there already.

    Returns
    -------
    Figure
        Three pictures, time upwards: dunes are bands, their slope is their speed. A plug is marked.
    """
    found = found or survey(results)
    solids, pipe = found.solids, results.case.pipe
    assert solids is not None
    moving = np.divide(
        solids.flux, solids.fraction, out=np.full_like(solids.flux, np.nan),
        where=solids.fraction > 0,
    )  # fmt: skip
    pictures = (
        ("volume fraction (-)", solids.fraction, FRACTION_COLOURS, 0.0),
        ("axial velocity (m/s)", moving, SPEED_COLOURS, None),
        ("height of the bed (m)", solids.bed_surface, FRACTION_COLOURS, 0.0),
    )
    with style():
        figure = Figure(figsize=(12.0, 4.6), layout="constrained")
        figure.suptitle(heading(results, "solids along the pipe, over time"), x=0.01, ha="left")
        panels = figure.subplots(1, 3, sharex=True, sharey=True)
        for axes, (label, values, colours, low) in zip(panels, pictures, strict=True):
            norm = _usual(values, low)
            picture = axes.pcolormesh(
                _borders(solids.station, (0.0, pipe.length)), _borders(solids.time, None), values,
                cmap=colours, norm=norm, rasterized=True,
            )  # fmt: skip
            axes.set_facecolor("white")
            axes.grid(visible=False)
            bar = figure.colorbar(picture, ax=axes, location="top", shrink=0.9, extend="max")
            bar.set_label(label)
            bar.outline.set_linewidth(0.4)
            axes.set_xlabel("distance from the inlet x (m)")
            if found.blockage is not None and (plug := found.blockage.plug) is not None:
                axes.plot(plug.position, plug.time, "x", color=ACCENTS[0], markersize=9)
                axes.annotate(
                    " plug", (plug.position, plug.time), color=ACCENTS[0], weight="bold",
                    va="bottom",
                )  # fmt: skip
        panels[0].set_ylabel("time (s)")
    return figure


def _mark(axes: Axes, found: Survey, name: str, colour: str) -> None:
    """The mean over the window, with its standard error."""
    average = found.averages.get(name)
    if average is None or not average.window[1] > average.window[0]:
        return
    axes.hlines(average.mean, *average.window, color=colour, linewidth=0.8, linestyle=":")
    if np.isfinite(average.error):
        axes.fill_between(
            average.window, average.mean - average.error, average.mean + average.error,
            color=FAINT, alpha=0.5, linewidth=0, zorder=0,
        )  # fmt: skip


def _usual(values: FloatArray, low: float | None) -> Normalize:
    """Colours over what is usual: a start-up does not wash out what follows."""
    known = values[np.isfinite(values)]
    if not known.size:
        return Normalize(0.0, 1.0)
    bottom, top = np.quantile(known, [0.01, 0.99])
    bottom = float(bottom) if low is None else low
    return Normalize(bottom, float(top) if top > bottom else bottom + 1.0)


def _borders(middles: FloatArray, ends: tuple[float, float] | None) -> FloatArray:
    """Borders of cells about places that rise evenly."""
    if middles.size == 1:
        return np.array(ends or (middles[0] - 0.5, middles[0] + 0.5))
    inner = (middles[1:] + middles[:-1]) / 2
    first, last = ends or (middles[0], middles[-1])
    return np.concatenate([[first], inner, [last]])
