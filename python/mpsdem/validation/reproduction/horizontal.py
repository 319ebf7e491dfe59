"""Case A, and what Pan, Wei & Wan state of it.

"MPS-DEM method for particle effects on mixed transportation characteristics of horizontal
pipeline": 512 nodules that a liquid of 1 m/s collapses and stretches. Velocities are the paper's
colours, between 0 and 1 m/s, so "near" is a fifth of the scale.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from mpsdem.validation.reproduction.measured import Measured
from mpsdem.validation.reproduction.scene import Instant, Scene
from mpsdem.validation.reproduction.statement import Statement

FloatArray = NDArray[np.float64]
Chosen = NDArray[np.intp]

SCENE = "horizontal_pipe"

_TENTH = 0.1
_LATE = (10.0, 20.0)  # [s] when the paper shows 11 and 18 s; the cluster is a ring by then


def rear_middle_front(at: Instant) -> tuple[Chosen, Chosen, Chosen]:
    """The hindmost, the middle and the foremost tenth of the solids."""
    order = np.argsort(at.along)
    count = max(1, round(_TENTH * order.size))
    start = (order.size - count) // 2
    return order[:count], order[start : start + count], order[-count:]


def lower_upper(at: Instant) -> tuple[Chosen, Chosen]:
    """The lower and the upper half of the solids."""
    order = np.argsort(at.height)
    return order[: order.size // 2], order[-(order.size // 2) :]


def collapse(at: Instant) -> float:
    """Height below which 95 % of the solids lie whole [m]."""
    return float(np.quantile(at.height + at.radius, 0.95))


def length(at: Instant) -> float:
    """Of the cluster, between the 5 % quantiles of the solids [m]."""
    low, high = np.quantile(at.along, [0.05, 0.95])
    return float(high - low)


def arch(at: Instant) -> float:
    """How far the outline of the middle stands above the higher one of its ends [m]."""
    rear, middle, front = ((at.height + at.radius)[part].max() for part in rear_middle_front(at))
    return float(middle - max(rear, front))


def covered(at: Instant) -> float:
    """Share of the pipe, in sections as long as its radius, that holds solids [-]."""
    sections = round(at.length / at.pipe_radius)
    section = np.floor(at.along % at.length / at.length * sections).astype(int) % sections
    return np.unique(section).size / sections


def front_less_rear(at: Instant) -> float:
    """Axial velocity of the foremost less that of the hindmost tenth [m/s]."""
    rear, _, front = rear_middle_front(at)
    return float(at.velocity[front, 0].mean() - at.velocity[rear, 0].mean())


def middle_velocity(at: Instant) -> float:
    """Axial velocity of the middle tenth [m/s]."""
    return float(at.velocity[rear_middle_front(at)[1], 0].mean())


def lower_velocity(at: Instant) -> float:
    """Axial velocity of the lower half [m/s]."""
    return float(at.velocity[lower_upper(at)[0], 0].mean())


def upper_velocity(at: Instant) -> float:
    """Axial velocity of the upper half [m/s]."""
    return float(at.velocity[lower_upper(at)[1], 0].mean())


def upper_less_lower(at: Instant) -> float:
    """Axial velocity of the highest less that of the lower half [m/s]."""
    return upper_velocity(at) - lower_velocity(at)


def upper_less_lower_of_sections(at: Instant) -> float:
    """The same section by section as long as the radius of the bore [m/s].

    Sections of fewer than eight solids have no top and bottom; each counts with its solids.
    """
    section = np.floor(at.along / at.pipe_radius).astype(int)
    differences, counts = [0.0], [0]
    for here in np.unique(section):
        solids = np.flatnonzero(section == here)
        if solids.size >= 8:
            order = solids[np.argsort(at.height[solids])]
            half, u = solids.size // 2, at.velocity[:, 0]
            differences.append(float(u[order[-half:]].mean() - u[order[:half]].mean()))
            counts.append(solids.size)
    return float(np.average(differences, weights=counts)) if sum(counts) else float("nan")


def liquid_at_solids(at: Instant) -> float:
    """Axial velocity of the liquid at the solids, mean over them [m/s]."""
    return float(at.liquid.mean())


def first_back(scene: Scene) -> Measured:
    """When the first solid has left the outlet and come back at the inlet [s]."""
    times = []
    for run in scene.starts:
        back = (run.solids.laps[:] > 0).any(axis=1)
        times.append(float(run.time[np.argmax(back)]) if back.any() else float("inf"))
    error = np.std(times, ddof=1) / np.sqrt(len(times)) if len(times) > 1 else float("nan")
    return Measured(mean=float(np.mean(times)), error=float(error))


def flatness(scene: Scene) -> Measured:
    """Velocity of the liquid at 0.8 of the radius over that near the axis [-].

    Means over rings and over the whole pipe, from 20 s on.
    """
    run = scene.starts[0]
    liquid = run.liquid
    away = liquid.profile_radius / run.case.pipe.radius
    later = run.time >= min(20.0, float(run.time[-1]) / 2)
    profile = liquid.velocity_profile[:][later]
    outer = np.array([np.interp(0.8, away[known], row[known]) for row, known in _known(profile)])
    inner = np.array([row[known][0] for row, known in _known(profile)])
    return scene.average(run.time[later], outer / inner)


def _known(profile: FloatArray) -> list[tuple[FloatArray, NDArray[np.bool_]]]:
    return [(row, np.isfinite(row)) for row in profile]


def _late_loss(scene: Scene) -> Measured:
    """Loss of pressure of the last third of the run less that of a second about 2 s [Pa/m]."""
    end = float(scene.starts[0].time[-1])
    return scene.loss(since=end * 2 / 3) - scene.loss(since=1.5, until=2.5)


def _said(
    name: str,
    claim: str,
    number: str,
    measure: Callable[[Scene], Measured],
    *,
    at_least: float = -math.inf,
    at_most: float = math.inf,
) -> Statement:
    return Statement(
        id=f"A/{name}",
        claim=claim,
        number=number,
        measure=lambda scenes: measure(scenes[SCENE]),
        scenes=(SCENE,),
        at_least=at_least,
        at_most=at_most,
    )


def _early_and_late(
    name: str,
    claim: str,
    number: str,
    of: Callable[[Instant], float],
    *,
    times: tuple[float, ...],
    unit: str = "m/s",
    factor: float = 1.0,
) -> Iterator[Statement]:
    """What holds at some instants, and as a mean over the later time."""
    for place, time in enumerate(times):
        yield _said(
            f"{name}-{time:g}",
            "the same" if place else claim,
            f"{number} at {time:g} s [{unit}]",
            lambda scene, time=time: scene.at(time, of).times(factor),  # type: ignore[misc]
            at_least=0.0,
        )
    since, until = _LATE
    yield _said(
        f"{name}-late",
        "the same",
        f"{number}, mean of {since:g} to {until:g} s [{unit}]",
        lambda scene: scene.mean(of, since=since, until=until).times(factor),
        at_least=0.0,
    )


HORIZONTAL = (
    _said(
        "collapse",
        "the block collapses",
        "height below which 95 % lie at 5 s, over that at 0 s",
        lambda scene: scene.at(5.0, collapse) / scene.at(0.0, collapse),
        at_most=0.75,
    ),
    _said(
        "compact",
        "at 5 s the outline is still compact",
        "length of the cluster at 5 s, over that at 0 s",
        lambda scene: scene.at(5.0, length) / scene.at(0.0, length),
        at_most=3.0,
    ),
    _said(
        "longer-2-5",
        "the outline is stretched all the time",
        "length at 5 s less that at 2 s [m]",
        lambda scene: scene.at(5.0, length) - scene.at(2.0, length),
        at_least=0.0,
    ),
    _said(
        "longer-5-11",
        "the same",
        "length at 11 s less that at 5 s [m]",
        lambda scene: scene.at(11.0, length) - scene.at(5.0, length),
        at_least=0.0,
    ),
    _said(
        "fills",
        "at 18 s it is flattened to the whole pipe",
        f"share of the pipe that holds solids, mean of {_LATE[0]:g} to {_LATE[1]:g} s",
        lambda scene: scene.mean(covered, since=_LATE[0], until=_LATE[1]),
        at_least=0.95,
    ),
    *_early_and_late(
        "arch",
        "the outline is low at both ends and high in the middle",
        "top of the middle tenth above that of the higher end",
        arch,
        times=(2.0, 5.0),
        unit="mm",
        factor=1e3,
    ),
    *_early_and_late(
        "front",
        "the front is faster than the rear",
        "foremost less hindmost tenth",
        front_less_rear,
        times=(2.0, 5.0),
    ),
    *_early_and_late(
        "upper",
        "the upper part is faster than the lower",
        "upper less lower half",
        upper_less_lower,
        times=(2.0, 5.0),
    ),
    *_early_and_late(
        "upper-of-sections",
        "the same, of what lies above each other",
        "upper less lower half of each 100 mm of pipe",
        upper_less_lower_of_sections,
        times=(2.0, 5.0),
    ),
    _said(
        "middle",
        "at 2 s the middle moves at 0.5 m/s",
        "middle tenth at 2 s [m/s]",
        lambda scene: scene.at(2.0, middle_velocity),
        at_least=0.4,
        at_most=0.6,
    ),
    _said(
        "liquid-shows-solids",
        "the solids show in the liquid's velocity",
        "liquid at the solids less bulk velocity, at 2 s [m/s]",
        lambda scene: scene.at(2.0, lambda at: liquid_at_solids(at) - scene.bulk_velocity),
        at_most=0.0,
    ),
    _said(
        "upper-near-1",
        "at 5 s the upper solids move at about 1 m/s",
        "upper half at 5 s [m/s]",
        lambda scene: scene.at(5.0, upper_velocity),
        at_least=0.8,
        at_most=1.2,
    ),
    _said(
        "lower-near-half",
        "at 5 s the lower solids move at about 0.5 m/s",
        "lower half at 5 s [m/s]",
        lambda scene: scene.at(5.0, lower_velocity),
        at_least=0.4,
        at_most=0.6,
    ),
    _said(
        "comes-back",
        "by 34 s the solids have left the outlet and come back at the inlet",
        "when the first does [s]",
        first_back,
        at_most=34.0,
    ),
    _said(
        "flat",
        "at 1 m/s the liquid's velocity is rather flat over the radius",
        "at 0.8 of the radius over that at the axis, means over rings (7th root: 0.79)",
        flatness,
        at_least=0.75,
    ),
    _said(
        "less-resistance",
        "the shape becomes that of least resistance, to lose less energy",
        "loss of pressure of the last third less that at 2 s [Pa/m]",
        _late_loss,
        at_most=0.0,
    ),
)
