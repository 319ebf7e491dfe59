"""Operators of the particle liquid: against sums over all pairs, against fields they must get
exactly, against their order of accuracy, and against the laws they must keep."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from mpsdem._core import geometry, mps
from mpsdem._core.neighbors import NeighborList, cell_order
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
    "divergence": lambda n, s, **k: mps.divergence(n, s.reference, s.velocity, **k),
    "slip_divergence": lambda n, s, **k: mps.slip_divergence(
        n, s.reference, s.velocity, kind=s.kind, wall=s.wall, **k
    ),
    "laplacian": lambda n, s, **k: mps.laplacian(n, s.reference, s.velocity, **k),
    "least_squares_laplacian": lambda n, s, **k: mps.least_squares_laplacian(
        n, s.velocity, kind=s.kind, wall=s.wall, **k
    )[0],
    "viscous_acceleration": lambda n, s, **k: mps.viscous_acceleration(
        n, s.reference, s.velocity, viscosity=s.viscosity, kind=s.kind, **k
    ),
    "shear_rate": lambda n, s, **k: mps.shear_rate(n, s.reference, s.velocity, kind=s.kind, **k),
}
EVERY_OPERATOR = pytest.mark.parametrize("name", OPERATORS)


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


# Every sum, written once more over all pairs.


@dataclass(frozen=True)
class AllPairs:
    apart: np.ndarray  # (n, n, 3) x_j - x_i
    weight: np.ndarray  # (n, n)
    factor: np.ndarray  # (n, n) weight over square distance
    number_density: float
    lambda_: float


def kernel(r, effective_radius):
    return np.where(
        r < effective_radius, effective_radius / (0.85 * r + 0.15 * effective_radius) - 1, 0
    )


def all_pairs(s):
    reach = s.reach * s.spacing
    apart = s.position[None, :] - s.position[:, None]
    apart[..., 0] -= s.period * np.round(apart[..., 0] / s.period)
    r = np.linalg.norm(apart, axis=2)
    np.fill_diagonal(r, np.inf)
    weight = kernel(r, reach)
    axis = np.arange(-4, 5) * s.spacing
    lattice = np.linalg.norm(np.stack(np.meshgrid(axis, axis, axis)), axis=0).ravel()
    lattice = lattice[lattice > 0]
    n0 = kernel(lattice, reach).sum()
    return AllPairs(
        apart=apart,
        weight=weight,
        factor=weight / r**2,
        number_density=n0,
        lambda_=(kernel(lattice, reach) * lattice**2).sum() / n0,
    )


def by_number_density(_, a):
    return a.weight.sum(axis=1)


def by_sum_gradient(s, a):
    both = s.pressure[None, :] + s.pressure[:, None]
    return 3 / a.number_density * np.einsum("ij,ijk->ik", a.factor * both, a.apart)


def by_difference_gradient(s, a):
    difference = s.pressure[None, :] - s.pressure[:, None]
    return 3 / a.number_density * np.einsum("ij,ijk->ik", a.factor * difference, a.apart)


def weighted_fit(columns, weight, right):
    root = np.sqrt(weight)[:, None]
    return np.linalg.lstsq(root * columns, root * right, rcond=None)[0]


def by_corrected_gradient(s, a):
    rows = range(len(s.position))
    return np.stack(
        [
            weighted_fit(a.apart[i], a.factor[i], (s.pressure - s.pressure[i])[:, None])[:, 0]
            for i in rows
        ]
    )


def outward(s):
    """Unit vectors from the axis, and the distance from the wall, in a pipe of radius 0.1."""
    r = np.hypot(s.position[:, 1], s.position[:, 2])
    return s.position * [0, 1, 1] / r[:, None], 0.1 - r


def by_background_gradient(s, a):
    normal = -outward(s)[0]
    along = np.einsum("ijk,ik->ij", a.apart, normal)[..., None] * normal[:, None]
    alike = (s.kind[None, :] == s.kind[:, None])[..., None]
    push = np.where(alike, a.apart, along)
    return by_difference_gradient(s, a) + 6 * BACKGROUND / a.number_density * np.einsum(
        "ij,ijk->ik", a.factor, push
    )


def by_divergence(s, a):
    du = s.velocity[None, :] - s.velocity[:, None]
    return 3 / a.number_density * np.einsum("ij,ijk,ijk->i", a.factor, du, a.apart)


def by_slip_divergence(s, a):
    normal, distance = outward(s)
    total = np.zeros(len(s.position))
    for i, j in zip(*np.nonzero(a.weight), strict=True):
        du = s.velocity[j] - s.velocity[i]
        liquid = s.kind[[i, j]] == LIQUID
        if not liquid.any() or s.kind[i] == GHOST:
            continue
        if not liquid.all():
            inner, outer = (i, j) if liquid[0] else (j, i)
            times = 1 - distance[outer] / max(distance[inner], 0.3 * s.spacing)
            du = min(times, 3) * (du @ normal[inner]) * normal[inner]
        total[i] += a.factor[i, j] * (du @ a.apart[i, j])
    return 3 / a.number_density * total


def by_laplacian(s, a):
    du = s.velocity[None, :] - s.velocity[:, None]
    return 6 / (a.number_density * a.lambda_) * np.einsum("ij,ijk->ik", a.weight, du)


def by_least_squares_laplacian(s, a):
    outwards, distance = outward(s)
    to_wall = np.where(s.kind == WALL, distance, 0)[:, None] * outwards
    result = np.zeros_like(s.velocity)
    for i in np.flatnonzero(s.kind == LIQUID):
        near = (a.weight[i] > 0) & (s.kind != GHOST)
        q = (a.apart[i] + to_wall)[near] / s.spacing
        x, y, z = q.T
        columns = np.column_stack([q, x**2, y**2, z**2, x * y, x * z, y * z])
        weight = (1 - np.linalg.norm(q, axis=1) / s.reach) ** 2
        fit = weighted_fit(columns, weight, (s.velocity - s.velocity[i])[near])
        result[i] = 2 * fit[3:6].sum(axis=0) / s.spacing**2
    return result


def among_liquid(s, values):
    liquid = s.kind == LIQUID
    return values * liquid[None, :] * liquid[:, None]


def by_viscous_acceleration(s, a):
    nu = (s.viscosity[None, :] + s.viscosity[:, None]) / 2
    du = s.velocity[None, :] - s.velocity[:, None]
    weight = among_liquid(s, a.weight * nu)
    return 6 / (a.number_density * a.lambda_) * np.einsum("ij,ijk->ik", weight, du)


def by_shear_rate(s, a):
    factor = among_liquid(s, a.factor)
    result = np.zeros(len(s.position))
    for i in np.flatnonzero(s.kind == LIQUID):
        gradient = weighted_fit(a.apart[i], factor[i], s.velocity - s.velocity[i])
        strain = (gradient + gradient.T) / 2
        result[i] = np.sqrt(2 * np.sum(strain**2))
    return result


@EVERY_OPERATOR
def test_an_operator_is_the_sum_over_all_pairs(name):
    scene = pipe()
    expected = globals()[f"by_{name}"](scene, all_pairs(scene))
    largest = np.abs(expected).max()
    np.testing.assert_allclose(apply(name, scene), expected, atol=1e-9 * largest)


# What no operator may depend on.


@EVERY_OPERATOR
def test_the_result_does_not_depend_on_the_threads(name):
    scene = pipe(cells=5, stations=20)
    one = apply(name, scene)
    for threads in (2, 3):
        np.testing.assert_array_equal(apply(name, scene, threads=threads), one)


@EVERY_OPERATOR
def test_the_result_does_not_depend_on_the_order_of_the_particles(name):
    scene = pipe()
    order = cell_order(scene.position, cell_size=0.04, period=scene.period)
    fields = ("position", "kind", "pressure", "velocity", "viscosity")
    sorted_scene = replace(scene, **{field: getattr(scene, field)[order] for field in fields})
    expected = apply(name, scene)[order]
    np.testing.assert_allclose(
        apply(name, sorted_scene), expected, atol=1e-10 * np.abs(expected).max()
    )


@EVERY_OPERATOR
def test_the_pipe_may_be_turned_about_its_axis_and_shifted_along_it(name):
    turn = np.array([[1, 0, 0], [0, 0.6, -0.8], [0, 0.8, 0.6]])
    scene = pipe()
    turned = replace(
        scene,
        position=scene.position @ turn.T + [0.37, 0, 0],
        velocity=scene.velocity @ turn.T,
    )
    expected = apply(name, scene)
    if expected.ndim == 2:
        expected = expected @ turn.T
    np.testing.assert_allclose(apply(name, turned), expected, atol=1e-9 * np.abs(expected).max())


POWER_OF_LENGTH = {
    "number_density": 0,
    "laplacian": -2,
    "least_squares_laplacian": -2,
    "viscous_acceleration": -2,
}


@EVERY_OPERATOR
def test_the_result_scales_with_the_unit_of_length(name):
    scene = pipe()
    in_millimetres = replace(
        scene,
        position=1e3 * scene.position,
        spacing=1e3 * scene.spacing,
        period=1e3 * scene.period,
        wall=geometry.Cylinder(radius=100.0, velocity=AT_REST),
    )
    expected = apply(name, scene) * 1e3 ** POWER_OF_LENGTH.get(name, -1)
    np.testing.assert_allclose(
        apply(name, in_millimetres), expected, atol=1e-9 * np.abs(expected).max()
    )


@EVERY_OPERATOR
def test_nothing_comes_of_a_field_that_is_the_same_everywhere(name):
    if name in ("number_density", "sum_gradient", "background_gradient"):
        pytest.skip("made to feel the particles' own unevenness")
    scene = pipe()
    same = replace(
        scene,
        pressure=np.full_like(scene.pressure, 5.0),
        velocity=np.full_like(scene.velocity, 5.0),
    )
    scale = np.abs(apply(name, scene)).max()
    np.testing.assert_allclose(apply(name, same), 0, atol=1e-10 * scale)


# The reference.


def test_the_reference_density_is_what_a_lattice_has():
    scene = block(8)
    density = mps.number_density(scene.neighbors, scene.reference)
    np.testing.assert_allclose(density[inside(scene)], scene.reference.number_density, rtol=1e-12)


def test_six_nearest_neighbors_are_the_whole_reference_of_a_short_reach():
    reference = mps.ReferenceDensity(spacing=0.01, effective_radius=0.012)
    assert reference.number_density == pytest.approx(6 * (1.2 / 1.03 - 1))
    assert reference.lambda_ == pytest.approx(1e-4)


def test_rings_beside_a_wall_have_nearly_the_density_of_the_lattice():
    scene = pipe(cells=10, jitter=0)
    density = mps.number_density(scene.neighbors, scene.reference)[scene.kind == LIQUID]
    assert density.mean() == pytest.approx(scene.reference.number_density, rel=0.01)
    assert density.std() < 0.01 * scene.reference.number_density


@pytest.mark.parametrize("arguments", [(0.0, 0.02), (-1, 0.02), (0.01, 0.01), (0.01, 0.2)])
def test_a_reference_without_neighbors_or_without_end_is_refused(arguments):
    spacing, effective_radius = arguments
    with pytest.raises(ValueError, match="ReferenceDensity"):
        mps.ReferenceDensity(spacing=spacing, effective_radius=effective_radius)


# Exact fields.

SLOPE = np.array([0.3, -1.2, 0.8])


def linear(scene):
    """Linear away from the seam, where a periodic field cannot be."""
    return scene.position @ SLOPE


def away_from_the_seam(scene):
    return (np.abs(scene.position[:, 0] / scene.period - 0.5) < 0.25) & inside(scene)


@pytest.mark.parametrize("name", ["difference_gradient", "sum_gradient", "corrected_gradient"])
def test_a_gradient_of_a_linear_pressure_is_exact_on_a_lattice(name):
    scene = block(12)
    scene = replace(scene, pressure=linear(scene))
    found = apply(name, scene)[away_from_the_seam(scene)]
    np.testing.assert_allclose(found - SLOPE, 0, atol=1e-12)


def test_the_corrected_gradient_of_a_linear_pressure_is_exact_among_scattered_particles():
    scene = block(12, jitter=0.3)
    scene = replace(scene, pressure=linear(scene))
    middle = np.abs(scene.position[:, 0] - 0.5) < 0.25  # to the open faces of the block
    np.testing.assert_allclose(apply("corrected_gradient", scene)[middle] - SLOPE, 0, atol=1e-11)
    plain = apply("difference_gradient", scene)[middle]
    assert np.abs(plain - SLOPE).max() > 0.05


def velocity_of(matrix, scene):
    return scene.position @ np.asarray(matrix, dtype=float).T


def test_the_divergence_of_a_linear_velocity_is_exact_on_a_lattice():
    scene = block(12)
    scene = replace(scene, velocity=velocity_of([[1, 2, 3], [4, -6, 5], [7, 8, 2.5]], scene))
    found = apply("divergence", scene)[away_from_the_seam(scene)]
    np.testing.assert_allclose(found, -2.5, rtol=1e-12)


ROTATION = [[0, 0, 0], [0, 0, -3], [0, 3, 0]]  # about the axis, 3 rad/s


def test_rotation_has_neither_divergence_nor_shear():
    scene = pipe()
    scene = replace(scene, velocity=velocity_of(ROTATION, scene))
    for name in ("divergence", "shear_rate"):
        np.testing.assert_allclose(apply(name, scene), 0, atol=1e-12)


@pytest.mark.parametrize(
    ("matrix", "rate"),
    [
        ([[0, 0, 4], [0, 0, 0], [0, 0, 0]], 4.0),  # u_x = 4 z
        ([[2, 0, 0], [0, -2, 0], [0, 0, 0]], 4.0),  # stretched along x
        ([[0, 0, 0], [0, 0, 3], [0, 3, 0]], 6.0),
    ],
)
def test_the_shear_rate_of_a_linear_velocity_is_exact_among_scattered_particles(matrix, rate):
    scene = block(12, jitter=0.3)
    scene = replace(scene, velocity=velocity_of(matrix, scene))
    middle = np.abs(scene.position[:, 0] - 0.5) < 0.25
    np.testing.assert_allclose(apply("shear_rate", scene)[middle], rate, rtol=1e-10)


QUADRATIC = np.array([[1.0, 0.4, -0.7], [0.4, -2.0, 0.3], [-0.7, 0.3, 0.5]])


def quadratic(scene):
    x = scene.position
    field = np.einsum("ia,ab,ib->i", x, QUADRATIC, x) + x @ SLOPE + 3
    return np.column_stack([field, -2 * field, x[:, 0]])


LAPLACIAN_OF_QUADRATIC = np.array([-1.0, 2.0, 0.0])  # twice the trace


def test_the_laplacian_of_a_quadratic_field_is_exact_on_a_lattice():
    scene = block(12)
    scene = replace(scene, velocity=quadratic(scene))
    for name in ("laplacian", "least_squares_laplacian", "viscous_acceleration"):
        found = apply(name, scene)[away_from_the_seam(scene)]
        np.testing.assert_allclose(found - LAPLACIAN_OF_QUADRATIC, 0, atol=1e-10)


def test_the_least_squares_laplacian_of_a_quadratic_field_is_exact_among_scattered_particles():
    scene = block(12, jitter=0.3)
    scene = replace(scene, velocity=quadratic(scene))
    found, deficient = mps.least_squares_laplacian(
        scene.neighbors, scene.velocity, kind=scene.kind, wall=scene.wall
    )
    assert deficient == 0
    middle = away_from_the_seam(scene)
    np.testing.assert_allclose(found[middle] - LAPLACIAN_OF_QUADRATIC, 0, atol=1e-8)
    plain = apply("laplacian", scene)[middle]
    assert np.abs(plain - LAPLACIAN_OF_QUADRATIC).max() > 1


@pytest.mark.parametrize("cells", [3, 6, 10])
@pytest.mark.parametrize("jitter", [0, 0.2])
def test_poiseuille_flow_has_the_same_viscous_force_everywhere(cells, jitter):
    """The parabola is met exactly: the wall's particles stand for points on the wall."""
    scene = pipe(cells=cells, jitter=jitter)
    parabola = 1 - (np.hypot(scene.position[:, 1], scene.position[:, 2]) / 0.1) ** 2
    liquid = scene.kind == LIQUID
    velocity = np.column_stack([np.where(liquid, parabola, 0), *np.zeros((2, len(parabola)))])
    velocity[scene.kind == GHOST] = 99.0  # left out
    found = apply("least_squares_laplacian", replace(scene, velocity=velocity))[liquid]
    np.testing.assert_allclose(found[:, 0], -4 / 0.1**2, rtol=1e-8)
    np.testing.assert_allclose(found[:, 1:], 0, atol=1e-8 / 0.1**2)


def test_a_viscosity_that_varies_brings_its_own_gradient():
    """u_x = 2 z in nu = 3 + 0.5 z: d/dz(nu du/dz) = 1."""
    scene = block(12)
    z = scene.position[:, 2]
    velocity = np.column_stack([2 * z, 0 * z, 0 * z])
    scene = replace(scene, velocity=velocity, viscosity=3 + 0.5 * z)
    found = apply("viscous_acceleration", scene)[inside(scene)]
    np.testing.assert_allclose(found - [1.0, 0, 0], 0, atol=1e-11)


def test_scalars_and_vectors_have_the_same_laplacian():
    scene = pipe()
    for of in (
        lambda field: mps.laplacian(scene.neighbors, scene.reference, field),
        lambda field: mps.least_squares_laplacian(
            scene.neighbors, field, kind=scene.kind, wall=scene.wall
        )[0],
    ):
        by_component = [of(component.copy()) for component in scene.velocity.T]
        np.testing.assert_array_equal(of(scene.velocity), np.column_stack(by_component))


# Order of accuracy.


def wave(scene):
    """A smooth field, periodic along x, with its gradient and Laplacian."""
    x, y, z = scene.position.T
    k = 2 * np.pi
    s, c = np.sin(k * x), np.cos(k * x)
    f = s * np.cos(2 * y) * np.exp(z)
    gradient = np.column_stack([k * c * np.cos(2 * y), -2 * s * np.sin(2 * y), s * np.cos(2 * y)])
    return f, gradient * np.exp(z)[:, None], (1 - k**2 - 4) * f


def error(name, cells, jitter):
    """Root mean square error over the middle of a block."""
    scene = block(cells, jitter=jitter)
    f, gradient, laplacian = wave(scene)
    velocity = np.column_stack([f, 0.5 * f, -f])
    scene = replace(scene, pressure=f + 2, velocity=velocity)
    strain = np.einsum("ia,b->iab", gradient, [1, 0.5, -1])
    strain = (strain + np.swapaxes(strain, 1, 2)) / 2
    exact = {
        "divergence": gradient @ [1, 0.5, -1],
        "slip_divergence": gradient @ [1, 0.5, -1],
        "shear_rate": np.sqrt(2 * np.sum(strain**2, axis=(1, 2))),
        "laplacian": laplacian[:, None] * [1, 0.5, -1],
        "least_squares_laplacian": laplacian[:, None] * [1, 0.5, -1],
        "viscous_acceleration": laplacian[:, None] * [1, 0.5, -1],
    }.get(name, gradient)
    off = (apply(name, scene) - exact)[inside(scene)]
    return np.sqrt(np.mean(off**2))


ORDER = {  # on a lattice, among scattered particles
    "sum_gradient": (2, -1),
    "difference_gradient": (2, 0),
    "background_gradient": (2, -1),
    "corrected_gradient": (2, 1),
    "divergence": (2, 0),
    "slip_divergence": (2, 0),
    "laplacian": (2, -1),
    "viscous_acceleration": (2, -1),
    "least_squares_laplacian": (2, 1),
    "shear_rate": (2, 1),
}


def assert_order(errors, order):
    """On three spacings, the finer pair deciding: a coarse one may still fall faster."""
    observed = -np.diff(np.log2(errors))
    assert observed[1] == pytest.approx(order, abs=0.4)
    assert observed[0] > order - 0.4


@pytest.mark.parametrize("name", ORDER)
@pytest.mark.parametrize("jitter", [0, 0.35])
def test_the_error_falls_with_the_spacing_at_the_order_of_the_operator(name, jitter):
    assert_order([error(name, cells, jitter) for cells in (12, 24, 48)], ORDER[name][jitter > 0])


def pipe_error(name, cells, jitter):
    """Root mean square error over a pipe of radius 1, up to the wall where the operator sees it."""
    scene = pipe(cells=cells, stations=cells, jitter=jitter, radius=1.0)
    r = np.hypot(scene.position[:, 1], scene.position[:, 2])
    if name == "least_squares_laplacian":  # the wall's values hold on the wall itself
        at = scene.position.copy()
        at[scene.kind == WALL, 1:] /= r[scene.kind == WALL, None]
        f, _, laplacian = wave(replace(scene, position=at))
        field = np.column_stack([f, -f, 0 * f])
        exact = np.column_stack([laplacian, -laplacian, 0 * f])
        off = apply(name, replace(scene, velocity=field)) - exact
        return np.sqrt(np.mean(off[scene.kind == LIQUID] ** 2))
    f, gradient, _ = wave(scene)
    off = apply(name, replace(scene, pressure=f)) - gradient
    return np.sqrt(np.mean(off[scene.kind == LIQUID] ** 2))


@pytest.mark.parametrize(
    ("name", "order"),
    [("corrected_gradient", 1), ("least_squares_laplacian", 1), ("difference_gradient", 0)],
)
@pytest.mark.parametrize("jitter", [0, 0.35])
def test_the_order_holds_on_rings_up_to_the_wall(name, order, jitter):
    errors = [pipe_error(name, cells, jitter) for cells in (10, 20, 40)]
    if jitter:
        assert_order(errors, order)
    else:
        assert np.all(-np.diff(np.log2(errors)) > order - 0.4)


# Laws that are kept.


def net(forces):
    return np.abs(forces.sum(axis=0)).max() / np.abs(forces).max()


def test_forms_that_pair_equal_and_opposite_keep_momentum_to_round_off():
    scene = block(8, jitter=0.3)
    rng = np.random.default_rng(5)
    count = len(scene.position)
    scene = replace(
        scene,
        pressure=rng.uniform(0, 1, count),
        velocity=rng.uniform(-1, 1, (count, 3)),
        viscosity=rng.uniform(0.1, 1, count),
    )
    for name in ("sum_gradient", "laplacian", "viscous_acceleration"):
        assert net(apply(name, scene)) < 1e-12
    for name in ("difference_gradient", "corrected_gradient"):
        assert net(apply(name, scene)) > 1e-3
    same = replace(scene, pressure=np.ones(count))
    assert net(apply("background_gradient", same)) < 1e-12


def test_viscosity_takes_kinetic_energy_and_leaves_walls_out():
    scene = pipe()
    acceleration = apply("viscous_acceleration", scene)
    assert np.sum(scene.velocity * acceleration) < 0
    walls = scene.kind != LIQUID
    assert np.all(acceleration[walls] == 0)
    moved = scene.velocity + 10 * walls[:, None]
    np.testing.assert_array_equal(
        apply("viscous_acceleration", replace(scene, velocity=moved)), acceleration
    )


# Pairs of a liquid and a wall particle.


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


@pytest.mark.parametrize(
    ("distance", "depth", "times"),
    [
        (0.5, 0.5, 2.0),  # its mirror image, with the opposite velocity
        (1.5, 0.5, 4 / 3),
        (0.75, 1.5, 3.0),
        (0.5, 1.5, 3.0),  # cut
        (0.1, 0.5, 1 + 0.5 / 0.3),  # as from 0.3 spacings
        (0.01, 0.5, 1 + 0.5 / 0.3),
    ],
)
def test_a_wall_meets_liquid_with_its_normal_velocity_mirrored(distance, depth, times):
    scene = beside_a_floor((0, 0, distance), (0, 0, -depth), kinds=[LIQUID, WALL])
    falling = replace(scene, velocity=np.array([[0.3, -0.2, -1.0], [0, 0, 0]]))
    plain, slip = apply("divergence", falling), apply("slip_divergence", falling)
    assert slip[0] < 0
    np.testing.assert_allclose(slip / plain, times)


def test_liquid_that_slides_along_a_wall_meets_no_divergence_with_slip():
    scene = beside_a_floor((0, 0, 0.5), (0.7, 0.2, -0.5), kinds=[LIQUID, WALL])
    sliding = replace(scene, velocity=np.array([[1.0, -2.0, 0], [0, 0, 0]]))
    assert np.all(apply("slip_divergence", sliding) == 0)
    assert np.all(apply("divergence", sliding) != 0)


def test_plug_flow_in_a_jittered_pipe_has_no_divergence_with_slip():
    scene = pipe()
    plug = np.where((scene.kind == LIQUID)[:, None], [1.0, 0, 0], 0)
    scene = replace(scene, velocity=plug)
    np.testing.assert_allclose(apply("slip_divergence", scene), 0, atol=1e-12)
    liquid = scene.kind == LIQUID
    assert np.abs(apply("divergence", scene)[liquid]).max() > 0.01 / scene.spacing


def test_a_velocity_that_grows_from_the_wall_has_its_divergence_up_to_the_wall():
    """u_z = z over a floor, the reach so short that no mirror factor is cut."""
    scene = block(12, reach=1.5)
    depth = scene.position[:, 2] - scene.position[:, 2].min() - 0.5 * scene.spacing
    floor = geometry.Plane(
        point=(0, 0, scene.position[:, 2].min() + 0.5 * scene.spacing),
        normal=(0, 0, 1),
        velocity=AT_REST,
    )
    liquid = depth > 0
    velocity = np.where(liquid, depth, 0)[:, None] * [0, 0, 1.0]
    kind = np.where(liquid, LIQUID, WALL).astype(np.int8)
    scene = replace(scene, kind=kind, wall=floor, velocity=velocity)
    low = liquid & (depth < 0.3) & (np.abs(scene.position[:, 1]) < 0.25)
    assert depth[low].min() == pytest.approx(0.5 * scene.spacing)
    np.testing.assert_allclose(apply("slip_divergence", scene)[low], 1, rtol=1e-12)


def test_walls_and_ghosts_among_themselves_have_no_divergence():
    kinds = [LIQUID, WALL, GHOST]
    scene = beside_a_floor((0, 0, 3.0), (0, 0, -0.5), (0.3, 0, -1.5), kinds=kinds)
    scene = replace(scene, reach=2.1, velocity=np.array([[0, 0, 0], [0, 0, 1.0], [1.0, 0, 0]]))
    assert np.all(apply("slip_divergence", scene) == 0)


def test_the_background_pushes_liquid_apart_along_the_line_between():
    scene = beside_a_floor((0, 0, 5.0), (0.6, 0, 5.8), kinds=[LIQUID, LIQUID])
    force = -apply("background_gradient", scene)
    assert force[0] @ [0.6, 0, 0.8] < 0
    np.testing.assert_allclose(np.cross(force[0], [0.6, 0, 0.8]), 0, atol=1e-12)
    np.testing.assert_array_equal(force[0], -force[1])


def test_the_background_of_a_wall_pushes_along_its_normal_alone():
    scene = beside_a_floor((0, 0, 0.5), (0.6, 0.3, -0.5), kinds=[LIQUID, WALL])
    force = -apply("background_gradient", scene)
    assert force[0, 2] > 0
    assert np.all(force[0, :2] == 0)
    np.testing.assert_array_equal(force[0], -force[1])


def test_without_a_background_the_difference_is_left():
    scene = pipe()
    found = mps.background_gradient(
        scene.neighbors, scene.reference, scene.pressure, background=0.0, kind=scene.kind,
        wall=scene.wall,
    )  # fmt: skip
    np.testing.assert_allclose(found, apply("difference_gradient", scene), rtol=1e-12)


# Too few neighbors.


@EVERY_OPERATOR
def test_a_lone_particle_and_two_in_one_place_give_finite_numbers(name):
    scene = beside_a_floor((0, 0, 9.0), (20, 0, 1.0), (20, 0, 1.0), kinds=[LIQUID] * 3)
    scene = replace(scene, velocity=np.arange(9.0).reshape(3, 3), pressure=np.arange(3.0))
    assert np.all(np.isfinite(apply(name, scene)))


def test_liquid_whose_neighbors_fix_no_quadratic_is_counted_and_left_alone():
    sheet = [(x, y, 5.0) for x in range(4) for y in range(4)]
    scene = beside_a_floor(*sheet, (30, 0, 5.0), (31, 0, 5.0), kinds=[LIQUID] * 17 + [WALL])
    scene = replace(scene, velocity=np.random.default_rng(1).random((18, 3)))
    found, deficient = mps.least_squares_laplacian(
        scene.neighbors, scene.velocity, kind=scene.kind, wall=scene.wall
    )
    assert deficient == 17
    assert np.all(found == 0)


def test_a_sheet_of_particles_keeps_the_gradient_that_it_can_have():
    sheet = [(x, y, 5.0) for x in range(5) for y in range(5)]
    scene = beside_a_floor(*sheet, kinds=[LIQUID] * 25)
    scene = replace(scene, pressure=scene.position @ [1.0, 0, 0])
    np.testing.assert_allclose(
        apply("corrected_gradient", scene), apply("difference_gradient", scene), atol=1e-15
    )
    assert np.all(apply("shear_rate", scene) == 0)


# Turbulence.

R = 0.1


def at_radius(r):
    r = np.atleast_1d(np.asarray(r, dtype=float))
    return np.column_stack([np.full_like(r, 0.3), 0.6 * r, -0.8 * r])


def test_the_mixing_length_is_four_tenths_of_the_distance_next_to_the_wall():
    model = mps.MixingLength(pipe_radius=R)
    y = np.array([1e-4, 1e-3]) * R
    np.testing.assert_allclose(model.length(at_radius(R - y)), 0.4 * y, rtol=2e-3)
    assert model.length(at_radius(0)) == pytest.approx(0.14 * R)
    assert np.all(model.length(at_radius([R, 1.2 * R, 5 * R])) == 0)


def test_the_mixing_length_gives_turbulent_pipe_flow_its_velocity_defect():
    """Nikuradse's pipes: (axis - bulk velocity) / u* = 4.07, Schlichting ch. 20."""
    model = mps.MixingLength(pipe_radius=R)
    r = np.linspace(0, R, 20_001)[:-1]
    slope = np.sqrt(r / R) / model.length(at_radius(r))  # l^2 (du/dr)^2 = u*^2 r / R, u* = 1
    defect = np.concatenate([[0], np.cumsum((slope[1:] + slope[:-1]) / 2 * np.diff(r))])
    mean = np.sum(defect * r) / np.sum(r)
    assert mean == pytest.approx(4.07, rel=0.06)


def test_the_eddy_viscosity_is_length_squared_times_rate_up_to_what_the_step_allows():
    model = mps.Smagorinsky(spacing=0.01, coefficient=0.2)
    found = mps.eddy_viscosity(
        model, position=at_radius([0, 0.05, 0.09]), shear_rate=[0.0, 10.0, 1e6], largest=1e-3
    )
    np.testing.assert_allclose(found, [0, 4e-5, 1e-3], rtol=1e-12)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: mps.MixingLength(pipe_radius=0.0), "pipe_radius must be > 0 m"),
        (lambda: mps.Smagorinsky(spacing=0.0), "spacing must be > 0 m"),
        (lambda: mps.Smagorinsky(spacing=0.1, coefficient=-0.1), "coefficient must be >= 0"),
    ],
)
def test_a_turbulence_model_refuses_bad_input(make, message):
    with pytest.raises(ValueError, match=message):
        make()


# Wall function.


def shear(speed, distance, *, kinematic_viscosity=1e-6, roughness=0.0):
    function = mps.WallFunction(kinematic_viscosity=kinematic_viscosity, roughness=roughness)
    speed, distance = np.broadcast_arrays(np.atleast_1d(speed), distance)
    return function.shear(speed=speed.astype(float).copy(), distance=distance.astype(float).copy())


@pytest.mark.parametrize("roughness", [0.0, 1e-5, 2e-4])
@pytest.mark.parametrize("reynolds", [1e4, 1e5, 5e5])
def test_the_speed_near_the_wall_tells_the_friction_of_the_pipe(reynolds, roughness):
    """Reichardt's profile with Colebrook's friction, read at a sixteenth of the radius."""
    pipe_flow = mps.PipeProfile(
        pipe_radius=R,
        bulk_velocity=reynolds * 1e-6 / (2 * R),
        kinematic_viscosity=1e-6,
        roughness=roughness,
    )
    speed = pipe_flow.velocity(at_radius(R - R / 16))[:, 0]
    found = shear(speed, R / 16, roughness=roughness)
    assert found == pytest.approx(pipe_flow.friction_velocity**2, rel=0.1)


def test_the_sublayer_is_laminar():
    """To y+ = 8: u* y / nu from the shear found."""
    y = 1e-3
    speed = np.array([1e-6, 1e-4, 0.03, 0.06])
    found = shear(speed, y)
    np.testing.assert_allclose(found, 1e-6 * speed / y, rtol=1e-12)
    assert np.sqrt(found[-1]) * y / 1e-6 == pytest.approx(7.7, abs=0.1)


def test_the_shear_rises_with_the_speed_and_without_a_jump():
    speed = np.geomspace(1e-4, 10, 4000)
    for roughness in (0.0, 1e-4):
        found = shear(speed, 1e-3, roughness=roughness)
        steps = np.diff(np.log(found)) / np.diff(np.log(speed))
        assert steps.min() > 0.95
        assert steps.max() < 2.1


def test_still_liquid_has_no_shear():
    assert shear(0.0, 1e-3) == 0
    assert shear(0.0, 1e-3, roughness=1e-4) == 0


def test_a_fully_rough_wall_knows_no_viscosity_and_a_smooth_one_no_grains():
    rough = shear(2.0, 0.01, kinematic_viscosity=[1e-9, 1e-10][0], roughness=1e-3)
    rougher = shear(2.0, 0.01, kinematic_viscosity=1e-10, roughness=1e-3)
    np.testing.assert_allclose(rough, rougher, rtol=1e-3)
    np.testing.assert_allclose(shear(1.0, 0.01, roughness=1e-8), shear(1.0, 0.01), rtol=1e-3)


def test_a_fully_rough_wall_has_the_velocity_of_nikuradses_sand():
    """u / u* = 2.5 ln(y / k) + 8.5 to within what 0.41 for 0.40 makes."""
    u_star = np.sqrt(shear(2.0, 0.01, kinematic_viscosity=1e-9, roughness=1e-3))
    assert 2.0 / u_star == pytest.approx(2.5 * np.log(10) + 8.5, rel=0.02)


def test_roughness_raises_the_shear():
    grains = [0.0, 1e-5, 1e-4, 1e-3]
    found = np.concatenate([shear(1.0, 0.01, roughness=k) for k in grains])
    assert np.all(np.diff(found) > 0)


def test_the_shear_scales_with_the_units():
    """In millimetres and minutes."""
    length, time = 1e3, 1 / 60
    found = shear(
        2.0 * length / time,
        0.01 * length,
        kinematic_viscosity=1e-6 * length**2 / time,
        roughness=1e-4 * length,
    )
    expected = shear(2.0, 0.01, roughness=1e-4) * (length / time) ** 2
    np.testing.assert_allclose(found, expected, rtol=1e-9)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ({"kinematic_viscosity": 0.0}, "kinematic_viscosity must be > 0 m2/s"),
        ({"roughness": -1.0}, "roughness must be >= 0 m"),
        ({"speed": -1.0}, "speed must be >= 0 m/s"),
        ({"distance": 0.0}, "distance must be > 0 m"),
        ({"speed": np.nan}, "speed must be >= 0 m/s"),
    ],
)
def test_a_wall_function_refuses_bad_input(call, message):
    with pytest.raises(ValueError, match=message):
        shear(**({"speed": 1.0, "distance": 0.01} | call))


# Input.


@pytest.mark.parametrize("field", ["pressure", "velocity", "viscosity", "kind"])
def test_a_field_of_another_length_is_refused(field):
    scene = pipe()
    short = replace(scene, **{field: getattr(scene, field)[:-1]})
    user = {
        "pressure": "sum_gradient",
        "velocity": "divergence",
        "viscosity": "viscous_acceleration",
        "kind": "shear_rate",
    }
    with pytest.raises(ValueError, match=f"{field} must have one row per point"):
        apply(user[field], short)


def test_a_kind_that_is_none_is_refused():
    scene = pipe()
    with pytest.raises(ValueError, match="kind must be 2"):
        apply("shear_rate", replace(scene, kind=np.zeros_like(scene.kind)))


def test_a_list_that_does_not_reach_far_enough_is_refused():
    scene = pipe()
    short = NeighborList(scene.position, radius=1.5 * scene.spacing, period=scene.period)
    for name, operator in OPERATORS.items():
        if name != "least_squares_laplacian":
            with pytest.raises(ValueError, match="make the list with that radius"):
                operator(short, scene)


def test_a_wall_that_is_none_is_refused():
    scene = replace(pipe(), wall=None)
    with pytest.raises(TypeError):
        apply("slip_divergence", scene)
