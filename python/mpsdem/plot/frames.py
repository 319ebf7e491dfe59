"""Which frames a figure shows, and what it is called."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from textwrap import shorten

import numpy as np
from numpy.typing import NDArray

from mpsdem.results import Results

FloatArray = NDArray[np.float64]

_HALVINGS = 4
_MOST_MEANED = 100  # frames, as a mean over more does not change on paper
_LONGEST_TITLE = 44  # characters that leave room for the subject


def chosen_frames(results: Results, times: Sequence[float] | None = None) -> list[int]:
    """Frames nearest to the times asked for, each once, in order.

    Parameters
    ----------
    results : Results
        The run.
    times : sequence of float, optional
        Times [s]; by default the start, and the end halved four times.

    Returns
    -------
    list of int
        Frame numbers.

    Raises
    ------
    ResultsError
        If the run has no frames.
    """
    if times is None or not len(times):
        end = results.time[-1] if results.time.size else 0.0
        times = [0.0, *(end / 2**k for k in range(_HALVINGS, -1, -1))]
    return results.frames_at(times)


def second_half(results: Results) -> list[int]:
    """Frames of the second half of the run, by time; at most some hundred, evenly taken."""
    later = np.flatnonzero(results.time >= results.time[-1] / 2)
    return [int(frame) for frame in later[:: -(-later.size // _MOST_MEANED)]]


def mean_of(
    results: Results, frames: Sequence[int], values: Callable[[int], FloatArray]
) -> tuple[FloatArray, str]:
    """Mean over frames of what is not NaN, and from when to when it goes."""
    mean = np.ma.masked_invalid([values(frame) for frame in frames]).mean(axis=0)
    start, end = results.time[frames[0]], results.time[frames[-1]]
    return mean.filled(np.nan), f"{when(start)} to {when(end)}" if end > start else when(end)


def when(time: float) -> str:
    """The time of a frame as a label."""
    return f"{time:.3g} s"


def heading(results: Results, subject: str) -> str:
    """The case's title, and what the figure shows of it."""
    title = shorten(results.case.title, _LONGEST_TITLE, placeholder=" ...")
    return f"{title}: {subject}" if title else subject[:1].upper() + subject[1:]
