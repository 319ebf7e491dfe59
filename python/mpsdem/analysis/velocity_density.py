"""How the velocities of the solids are distributed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_USUAL = 0.999  # share of the values that lie within the edges
_BINS = 40


@dataclass(frozen=True, slots=True, kw_only=True)
class Density:
    """Probability density of a velocity.

    Parameters
    ----------
    edges : (bins + 1,) float64 ndarray
        Velocities between which the bins lie [m/s].
    density : (bins,) float64 ndarray
        Probability density [s/m]; it integrates to the share of the values within the edges.
    mean, deviation : float
        Of all values, and their standard deviation [m/s].
    """

    edges: FloatArray
    density: FloatArray
    mean: float
    deviation: float


def radial_velocity(position: FloatArray, velocity: FloatArray) -> FloatArray:
    """Velocity away from the axis of the pipe.

    Parameters
    ----------
    position, velocity : (..., 3) float64 ndarray
        Places [m] and velocities [m/s].

    Returns
    -------
    (...) float64 ndarray
        Positive towards the wall [m/s]; on the axis itself the whole speed across the pipe.
    """
    across, v = position[..., 1:], velocity[..., 1:]
    away = np.linalg.norm(across, axis=-1)
    outwards = np.divide(
        (across * v).sum(axis=-1), away, out=np.linalg.norm(v, axis=-1), where=away > 0
    )
    return np.asarray(outwards)


def velocity_density(values: FloatArray, *, edges: FloatArray | None = None) -> Density:
    """Probability density of velocities, each solid counting alike.

    Parameters
    ----------
    values : float64 ndarray
        Velocities of any shape [m/s].
    edges : (bins + 1,) float64 ndarray, optional
        Borders of the bins [m/s], rising; by default 40 equal bins over the middle 99.9 %.

    Returns
    -------
    Density
        With mean and deviation of all values.
    """
    values = values.ravel()
    if edges is None:
        low, high = np.quantile(values, [(1 - _USUAL) / 2, (1 + _USUAL) / 2])
        room = 1e-6 * max(abs(low), abs(high)) or 1e-6  # all values may be one
        edges = np.linspace(low - room, high + room, _BINS + 1)
    count, _ = np.histogram(values, edges)
    return Density(
        edges=edges,
        density=count / (values.size * np.diff(edges)),
        mean=float(values.mean()),
        deviation=float(values.std()),
    )
