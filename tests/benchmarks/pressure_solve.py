"""Time the pressure solve, and show that its iterations do not grow with the length of a pipe.

usage: python tests/benchmarks/pressure_solve.py [--spacing 0.0075] [--lengths 4 16] [--threads 1]

A pipe of 0.2 m filled with a jittered lattice and its wall layer: 3.5e5 unknowns in 4 m. Twice: as
a periodic pipe without any known value, and with an inflow at one end and known values at the
other, the long wave at its worst. CPU time, the least of three.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "unit"))
from particle_clouds import Cloud, pipe

from mpsdem._core import linear

DIAMETER = 0.2  # [m]
METHODS = {"additive": linear.TwoLevelAdditive, "deflation": linear.TwoLevelDeflation}
TOLERANCES = (1e-3, 1e-6)


def least_of_three(work: Callable[[], Any]) -> tuple[float, Any]:
    """CPU time [s] of some work, and what it returns."""
    seconds = []
    for _ in range(3):
        began = time.process_time()
        result = work()
        seconds.append(time.process_time() - began)
    return min(seconds), result


def problem(cloud: Cloud, *, periodic: bool) -> tuple[np.ndarray, np.ndarray | None]:
    """Right-hand side, and the known values."""
    noise = np.random.default_rng(1).standard_normal(len(cloud.position))
    if periodic:
        return noise, None
    x = cloud.position[:, 0]
    inflow = 10 * (x < 2 * cloud.spacing)
    return noise + inflow, 3.0 * (x > x.max() - 2 * cloud.spacing)


def rows(spacing: float, length: float, *, periodic: bool, threads: int) -> list[str]:
    """One line for each method and tolerance."""
    cloud = pipe(spacing=spacing, diameter=DIAMETER, length=length, periodic=periodic)
    b, dirichlet = problem(cloud, periodic=periodic)
    period = length if periodic else 0.0
    assembly, matrix = least_of_three(
        lambda: linear.LaplacianMatrix(**cloud.arrays, dirichlet=dirichlet, threads=threads)
    )
    lines = []
    for name, two_level in METHODS.items():
        set_up, m = least_of_three(
            lambda make=two_level: make(
                matrix,
                position=cloud.position,
                particle_spacing=spacing,
                period=period,
                threads=threads,
            )
        )
        for tolerance in TOLERANCES:
            seconds, solution = least_of_three(
                lambda m=m, tolerance=tolerance: linear.conjugate_gradients(
                    matrix, b, preconditioner=m, tolerance=tolerance, threads=threads
                )
            )
            ends = "periodic" if periodic else "outlet"
            lines.append(
                f"{ends:9} {length:5.1f} {len(matrix):9d}  {name:10} {tolerance:7.0e}"
                f" {solution.iterations:4d} {assembly:8.3f} {set_up:8.3f} {seconds:8.3f}"
                f" {set_up + seconds:8.3f}"
            )
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--spacing", type=float, default=0.0075, help="of the particles [m]")
    parser.add_argument("--lengths", type=float, nargs="+", default=[4.0, 16.0], help="[m]")
    parser.add_argument("--threads", type=int, default=1)
    given = parser.parse_args()
    write = sys.stdout.write
    write(
        "ends       L [m]  unknowns  method    tolerance  it   matrix   set-up    solve      sum\n"
    )
    for periodic in (True, False):
        for length in given.lengths:
            lines = rows(given.spacing, length, periodic=periodic, threads=given.threads)
            write("\n".join(lines) + "\n")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
