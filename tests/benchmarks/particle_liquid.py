"""Time a step of the particle liquid, and say what the machine would allow.

usage: python tests/benchmarks/particle_liquid.py [--spacing 0.0075] [--length 4] [--steps 20]

Turbulent flow in a pipe of 0.2 m at a Reynolds number of 2e5: 3e5 liquid particles in 4 m. One and
two threads after each other; wall clock over the steps after the first. The floor of a sweep over
the neighbors is the time to read its list once at the speed that a sum over a long array reaches.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_WAIT_POLICY", "passive")

import argparse
import resource
import sys
import time

import numpy as np

from mpsdem._core import mps
from mpsdem._core.neighbors import NeighborList
from mpsdem.geometry import Kind, ring_layout

RADIUS = 0.1  # [m]
VISCOSITY = 1e-6  # [m2/s]
COURANT = 0.8


def liquid(spacing: float, length: float, threads: int) -> mps.LagrangianLiquid:
    """Make the liquid with its developed profile and 2 % of noise."""
    layout = ring_layout(radius=RADIUS, length=length, spacing=spacing)
    moving = layout.kind == Kind.LIQUID
    profile = mps.PipeProfile(
        pipe_radius=RADIUS, bulk_velocity=1.0, kinematic_viscosity=VISCOSITY, roughness=0.0
    )
    velocity = np.where(moving[:, None], profile.velocity(layout.position), 0.0)
    velocity[moving] += np.random.default_rng(0).normal(0, 0.02, (moving.sum(), 3))
    return mps.LagrangianLiquid(
        position=layout.position,
        velocity=velocity,
        kind=layout.kind,
        particle_spacing=layout.spacing,
        pipe_radius=RADIUS,
        pipe_length=length,
        density=1000.0,
        kinematic_viscosity=VISCOSITY,
        roughness=0.0,
        turbulence=mps.MixingLength(pipe_radius=RADIUS),
        bulk_velocity=1.0,
        courant=COURANT,
        threads=threads,
    )


def say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def bandwidth() -> float:
    """What one thread reads from memory [bytes/s], the most of five."""
    array = np.ones(20_000_000)
    seconds = []
    for _ in range(5):
        began = time.perf_counter()
        array.sum()
        seconds.append(time.perf_counter() - began)
    return array.nbytes / min(seconds)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--spacing", type=float, default=0.0075)
    parser.add_argument("--length", type=float, default=4.0)
    parser.add_argument("--steps", type=int, default=20)
    options = parser.parse_args()

    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for threads in (1, 2):
        particles = liquid(options.spacing, options.length, threads)
        count = particles.liquid_count
        step = COURANT * options.spacing / 1.4
        particles.advance(step)
        began, substeps, iterations, solving = time.perf_counter(), 0, 0, 0.0
        for _ in range(options.steps):
            report = particles.advance(step)
            substeps += report.substeps
            iterations += report.iterations
            solving += report.solve_seconds
        each = 1e6 / substeps / count
        wall = (time.perf_counter() - began) * each
        say(
            f"{count} particles, {threads} thread(s): {wall:.2f} us a particle and step, "
            f"{solving * each:.2f} of it pressure in {iterations / substeps:.1f} iterations"
        )
        if threads == 1:
            memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
            say(f"memory: {memory * 1024 / count:.0f} bytes a particle")
    position = particles.position
    neighbors = len(
        NeighborList(position, radius=2.1 * options.spacing, period=options.length).column
    ) / len(position)
    speed = bandwidth()
    say(
        f"floor of a sweep: {neighbors:.0f} neighbors of 8 bytes at {speed / 1e9:.1f} GB/s, "
        f"{neighbors * 8 / speed * 1e6:.3f} us a particle"
    )


if __name__ == "__main__":
    main()
