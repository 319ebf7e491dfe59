"""Cases B, and what Li, Xie & Wan state of them.

"Numerical investigation of two-phase flows around inclined flexible pipes by MPS-DEM method": a
pipe inclined by 50 degrees, still (case 1), shaken sideways (2) and in the vertical plane (3). The
paper's "radial distance" is a height above the bottom: it goes up to 80 mm "from the bottom".

"Significantly" is read as a tenth at least, of what is larger.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from mpsdem.analysis import slab_area, velocity_density
from mpsdem.validation.reproduction.measured import Measured
from mpsdem.validation.reproduction.scene import Instant, Scene
from mpsdem.validation.reproduction.statement import Statement

FloatArray = NDArray[np.float64]

STILL, SIDEWAYS, UPRIGHT = "paper001_case1", "paper001_case2", "paper001_case3"

_SIGNIFICANT = 1.1  # ratio
_LITTLE = 0.05  # of the peak: what a profile may rise where it falls
_FAST = 0.05  # share of the solids that are the fastest
_BINS = 21  # of a density that has one peak or more


def gathering(at: Instant) -> float:
    """Solids in the fullest section, as long as the radius, over those in the mean section [-]."""
    sections = round(at.length / at.pipe_radius)
    section = np.floor(at.along % at.length / at.length * sections).astype(int) % sections
    volume = np.bincount(section, at.radius**3, minlength=sections)
    return float(volume.max() / volume.mean())


def sliding_back(at: Instant) -> float:
    """Share of the solids that move towards the inlet [-]."""
    return float((at.velocity[:, 0] < 0).mean())


def above_axis(at: Instant) -> float:
    """Share of the solids above the axis [-]."""
    return float((at.height > at.pipe_radius).mean())


def at_wall(at: Instant) -> float:
    """Share of the solids that leave a gap of less than half a diameter to the wall [-]."""
    return float((at.pipe_radius - at.away < 2 * at.radius).mean())


def reach(at: Instant) -> float:
    """Height above the bottom below which 99 % of the solids lie whole [m]."""
    return float(np.quantile(at.height + at.radius, 0.99))


def axial_velocity(at: Instant) -> float:
    """Mean of the solids [m/s]."""
    return float(at.velocity[:, 0].mean())


def fastest_away(at: Instant) -> float:
    """Distance from the axis of the fastest twentieth of the solids, over the radius [-]."""
    count = max(1, round(_FAST * at.away.size))
    fastest = np.argsort(at.velocity[:, 0])[-count:]
    return float(at.away[fastest].mean() / at.pipe_radius)


def rms_upwards(at: Instant) -> float:
    """Root mean square of the velocity along the height [m/s]."""
    return float(np.sqrt((at.velocity[:, 2] ** 2).mean()))


def rms_outwards(at: Instant) -> float:
    """Root mean square of the velocity away from the axis [m/s]."""
    return float(np.sqrt((at.outwards**2).mean()))


def in_layers(scene: Scene) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Volume fraction in layers about as thick as a solid: heights [m], means and errors [-]."""
    profile = scene.solids.fraction_over_height
    pipe_radius = scene.starts[0].case.pipe.radius
    diameter = 2 * float(scene.starts[0].solids.radius.max())
    each = max(1, round(diameter * profile.place.size / (2 * pipe_radius)))
    area = slab_area(pipe_radius, np.linspace(-pipe_radius, pipe_radius, profile.place.size + 1))
    first = np.arange(0, profile.place.size, each)
    total = np.add.reduceat(area, first)
    mean = np.add.reduceat(area * profile.mean, first) / total
    error = np.add.reduceat(area * profile.error, first) / total  # layers go together
    return np.add.reduceat(area * profile.place, first) / total, mean, error


def largest_rise(scene: Scene) -> Measured:
    """The largest rise of volume fraction from a layer to the next above, over its maximum [-]."""
    _, mean, error = in_layers(scene)
    k = int(np.argmax(np.diff(mean)))
    rise = max(float(mean[k + 1] - mean[k]), 0.0)
    return Measured(mean=rise / mean.max(), error=math.hypot(error[k], error[k + 1]) / mean.max())


def lowest_below_largest(scene: Scene) -> Measured:
    """How much less the lowest layer holds than the fullest one, over the latter [-]."""
    _, mean, error = in_layers(scene)
    k = int(np.argmax(mean))
    if k == 0:
        return Measured(mean=0.0, error=0.0)
    largest, lowest = (Measured(mean=float(mean[i]), error=float(error[i])) for i in (k, 0))
    return (largest - lowest) / Measured(mean=largest.mean, error=0.0)


def largest_fraction(scene: Scene) -> Measured:
    """The largest volume fraction of a layer [-]."""
    _, mean, error = in_layers(scene)
    k = int(np.argmax(mean))
    return Measured(mean=float(mean[k]), error=float(error[k]))


def second_peak(at: Instant) -> float:
    """The largest rise of the density of vertical velocities away from its peak, over it [-]."""
    density = velocity_density(
        at.velocity[:, 2], edges=np.linspace(*_span(at.velocity[:, 2]), _BINS + 1)
    ).density
    peak = int(np.argmax(density))
    rises = np.concatenate([np.diff(density[peak:]), -np.diff(density[: peak + 1]), [0.0]])
    return float(rises.max() / density[peak])


def _span(values: FloatArray) -> tuple[float, float]:
    """Three deviations both ways [m/s]."""
    width = 3 * float(values.std()) or 1.0
    return float(values.mean()) - width, float(values.mean()) + width


def bed_share(scene: Scene) -> Measured:
    """Share of the solids that rest on the wall, or on others that do [-]."""
    solids = scene.solids
    later = solids.time >= scene.since
    return scene.average(solids.time[later], solids.bed_share[later])


def varies(scene: Scene) -> Measured:
    """Between the least and the largest mean velocity of the solids within a period [m/s]."""
    return scene.of_periods(scene.starts[0].diagnostics["solids_mean_velocity"], part="range")


def _said(
    name: str,
    claim: str,
    number: str,
    measure: Callable[..., Measured],
    *scenes: str,
    at_least: float = -math.inf,
    at_most: float = math.inf,
) -> Statement:
    return Statement(
        id=f"B/{name}",
        claim=claim,
        number=number,
        measure=lambda of: measure(*(of[scene] for scene in scenes)),
        scenes=scenes,
        at_least=at_least,
        at_most=at_most,
    )


def _of(number: Callable[[Instant], float], factor: float = 1.0) -> Callable[[Scene], Measured]:
    return lambda scene: scene.mean(number).times(factor)


def _more(
    measure: Callable[[Scene], Measured],
) -> Callable[[Scene, Scene], Measured]:
    return lambda one, other: measure(other) - measure(one)


def _times(
    measure: Callable[[Scene], Measured],
) -> Callable[[Scene, Scene], Measured]:
    return lambda one, other: measure(other) / measure(one)


def _peak(scene: Scene) -> Measured:
    return scene.of_periods(part="peak")


def _range(scene: Scene) -> Measured:
    return scene.of_periods(part="range")


INCLINED = (
    _said(
        "gather-still",
        "case 1: solids gather",
        "solids in the fullest section over the mean of all",
        _of(gathering),
        STILL,
        at_least=2.0,
    ),
    _said(
        "gather-sideways",
        "case 2: solids gather",
        "the same",
        _of(gathering),
        SIDEWAYS,
        at_least=2.0,
    ),
    _said(
        "gather-upright",
        "case 3: solids gather",
        "the same",
        _of(gathering),
        UPRIGHT,
        at_least=2.0,
    ),
    _said(
        "return",
        "some of the solids go back to the inlet",
        "share that moves back, case 1",
        _of(sliding_back),
        STILL,
        at_least=0.05,
        at_most=0.95,
    ),
    _said(
        "carried",
        "(the others are delivered)",
        "mean axial velocity of the solids, case 1 [m/s]",
        _of(axial_velocity),
        STILL,
        at_least=0.0,
    ),
    _said(
        "even",
        "case 1 is more even along the pipe than case 2",
        "fullest section over mean, case 2 less case 1",
        _more(_of(gathering)),
        STILL,
        SIDEWAYS,
        at_least=0.0,
    ),
    _said(
        "even-above",
        "above all in the upper part of the pipe",
        "share of the solids above the axis, case 1",
        _of(above_axis),
        STILL,
        at_least=0.01,
    ),
    _said(
        "wall",
        "case 2 moves solids to the wall",
        "share within half a diameter of the wall, case 2 over case 1",
        _times(_of(at_wall)),
        STILL,
        SIDEWAYS,
        at_least=_SIGNIFICANT,
    ),
    _said(
        "falls-still",
        "case 1: volume fraction is largest at the bottom and falls with height",
        "largest rise from layer to layer, over the largest fraction",
        largest_rise,
        STILL,
        at_most=_LITTLE,
    ),
    _said(
        "falls-sideways",
        "case 2: the same",
        "the same",
        largest_rise,
        SIDEWAYS,
        at_most=_LITTLE,
    ),
    _said(
        "reach",
        "vibration lets solids reach higher",
        "height below which 99 % lie, case 2 less case 1 [mm]",
        _more(_of(reach, 1e3)),
        STILL,
        SIDEWAYS,
        at_least=0.0,
    ),
    _said(
        "slower",
        "solids of the still pipe are faster than those of case 2",
        "mean axial velocity, case 1 less case 2 [m/s]",
        _more(_of(axial_velocity)),
        SIDEWAYS,
        STILL,
        at_least=0.0,
    ),
    _said(
        "fastest-still",
        "case 1: the fastest solids are near the axis",
        "distance of the fastest twentieth from the axis, over the radius",
        _of(fastest_away),
        STILL,
        at_most=0.5,
    ),
    _said(
        "fastest-sideways",
        "case 2: the fastest solids are near the wall",
        "the same",
        _of(fastest_away),
        SIDEWAYS,
        at_least=0.75,
    ),
    _said(
        "fluctuates",
        "case 2: the velocity fluctuates",
        "range of the mean velocity within a period, case 2 over case 1",
        _times(varies),
        STILL,
        SIDEWAYS,
        at_least=_SIGNIFICANT,
    ),
    *(
        _said(
            f"one-peak-{case}",
            f"case {case}: the density of radial velocities falls on both sides of a peak",
            "largest rise away from the peak, over it",
            _of(second_peak),
            scene,
            at_most=_LITTLE,
        )
        for case, scene in ((1, STILL), (2, SIDEWAYS))
    ),
    _said(
        "wider-height",
        "case 2 widens the distribution of radial velocities",
        "rms of the velocity along the height, case 2 over case 1",
        _times(_of(rms_upwards)),
        STILL,
        SIDEWAYS,
        at_least=_SIGNIFICANT,
    ),
    _said(
        "wider-radial",
        "the same, away from the axis",
        "rms of the velocity away from the axis, case 2 over case 1",
        _times(_of(rms_outwards)),
        STILL,
        SIDEWAYS,
        at_least=_SIGNIFICANT,
    ),
    _said(
        "80-mm",
        "case 2: solids stay below 80 mm from the bottom",
        "height below which 99 % lie [mm]",
        _of(reach, 1e3),
        SIDEWAYS,
        at_most=80.0,
    ),
    _said(
        "fills-section",
        "case 3: solids fill the section",
        "height below which 99 % lie, of 200 [mm]",
        _of(reach, 1e3),
        UPRIGHT,
        at_least=180.0,
    ),
    _said(
        "suspended",
        "case 3: heterogeneous suspended flow",
        "share of the solids that rest on the wall or on others",
        bed_share,
        UPRIGHT,
        at_most=0.5,
    ),
    _said(
        "more-even",
        "case 3: solids are spread more evenly over the height than in case 2",
        "largest fraction of a layer, case 3 over case 2",
        _times(largest_fraction),
        SIDEWAYS,
        UPRIGHT,
        at_most=1 / _SIGNIFICANT,
    ),
    _said(
        "rises-first",
        "case 3: volume fraction first rises with height, then falls",
        "how much less the lowest layer holds than the fullest, over the latter",
        lowest_below_largest,
        UPRIGHT,
        at_least=1 - 1 / _SIGNIFICANT,
    ),
    *(
        _said(
            f"loss-fluctuates-{case}",
            f"case {case}: the loss of pressure fluctuates within a period",
            "peak to trough within a period, over that of case 1 in a second",
            _times(_range),
            STILL,
            scene,
            at_least=_SIGNIFICANT,
        )
        for case, scene in ((2, SIDEWAYS), (3, UPRIGHT))
    ),
    _said(
        "loss-mean",
        "the mean loss of pressure is significantly larger in case 3 than in case 2",
        "case 3 over case 2",
        _times(Scene.loss),
        SIDEWAYS,
        UPRIGHT,
        at_least=_SIGNIFICANT,
    ),
    _said(
        "loss-peak",
        "so is its peak",
        "mean of the peaks of all periods, case 3 over case 2",
        _times(_peak),
        SIDEWAYS,
        UPRIGHT,
        at_least=_SIGNIFICANT,
    ),
)
