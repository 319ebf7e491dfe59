"""Which frames a figure shows, and what it is called."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import shorten

import numpy as np

from mpsdem.results import Results, ResultsError

_HALVINGS = 4
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
    if not results.time.size:
        raise ResultsError(f"the run in {results.directory} has no frames yet")
    if times is None or not len(times):
        times = [0.0, *(results.time[-1] / 2**k for k in range(_HALVINGS, -1, -1))]
    return sorted({int(np.abs(results.time - time).argmin()) for time in times})


def when(time: float) -> str:
    """The time of a frame as a label."""
    return f"{time:.3g} s"


def heading(results: Results, subject: str) -> str:
    """The case's title, and what the figure shows of it."""
    title = shorten(results.case.title, _LONGEST_TITLE, placeholder=" ...")
    return f"{title}: {subject}" if title else subject[:1].upper() + subject[1:]
