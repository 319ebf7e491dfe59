"""Made-up runs for the tests of what reads results: a cluster that collapses and stretches."""

from pathlib import Path

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


def frame(time, case=CASE, liquid="prescribed"):
    """What a run would append at `time`; `liquid` is as in `open_writer`."""
    diagnostics = {"pressure_gradient": 80.0 + 5.0 * np.sin(time), "contacts": 3}
    fields = {}
    if case.solids is not None:
        position, velocity = cluster(time)
        laps, x = np.divmod(position[:, 0], case.pipe.length)
        position[:, 0] = x
        fields["solids"] = {
            "position": position,
            "velocity": velocity,
            "spin": np.zeros_like(position),
            "laps": laps,
        }
    if liquid != "prescribed":
        fields["liquid"], numbers = particle_frame(time, case)
        diagnostics |= numbers
    if liquid == "unrecorded":
        fields["liquid"] = {k: v for k, v in fields["liquid"].items() if k in MEANS}
    return fields | {"diagnostics": diagnostics}


MEANS = {"velocity_profile", "layer_velocity", "section_pressure"}
HEIGHTS = np.linspace(-0.95, 0.95, 12)  # of the layers, over the radius
PARTICLES = 6000
KIND = np.where(np.arange(PARTICLES) % 10 < 7, 2, np.where(np.arange(PARTICLES) % 10 < 9, -2, -1))
BULK = 1.0  # [m/s]
FRICTION_VELOCITY = 0.0442  # [m/s] at that bulk velocity, smooth
LAMINAR = CLEAR.with_(liquid={"kinematic_viscosity": 1e-3})


def mean_velocity(r, case):
    """A flow that an engineer would expect: parabola or log law."""
    y = np.maximum(1 - r / case.pipe.radius, 1e-3)
    if case.liquid.kinematic_viscosity > 1e-4:
        return 2 * BULK * (1 - (r / case.pipe.radius) ** 2)
    return FRICTION_VELOCITY * (np.log(y * 4420) / 0.41 + 5.2)


def particle_frame(time, case):
    """Fields and diagnostics of a liquid of particles: a flow with jitter."""
    radius, length = case.pipe.radius, case.pipe.length
    rng = np.random.default_rng(1)
    r = np.where(KIND == 2, radius * np.sqrt(rng.random(PARTICLES)), 1.06 * radius)
    angle = rng.uniform(0, 2 * np.pi, PARTICLES)
    start = rng.uniform(0, length, PARTICLES)
    u = np.where(KIND == 2, mean_velocity(r, case), 0.0)
    noise = np.random.default_rng(round(1000 * time) + 2)
    velocity = 0.02 * noise.standard_normal((PARTICLES, 3)) * (KIND == 2)[:, None]
    velocity[:, 0] += u
    x = (start + u * time) % length
    position = np.column_stack([x, r * np.cos(angle), r * np.sin(angle)])
    wave = 3.0 * position[:, 2] / radius * np.sin(2 * np.pi * x / length)
    edges = np.linspace(0, radius, 21)
    middles = (edges[1:] + edges[:-1]) / 2
    section = (np.arange(40) + 0.5) * length / 40
    profile = mean_velocity(middles, case) * (1 + 0.01 * np.sin(time + 40 * middles))
    profile[0] = np.nan
    fields = {
        "position": position,
        "velocity": velocity,
        "pressure": 200.0 + wave + 2.0 * noise.standard_normal(PARTICLES),
        "velocity_profile": profile,
        "layer_velocity": BULK * (1 + 0.1 * HEIGHTS),
        "section_pressure": 2.0 * np.sin(2 * np.pi * section / length + time),
    }
    diagnostics = {
        "bulk_velocity": BULK,
        "pressure_gradient": 2 * case.liquid.density * FRICTION_VELOCITY**2 / radius,
        "pressure_iterations": 12 + np.sin(time) if time else 0.0,
        "pressure_residual": 9e-4 if time else 0.0,
        "density_scatter": 0.017 - 0.005 * np.exp(-time),
        "pressure_noise": 1.6,
        "liquid_kinetic_energy": 0.51,
        "clamped": int(time == 2.0),
        "held_back": int(3 * (time > 4)),
    }
    return fields, diagnostics


def open_writer(directory, case=CASE, liquid="prescribed"):
    """A writer with the constants of the made-up run.

    `liquid` is "prescribed", "particles", or "unrecorded" for particles none of which is written.
    """
    solids = {"radius": np.full(64, 0.01), "density": np.full(64, 2700.0)}
    radius, length = case.pipe.radius, case.pipe.length
    if liquid == "prescribed":
        r = np.linspace(0, radius, 50)
        velocity = 1.2 * np.maximum(1 - r / radius, 0) ** (1 / 7)
        constants = {"profile_radius": r, "profile_velocity": velocity}
    else:
        constants = {
            "profile_radius": (np.arange(20) + 0.5) * radius / 20,
            "layer_height": HEIGHTS * radius,
            "section_position": (np.arange(40) + 0.5) * length / 40,
        }
    if liquid == "particles":
        constants["kind"] = KIND
    return ResultsWriter(
        directory,
        case=case,
        provenance=PROVENANCE,
        solids=None if case.solids is None else solids,
        liquid=None if case.liquid is None else constants,
    )


def write_run(directory, case=CASE, times=TIMES, liquid="prescribed"):
    """Write a whole made-up run and return its directory."""
    with open_writer(directory, case, liquid) as writer:
        for time in times:
            writer.append(time, **frame(time, case, liquid))
    write_summary(
        directory, dict.fromkeys(SUMMARY_KEYS) | {"status": "finished", "time": times[-1]}
    )
    return directory


def blank(_figure, path, **_options):
    """In place of Figure.savefig, where a test asks which figures there are, not how they look."""
    Path(path).touch()
