"""The bed: solids that rest on the wall below them, on their own or on others."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array  # type: ignore[import-untyped, unused-ignore]
from scipy.sparse.csgraph import (  # type: ignore[import-untyped, unused-ignore]
    connected_components,
)
from scipy.spatial import cKDTree  # type: ignore[import-untyped, unused-ignore]

FloatArray = NDArray[np.float64]


def in_bed(
    position: FloatArray,
    radius: FloatArray,
    *,
    pipe_radius: float,
    length: float,
    gap: float = 0.02,
) -> NDArray[np.bool_]:
    """Which solids rest on the lower half of the wall, through a chain of touching solids.

    Parameters
    ----------
    position : (n, 3) float64 ndarray
        Centres [m]; z points away from where solids settle.
    radius : (n,) float64 ndarray
        Radii [m].
    pipe_radius, length : float
        The periodic bore [m].
    gap : float
        Widest gap at which two still count as touching, over their mean diameter, and over the
        diameter at the wall [-]: a bed that moves rattles.

    Returns
    -------
    (n,) bool ndarray
        The contact load; all others are suspended, or between two jumps.

    Notes
    -----
    A single solid that happens to be at the wall in this instant counts as resting there. Contact
    load and suspended load are the terms of Bagnold (1956), doi:10.1098/rsta.1956.0020.
    """
    if not len(position):
        return np.zeros(0, dtype=bool)
    x = position.copy()
    x[:, 0] %= length
    x[x[:, 0] >= length, 0] = 0.0  # a remainder that was rounded up
    reach = 2 * float(radius.max()) * (1 + gap)
    # shorter pipes than that hold no two neighbors to tell apart
    box: Any = (length, 0.0, 0.0) if length > 2 * reach else None
    tree = cKDTree(x, boxsize=box)
    first, second = tree.query_pairs(reach, output_type="ndarray").T
    away = x[first] - x[second]
    away[:, 0] -= length * np.rint(away[:, 0] / length)
    touching = np.linalg.norm(away, axis=1) <= (radius[first] + radius[second]) * (1 + gap)
    first, second = first[touching], second[touching]
    chains = coo_array((np.ones(len(first)), (first, second)), shape=(len(x), len(x)))
    _, chain = connected_components(chains, directed=False)
    room = pipe_radius - radius - np.hypot(x[:, 1], x[:, 2])
    on_wall = (room <= 2 * gap * radius) & (x[:, 2] < 0)
    return np.asarray(np.isin(chain, chain[on_wall]))


def bed_height(z: FloatArray, radius: FloatArray, *, pipe_radius: float) -> float:
    """Height above the lowest line of the bore below which 95 % of the solids lie whole [m].

    Parameters
    ----------
    z : (n,) float64 ndarray
        Heights of the centres from the axis [m].
    radius : (n,) float64 ndarray
        Radii [m].
    pipe_radius : float
        Radius of the bore [m].
    """
    return float(np.quantile(z + radius, 0.95) + pipe_radius)
