"""What the tables cannot show: the histories of case A, the profiles of case B."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mpsdem.analysis import velocity_density
from mpsdem.plot.style import ACCENTS, FAINT, style
from mpsdem.validation.reproduction import horizontal, inclined
from mpsdem.validation.reproduction.scene import Instant, Scene
from mpsdem.validation.reproduction.statement import Scenes

FloatArray = NDArray[np.float64]

_LINES = {"quick": "--", "balanced": "-", "finest": ":"}
_CASES = (inclined.STILL, inclined.SIDEWAYS, inclined.UPRIGHT)
_NAMES = dict(zip(_CASES, ("1, still", "2, sideways", "3, upright"), strict=True))
_COLOURS = dict(zip(_CASES, (ACCENTS[1], ACCENTS[2], ACCENTS[0]), strict=True))


def of_horizontal(of: Mapping[str, Scenes]) -> Figure:
    """Velocities of the parts of the cluster, and the loss of pressure, over time."""
    with style():
        figure = Figure(figsize=(8.4, 3.3), layout="constrained")
        parts, loss = figure.subplots(1, 2)
        for level, scenes in of.items():
            if horizontal.SCENE not in scenes:
                continue
            scene = scenes[horizontal.SCENE]
            run = scene.starts[0]
            for number, (label, part) in enumerate(_PARTS.items()):
                values = [part(at) for at in scene.instants(until=12.0)]
                colour = (*ACCENTS, "#5b8c5a")[number]
                parts.plot(
                    run.time[: len(values)], values, _LINES[level], color=colour,
                    label=label if level == "balanced" else None,
                )  # fmt: skip
            begun = run.time >= 0.5
            _smooth(loss, run.time[begun], run.pressure_gradient[begun], _LINES[level], level)
        parts.set(
            xlabel="time (s)", ylabel="axial velocity (m/s)", ylim=(0, 1.4),
            title="Case A: solids",
        )  # fmt: skip
        loss.set(
            xlabel="time (s)", ylabel="loss of pressure (Pa/m), mean of 1 s", ylim=(0, None),
            title="Case A: liquid",
        )  # fmt: skip
        parts.legend(ncols=2, loc="lower right")
        loss.legend(loc="lower right")
        return figure


def of_inclined(of: Mapping[str, Scenes]) -> Figure:
    """Volume fraction and velocity over height, loss of pressure in time, spread of velocities."""
    with style():
        figure = Figure(figsize=(8.4, 6.2), layout="constrained")
        (fraction, velocity), (loss, spread) = figure.subplots(2, 2)
        for level, scenes in of.items():
            for case in (case for case in _CASES if case in scenes):
                _over_height(fraction, velocity, scenes[case], _drawn(level, case))
                if level == "balanced":
                    _in_time(loss, spread, scenes[case], _drawn(level, case))
        fraction.axhline(80, color=FAINT)
        fraction.text(0.99, 82, "80 mm", transform=fraction.get_yaxis_transform(), ha="right")
        fraction.set(
            xlabel="volume fraction of the solids (-)", ylabel="height above the bottom (mm)",
            xscale="log", xlim=(1e-4, 0.6), ylim=(0, 100), title="Where the solids are",
        )  # fmt: skip
        velocity.axvline(0, color=FAINT)
        velocity.set(
            xlabel="axial velocity of the solids (m/s)", ylabel="height above the bottom (mm)",
            ylim=(0, 100), title="Which of them climb",
        )  # fmt: skip
        loss.set(xlabel="time (s)", ylabel="loss of pressure (Pa/m)", title="Loss of pressure")
        spread.set(
            xlabel="velocity along the height (m/s)", ylabel="probability density (s/m)",
            yscale="log", ylim=(1e-2, None), title="Spread of velocities",
        )  # fmt: skip
        fraction.legend(title="case; dashed: quick")
        return figure


_PARTS: dict[str, Callable[[Instant], float]] = {
    "front": lambda at: float(at.velocity[horizontal.rear_middle_front(at)[2], 0].mean()),
    "rear": lambda at: float(at.velocity[horizontal.rear_middle_front(at)[0], 0].mean()),
    "lower half": horizontal.lower_velocity,
    "upper half": horizontal.upper_velocity,
}


def _drawn(level: str, case: str) -> dict[str, str]:
    named = {"label": _NAMES[case]} if level == "balanced" else {}
    return {"linestyle": _LINES[level], "color": _COLOURS[case], **named}


def _over_height(fraction: Axes, velocity: Axes, scene: Scene, drawn: dict[str, str]) -> None:
    diameter = 2 * float(scene.starts[0].solids.radius.max())
    height, mean, _ = inclined.in_layers(scene)
    fraction.plot(mean, 1e3 * height, **drawn)  # type: ignore[arg-type]
    profile = scene.solids.velocity_over_height
    dense = scene.solids.fraction_over_height.mean > 1e-4
    dense &= profile.place > diameter / 4
    velocity.plot(profile.mean[dense], 1e3 * profile.place[dense], **drawn)  # type: ignore[arg-type]


def _in_time(loss: Axes, spread: Axes, scene: Scene, drawn: dict[str, str]) -> None:
    run = scene.starts[0]
    later = run.time >= scene.since
    loss.plot(run.time[later], run.pressure_gradient[later], **drawn)  # type: ignore[arg-type]
    values = np.concatenate([at.velocity[:, 2] for at in scene.instants()])
    density = velocity_density(values, edges=np.linspace(-0.25, 0.25, 51))
    middle = (density.edges[1:] + density.edges[:-1]) / 2
    spread.plot(middle, density.density, **drawn)  # type: ignore[arg-type]


def _smooth(axes: Axes, time: FloatArray, values: FloatArray, line: str, label: str) -> None:
    width = max(1, round(1.0 / float(time[1] - time[0])))
    kernel = np.full(width, 1 / width)
    axes.plot(
        np.convolve(time, kernel, "valid"), np.convolve(values, kernel, "valid"), line,
        color=ACCENTS[1], label=label,
    )  # fmt: skip
