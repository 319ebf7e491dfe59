"""Particles to try the operators on: a pipe, a block, a few beside a floor."""

from dataclasses import dataclass

import numpy as np

from mpsdem._core import geometry, mps
from mpsdem._core.neighbors import NeighborList
from mpsdem.geometry.layout import ring_layout

AT_REST = (0.0, 0.0, 0.0)
LIQUID, WALL, GHOST = 2, -2, -1
FAR_WALL = geometry.Plane(point=(0, 0, -1e3), normal=(0, 0, 1), velocity=AT_REST)


@dataclass(frozen=True)
class Scene:
    """Particles and everything the operators may ask of them."""

    position: np.ndarray
    spacing: float
    period: float
    kind: np.ndarray
    wall: geometry.Plane | geometry.Cylinder
    pressure: np.ndarray
    velocity: np.ndarray
    viscosity: np.ndarray
    reach: float = 2.1  # effective radius over spacing

    @property
    def reference(self):
        return mps.ReferenceDensity(
            spacing=self.spacing, effective_radius=self.reach * self.spacing
        )

    @property
    def neighbors(self):
        return NeighborList(self.position, radius=self.reach * self.spacing, period=self.period)


BACKGROUND = 0.7  # [Pa]
OPERATORS = {
    "number_density": lambda n, s, **k: mps.number_density(n, s.reference, **k),
    "sum_gradient": lambda n, s, **k: mps.sum_gradient(n, s.reference, s.pressure, **k),
    "difference_gradient": lambda n, s, **k: mps.difference_gradient(
        n, s.reference, s.pressure, **k
    ),
    "corrected_gradient": lambda n, s, **k: mps.corrected_gradient(n, s.reference, s.pressure, **k),
    "background_gradient": lambda n, s, **k: mps.background_gradient(
        n, s.reference, s.pressure, background=BACKGROUND, kind=s.kind, wall=s.wall, **k
    ),
    "conserving_gradient": lambda n, s, **k: mps.conserving_gradient(
        n, s.reference, s.pressure, background=BACKGROUND, kind=s.kind, wall=s.wall, **k
    ),
    "divergence": lambda n, s, **k: mps.divergence(n, s.reference, s.velocity, **k),
    "slip_divergence": lambda n, s, **k: mps.slip_divergence(
        n, s.reference, s.velocity, kind=s.kind, wall=s.wall, **k
    ),
    "corrected_divergence": lambda n, s, **k: mps.corrected_divergence(
        n, s.reference, s.velocity, kind=s.kind, wall=s.wall, **k
    ),
    "laplacian": lambda n, s, **k: mps.laplacian(n, s.reference, s.velocity, **k),
    "least_squares_laplacian": lambda n, s, **k: mps.least_squares_laplacian(
        n, s.velocity, kind=s.kind, wall=s.wall, **k
    )[0],
    "viscous_acceleration": lambda n, s, **k: mps.viscous_acceleration(
        n, s.reference, s.velocity, viscosity=s.viscosity, kind=s.kind, **k
    ),
    "relative_convection": lambda n, s, **k: mps.relative_convection(
        n,
        s.reference,
        relative_flux=s.viscosity[:, None] * s.velocity,
        void_fraction=s.viscosity,
        velocity=s.velocity,
        kind=s.kind,
        **k,
    ),
    "shifting": lambda n, s, **k: mps.shifting(n, s.reference, coefficient=0.1, **k),
    "shear_rate": lambda n, s, **k: mps.shear_rate(n, s.reference, s.velocity, kind=s.kind, **k),
}


def apply(name, scene, **call):
    return OPERATORS[name](scene.neighbors, scene, **call)


def jittered(position, amount, seed=1):
    """Move every point by up to `amount` along each axis."""
    return position + np.random.default_rng(seed).uniform(-amount, amount, position.shape)


def pipe(*, cells=4, stations=6, jitter=0.15, seed=2, radius=0.1, ghost_layers=1):
    """Rings of liquid, jittered, in their wall and ghosts; fields without any pattern."""
    made = ring_layout(
        radius=radius,
        length=stations * radius / cells,
        spacing=radius / cells,
        ghost_layers=ghost_layers,
    )
    rng = np.random.default_rng(seed)
    liquid = made.kind == LIQUID
    position = made.position.copy()
    position[liquid] = jittered(position[liquid], jitter * made.spacing, seed)
    count = len(position)
    return Scene(
        position=position,
        spacing=made.spacing,
        period=stations * made.axial_spacing,
        kind=made.kind,
        wall=geometry.Cylinder(radius=radius, velocity=AT_REST),
        pressure=rng.uniform(-1, 1, count),
        velocity=rng.uniform(-1, 1, (count, 3)),
        viscosity=rng.uniform(0.1, 1, count),
    )


def block(cells, *, jitter=0.0, size=1.0, seed=3, reach=2.1):
    """Liquid on a cubic lattice without walls, periodic along x; y and z about 0."""
    axis = (np.arange(cells) + 0.5) / cells
    position = np.stack(np.meshgrid(axis, axis - 0.5, axis - 0.5, indexing="ij"), axis=-1)
    position = jittered(size * position.reshape(-1, 3), jitter * size / cells, seed)
    count = len(position)
    return Scene(
        position=position,
        spacing=size / cells,
        period=size,
        kind=np.full(count, LIQUID, np.int8),
        wall=FAR_WALL,
        pressure=np.zeros(count),
        velocity=np.zeros((count, 3)),
        viscosity=np.ones(count),
        reach=reach,
    )


def inside(scene, share=0.25):
    """Points of a block whose neighborhoods are whole."""
    across = np.abs(scene.position[:, 1:]).max(axis=1)
    return across < share * scene.period


def beside_a_floor(*points, kinds, spacing=1.0):
    """A few particles on and under a floor at z = 0."""
    count = len(points)
    return Scene(
        position=np.array(points, dtype=float),
        spacing=spacing,
        period=0.0,
        kind=np.array(kinds, np.int8),
        wall=geometry.Plane(point=(0, 0, 0), normal=(0, 0, 1), velocity=AT_REST),
        pressure=np.zeros(count),
        velocity=np.zeros((count, 3)),
        viscosity=np.ones(count),
        reach=4.0,
    )
