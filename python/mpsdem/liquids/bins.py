"""What the results hold of a computed liquid: means over rings and sections, some of its points."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

RINGS = 20  # radial bins of the measured profile
LAYERS = 12  # bins of its heights: each holds several points of a coarse liquid
_MOST_WRITTEN = 10_000  # points of a frame, unless the case says otherwise


def ring_edges(pipe_radius: float) -> FloatArray:
    """Borders of the radial bins [m]."""
    return np.linspace(0, pipe_radius, RINGS + 1)


def middles(edges: FloatArray) -> FloatArray:
    """Middles of bins between edges."""
    return np.asarray(edges[1:] + edges[:-1]) / 2


def layer_edges(pipe_radius: float) -> FloatArray:
    """Borders of equal layers from the bottom of the bore to its top [m]."""
    return np.linspace(-pipe_radius, pipe_radius, LAYERS + 1)


def section_count(pipe_radius: float, pipe_length: float) -> int:
    """Bins along the pipe, about a radius long."""
    return max(1, round(pipe_length / pipe_radius))


def bin_means(bins: NDArray[np.intp], values: FloatArray, count: int) -> FloatArray:
    """Mean of the values in each bin; NaN in an empty one."""
    number = np.bincount(bins, minlength=count)
    mean = np.full(count, np.nan)
    np.divide(
        np.bincount(bins, weights=values, minlength=count), number, out=mean, where=number > 0
    )
    return mean


def sample(count: int, stride: int | None) -> NDArray[np.intp]:
    """Choose one of every `stride` points.

    At random: a regular choice would take whole rings and leave others out.
    """
    if stride is None:
        stride = math.ceil(count / _MOST_WRITTEN)
    if stride == 0:
        return np.zeros(0, dtype=np.intp)
    chosen = np.random.default_rng(0).choice(count, size=math.ceil(count / stride), replace=False)
    return np.sort(chosen)
