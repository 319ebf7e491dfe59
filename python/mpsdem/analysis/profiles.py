"""What changes with the height in the pipe, from exact slices of spheres."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def height_edges(pipe_radius: float, bins: int) -> FloatArray:
    """Edges of equal slabs from the lowest to the highest point of the bore, (bins + 1,) [m]."""
    return np.linspace(-pipe_radius, pipe_radius, bins + 1)


def slab_volume(z: FloatArray, radius: FloatArray, edges: FloatArray) -> FloatArray:
    """Volume of each sphere within each horizontal slab.

    Parameters
    ----------
    z : (n,) float64 ndarray
        Heights of the centres [m].
    radius : (n,) float64 ndarray
        Radii [m].
    edges : (bins + 1,) float64 ndarray
        Heights between which the slabs lie [m], rising.

    Returns
    -------
    (n, bins) float64 ndarray
        Volumes [m3]; over all space they add up to the spheres' own.
    """
    r = radius[:, None]
    h = np.clip(edges - z[:, None], -r, r)
    return np.diff(np.pi * (r**2 * h - h**3 / 3), axis=1)


def slab_area(pipe_radius: float, edges: FloatArray) -> FloatArray:
    """Area of the bore's cross-section within each horizontal slab, (bins,) [m2].

    Parameters
    ----------
    pipe_radius : float
        Radius of the bore [m].
    edges : (bins + 1,) float64 ndarray
        Heights from the axis between which the slabs lie [m], rising.
    """
    s = np.clip(edges / pipe_radius, -1, 1)
    return np.diff(pipe_radius**2 * (s * np.sqrt(1 - s**2) + np.arcsin(s)))


def volume_fraction_over_height(
    position: FloatArray,
    radius: FloatArray,
    *,
    pipe_radius: float,
    length: float,
    edges: FloatArray,
) -> FloatArray:
    """Share of the bore that solids fill, slab by slab.

    Parameters
    ----------
    position : (n, 3) float64 ndarray
        Centres [m].
    radius : (n,) float64 ndarray
        Radii [m].
    pipe_radius, length : float
        The bore [m].
    edges : (bins + 1,) float64 ndarray
        Heights from the axis between which the slabs lie [m], rising.

    Returns
    -------
    (bins,) float64 ndarray
        Volume fraction [-], mean over the length of the pipe; NaN in slabs outside of the bore.
    """
    solid = slab_volume(position[:, 2], radius, edges).sum(axis=0)
    return _ratio(solid, slab_area(pipe_radius, edges) * length)


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
    volume = slab_volume(position[:, 2], radius, edges)
    return _ratio(velocity[:, 0] @ volume, volume.sum(axis=0))


def _ratio(above: FloatArray, below: FloatArray) -> FloatArray:
    return np.divide(above, below, out=np.full_like(below, np.nan), where=below > 0)
