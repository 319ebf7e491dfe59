"""A ball on a plane: from sliding to rolling, rolling resistance, inclines."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from mpsdem.validation.ball import Ball, Track, track_on_slope
from mpsdem.validation.registry import Check

BALL = Ball(radius=0.005, density=2500, youngs_modulus=1e8, poisson_ratio=0.20)
SLOPE = math.radians(30)
STEEPNESS = math.tan(SLOPE)


def checks() -> Iterator[Check]:
    """All checks of this module."""
    yield from _from_sliding_to_rolling()
    yield from _rolling_resistance()
    yield from _inclines()


def _from_sliding_to_rolling() -> Iterator[Check]:
    """Launched at 1 m/s without spin, friction 0.3: it rolls after 2 u0 / (7 mu g)."""
    run = partial(track_on_slope, BALL, friction=0.3, speed=1.0, end=0.12, samples=2400)
    for quantity, expected, unit, measure in (
        ("time", 0.097083, "s", lambda: run().time[_first_rolling(run())]),
        ("distance", 0.083214, "m", lambda: run().distance[_first_rolling(run())]),
        ("speed", 0.714286, "m/s", lambda: run().speed[-1]),
    ):
        yield Check(
            id=f"rolling/onset/{quantity}",
            claim="a sliding ball comes to roll where the balance of momentum says",
            expected=expected,
            measure=measure,
            relative=0.005,
            unit=unit,
        )


def _rolling_resistance() -> Iterator[Check]:
    yield Check(
        id="rolling/decay/spinning",
        claim="a ball that spins on a smooth plane loses 5 mu_r g t / (2 r) of its spin",
        expected=50.95,
        measure=_of(
            partial(track_on_slope, BALL, friction=0.0, rolling_friction=0.1, spin=100.0, end=0.1),
            lambda track: track.spin[-1],
        ),
        relative=0.005,
        unit="rad/s",
    )
    yield Check(
        id="rolling/decay/rolling",
        claim="a rolling ball is slowed by 5/7 mu_r g",
        expected=0.289786,
        measure=_of(
            partial(
                track_on_slope,
                BALL,
                friction=0.5,
                rolling_friction=0.1,
                speed=0.5,
                spin=100.0,
                end=0.3,
            ),
            lambda track: track.speed[-1],
        ),
        relative=0.005,
        unit="m/s",
    )


def _inclines() -> Iterator[Check]:
    """On a slope of 30 degrees, for half a second from rest."""

    def slope(friction: float, rolling_friction: float = 0.0) -> Callable[[], Track]:
        return partial(
            track_on_slope,
            BALL,
            slope=SLOPE,
            friction=friction,
            rolling_friction=rolling_friction,
            end=0.5,
        )

    for name, claim, run, acceleration in (
        ("rolling", "a ball rolls down at 5/7 g sin th", slope(0.5), 3.50357),
        ("barely-rolling", "and does so from mu = 2/7 tan th on", slope(0.166), 3.50357),
        ("sliding", "below that it slides, at g (sin th - mu cos th)", slope(0.1), 4.05543),
        (
            "resisted",
            "with resistance it rolls down at 5/7 g (sin th - mu_r cos th)",
            slope(0.5, STEEPNESS / 2),
            1.751786,
        ),
    ):
        yield Check(
            id=f"incline/{name}/acceleration",
            claim=claim,
            expected=acceleration,
            measure=_of(run, lambda track: track.speed[-1] / track.time[-1]),
            relative=0.005,
            unit="m/s2",
        )
    yield Check(
        id="incline/sliding/spin",
        claim="a ball that slides down spins up by 5 mu g cos th / (2 r)",
        expected=424.8,
        measure=_of(slope(0.1), lambda track: track.spin[-1] / track.time[-1]),
        relative=0.005,
        unit="rad/s2",
    )
    yield Check(
        id="incline/at-rest/speed",
        claim="a ball rests where mu_r exceeds tan th",
        expected=0.0,
        measure=_of(slope(0.9, 1.05 * STEEPNESS), lambda track: track.speed[-1]),
        absolute=1e-9,
        unit="m/s",
    )
    yield Check(
        id="incline/slightly-steeper/acceleration",
        claim="and rolls where mu_r falls short of it",
        expected=0.175179,
        measure=_of(slope(0.9, 0.95 * STEEPNESS), _settled_acceleration),
        relative=0.005,
        unit="m/s2",
    )


def _first_rolling(track: Track) -> int:
    """Index of the first time at which the contact patch no longer moves."""
    return int(np.argmax(track.speed <= BALL.radius * track.spin * (1 + 1e-6)))


def _settled_acceleration(track: Track) -> float:
    """Over the second half, when the contact has taken up the load [m/s2]."""
    half = len(track.time) // 2
    return float((track.speed[-1] - track.speed[half]) / (track.time[-1] - track.time[half]))


def _of(run: Callable[[], Track], what: Callable[[Track], float]) -> Callable[[], float]:
    """Measure one number of a track."""
    return lambda: what(run())
