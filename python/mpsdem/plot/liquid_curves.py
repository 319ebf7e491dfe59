"""Curves of a liquid that is computed: its profile, its pressure, and how its solver fared."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from mpsdem.analysis import friction_velocity, laminar_profile, turbulent_profile
from mpsdem.analysis.correlations import LAMINAR_LIMIT
from mpsdem.plot.drawing import legend_beside
from mpsdem.plot.frames import chosen_frames, heading, mean_of, second_half, when
from mpsdem.plot.style import ACCENTS, FAINT, INK, style, time_colours
from mpsdem.results import Results, ResultsError

FloatArray = NDArray[np.float64]

_HISTORY = (
    ("iterations\nper step (-)", ("pressure_iterations",)),
    ("largest\nresidual (-)", ("pressure_residual",)),
    ("divergence\n(-)", ("divergence",)),
    ("scatter of the\ndensity (-)", ("density_scatter",)),
    ("scatter of the\npressure (Pa)", ("pressure_noise",)),
    ("since the last\nframe (-)", ("clamped", "held_back")),
)
_COUNTED = {"clamped": "pressures cut", "held_back": "held back\nfrom the wall"}
_SINCE_LAST_FRAME = {"pressure_iterations", "pressure_residual", *_COUNTED}
_COLOURS = (ACCENTS[2], ACCENTS[0])
_POINTS: dict[str, Any] = {"linewidth": 1.0, "marker": ".", "markersize": 3}


def liquid_velocity_profile(results: Results, times: Sequence[float] | None = None) -> Figure:
    """Mean axial velocity of a computed liquid over the distance from the axis.

    Parameters
    ----------
    results : Results
        A run with a computed liquid.
    times : sequence of float, optional
        When to look [s]; by default at the start and after successive halves of the run.

    Returns
    -------
    Figure
        With the parabola of the same bulk velocity below a Reynolds number of 2300, above it with
        the log law of the friction velocity that the loss of pressure gives, less the drag of the
        solids; then a second diagram shows both in wall units.
    """
    pipe, radius, profile = results.case.pipe, results.liquid.profile_radius, _profile(results)
    frames = chosen_frames(results, times)
    later = second_half(results)
    mean, span = mean_of(results, later, profile)
    theory, label, u_star = _theory(results, later)
    with style():
        figure = Figure(figsize=(10.0 if u_star else 7.2, 4.2), layout="constrained")
        axes = figure.add_subplot(1, 2 if u_star else 1, 1)
        axes.set_title(heading(results, "velocity profile"))
        _plot(axes, radius, mean, color=FAINT, linewidth=5, label=f"mean, {span}")
        for frame, colour in zip(frames, time_colours(len(frames)), strict=True):
            _plot(
                axes, radius, profile(frame), color=colour, linewidth=1.0,
                label=when(results.time[frame]),
            )  # fmt: skip
        r = np.linspace(0, pipe.radius, 400)
        axes.plot(r, theory(r), color=INK, linestyle="--", linewidth=1.2, label=label)
        axes.set(xlim=(0, pipe.radius), xlabel="distance from the axis (m)")
        axes.set_ylabel("mean axial velocity (m/s)")
        if u_star:
            axes.legend(loc="lower left")
            _in_wall_units(figure.add_subplot(1, 2, 2), results, mean, theory, u_star)
        else:
            legend_beside(axes)
    return figure


def pressure_along_axis(results: Results, times: Sequence[float] | None = None) -> Figure:
    """Pressure of a computed liquid along the pipe, static head apart.

    Parameters
    ----------
    results : Results
        A run with a computed liquid.
    times : sequence of float, optional
        When to look [s]; by default at the start and after successive halves of the run.

    Returns
    -------
    Figure
        Above the whole pressure, from 0 at the inlet; below what is left of it without the mean
        gradient.
    """
    x, rest = results.liquid.section_position, results.liquid.section_pressure
    gradient = results.pressure_gradient
    frames = chosen_frames(results, times)
    with style():
        figure = Figure(figsize=(8.0, 5.0), layout="constrained")
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        above.set_title(heading(results, "pressure along the pipe"))
        for frame, colour in zip(frames, time_colours(len(frames)), strict=True):
            p, label = rest[frame], when(results.time[frame])
            _plot(above, x, p - gradient[frame] * x, color=colour, label=label)
            _plot(below, x, p, color=colour)
        above.set_ylabel("pressure (Pa)")
        below.set_ylabel("without its\nmean gradient (Pa)")
        below.set(xlim=(0, results.case.pipe.length), xlabel="distance from the inlet x (m)")
        legend_beside(above)
        figure.align_ylabels()
    return figure


def solver_history(results: Results) -> Figure:
    """How a computed liquid fared: its pressure equation, its scatter, what had to be cut.

    Parameters
    ----------
    results : Results
        A run with a computed liquid.

    Returns
    -------
    Figure
        One diagram for each of what was recorded, against time.

    Raises
    ------
    ResultsError
        If nothing of it was recorded.
    """
    recorded, time = results.diagnostics, results.time
    rows = [
        (label, {name: recorded[name] for name in names if name in recorded})
        for label, names in _HISTORY
    ]
    rows = [row for row in rows if row[1]]
    if not rows:
        raise ResultsError(f"the run in {results.directory} has no liquid that is computed")
    with style():
        figure = Figure(figsize=(8.0, 0.9 + 1.15 * len(rows)), layout="constrained")
        panels = figure.subplots(len(rows), 1, sharex=True, squeeze=False)[:, 0]
        panels[0].set_title(heading(results, "how the liquid was solved"))
        for axes, (label, curves) in zip(panels, rows, strict=True):
            counts = curves.keys() <= _COUNTED.keys()
            for (name, values), colour in zip(curves.items(), _COLOURS, strict=False):
                since = slice(name in _SINCE_LAST_FRAME, None)
                axes.plot(
                    time[since], values[since], color=colour, label=_COUNTED.get(name), **_POINTS
                )
            highest = float(max(values.max() for values in curves.values()))
            if "pressure_residual" in curves and highest > 0:
                lowest = float(min(values[values > 0].min() for values in curves.values()))
                axes.set(yscale="log", ylim=(lowest / 10, highest * 10))
            else:
                axes.set_ylim(0, 1.12 * highest or 1.0)
                axes.yaxis.set_major_locator(MaxNLocator(3, integer=counts))
            if counts:
                legend_beside(axes)
            axes.set_ylabel(label)
        panels[-1].set(xlim=(time[0], time[-1] or 1.0), xlabel="time (s)")
        figure.align_ylabels()
    return figure


def _profile(results: Results) -> Callable[[int], FloatArray]:
    profile = results.liquid.velocity_profile
    return lambda frame: profile[frame]


def _theory(
    results: Results, frames: Sequence[int]
) -> tuple[Callable[[FloatArray], FloatArray], str, float]:
    """What the profile should be, its name, and the friction velocity [m/s] of a turbulent one."""
    pipe, liquid, recorded = results.case.pipe, results.case.liquid, results.diagnostics
    assert liquid is not None
    bulk = liquid.bulk_velocity or 0.0
    if "bulk_velocity" in recorded:
        bulk = float(recorded["bulk_velocity"][frames].mean())
    nu = liquid.kinematic_viscosity
    if abs(bulk) * 2 * pipe.radius < LAMINAR_LIMIT * nu:
        laminar = partial(laminar_profile, pipe_radius=pipe.radius, bulk_velocity=bulk)
        return laminar, "parabola", 0.0
    loss = float(results.pressure_gradient[frames].mean())
    if "pressure_gradient_solids" in recorded:
        loss -= float(recorded["pressure_gradient_solids"][frames].mean())
    u_star = friction_velocity(loss, pipe_radius=pipe.radius, density=liquid.density)
    turbulent = partial(
        turbulent_profile,
        pipe_radius=pipe.radius,
        friction_velocity=u_star,
        kinematic_viscosity=nu,
        roughness=pipe.roughness,
    )
    return turbulent, f"log law, u* = {u_star:.3g} m/s", u_star


def _in_wall_units(
    axes: Axes,
    results: Results,
    mean: FloatArray,
    theory: Callable[[FloatArray], FloatArray],
    u_star: float,
) -> None:
    pipe, liquid = results.case.pipe, results.case.liquid
    assert liquid is not None
    per_metre = abs(u_star) / liquid.kinematic_viscosity
    y = pipe.radius - results.liquid.profile_radius
    nearest = min(float(y[y > 0].min(initial=pipe.radius)), 10 / per_metre)
    along = np.geomspace(nearest / 2, pipe.radius, 300)
    axes.plot(
        along * per_metre, theory(pipe.radius - along) / u_star, color=INK, linestyle="--",
        linewidth=1.2, label="log law",
    )  # fmt: skip
    axes.plot(
        y * per_metre, mean / u_star, "o", color=ACCENTS[2], markersize=4, label="liquid, mean"
    )
    axes.set_xscale("log")
    axes.set_title("the mean, in wall units")
    axes.set(xlabel="distance from the wall y+ (-)", ylabel="mean axial velocity u+ (-)")
    axes.set_ylim(bottom=0)
    axes.legend(loc="lower right")


def _plot(axes: Axes, x: FloatArray, values: FloatArray, **look: Any) -> None:
    """A curve through what is known: bins without particles are bridged."""
    known = np.isfinite(values)
    axes.plot(x[known], values[known], **look)
