"""What pumping the solids costs, beside what engineers expect of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mpsdem.analysis.head_loss import (
    MODELS,
    Conveying,
    Measured,
    hydraulic_gradient,
    inclined_gradient,
    measured,
)
from mpsdem.analysis.head_loss.dhlldv import limit_deposit_velocity
from mpsdem.plot.drawing import curve_figure, legend_beside
from mpsdem.plot.style import FAINT, INK, style
from mpsdem.results import Results, ResultsError

FloatArray = NDArray[np.float64]

_COLOURS = ("#2a6f97", "#5b8e3e", "#c98a1b", "#8a5a9e")
_BEYOND = (0, (1, 2))  # dotted: the model does not hold there
_POINTS = 160
_SAME = ("pipe_diameter", "diameter", "density", "liquid_density", "concentration")
_ROOM = 0.02  # relative, that concentrations of random arrangements may differ


def draw_head_loss(results: Sequence[Results]) -> Figure:
    """Hydraulic gradient over bulk velocity: the runs' own points before the correlations.

    Parameters
    ----------
    results : sequence of Results
        One run, or several that differ in velocity alone. Each is `comparable`.

    Returns
    -------
    Figure
        A curve is full where its model holds, dotted where it does not. Models of a delivered
        concentration get that of the runs, interpolated between them. Error bars are two standard
        errors. In a pipe that rises the curves are turned after Worster and Denny.

    Raises
    ------
    ResultsError
        If a run has nothing to show here, or the runs differ in more than velocity.
    """
    if not results:
        raise ResultsError("draw_head_loss needs at least one run")
    points = sorted((measured(run) for run in results), key=lambda p: p.flow.bulk_velocity)
    _require_one_scene(points)
    velocity = np.array([point.flow.bulk_velocity for point in points])
    delivered = np.array([point.delivered for point in points])
    sweep = np.linspace(0.4 * velocity[0], 1.35 * velocity[-1], _POINTS)
    scene = points[0]
    with style():
        figure, axes = curve_figure(results[0], _subject(scene), size=(8.4, 4.6))
        clear = _curve(sweep, scene, lambda flow: flow.clear_gradient, weight=0.0)
        axes.plot(sweep, clear, color=INK, linewidth=0.9, linestyle="--", label="liquid alone")
        for model, colour in zip(MODELS, _COLOURS, strict=True):
            share = (
                np.full(sweep.size, scene.flow.concentration)
                if model.concentration == "in-situ"
                else np.interp(sweep, velocity, delivered)
            )
            loss = _curve(sweep, scene, model.gradient, share)
            holds = np.array(
                [
                    not model.outside(replace(scene.flow, bulk_velocity=float(u), concentration=c))
                    for u, c in zip(sweep, share, strict=True)
                ]
            )
            label = f"{model.name},\n{_of(model.concentration, points)}"
            inside, outside = (label, None) if holds.any() else (None, label)
            axes.plot(
                sweep, loss, color=colour, linestyle=_BEYOND, linewidth=1.0, label=outside
            )  # fmt: skip
            axes.plot(sweep, np.where(holds, loss, np.nan), color=colour, label=inside)
        heads = np.array([_head(point.gradient, point.flow) for point in points])
        bars = np.array([_head(2 * point.error, point.flow) for point in points])
        axes.errorbar(
            velocity, heads, yerr=bars, color=INK, marker="o", markersize=5, capsize=3,
            linestyle="none", zorder=5, label="this run" if len(points) == 1 else "these runs",
        )  # fmt: skip
        axes.set(xlim=(0, sweep[-1]), ylim=(min(0.0, 1.2 * heads.min()), _top(points, heads)))
        _mark_limit(axes, scene)
        axes.set_xlabel("bulk velocity of liquid and solids (m/s)")
        axes.set_ylabel("loss of pressure (m of liquid per m of pipe)")
        legend_beside(axes)
        axes.text(
            1.015, 0.0, "dotted: beyond the\nrange of the model", transform=axes.transAxes, size=8
        )  # fmt: skip
    return figure


def _curve(
    sweep: FloatArray,
    scene: Measured,
    gradient: Callable[[Conveying], float],
    share: FloatArray | None = None,
    weight: float = 1.0,
) -> FloatArray:
    """Metres of liquid per metre of the scene at other velocities and concentrations."""
    values = []
    for k, u in enumerate(sweep):
        concentration = scene.flow.concentration if share is None else float(share[k])
        flow = replace(scene.flow, bulk_velocity=float(u), concentration=concentration)
        loss = inclined_gradient(
            gradient(flow),
            clear=flow.clear_gradient,
            bed_weight=weight * scene.flow.bed_weight,
            inclination=scene.inclination,
        )
        values.append(_head(loss, flow))
    return np.array(values)


def _top(points: Sequence[Measured], heads: FloatArray) -> float:
    """Height of the diagram: of the points and the models there, but what is twice as large."""
    expected = [
        model.gradient(
            replace(point.flow, concentration=point.delivered)
            if model.concentration == "delivered"
            else point.flow
        )
        for point in points
        for model in MODELS
    ]
    most = max(_head(loss, points[0].flow) for loss in expected)
    return 1.2 * float(max(heads.max(), min(most, 2 * heads.max())))


def _head(gradient: float, flow: Conveying) -> float:
    return hydraulic_gradient(gradient, liquid_density=flow.liquid_density, gravity=flow.gravity)


def _of(concentration: str, points: Sequence[Measured]) -> str:
    if concentration == "in-situ":
        return f"in situ {points[0].flow.concentration:.3g}"
    least, most = (f"{pick(p.delivered for p in points):.3g}" for pick in (min, max))
    return f"delivered {least}" if least == most else f"delivered {least} to {most}"


def _subject(scene: Measured) -> str:
    if abs(scene.inclination) < 1e-3:
        return "head loss"
    verb = "rises" if scene.inclination > 0 else "falls"
    return f"head loss, pipe {verb} by {abs(math.degrees(scene.inclination)):.3g} deg"


def _mark_limit(axes: Axes, scene: Measured) -> None:
    """The velocity above which no bed is left, where it can be seen."""
    if scene.flow.concentration <= 0 or abs(scene.inclination) >= 1e-3:
        return
    limit = limit_deposit_velocity(scene.flow)
    if limit < axes.get_xlim()[1]:
        axes.axvline(limit, color=FAINT, linewidth=1.0, zorder=1)
        axes.text(limit, axes.get_ylim()[0], " limit deposit velocity (DHLLDV)", rotation=90,
                  va="bottom", ha="right", size=7.5, color=INK)  # fmt: skip


def _require_one_scene(points: Sequence[Measured]) -> None:
    for point in points[1:]:
        for name in _SAME:
            first, other = getattr(points[0].flow, name), getattr(point.flow, name)
            if not math.isclose(first, other, rel_tol=_ROOM):
                raise ResultsError(
                    f"these runs differ in {name}, {first:g} and {other:g}: one figure holds runs "
                    "that differ in velocity alone"
                )
        if point.inclination != points[0].inclination:
            raise ResultsError("these runs differ in inclination: draw them one by one")
