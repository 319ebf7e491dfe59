"""Where the solids are: their share of the bore over height and radius, across and along the pipe.

Spheres are cut exactly, so each sum over bins returns the volume of the solids. One that is pressed
into the wall counts as touching it, as no part of it may be lost.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mpsdem.analysis.partial_volumes import (
    cell_area,
    cell_volume,
    ring_volume,
    slab_area,
    slab_volume,
)

FloatArray = NDArray[np.float64]


def height_edges(pipe_radius: float, bins: int) -> FloatArray:
    """Edges of equal slabs from the lowest to the highest point of the bore, (bins + 1,) [m]."""
    return np.linspace(-pipe_radius, pipe_radius, bins + 1)


def radius_edges(pipe_radius: float, bins: int) -> FloatArray:
    """Edges of rings of equal width from the axis to the wall, (bins + 1,) [m]."""
    return np.linspace(0, pipe_radius, bins + 1)


def station_count(pipe_radius: float, length: float, diameter: float) -> int:
    """Equal sections of a pipe that are as long as its radius, and as the largest solid at least.

    Parameters
    ----------
    pipe_radius, length, diameter : float
        Of the bore, and of the largest solid [m].
    """
    return max(1, round(length / max(pipe_radius, diameter)))


def insitu_concentration(radius: FloatArray, *, pipe_radius: float, length: float) -> float:
    """Volume of the solids over that of the bore [-].

    Parameters
    ----------
    radius : (n,) float64 ndarray
        Radii of the solids [m].
    pipe_radius, length : float
        The bore [m].
    """
    return float(4 / 3 * (radius**3).sum() / (pipe_radius**2 * length))


def volume_fraction_over_height(
    position: FloatArray,
    radius: FloatArray,
    *,
    pipe_radius: float,
    length: float,
    edges: FloatArray,
) -> FloatArray:
    """Share of the bore that solids fill, slab by slab along the vertical.

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
        Its mean over the bore, weighted with `slab_area`, is the concentration in situ.
    """
    z = _within(position, radius, pipe_radius)[:, 1]
    solid = slab_volume(z, radius, edges).sum(axis=0)
    return _ratio(solid, slab_area(pipe_radius, edges) * length)


def volume_fraction_over_radius(
    position: FloatArray,
    radius: FloatArray,
    *,
    pipe_radius: float,
    length: float,
    edges: FloatArray,
) -> FloatArray:
    """Share of the bore that solids fill, ring by ring about the axis.

    Parameters
    ----------
    position : (n, 3) float64 ndarray
        Centres [m].
    radius : (n,) float64 ndarray
        Radii [m].
    pipe_radius, length : float
        The bore [m].
    edges : (bins + 1,) float64 ndarray
        Distances from the axis between which the rings lie [m], rising from 0.

    Returns
    -------
    (bins,) float64 ndarray
        Volume fraction [-], mean over the length of the pipe. Its mean over the bore, weighted
        with the areas of the rings, is the concentration in situ.
    """
    distance = np.hypot(*_within(position, radius, pipe_radius).T)
    solid = ring_volume(distance, radius, edges).sum(axis=0)
    return _ratio(solid, np.pi * np.diff(edges**2) * length)


def volume_fraction_over_section(
    position: FloatArray, radius: FloatArray, *, pipe_radius: float, length: float, bins: int
) -> FloatArray:
    """Share of the bore that solids fill, cell by cell across the pipe.

    Parameters
    ----------
    position : (n, 3) float64 ndarray
        Centres [m].
    radius : (n,) float64 ndarray
        Radii [m].
    pipe_radius, length : float
        The bore [m].
    bins : int
        Cells along a diameter.

    Returns
    -------
    (bins, bins) float64 ndarray
        Volume fraction [-], mean over the length of the pipe; rows go along y, columns along z. NaN
        in cells outside of the bore. Its mean over the bore, weighted with `cell_area`, is the
        concentration in situ.
    """
    edges = height_edges(pipe_radius, bins)
    y, z = _within(position, radius, pipe_radius).T
    area = cell_area(pipe_radius, edges)
    area[area < 1e-9 * area.max()] = 0  # round-off
    return _ratio(cell_volume(y, z, radius, edges), area * length)


def volume_fraction_along_pipe(
    x: FloatArray, radius: FloatArray, *, pipe_radius: float, length: float, bins: int
) -> FloatArray:
    """Share of the bore that solids fill, section by section of the periodic pipe.

    Parameters
    ----------
    x : (n,) float64 ndarray
        Axial places of the centres [m].
    radius : (n,) float64 ndarray
        Radii [m], below `length`.
    pipe_radius, length : float
        The bore [m].
    bins : int
        Number of equal sections.

    Returns
    -------
    (bins,) float64 ndarray
        Volume fraction [-]; its mean is the concentration in situ.
    """
    section, volume = _along(x, radius, length, bins)
    filled = np.bincount(section.ravel(), volume.ravel(), minlength=bins)
    return filled / (np.pi * pipe_radius**2 * length / bins)


def solids_flux_along_pipe(
    x: FloatArray,
    velocity: FloatArray,
    radius: FloatArray,
    *,
    pipe_radius: float,
    length: float,
    bins: int,
) -> FloatArray:
    """Flow rate of the solids over the area of the bore, section by section.

    Parameters
    ----------
    x, velocity : (n,) float64 ndarray
        Axial places of the centres [m], and their axial velocities [m/s].
    radius : (n,) float64 ndarray
        Radii [m], below `length`.
    pipe_radius, length : float
        The bore [m].
    bins : int
        Number of equal sections.

    Returns
    -------
    (bins,) float64 ndarray
        Mean over each section [m/s]; over the bulk velocity it is the delivered concentration.
    """
    section, volume = _along(x, radius, length, bins)
    flux = np.bincount(section.ravel(), (velocity[:, None] * volume).ravel(), minlength=bins)
    return flux / (np.pi * pipe_radius**2 * length / bins)


def _along(
    x: FloatArray, radius: FloatArray, length: float, bins: int
) -> tuple[NDArray[np.intp], FloatArray]:
    """The sections that each sphere touches, and its volume in them [m3], (n, touched)."""
    width = length / bins
    touched = int(np.ceil(2 * radius.max(initial=0.0) / width)) + 1
    first = np.floor((x - radius) / width)[:, None]
    h = (first + np.arange(touched + 1)) * width - x[:, None]
    h = np.clip(h, -radius[:, None], radius[:, None])
    volume = np.diff(np.pi * (radius[:, None] ** 2 * h - h**3 / 3), axis=1)
    return (first.astype(np.intp) + np.arange(touched)) % bins, volume


def _within(position: FloatArray, radius: FloatArray, pipe_radius: float) -> FloatArray:
    """Places across the pipe, (n, 2) [m], of spheres of which none cuts the wall."""
    across = position[:, 1:]
    distance = np.hypot(*across.T)
    room = np.maximum(pipe_radius - radius, 0)
    inwards = np.divide(room, distance, out=np.ones_like(room), where=distance > room)
    return np.asarray(across * inwards[:, None])


def _ratio(above: FloatArray, below: FloatArray) -> FloatArray:
    return np.divide(above, below, out=np.full_like(below, np.nan), where=below > 0)
