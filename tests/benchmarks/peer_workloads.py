"""Two dry workloads, written for this code and for LAMMPS: the same physics on both sides.

Both use the viscoelastic Hertz law with tangential history that LAMMPS calls gran/hertz/history,
friction 0.2, and stiffnesses of a Young's modulus of 1e8 Pa and a Poisson's ratio of 0.2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mpsdem._core import dem, geometry

FloatArray = NDArray[np.float64]

YOUNGS_MODULUS = 1e8  # [Pa]
POISSON_RATIO = 0.2
SHEAR_MODULUS = YOUNGS_MODULUS / (2 * (1 + POISSON_RATIO))  # [Pa]
NORMAL_STIFFNESS = 4 * SHEAR_MODULUS / (3 * (1 - POISSON_RATIO))  # [Pa] 4/3 E* of a like pair
TANGENTIAL_STIFFNESS = 4 * SHEAR_MODULUS / (2 - POISSON_RATIO)  # [Pa] 8 G* of a like pair
FRICTION = 0.2
GRAVITY = 9.81  # [m/s2] along -z


@dataclass(frozen=True, slots=True, kw_only=True)
class Cylinder:
    """A wall around the x axis."""

    radius: float  # [m]


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """A floor at z = 0 and four walls at x, y = 0 and `width`; open above, up to `height`."""

    width: float  # [m]
    height: float  # [m]


@dataclass(frozen=True, slots=True, kw_only=True)
class Workload:
    """Like spheres at rest that fall in a vessel.

    Parameters
    ----------
    position : (n, 3) float64 ndarray
        Centres at the start [m].
    radius, density : float
        Of every sphere [m], [kg/m3].
    vessel : Cylinder or Box
        The walls, of the spheres' material.
    period : float
        Length of the periodic x axis [m]; 0 for none.
    normal_damping : float
        Of the contact law [1/(m s)]; the tangential one is half of it.
    time_step : float
        [s]
    stages : tuple of int
        Steps of each part of the run that is timed for itself.
    skin : float
        How much farther than contact the peer's neighbor list reaches [m].
    """

    position: FloatArray
    radius: float
    density: float
    vessel: Cylinder | Box
    period: float
    normal_damping: float
    time_step: float
    stages: tuple[int, ...]
    skin: float

    @property
    def count(self) -> int:
        """Number of spheres."""
        return len(self.position)


def collapse_in_a_pipe() -> Workload:
    """D1: 512 spheres, layers of 7 x 7, collapse in a pipe for 0.2 s."""
    pitch = 0.0201
    layer, row, column = (i.ravel() for i in np.indices((11, 7, 7)))  # the last layer: low rows
    lattice = np.column_stack([layer - 5, column - 3, row - 3])[:512] * pitch
    return Workload(
        position=lattice + np.array([2.0, 0.0, 0.0]),
        radius=0.01,
        density=2700.0,
        vessel=Cylinder(radius=0.1),
        period=4.0,
        normal_damping=6e5,
        time_step=1e-6,
        stages=(200_000,),
        skin=0.004,
    )


def settling_in_a_box() -> Workload:
    """D2: 20,000 spheres settle in a box for 0.1 s; the last tenth of it is their dense phase."""
    pitch, jitter = 0.0105, 0.0002
    lattice = (np.indices((25, 25, 32)).reshape(3, -1).T + 0.5) * pitch
    shift = np.random.default_rng(1).uniform(-jitter, jitter, lattice.shape)
    return Workload(
        position=lattice + shift,
        radius=0.005,
        density=2700.0,
        vessel=Box(width=25 * pitch, height=0.5),
        period=0.0,
        normal_damping=2e6,
        time_step=5e-6,
        stages=(18_000, 2_000),
        skin=0.001,
    )


WORKLOADS = {"D1": collapse_in_a_pipe, "D2": settling_in_a_box}


def solids(workload: Workload) -> dem.Solids:
    """Make the spheres of a workload, on one thread."""
    n = workload.count
    still = np.zeros(3)
    match workload.vessel:
        case Cylinder(radius=radius):
            walls = [geometry.Cylinder(radius=radius, velocity=still)]
        case Box(width=width):
            walls = [
                geometry.Plane(point=np.array(point), normal=np.array(normal), velocity=still)
                for point, normal in (
                    ([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
                    ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
                    ([0.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
                    ([width, 0.0, 0.0], [-1.0, 0.0, 0.0]),
                    ([0.0, width, 0.0], [0.0, -1.0, 0.0]),
                )
            ]
    law = dem.HertzViscoelastic(
        normal_stiffness=NORMAL_STIFFNESS,
        tangential_stiffness=TANGENTIAL_STIFFNESS,
        normal_damping=workload.normal_damping,
        tangential_damping=workload.normal_damping / 2,
        friction=FRICTION,
    )
    made = dem.Solids(
        position=workload.position,
        velocity=np.zeros((n, 3)),
        spin=np.zeros((n, 3)),
        radius=np.full(n, workload.radius),
        density=np.full(n, workload.density),
        pair_law=law,
        wall_law=law,
        walls=walls,
        period=workload.period,
        threads=1,
    )
    made.set_forcing(acceleration=np.tile([0.0, 0.0, -GRAVITY], (n, 1)))
    return made


def lammps_data(workload: Workload) -> str:
    """Write the spheres as a LAMMPS data file of atom style sphere.

    LAMMPS has cylinders around its z axis only: around a cylinder our (x, y, z) is its (z, x, y).
    """
    match workload.vessel:
        case Cylinder(radius=radius):
            position = workload.position[:, [1, 2, 0]]
            bounds = [(-radius, radius), (-radius, radius), (0.0, workload.period)]
        case Box(width=width, height=height):
            position = workload.position
            bounds = [(0.0, width), (0.0, width), (-workload.radius / 5, height)]
    lines = ["spheres", "", f"{workload.count} atoms", "1 atom types", ""]
    lines += [f"{low!r} {high!r} {a}lo {a}hi" for a, (low, high) in zip("xyz", bounds, strict=True)]
    lines += ["", "Atoms # sphere", ""]
    sphere = f"1 {2 * workload.radius!r} {workload.density!r}"
    lines += [f"{i} {sphere} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(position.tolist(), 1)]
    return "\n".join([*lines, ""])


def lammps_input(workload: Workload, data: str) -> str:
    """Write the LAMMPS input that runs the spheres of the file `data`, stage by stage."""
    law = (
        f"{NORMAL_STIFFNESS!r} {TANGENTIAL_STIFFNESS!r} "
        f"{workload.normal_damping!r} {workload.normal_damping / 2!r} {FRICTION!r} 1"
    )
    match workload.vessel:
        case Cylinder(radius=radius):
            boundary, down = "f f p", "0 -1 0"
            walls = [f"zcylinder {radius!r}"]
        case Box(width=width):
            boundary, down = "f f f", "0 0 -1"
            walls = [f"xplane 0 {width!r}", f"yplane 0 {width!r}", "zplane 0 NULL"]
    lines = [
        "units si",
        "atom_style sphere",
        f"boundary {boundary}",
        "newton off",
        "comm_modify vel yes",
        f"read_data {data}",
        f"neighbor {workload.skin!r} bin",
        "neigh_modify delay 0 every 10 check yes",
        f"timestep {workload.time_step!r}",
        f"pair_style gran/hertz/history {law}",
        "pair_coeff * *",
        *[f"fix wall{i} all wall/gran hertz/history {law} {w}" for i, w in enumerate(walls)],
        f"fix gravity all gravity {GRAVITY!r} vector {down}",
        "fix move all nve/sphere",
        "thermo_style custom step ke",
        "thermo_modify format float %.12g lost error",
        "thermo 0",
        *[f"run {steps}" for steps in workload.stages],
    ]
    return "\n".join([*lines, ""])
