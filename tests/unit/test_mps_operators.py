"""Operators of the particle liquid: against sums over all pairs, against fields they must get
exactly, against their order of accuracy, and against the laws they must keep."""

from dataclasses import replace

import numpy as np
import pytest
from mps_scenes import (
    AT_REST,
    GHOST,
    LIQUID,
    OPERATORS,
    WALL,
    apply,
    beside_a_floor,
    block,
    inside,
    pipe,
)
from mps_sums import SUMS, all_pairs

from mpsdem._core import geometry, mps
from mpsdem._core.neighbors import NeighborList, cell_order

EVERY_OPERATOR = pytest.mark.parametrize("name", OPERATORS)


@EVERY_OPERATOR
def test_an_operator_is_the_sum_over_all_pairs(name):
    scene = pipe()
    expected = SUMS[name](scene, all_pairs(scene))
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
    "shifting": 1,
    "laplacian": -2,
    "least_squares_laplacian": -2,
    "viscous_acceleration": -2,
    "relative_convection": -1,
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


@pytest.mark.parametrize(
    "name",
    sorted(
        OPERATORS.keys()
        - {
            "number_density",
            "sum_gradient",
            "background_gradient",
            "conserving_gradient",
            "shifting",
        }
    ),
)
def test_nothing_comes_of_a_field_that_is_the_same_everywhere(name):
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
        "corrected_divergence": gradient @ [1, 0.5, -1],
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
    "conserving_gradient": (2, -1),
    "corrected_gradient": (2, 1),
    "divergence": (2, 0),
    "slip_divergence": (2, 0),
    "corrected_divergence": (2, 1),
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
    for name in ("sum_gradient", "conserving_gradient", "laplacian", "viscous_acceleration"):
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


@pytest.mark.parametrize(("direction", "expected"), [((0, 0, 1), 1), ((1, -2, 0), 0)])
def test_a_corrected_divergence_knows_a_linear_velocity_among_scattered_particles(
    direction, expected
):
    """u = z over a floor that it sticks to, the reach so short that no mirror factor is cut."""
    scene = block(12, reach=1.5, jitter=0.1)
    depth = scene.position[:, 2] - scene.position[:, 2].min() - 0.5 * scene.spacing
    floor = geometry.Plane(
        point=(0, 0, scene.position[:, 2].min() + 0.5 * scene.spacing),
        normal=(0, 0, 1),
        velocity=AT_REST,
    )
    liquid = depth > 0
    velocity = np.outer(np.where(liquid, depth, 0), direction)
    kind = np.where(liquid, LIQUID, WALL).astype(np.int8)
    scene = replace(scene, kind=kind, wall=floor, velocity=velocity)
    among = liquid & (np.abs(scene.position[:, :2]) < 0.25).all(axis=1) & (depth < 0.5)
    assert depth[among].min() < scene.spacing
    got = apply("corrected_divergence", scene)
    np.testing.assert_allclose(got[among], expected, atol=1e-10)
    assert np.all(got[~liquid] == 0)
    assert np.abs(apply("divergence", scene)[among] - expected).max() > 0.01


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


def test_weights_stored_in_float32_are_the_evaluated_ones_and_the_same_in_both_rows():
    scene = pipe(cells=6)
    neighbors = scene.neighbors
    weight, over_square = mps.stored_weights(scene.position, scene.reference, period=scene.period)
    rows = np.repeat(np.arange(len(scene.position)), np.diff(neighbors.row.astype(int)))
    columns = neighbors.column.astype(int)
    pairs = all_pairs(scene)
    np.testing.assert_allclose(weight, pairs.weight[rows, columns], atol=2e-5)
    np.testing.assert_allclose(
        over_square, pairs.factor[rows, columns], rtol=2e-5, atol=1e-6 / scene.spacing**2
    )
    table = np.zeros_like(pairs.weight)
    table[rows, columns] = weight
    np.testing.assert_array_equal(table, table.T)


def test_a_flux_past_the_particles_brings_what_lies_upstream():
    scene = block(8)
    gradient = np.random.default_rng(4).uniform(-1, 1, (3, 3))
    flux, eps = np.array([0.3, -0.2, 0.5]), 0.4
    scene = replace(scene, velocity=scene.position @ gradient.T)
    brought = mps.relative_convection(
        scene.neighbors,
        scene.reference,
        relative_flux=np.tile(flux, (len(scene.position), 1)),
        void_fraction=np.full(len(scene.position), eps),
        velocity=scene.velocity,
        kind=scene.kind,
    )
    expected = -(gradient @ flux) / eps
    middle = inside(scene, 0.2) & (np.abs(scene.position[:, 0] - 0.5) < 0.2)
    assert middle.any()
    np.testing.assert_allclose(brought[middle], np.tile(expected, (middle.sum(), 1)), atol=1e-9)


def test_liquid_is_shifted_away_from_where_it_is_dense():
    scene = beside_a_floor((0, 0, 5.0), (0.6, 0, 5.8), (9, 9, 5.0), kinds=[LIQUID] * 3)
    shift = apply("shifting", scene)
    assert shift[0] @ [0.6, 0, 0.8] < 0
    np.testing.assert_array_equal(shift[0], -shift[1])
    assert np.all(shift[2] == 0)


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
