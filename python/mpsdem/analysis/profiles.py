"""How fast the solids go, over the height in the pipe and over the distance from its axis."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mpsdem.analysis.partial_volumes import ring_volume, slab_volume

FloatArray = NDArray[np.float64]


def velocity_over_height(
    position: FloatArray, velocity: FloatArray, radius: FloatArray, *, edges: FloatArray
) -> FloatArray:
    """Axial velocity of the solids slab by slab, each weighted with its volume in the slab.

    Parameters
    ----------
    position, velocity : (n, 3) float64 ndarray
        Centres [m] and their velocities [m/s].
    radius : (n,) float64 ndarray
        Radii [m].
    edges : (bins + 1,) float64 ndarray
        Heights from the axis between which the slabs lie [m], rising.

    Returns
    -------
    (bins,) float64 ndarray
        Mean velocity [m/s]; NaN where there are no solids.
    """
    return _weighted(velocity, slab_volume(position[:, 2], radius, edges))


def velocity_over_radius(
    position: FloatArray, velocity: FloatArray, radius: FloatArray, *, edges: FloatArray
) -> FloatArray:
    """Axial velocity of the solids ring by ring, each weighted with its volume in the ring.

    Parameters
    ----------
    position, velocity : (n, 3) float64 ndarray
        Centres [m] and their velocities [m/s].
    radius : (n,) float64 ndarray
        Radii [m].
    edges : (bins + 1,) float64 ndarray
        Distances from the axis between which the rings lie [m], rising from 0.

    Returns
    -------
    (bins,) float64 ndarray
        Mean velocity [m/s]; NaN where there are no solids.
    """
    distance = np.hypot(position[:, 1], position[:, 2])
    return _weighted(velocity, ring_volume(distance, radius, edges))


def _weighted(velocity: FloatArray, volume: FloatArray) -> FloatArray:
    total = volume.sum(axis=0)
    mean: FloatArray = np.full_like(total, np.nan)
    np.divide(velocity[:, 0] @ volume, total, out=mean, where=total > 0)
    return mean
