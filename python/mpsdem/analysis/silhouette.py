"""The outline of a cluster as seen from the side: where it stands high, and where it has gaps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Silhouette:
    """Lower and upper outline along the pipe.

    Parameters
    ----------
    x : (bins,) float64 ndarray
        Middle of each bin [m].
    lower, upper : (bins,) float64 ndarray
        Lowest and highest z of any solid within the bin [m]; NaN where there is none.
    """

    x: FloatArray
    lower: FloatArray
    upper: FloatArray


def silhouette(
    position: FloatArray, radius: FloatArray, *, length: float, bins: int = 200
) -> Silhouette:
    """Outline of spheres seen along y, with every sphere's own roundness.

    Parameters
    ----------
    position : (n, 3) float64 ndarray
        Centres [m].
    radius : (n,) float64 ndarray
        Radii [m], below half of `length`.
    length : float
        Length of the periodic pipe [m].
    bins : int
        Number of equal bins along it.

    Returns
    -------
    Silhouette
        Extremes over each whole bin, so no sphere is missed however wide the bins are.
    """
    width = length / bins
    x, z = position[:, 0] % length, position[:, 2]
    lower, upper = np.full(bins, np.inf), np.full(bins, -np.inf)
    reach = int(np.ceil(radius.max(initial=0.0) / width))
    for offset in range(-reach, reach + 1):
        bin_ = np.floor(x / width).astype(np.int64) + offset
        nearest = np.clip(x, bin_ * width, (bin_ + 1) * width)
        half_height = np.sqrt(np.maximum(radius**2 - (x - nearest) ** 2, 0))
        touches = np.abs(x - nearest) < radius
        np.minimum.at(lower, bin_[touches] % bins, (z - half_height)[touches])
        np.maximum.at(upper, bin_[touches] % bins, (z + half_height)[touches])
    empty = upper < lower
    return Silhouette(
        x=np.linspace(width / 2, length - width / 2, bins),
        lower=np.where(empty, np.nan, lower),
        upper=np.where(empty, np.nan, upper),
    )
