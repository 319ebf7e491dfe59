"""How fast this machine is: two fixed pieces of work for the compiled kernels, timed."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mpsdem._core import dem, geometry, mps
from mpsdem.geometry import node_layout

_REPEATS = 5
_SOLIDS, _FALL, _SOLID_STEPS = 6, 25_000, 3000  # along an edge of the block; steps
_ACROSS, _NODE_TIME = 12, 0.25  # spacings across the bore; [s] of flow


@dataclass(frozen=True, slots=True, kw_only=True)
class Machine:
    """Processor time of fixed work, in one thread.

    Parameters
    ----------
    solids, liquid : float
        Of 216 spheres that lie in a pipe, 3000 steps, and of turbulent water on 5952 nodes for
        0.25 s [s].
    """

    solids: float
    liquid: float

    @classmethod
    def measured(cls) -> Machine:
        """Time both, the shortest of five; less than a second in all."""
        return cls(solids=_shortest(_some_solids), liquid=_shortest(_some_liquid))

    def slower_than(self, other: Machine, *, of_solids: float) -> float:
        """How many times longer this machine takes than another.

        Parameters
        ----------
        other : Machine
        of_solids : float
            Share of the work, by its time on the other, that is the solids' [-].
        """
        return float(
            of_solids * self.solids / other.solids
            + (1 - of_solids) * self.liquid / other.liquid
        )  # fmt: skip


#: Where the constants of the plan's estimate were fitted.
REFERENCE = Machine(solids=0.031, liquid=0.027)


def _shortest(prepare: Callable[[], Callable[[], object]]) -> float:
    work = prepare()
    times = []
    for _ in range(_REPEATS):
        began = time.process_time()
        work()
        times.append(time.process_time() - began)
    return min(times)


def _some_solids() -> Callable[[], object]:
    count, radius, pipe = _SOLIDS**3, 0.01, 0.1
    lattice = np.indices((_SOLIDS,) * 3).reshape(3, -1).T - (_SOLIDS - 1) / 2
    law = dem.HertzMindlin(
        youngs_modulus=1e8, poisson_ratio=0.2, restitution=0.9, friction=0.2
    )  # fmt: skip
    solids = dem.Solids(
        position=2.01 * radius * lattice + np.array([0.5, 0.0, 0.0]),
        velocity=np.zeros((count, 3)),
        spin=np.zeros((count, 3)),
        radius=np.full(count, radius),
        density=np.full(count, 2700.0),
        pair_law=law,
        wall_law=law,
        walls=[geometry.Cylinder(radius=pipe, velocity=np.zeros(3))],
        period=1.0,
        threads=1,
    )
    solids.set_forcing(acceleration=np.tile([0.0, 0.0, -9.81], (count, 1)))
    solids.advance(2e-5, _FALL)  # to the wall, and to rest
    return lambda: solids.advance(2e-5, _SOLID_STEPS)


def _some_liquid() -> Callable[[], object]:
    radius = 0.1
    nodes = node_layout(radius=radius, length=0.8, spacing=2 * radius / _ACROSS)
    share = np.hypot(*nodes.place.T)[:, None] / radius
    x = nodes.position[..., 0]
    velocity = np.zeros((*x.shape, 3))
    velocity[..., 0] = 1.2245 * np.maximum(1 - share, 0) ** (1 / 7)
    velocity[..., 1] = 0.1 * (1 - share**2) * np.sin(math.pi * x / (4 * radius))
    flow = mps.EulerianLiquid(
        place=nodes.place,
        area=nodes.area,
        wall_count=nodes.wall_count,
        stations=nodes.stations,
        spacing=nodes.spacing,
        velocity=velocity,
        pipe_radius=radius,
        pipe_length=0.8,
        density=1000.0,
        kinematic_viscosity=1e-6,
        roughness=0.0,
        turbulent=True,
        bulk_velocity=1.0,
        threads=1,
    )
    flow.advance(0.02)
    return lambda: flow.advance(_NODE_TIME)
