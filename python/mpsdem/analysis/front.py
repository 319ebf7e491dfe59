"""How far a cluster has come, and how much it has stretched."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """Where a cluster is along its way; all (frames,) float64 ndarray [m].

    Parameters
    ----------
    tail, centre, front : (frames,) float64 ndarray
        Quantiles of the axial positions.
    first, last : (frames,) float64 ndarray
        The foremost and the hindmost solid.
    """

    tail: FloatArray
    centre: FloatArray
    front: FloatArray
    first: FloatArray
    last: FloatArray


def extent(x: FloatArray, *, share: float = 0.05) -> Extent:
    """Tail, centre and front of a cluster against time.

    Parameters
    ----------
    x : (frames, n) float64 ndarray
        Axial positions, laps included [m].
    share : float
        Share of the solids behind the tail, and of those before the front: a few stragglers are
        not the cluster. The centre is the median.

    Returns
    -------
    Extent
        Positions [m].
    """
    tail, centre, front = np.quantile(x, [share, 0.5, 1 - share], axis=1)
    return Extent(tail=tail, centre=centre, front=front, first=x.max(axis=1), last=x.min(axis=1))
