"""Time the step of the liquid on fixed nodes.

usage: python tests/benchmarks/eulerian_step.py [--across 16 24] [--lengths 2 6.4] [--threads 1 2]

Turbulent water in a pipe of 0.2 m, disturbed. CPU and wall time of a step over the nodes, the least
of five; the share of the pressure, and the rate of the bytes that a step must move at least.
"""

from __future__ import annotations

import argparse
import itertools
import sys
import time

import numpy as np

from mpsdem._core import mps
from mpsdem.geometry import node_layout

RADIUS = 0.1  # [m]
# Fields that a stage reads and writes at least, of 8 bytes: convection 3 + 5, eddy viscosity 1 + 1,
# viscous terms 10 + 3, divergence 3 + 1, transforms 4, products 3, correction 4 + 3, wall and bulk
# velocity 2 + 1.
STAGE_BYTES = 8 * 44


def liquid(across: int, length: float, **options: object) -> tuple[mps.EulerianLiquid, int]:
    """Make a liquid, and count its nodes."""
    nodes = node_layout(radius=RADIUS, length=length, spacing=2 * RADIUS / across)
    share = np.hypot(*nodes.place.T)[:, None] / RADIUS
    x = nodes.position[..., 0]
    velocity = np.zeros((*x.shape, 3))
    velocity[..., 0] = 1.2245 * np.maximum(1 - share, 0) ** (1 / 7)
    velocity[..., 1] = 0.1 * (1 - share**2) * np.sin(np.pi * x / RADIUS)
    made = mps.EulerianLiquid(
        place=nodes.place,
        area=nodes.area,
        wall_count=nodes.wall_count,
        stations=nodes.stations,
        spacing=nodes.spacing,
        velocity=velocity,
        pipe_radius=RADIUS,
        pipe_length=length,
        density=1000.0,
        kinematic_viscosity=1e-6,
        roughness=0.0,
        turbulent=True,
        bulk_velocity=1.0,
        **options,
    )
    return made, len(nodes)


def row(across: int, length: float, convection: str, scheme: str, threads: int) -> str:
    """One line of the table."""
    flow, count = liquid(across, length, convection=convection, scheme=scheme, threads=threads)
    flow.advance(0.01)
    cpu, wall, solve = [], [], []
    for _ in range(5):
        began, clock = time.process_time(), time.perf_counter()
        report = flow.advance(0.04)
        steps = report.substeps * count / 1e6
        cpu.append((time.process_time() - began) / steps)
        wall.append((time.perf_counter() - clock) / steps)
        solve.append(report.solve_seconds / steps)
    stages = 2 if scheme == "rk2" else 3
    rate = stages * STAGE_BYTES / min(wall) / 1e3  # [GB/s]
    return (
        f"{across:4d} {length:6.1f} {count:8d}  {convection:7} {scheme} {threads:4d} "
        f"{min(cpu):8.3f} {min(wall):8.3f} {min(solve):8.3f} {rate:8.1f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--across", type=int, nargs="+", default=[16, 24])
    parser.add_argument("--lengths", type=float, nargs="+", default=[2.4, 6.4], help="[m]")
    parser.add_argument("--convection", nargs="+", default=["upwind", "muscl"])
    parser.add_argument("--scheme", nargs="+", default=["rk2"])
    parser.add_argument("--threads", type=int, nargs="+", default=[1])
    given = parser.parse_args()
    write = sys.stdout.write
    write(
        "D/dx  L [m]    nodes  form    steps thr   cpu us  wall us pressure     GB/s\n"
        "                                      of a node and step\n"
    )
    for case in itertools.product(
        given.across, given.lengths, given.convection, given.scheme, given.threads
    ):
        write(row(*case) + "\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
