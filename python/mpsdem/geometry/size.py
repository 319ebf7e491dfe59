"""Diameters drawn from a size distribution."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, ndtri  # type: ignore[import-untyped, unused-ignore]

from mpsdem.case import Distribution, Lognormal, Sieve, Uniform

FloatArray = NDArray[np.float64]


def sample_diameters(
    size: float | Distribution, count: int, generator: np.random.Generator
) -> FloatArray:
    """Draw diameters that follow a distribution as closely as their number allows.

    Parameters
    ----------
    size : float, Uniform, Lognormal or Sieve
        One diameter for all [m], or how diameters are distributed over the number of solids.
    count : int
        Number of diameters.
    generator : numpy.random.Generator
        Shuffles them.

    Returns
    -------
    (count,) float64 ndarray
        Diameters [m].

    Notes
    -----
    The distribution is cut into `count` equally likely strata, and each gives its middle quantile:
    the total volume then hardly depends on the seed, only the order does.

    Examples
    --------
    >>> import numpy as np
    >>> sample_diameters(0.02, 3, np.random.default_rng(0))
    array([0.02, 0.02, 0.02])
    """
    middles = (np.arange(count) + 0.5) / count
    return generator.permutation(_quantile(size, middles))


def _quantile(size: float | Distribution, share: FloatArray) -> FloatArray:
    match size:
        case Uniform():
            return size.smallest + share * (size.largest - size.smallest)
        case Lognormal():
            bounds = np.array([size.smallest, size.largest])
            low, high = ndtr(np.log(bounds / size.median) / size.deviation)
            normal = ndtri(low + share * (high - low))
            diameters: FloatArray = size.median * np.exp(size.deviation * normal)
            return diameters.clip(size.smallest, size.largest)
        case Sieve():
            cumulative = np.cumsum(size.fractions)
            index = np.searchsorted(cumulative / cumulative[-1], share)
            return np.array(size.diameters)[index]
        case _:
            return np.full(len(share), size)
