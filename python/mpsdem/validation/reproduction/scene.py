"""The runs of a case, and means over them: of an instant, of a window of time."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mpsdem.analysis import (
    SolidsSurvey,
    by_period,
    period_of_motion,
    radial_velocity,
    survey_solids,
    time_average,
)
from mpsdem.results import Results, ResultsError
from mpsdem.validation.reproduction.measured import Measured

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Instant:
    """The solids of a frame.

    Parameters
    ----------
    along : (n,) float64 ndarray
        Way along the pipe, laps included [m].
    height : (n,) float64 ndarray
        Of the centres above the lowest line of the bore [m].
    away : (n,) float64 ndarray
        Distance of the centres from the axis [m].
    outwards : (n,) float64 ndarray
        Velocity away from the axis [m/s].
    velocity : (n, 3) float64 ndarray
        [m/s]
    liquid : (n,) float64 ndarray
        Axial velocity of the liquid at the solids [m/s].
    radius : (n,) float64 ndarray
        [m]
    pipe_radius, length : float
        The bore [m].
    """

    along: FloatArray
    height: FloatArray
    away: FloatArray
    outwards: FloatArray
    velocity: FloatArray
    liquid: FloatArray
    radius: FloatArray
    pipe_radius: float
    length: float


Number = Callable[[Instant], float]


class Scene:
    """The runs of one case at one spacing.

    Parameters
    ----------
    starts : Results
        The first is the longest; the others start all but alike, and tell how far what grows from
        a thousandth of a diameter changes the numbers of an instant.
    since : float
        From when on solids are taken as settled [s].
    """

    def __init__(self, *starts: Results, since: float = 0.0) -> None:
        self.starts = starts
        self.since = since
        self.period = period_of_motion(starts[0].case.motion)
        self._frames = [_Frames(start) for start in starts]

    def at(self, time: float, number: Number) -> Measured:
        """A number at an instant [s], and the standard error of its mean over the starts."""
        values = [
            number(frames[start.frames_at([time])[0]])
            for start, frames in zip(self.starts, self._frames, strict=True)
            if start.time[-1] >= time - 1e-9
        ]
        if not values:
            raise ResultsError(f"{self.starts[0].directory} ends before {time:g} s")
        error = np.std(values, ddof=1) / math.sqrt(len(values)) if len(values) > 1 else math.nan
        return Measured(mean=float(np.mean(values)), error=float(error))

    def mean(
        self, number: Number, *, since: float | None = None, until: float = math.inf
    ) -> Measured:
        """Mean of a number over time [s], with its standard error by blocks."""
        time = self.starts[0].time
        values = np.array([number(at) for at in self.instants(since=since, until=until)])
        return self.average(time[self._window(time, since, until)], values)

    def loss(self, *, since: float | None = None, until: float = math.inf) -> Measured:
        """Mean loss of pressure [Pa/m], with its standard error by blocks."""
        run = self.starts[0]
        inside = self._window(run.time, since, until)
        return self.average(run.time[inside], run.pressure_gradient[inside])

    def of_periods(
        self, values: FloatArray | None = None, *, part: str, period: float = 1.0
    ) -> Measured:
        """Mean over the periods of their peak, or of what lies between trough and peak.

        Parameters
        ----------
        values : (frames,) float64 ndarray, optional
            By default the loss of pressure [Pa/m].
        part : {"peak", "range"}
            Of each period.
        period : float
            Of a pipe at rest, to be compared with one that moves [s].
        """
        run = self.starts[0]
        found = by_period(
            run.time,
            run.pressure_gradient if values is None else values,
            period=self.period or period,
            start=self.since,
        )
        parts = {"peak": found.peak, "range": found.peak - found.trough}[part]
        error = parts.std(ddof=1) / math.sqrt(parts.size) if parts.size > 1 else math.nan
        return Measured(mean=float(parts.mean()), error=float(error))

    def instants(self, *, since: float | None = None, until: float = math.inf) -> list[Instant]:
        """The frames of the first run between two times [s]."""
        frames = np.flatnonzero(self._window(self.starts[0].time, since, until))
        return [self._frames[0][frame] for frame in frames.tolist()]

    @cached_property
    def solids(self) -> SolidsSurvey:
        """What the solids do from `since` on."""
        run = self.starts[0]
        return survey_solids(run, window=(self.since, float(run.time[-1])), period=self.period)

    @property
    def bulk_velocity(self) -> float:
        """That of the case [m/s]."""
        liquid = self.starts[0].case.liquid
        return math.nan if liquid is None else liquid.bulk_velocity

    def _window(self, time: FloatArray, since: float | None, until: float) -> NDArray[np.bool_]:
        start = self.since if since is None else since
        return np.asarray((time >= start - 1e-9) & (time <= until + 1e-9))

    def average(self, time: FloatArray, values: FloatArray) -> Measured:
        """Mean of a series over time [s], with its standard error by blocks."""
        always = (-math.inf, math.inf)
        found = time_average(time, values, window=always, period=self.period)
        return Measured(mean=found.mean, error=found.error)


class _Frames:
    """The frames of a run as instants, read once."""

    def __init__(self, run: Results) -> None:
        self._run = run

    @cached_property
    def _all(self) -> list[Instant]:
        solids, pipe = self._run.solids, self._run.case.pipe
        position, velocity = solids.position[:], solids.velocity[:]
        along, radius = position[..., 0] + pipe.length * solids.laps[:], solids.radius
        away, outwards = (
            np.hypot(position[..., 1], position[..., 2]),
            radial_velocity(position, velocity),
        )
        known = "liquid_velocity" in solids
        liquid = solids.liquid_velocity[:][..., 0] if known else np.full(along.shape, np.nan)
        return [
            Instant(
                along=along[frame],
                height=position[frame, :, 2] + pipe.radius,
                away=away[frame],
                outwards=outwards[frame],
                velocity=velocity[frame],
                liquid=liquid[frame],
                radius=radius,
                pipe_radius=pipe.radius,
                length=pipe.length,
            )
            for frame in range(len(along))
        ]

    def __getitem__(self, frame: int) -> Instant:
        return self._all[frame]
