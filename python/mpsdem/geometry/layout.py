"""Liquid of a straight pipe as particles, with the layers of wall and ghosts around it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
KindArray = NDArray[np.int8]


class Kind(IntEnum):
    """What a particle is, numbered as in results of the method.

    Notes
    -----
    The numbers are those of Pan, Wei & Wan, "MPS-DEM Method for Particle Effects on Mixed
    Transportation Characteristics of Horizontal Pipeline".
    """

    WALL = -2
    GHOST = -1
    LIQUID = 2


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Layout:
    """Particles of a full straight pipe about the x axis, periodic along it.

    Parameters
    ----------
    position : (n, 3) float64 ndarray
        Liquid first, then the wall, then ghosts from the wall outwards; x from 0 to less than the
        pipe's length [m].
    kind : (n,) int8 ndarray
        2 liquid, -2 wall, -1 ghost.
    spacing : float
        Between particles in a cross-section: the one to scale the operators by [m].
    axial_spacing : float
        Between cross-sections; a whole number of them fills the length [m].
    """

    position: FloatArray
    kind: KindArray
    spacing: float
    axial_spacing: float


def ring_layout(*, radius: float, length: float, spacing: float, ghost_layers: int = 1) -> Layout:
    """Particles on rings about the axis, so that the wall is as round as the pipe.

    Liquid rings lie at ``radius - (k + 1/2) dx``, the wall's at ``radius + dx / 2``, the ghosts'
    each ``dx`` behind the last; a ring at r holds ``round(2 pi r / dx)`` particles.

    Parameters
    ----------
    radius : float
        Of the bore [m].
    length : float
        Of the period [m].
    spacing : float
        Asked for [m], at most the radius and the length. The layout's own ``dx`` is the nearest
        one that divides the radius.
    ghost_layers : int
        Rings behind the wall's. One fills the reach of 2.1 dx, two that of 3.1 dx.

    Returns
    -------
    Layout
        The liquid, a cube of side ``dx`` for each particle, fills the bore to 1 % from three rings
        on, to 5 % with fewer.

    Raises
    ------
    ValueError
        If a length is not positive, or the spacing too wide for the pipe.
    """
    _check(radius, length, spacing, ghost_layers)
    rings = round(radius / spacing)
    dx = radius / rings
    # From the axis outwards: liquid, wall, ghosts. Every other ring is turned by half a space.
    at = [(k + 0.5) * dx for k in range(rings + 1 + ghost_layers)]
    sections = [_ring(r, round(2 * np.pi * r / dx), turned=k % 2 == 1) for k, r in enumerate(at)]
    parts = [
        (np.concatenate(sections[:rings]), Kind.LIQUID),
        (sections[rings], Kind.WALL),
        *((ring, Kind.GHOST) for ring in sections[rings + 1 :]),
    ]
    return _extruded(parts, length, dx, spacing)


def push_plate_layout(
    *, radius: float, length: float, spacing: float, upstream: float, downstream: float
) -> Layout:
    """Particles of a pipe whose liquid a plate pushes: `ring_layout`, closed by a disc upstream.

    Parameters
    ----------
    radius : float
        Of the bore [m].
    length : float
        From inlet to outlet [m].
    spacing : float
        Asked for [m], at most the radius and the length.
    upstream, downstream : float
        How far liquid and wall reach beyond the inlet and the outlet [m].

    Returns
    -------
    Layout
        x from ``-upstream`` to ``length + downstream``. The plate is a disc of wall and one of
        ghosts, half a spacing and one and a half before ``-upstream``; two more rings of wall and
        ghosts stand around it.

    Raises
    ------
    ValueError
        If a length is not positive, or the spacing too wide for the pipe.
    """
    whole = length + upstream + downstream
    pipe = ring_layout(radius=radius, length=whole, spacing=spacing)
    dx = pipe.axial_spacing
    liquid = pipe.kind == Kind.LIQUID
    first = pipe.position[:, 0] < dx
    discs = [
        (pipe.position[first & liquid] * [0.0, 1.0, 1.0] - [(k + 0.5) * dx, 0.0, 0.0], kind)
        for k, kind in enumerate((Kind.WALL, Kind.GHOST))
    ]
    collar = pipe.position[first & ~liquid] * [0.0, 1.0, 1.0]
    added = [disc for disc, _ in discs] + [collar - [(k + 0.5) * dx, 0.0, 0.0] for k in (0, 1)]
    kinds = [np.full(len(disc), kind, dtype=np.int8) for disc, kind in discs]
    kinds += 2 * [pipe.kind[first & ~liquid]]
    return Layout(
        position=np.concatenate([pipe.position, *added]) - [upstream, 0.0, 0.0],
        kind=np.concatenate([pipe.kind, *kinds]),
        spacing=pipe.spacing,
        axial_spacing=dx,
    )


def lattice_layout(
    *, radius: float, length: float, spacing: float, ghost_layers: int = 2
) -> Layout:
    """Particles on a cubic lattice, cut by the wall: uniform inside, with a staircase for a wall.

    Parameters
    ----------
    radius : float
        Of the bore [m].
    length : float
        Of the period [m].
    spacing : float
        Of the lattice [m], at most the radius and the length.
    ghost_layers : int
        Layers behind the wall's, each as thick as the spacing. Two fill the reach of 2.1 dx, three
        that of 3.1 dx.

    Returns
    -------
    Layout
        Liquid inside the bore, wall up to one spacing outside, ghosts behind. The gap between
        liquid and the true wall varies from 0 to a spacing along the circumference.

    Raises
    ------
    ValueError
        If a length is not positive, or the spacing too wide for the pipe.

    Notes
    -----
    A laminar flow's error is eight times that on rings: prefer `ring_layout` for pipes.
    """
    _check(radius, length, spacing, ghost_layers)
    reach = int(radius / spacing) + ghost_layers + 2
    across = (np.arange(-reach, reach) + 0.5) * spacing
    section = np.stack(np.meshgrid(across, across, indexing="ij"), axis=-1).reshape(-1, 2)
    depth = np.hypot(section[:, 0], section[:, 1]) - radius
    layer = np.floor(depth / spacing)  # negative: liquid, 0: wall, 1 and more: ghosts
    parts = [
        (section[layer < 0], Kind.LIQUID),
        (section[layer == 0], Kind.WALL),
        *((section[layer == k], Kind.GHOST) for k in range(1, ghost_layers + 1)),
    ]
    return _extruded(parts, length, spacing, spacing)


def _check(radius: float, length: float, spacing: float, ghost_layers: int) -> None:
    for name, value in (("radius", radius), ("length", length), ("spacing", spacing)):
        if not (np.isfinite(value) and value > 0):
            raise ValueError(f"{name} = {value}: must be > 0 m")
    for name, value in (("radius", radius), ("length", length)):
        if spacing > value:
            raise ValueError(f"spacing = {spacing}: must be at most the {name}, {value} m")
    if ghost_layers < 0:
        raise ValueError(f"ghost_layers = {ghost_layers}: must be >= 0")


def _ring(r: float, count: int, *, turned: bool) -> FloatArray:
    angle = (np.arange(count) + 0.5 * turned) * (2 * np.pi / count)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle)])


def _extruded(
    parts: list[tuple[FloatArray, Kind]], length: float, spacing: float, asked: float
) -> Layout:
    """Repeat a cross-section along the pipe, at stations half a spacing from its ends."""
    stations = round(length / asked)
    x = (np.arange(stations) + 0.5) * (length / stations)
    position, kind = [], []
    for section, of_kind in parts:
        count = stations * len(section)
        position.append(
            np.column_stack([np.repeat(x, len(section)), np.tile(section, (stations, 1))])
        )
        kind.append(np.full(count, of_kind, dtype=np.int8))
    return Layout(
        position=np.concatenate(position),
        kind=np.concatenate(kind),
        spacing=spacing,
        axial_spacing=length / stations,
    )
