"""Solids at the start of a run: placed as the case says, and never overlapping."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree  # type: ignore[import-untyped, unused-ignore]

from mpsdem.case import Block, Case, CaseError, List, Pipe, Problem, Random
from mpsdem.geometry.size import sample_diameters

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.intp]

# Overlap over diameter that round-off of touching spheres may leave.
_ROUND_OFF = 1e-12
# Solids are pushed this much farther apart than touching, relative to their radius, so that a
# relaxation which approaches contact from within ends after a finite number of passes.
_CLEARANCE = 1e-3
# Share of the largest diameter by which a pair may be apart and still be watched.
_SKIN = 0.3
_PASSES = 5000
_NAMED = 5


@dataclass(frozen=True, slots=True, kw_only=True)
class Placement:
    """Solids at the start of a run.

    Parameters
    ----------
    position : (n, 3) float64 ndarray
        Centres, x from 0 to less than the length of the pipe [m].
    velocity : (n, 3) float64 ndarray
        Velocity [m/s].
    spin : (n, 3) float64 ndarray
        Angular velocity [rad/s].
    radius : (n,) float64 ndarray
        Radius [m].
    """

    position: FloatArray
    velocity: FloatArray
    spin: FloatArray
    radius: FloatArray


def place_solids(case: Case) -> Placement:
    """Place the solids of a case.

    Parameters
    ----------
    case : Case
        The case; without solids the placement is empty.

    Returns
    -------
    Placement
        The same for the same case, always.

    Raises
    ------
    CaseError
        If solids overlap the wall or each other by more than 1e-12 diameters, naming them; with
        ``relax = true`` or in a random arrangement, if they cannot be pushed apart.
    """
    solids, pipe = case.solids, case.pipe
    if solids is None:
        return Placement(
            position=np.zeros((0, 3)),
            velocity=np.zeros((0, 3)),
            spin=np.zeros((0, 3)),
            radius=np.zeros(0),
        )
    generator = np.random.default_rng(solids.seed)
    count = case.solids_count
    radius = sample_diameters(solids.diameter, count, generator) / 2
    spin = np.zeros((count, 3))
    match solids.arrangement:
        case Block() as block:
            position = _on_lattice(block, pipe, count, solids.largest_diameter)
            velocity = np.tile(block.velocity, (count, 1))
        case Random() as stretch:
            position = _pushed_apart(
                _anywhere(stretch, pipe, radius, generator), radius, pipe, generator, stretch
            )
            velocity = np.tile(stretch.velocity, (count, 1))
        case List() as each:
            position = np.array(each.positions)
            velocity = (
                np.zeros((count, 3)) if each.velocities is None else np.array(each.velocities)
            )
            spin = spin if each.spins is None else np.array(each.spins)
            radius = radius if each.diameters is None else np.array(each.diameters) / 2
    position = _wrapped(position, pipe)
    if solids.relax and not isinstance(solids.arrangement, Random):
        position = _pushed_apart(position, radius, pipe, generator)
    _refuse_overlaps(position, radius, pipe)
    return Placement(position=position, velocity=velocity, spin=spin, radius=radius)


def _on_lattice(block: Block, pipe: Pipe, count: int, diameter: float) -> FloatArray:
    counts = np.array(block.counts)
    index = np.stack(np.unravel_index(np.arange(count), block.counts), axis=1)
    pitch = diameter * (1 + block.gap)
    return pitch * (index - (counts - 1) / 2) + [block.at * pipe.length, 0.0, 0.0]


def _anywhere(
    stretch: Random, pipe: Pipe, radius: FloatArray, generator: np.random.Generator
) -> FloatArray:
    along, across, angle = generator.random((3, len(radius)))
    distance = (pipe.radius - radius) * np.sqrt(across)
    angle *= 2 * np.pi
    x = pipe.length * (stretch.start + along * (stretch.end - stretch.start))
    return np.stack([x, distance * np.cos(angle), distance * np.sin(angle)], axis=1)


def _wrapped(position: FloatArray, pipe: Pipe) -> FloatArray:
    wrapped = position.copy()
    wrapped[:, 0] %= pipe.length
    wrapped[wrapped[:, 0] >= pipe.length, 0] = 0.0  # the remainder of -1e-20 rounds to the length
    return wrapped


def _pushed_apart(
    position: FloatArray,
    radius: FloatArray,
    pipe: Pipe,
    generator: np.random.Generator,
    stretch: Random | None = None,
) -> FloatArray:
    """Move overlapping solids along their lines of centres, half the overlap each, till none is.

    The pairs to look at are found anew when a solid has moved half the skin, as in a Verlet list.
    """
    confined = stretch is not None and (stretch.start, stretch.end) != (0.0, 1.0)
    wanted = radius * (1 + _CLEARANCE)
    skin = _SKIN * 2 * radius.max()
    position = _inside(position, wanted, pipe, stretch if confined else None)
    searched = position
    first, second = _near(position, pipe, 2 * wanted.max() + skin)
    deepest = np.inf
    for _ in range(_PASSES):
        apart, distance = _separation(position, first, second, pipe)
        overlap = wanted[first] + wanted[second] - distance
        deepest = float((radius[first] + radius[second] - distance).max(initial=0.0))
        if deepest <= 0:
            return _wrapped(position, pipe)
        hit = overlap > 0
        i, j = first[hit], second[hit]
        direction = apart[hit] / np.where(distance[hit] > 0, distance[hit], 1.0)[:, None]
        lost = distance[hit] == 0
        direction[lost] = _unit_vectors(int(lost.sum()), generator)
        push = overlap[hit][:, None] * direction / 2
        position = position + np.stack(
            [
                np.bincount(i, push[:, k], len(radius)) - np.bincount(j, push[:, k], len(radius))
                for k in range(3)
            ],
            axis=1,
        )
        position = _inside(position, wanted, pipe, stretch if confined else None)
        if np.square(position - searched).sum(axis=1).max() > (skin / 2) ** 2:
            position = _wrapped(position, pipe)
            searched = position
            first, second = _near(position, pipe, 2 * wanted.max() + skin)
    raise CaseError(
        [
            Problem(
                field="solids.arrangement",
                rule=f"{len(radius)} solids cannot be pushed apart: "
                f"after {_PASSES} passes the deepest overlap is still {deepest:.3g} m",
                remedy="take fewer or smaller solids, or give them a longer stretch of the pipe",
            )
        ]
    )


def _inside(
    position: FloatArray, radius: FloatArray, pipe: Pipe, stretch: Random | None
) -> FloatArray:
    """Bring solids back that reach through the wall, or out of their stretch of the pipe."""
    room = np.maximum(pipe.radius - radius, 0.0)
    distance = np.hypot(position[:, 1], position[:, 2])
    inside = position * [1.0, 0.0, 0.0]
    scale = np.where(distance > room, room / np.where(distance > 0, distance, 1.0), 1.0)
    inside[:, 1:] = position[:, 1:] * scale[:, None]
    if stretch is not None:
        inside[:, 0] = np.clip(
            position[:, 0],
            stretch.start * pipe.length + radius,
            stretch.end * pipe.length - radius,
        )
    return inside


def _near(position: FloatArray, pipe: Pipe, reach: float) -> tuple[IntArray, IntArray]:
    """Pairs with centres nearer than `reach`, across the ends too, in a fixed order."""
    tree = cKDTree(_wrapped(position, pipe), boxsize=np.array([pipe.length, 0.0, 0.0]))
    pairs = tree.query_pairs(reach, output_type="ndarray")
    ordered = pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]
    return ordered[:, 0], ordered[:, 1]


def _separation(
    position: FloatArray, first: IntArray, second: IntArray, pipe: Pipe
) -> tuple[FloatArray, FloatArray]:
    """Vectors (m, 3) from second to first, across the ends where that is nearer; lengths (m,)."""
    apart = position[first] - position[second]
    apart[:, 0] -= pipe.length * np.round(apart[:, 0] / pipe.length)
    return apart, np.linalg.norm(apart, axis=1)


def _unit_vectors(count: int, generator: np.random.Generator) -> FloatArray:
    vectors = generator.normal(size=(count, 3))
    vectors /= np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors


def _refuse_overlaps(position: FloatArray, radius: FloatArray, pipe: Pipe) -> None:
    problems = _through_the_wall(position, radius, pipe) + _into_each_other(position, radius, pipe)
    if problems:
        raise CaseError(problems)


def _through_the_wall(position: FloatArray, radius: FloatArray, pipe: Pipe) -> list[Problem]:
    reach = np.hypot(position[:, 1], position[:, 2]) + radius
    outside = np.flatnonzero(reach - pipe.radius > _ROUND_OFF * 2 * radius)
    named = [
        f"solid {i} at {_point(position[i])} reaches {reach[i]:.6g} m from the axis, "
        f"through the wall at {pipe.radius:g} m"
        for i in outside[:_NAMED]
    ]
    return _listed(
        named, len(outside), f"overlap of the wall by {len(outside)} of {len(radius)} solids"
    )


def _into_each_other(position: FloatArray, radius: FloatArray, pipe: Pipe) -> list[Problem]:
    first, second = _near(position, pipe, 2 * radius.max())
    _, distance = _separation(position, first, second, pipe)
    overlap = radius[first] + radius[second] - distance
    deep = np.flatnonzero(overlap > _ROUND_OFF * 2 * np.minimum(radius[first], radius[second]))
    named = [
        f"solid {first[k]} at {_point(position[first[k]])} and "
        f"solid {second[k]} at {_point(position[second[k]])} overlap by {overlap[k]:.6g} m"
        for k in deep[:_NAMED]
    ]
    return _listed(named, len(deep), f"overlap in {len(deep)} pairs of solids")


def _listed(named: list[str], count: int, summary: str) -> list[Problem]:
    if not named:
        return []
    rest = [f"... and {count - len(named)} more"] if count > len(named) else []
    remedy = "move them apart, or write relax = true to have them pushed apart first"
    return [
        Problem(field="solids.arrangement", rule=summary, remedy=remedy),
        *(Problem(field="solids.arrangement", rule=line) for line in named + rest),
    ]


def _point(position: FloatArray) -> str:
    return "({:.6g}, {:.6g}, {:.6g}) m".format(*position)
