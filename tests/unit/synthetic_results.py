"""Made-up runs for the tests of what reads results: a cluster that collapses and stretches."""

import numpy as np

from mpsdem.case import Case
from mpsdem.results import ResultsWriter, write_summary
from mpsdem.results.summary import SUMMARY_KEYS

CASE = Case(
    title="Made-up cluster",
    end_time=8.0,
    pipe={"radius": 0.1, "length": 4.0},
    liquid={"density": 1000.0, "kinematic_viscosity": 1e-6, "bulk_velocity": 1.0},
    solids={
        "diameter": 0.02,
        "density": 2700.0,
        "youngs_modulus": 1e8,
        "arrangement": {"kind": "block", "counts": [4, 4, 4]},
    },
    output={"every": 0.5},
)
CLEAR = Case(
    end_time=8.0,
    pipe=CASE.pipe.model_dump(),
    liquid=CASE.liquid.model_dump(),
    output={"every": 0.5},
)
TIMES = np.arange(0.0, 8.25, 0.5)
PROVENANCE = {"version": "0.1.0", "compiler": "none", "threads": 2}


def cluster(time):
    """Unwrapped positions and velocities (64, 3) of spheres of radius 0.01 m that never touch."""
    i, j, k = (index.ravel() for index in np.indices((4, 4, 4)))
    start = np.column_stack([2.0 + 0.021 * i, 0.021 * (j - 1.5), -0.05 + 0.021 * k])
    speed = 0.4 + 0.1 * k + 0.02 * i
    position = start + np.outer(speed * time, [1.0, 0.0, 0.0])
    return position, np.outer(speed, [1.0, 0.0, 0.0])


def frame(time, case=CASE):
    """What a run would append at `time`."""
    diagnostics = {"pressure_gradient": 80.0 + 5.0 * np.sin(time), "contacts": 3}
    if case.solids is None:
        return {"diagnostics": diagnostics}
    position, velocity = cluster(time)
    laps, x = np.divmod(position[:, 0], case.pipe.length)
    position[:, 0] = x
    fields = {
        "position": position,
        "velocity": velocity,
        "spin": np.zeros_like(position),
        "laps": laps,
    }
    return {"solids": fields, "diagnostics": diagnostics}


def open_writer(directory, case=CASE):
    """A writer with the constants of the made-up run."""
    solids = {"radius": np.full(64, 0.01), "density": np.full(64, 2700.0)}
    r = np.linspace(0, case.pipe.radius, 50)
    liquid = {
        "profile_radius": r,
        "profile_velocity": 1.2 * np.maximum(1 - r / case.pipe.radius, 0) ** (1 / 7),
    }
    return ResultsWriter(
        directory,
        case=case,
        provenance=PROVENANCE,
        solids=None if case.solids is None else solids,
        liquid=None if case.liquid is None else liquid,
    )


def write_run(directory, case=CASE, times=TIMES):
    """Write a whole made-up run and return its directory."""
    with open_writer(directory, case) as writer:
        for time in times:
            writer.append(time, **frame(time, case))
    write_summary(
        directory, dict.fromkeys(SUMMARY_KEYS) | {"status": "finished", "time": times[-1]}
    )
    return directory
