"""Liquid of a straight pipe on fixed nodes: one cross-section, repeated along the axis."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_FEWEST_RINGS = 3  # the wall's among them
_DEGREE = 4  # of the polynomials that the areas integrate exactly
_LANES = 4  # stations come in whole registers of the kernels
_FEWEST_STATIONS = 8


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class NodeLayout:
    """Nodes of a full straight pipe about the x axis, periodic along it.

    Parameters
    ----------
    place : (n, 2) float64 ndarray
        (y, z) of the nodes of a cross-section: the axis, rings from there on, the wall last [m].
    area : (n,) float64 ndarray
        What each node stands for [m2]; a sum over the nodes integrates polynomials of degree 4
        over the bore exactly.
    wall_count : int
        Nodes on the wall.
    stations : int
        Cross-sections; station k lies at ``(k + 1/2) * axial_spacing``.
    spacing, axial_spacing : float
        Between rings, and between cross-sections [m].
    """

    place: FloatArray
    area: FloatArray
    wall_count: int
    stations: int
    spacing: float
    axial_spacing: float

    def __len__(self) -> int:
        return len(self.place) * self.stations

    @property
    def position(self) -> FloatArray:
        """Places of all nodes, (nodes, stations, 3) [m]."""
        position = np.empty((len(self.place), self.stations, 3))
        position[..., 0] = (np.arange(self.stations) + 0.5) * self.axial_spacing
        position[..., 1:] = self.place[:, None]
        return position


def node_layout(*, radius: float, length: float, spacing: float) -> NodeLayout:
    """Nodes on rings about the axis, the outermost on the wall.

    Ring k lies at ``k dx`` and holds ``2 round(pi k)`` nodes, one of them on the y axis, so that
    the pattern is its own image in that axis and in the z axis.

    Parameters
    ----------
    radius : float
        Of the bore [m].
    length : float
        Of the period [m].
    spacing : float
        Asked for [m], at most a third of the radius, and the length. The layout's own is the
        nearest one that divides the radius; along the axis, the nearest that divides the length
        into a multiple of four stations without prime factors above five, as suits the kernels
        and the Fourier transform.

    Raises
    ------
    ValueError
        If a length is not positive, or the spacing too wide for the pipe.
    """
    for name, value in (("radius", radius), ("length", length), ("spacing", spacing)):
        if not (np.isfinite(value) and value > 0):
            raise ValueError(f"{name} = {value}: must be > 0 m")
    rings = round(radius / spacing)
    if rings < _FEWEST_RINGS or spacing > length:
        widest = min(radius / _FEWEST_RINGS, length)
        raise ValueError(
            f"spacing = {spacing}: must be at most {widest:g} m, a third of the radius"
        )
    dx = radius / rings
    counts = [1, *(2 * round(np.pi * k) for k in range(1, rings + 1))]
    ring = np.repeat(np.arange(rings + 1), counts)
    angle = np.concatenate([2 * np.pi * np.arange(count) / count for count in counts])
    place = (ring * dx)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    stations = _stations(length / spacing)
    return NodeLayout(
        place=place,
        area=_areas(place, ring, np.array(counts), radius),
        wall_count=counts[-1],
        stations=stations,
        spacing=dx,
        axial_spacing=length / stations,
    )


def _stations(wanted: float) -> int:
    """Multiple of four without prime factors above five that is nearest to a number."""
    most = 2 * math.ceil(wanted) + _FEWEST_STATIONS
    smooth: list[int] = [
        _LANES * 2**i * 3**j * 5**k
        for i in range(most.bit_length())
        for j in range(most.bit_length())
        for k in range(most.bit_length())
        if _FEWEST_STATIONS <= _LANES * 2**i * 3**j * 5**k <= most
    ]
    return min(smooth, key=lambda stations: abs(math.log(stations / wanted)))


def _areas(
    place: FloatArray, ring: NDArray[np.intp], counts: NDArray[np.intp], radius: float
) -> FloatArray:
    """Annulus of each ring over its nodes, changed as little as possible to be exact."""
    rings = len(counts) - 1
    edges = np.concatenate([[0.0], (np.arange(rings) + 0.5) / rings, [1.0]])
    area: FloatArray = (np.pi * np.diff(edges**2) / counts)[ring]
    powers = [(a, b) for a in range(_DEGREE + 1) for b in range(_DEGREE + 1 - a)]
    y, z = place.T / radius
    values = np.array([y**a * z**b for a, b in powers])
    exact = np.array([_moment(a, b) for a, b in powers])
    weighted = values * area
    area = area + np.linalg.solve(weighted @ values.T, exact - weighted.sum(axis=1)) @ weighted
    return area * radius**2


def _moment(a: int, b: int) -> float:
    """Integral of y^a z^b over the unit disc."""
    if a % 2 or b % 2:
        return 0.0
    half = math.gamma((a + 1) / 2) * math.gamma((b + 1) / 2)
    return 2 * half / math.gamma((a + b) / 2 + 1) / (a + b + 2)
