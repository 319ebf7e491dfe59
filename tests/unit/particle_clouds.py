"""Clouds of particles and the matrix of their pressure equation, by NumPy and SciPy alone."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array, diags_array
from scipy.spatial import cKDTree

REACH = 2.1  # effective radius in particle spacings


@dataclass(frozen=True, slots=True, kw_only=True)
class Cloud:
    """Particles at positions [m], near in number where near in space, and the rows of neighbors."""

    position: NDArray[np.float64]
    row: NDArray[np.uint32]
    column: NDArray[np.uint32]
    weight: NDArray[np.float32]
    spacing: float  # [m]

    @classmethod
    def of(cls, position: NDArray[np.float64], graph: csr_array, *, spacing: float) -> Cloud:
        """Make a cloud of its graph of weights, both directions of each pair in it."""
        graph.sort_indices()
        return cls(
            position=position,
            row=graph.indptr.astype(np.uint32),
            column=graph.indices.astype(np.uint32),
            weight=graph.data,
            spacing=spacing,
        )

    @property
    def arrays(self) -> dict[str, NDArray[np.generic]]:
        """What a LaplacianMatrix is made of."""
        return {"row": self.row, "column": self.column, "weight": self.weight}

    def moved(self, by: ArrayLike) -> Cloud:
        """Shift the particles."""
        return replace(self, position=self.position + np.asarray(by))

    def matrix(self, dirichlet: NDArray[np.float64] | None = None) -> csr_array:
        """Assemble the same matrix in double precision."""
        n = len(self.position)
        weight = csr_array((self.weight.astype(float), self.column, self.row), shape=(n, n))
        diagonal = weight.sum(axis=1) + (0 if dirichlet is None else dirichlet)
        return csr_array(diags_array(diagonal) - weight)


def kernel(r: NDArray[np.float64], effective_radius: float) -> NDArray[np.float64]:
    """Weight of a neighbor at distance r."""
    return effective_radius / (0.85 * r + 0.15 * effective_radius) - 1


def joined(position: NDArray[np.float64], *, spacing: float, period: float = 0.0) -> Cloud:
    """Sort positions by slabs along x and join the neighbors within reach."""
    cell = np.floor(position / (REACH * spacing)).astype(int)
    position = position[np.lexsort(cell.T[::-1])]
    reach = REACH * spacing
    tree = cKDTree(position - position.min(axis=0), boxsize=[period, 0, 0])
    pairs = tree.query_pairs(reach, output_type="ndarray")
    apart = position[pairs[:, 0]] - position[pairs[:, 1]]
    if period:
        apart[:, 0] -= period * np.round(apart[:, 0] / period)
    weight = kernel(np.linalg.norm(apart, axis=1), reach).astype(np.float32)
    n = len(position)
    half = csr_array((weight, pairs.T), shape=(n, n))
    return Cloud.of(position, csr_array(half + half.T), spacing=spacing)


@cache
def pipe(*, spacing: float, diameter: float, length: float, periodic: bool, seed: int = 0) -> Cloud:
    """Fill a pipe with a jittered lattice, its wall layer included."""
    rng = np.random.default_rng(seed)
    along = np.arange(round(length / spacing)) + 0.5
    across = np.arange(-np.ceil(diameter / spacing) - 2, np.ceil(diameter / spacing) + 2) + 0.5
    y, z = np.meshgrid(across, across)
    inside = np.hypot(y, z) * spacing < diameter / 2 + spacing
    section = np.column_stack([y[inside], z[inside]])
    position = np.column_stack([np.repeat(along, len(section)), np.tile(section, (len(along), 1))])
    position = spacing * (position + rng.uniform(-0.2, 0.2, position.shape))
    return joined(position, spacing=spacing, period=length if periodic else 0.0)
