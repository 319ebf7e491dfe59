"""Means and peaks of a series, period by period."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mpsdem.case import Motion

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Periods:
    """A series in whole periods.

    Parameters
    ----------
    start : (periods,) float64 ndarray
        When each period begins [s].
    mean, peak, trough : (periods,) float64 ndarray
        Mean, largest and smallest value in it, in the unit of the series.
    """

    start: FloatArray
    mean: FloatArray
    peak: FloatArray
    trough: FloatArray


def by_period(time: FloatArray, values: FloatArray, *, period: float, start: float) -> Periods:
    """Mean, peak and trough of a series in each whole period.

    Parameters
    ----------
    time : (n,) float64 ndarray
        Times, rising [s].
    values : (n,) float64 ndarray
        The series.
    period : float
        [s]
    start : float
        When the first period begins [s].

    Returns
    -------
    Periods
        Of all periods that end by the last time and hold a value. One that stands where a period
        ends belongs to it, as values are means since the time before.

    Notes
    -----
    Peaks are those of what was recorded: of the means between two frames.
    """
    slack = 1e-9 * max(abs(float(time[-1])), period)  # times carry round-off
    whole = int((time[-1] - start + slack) / period)
    number = np.ceil((time - start - slack) / period).astype(np.intp) - 1
    kept = [(k, values[number == k]) for k in range(whole)]
    kept = [(k, inside) for k, inside in kept if inside.size]
    return Periods(
        start=np.array([start + k * period for k, _ in kept]),
        mean=np.array([inside.mean() for _, inside in kept]),
        peak=np.array([inside.max() for _, inside in kept]),
        trough=np.array([inside.min() for _, inside in kept]),
    )


def period_of_motion(motion: Motion) -> float | None:
    """After what time the pipe moves again as before [s].

    Parameters
    ----------
    motion : Motion
        How it moves.

    Returns
    -------
    float or None
        The longest period of its vibrations, where all others fit into it a whole number of times;
        None where they do not, where the pipe follows a table, and where it is at rest.
    """
    if motion.displacements is not None:
        return None
    periods = [part.resolved_period for part in motion.vibration if part.amplitude > 0]
    longest = max(periods, default=None)
    if longest is None or any(abs(longest / p - round(longest / p)) > 1e-6 for p in periods):
        return None
    return longest
