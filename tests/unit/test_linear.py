"""The pressure solvers: exact on small systems, and no slower in a longer pipe."""

from dataclasses import replace

import numpy as np
import pytest
from particle_clouds import Cloud, joined, pipe
from scipy.sparse import csr_array

from mpsdem import _core
from mpsdem._core import linear

SPACING = 0.02  # [m]
METHODS = ("jacobi", "additive", "deflation")
TWO_LEVEL = METHODS[1:]


def preconditioner(name, matrix, cloud, *, period=0.0, threads=1):
    if name == "jacobi":
        return linear.Jacobi(matrix)
    two_level = {"additive": linear.TwoLevelAdditive, "deflation": linear.TwoLevelDeflation}[name]
    return two_level(
        matrix,
        position=cloud.position,
        particle_spacing=cloud.spacing,
        period=period,
        threads=threads,
    )


def solve(name, cloud, b, *, dirichlet=None, period=0.0, threads=1, **call):
    matrix = linear.LaplacianMatrix(**cloud.arrays, dirichlet=dirichlet, threads=threads)
    m = preconditioner(name, matrix, cloud, period=period, threads=threads)
    call = {"tolerance": 1e-10} | call
    return linear.conjugate_gradients(matrix, b, preconditioner=m, threads=threads, **call)


def blob(count=300, seed=0):
    """A ball of particles in no order at all, but for the sorting."""
    rng = np.random.default_rng(seed)
    size = SPACING * count ** (1 / 3)
    return joined(rng.uniform(0, size, (count, 3)), spacing=SPACING)


def chain(count):
    """Particles in a row, each joined to the next by a weight of one."""
    position = np.column_stack([np.arange(count) * SPACING, np.zeros((count, 2))])
    i = np.arange(count - 1)
    pairs = np.concatenate([[i, i + 1], [i + 1, i]], axis=1)
    graph = csr_array((np.ones(2 * count - 2, np.float32), pairs), shape=(count, count))
    return Cloud.of(position, graph, spacing=SPACING)


def apart(*clouds):
    """Clouds that do not touch, as one."""
    shift = np.cumsum([0, *(len(c.position) for c in clouds)])
    entries = np.cumsum([0, *(len(c.column) for c in clouds)])
    return Cloud(
        position=np.concatenate([c.position for c in clouds]),
        row=np.concatenate(
            [[0], *(c.row[1:] + e for c, e in zip(clouds, entries, strict=False))]
        ).astype(np.uint32),
        column=np.concatenate([c.column + s for c, s in zip(clouds, shift, strict=False)]).astype(
            np.uint32
        ),
        weight=np.concatenate([c.weight for c in clouds]),
        spacing=clouds[0].spacing,
    )


def lone(position):
    """One particle without neighbors."""
    return Cloud.of(np.array([position]), csr_array((1, 1), dtype=np.float32), spacing=SPACING)


def pseudo_inverse(cloud, b, dirichlet=None):
    return np.linalg.lstsq(cloud.matrix(dirichlet).toarray(), b, rcond=1e-12)[0]


def relative(x, expected):
    return np.linalg.norm(x - expected) / np.linalg.norm(expected)


def noise(cloud, seed=1):
    return np.random.default_rng(seed).standard_normal(len(cloud.position))


def outlet(cloud):
    """Known values at the far end."""
    x = cloud.position[:, 0]
    return np.where(x > x.max() - 2 * cloud.spacing, 3.0, 0.0)


def test_a_product_is_that_of_the_assembled_matrix():
    cloud = blob()
    x, d = noise(cloud), outlet(cloud)
    matrix = linear.LaplacianMatrix(**cloud.arrays, dirichlet=d)
    np.testing.assert_allclose(matrix.apply(x), cloud.matrix(d) @ x, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(matrix.diagonal, cloud.matrix(d).diagonal(), rtol=1e-14)


def test_a_constant_is_annihilated_to_the_last_bit():
    matrix = linear.LaplacianMatrix(**blob().arrays)
    assert np.all(matrix.apply(np.full(len(matrix), 1 / 3)) == 0)


@pytest.mark.parametrize("name", METHODS)
def test_the_solution_is_that_of_dense_algebra(name):
    cloud = blob()
    b, d = noise(cloud), outlet(cloud)
    solution = solve(name, cloud, b, dirichlet=d)
    assert solution.converged
    assert relative(solution.x, np.linalg.solve(cloud.matrix(d).toarray(), b)) < 1e-8


@pytest.mark.parametrize("name", METHODS)
def test_without_known_values_the_solution_of_least_norm_is_found(name):
    """That of the right-hand side less its mean, with mean zero."""
    cloud = blob()
    b = noise(cloud) + 5
    solution = solve(name, cloud, b)
    assert solution.converged
    assert relative(solution.x, pseudo_inverse(cloud, b)) < 1e-8
    assert abs(solution.x.mean()) < 1e-14 * np.abs(solution.x).max() * len(b)


@pytest.mark.skipif(not _core.cholmod, reason="built without CHOLMOD")
@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("periodic", [True, False])
def test_every_method_agrees_with_the_sparse_factor(name, periodic):
    cloud = pipe(spacing=SPACING, diameter=0.2, length=0.8, periodic=periodic)
    b, d = noise(cloud), None if periodic else outlet(cloud)
    matrix = linear.LaplacianMatrix(**cloud.arrays, dirichlet=d)
    expected = linear.CholmodReference(matrix).solve(b)
    assert np.linalg.norm(matrix.apply(expected) - (b - periodic * b.mean())) < 1e-11
    period = 0.8 if periodic else 0.0
    assert relative(solve(name, cloud, b, dirichlet=d, period=period).x, expected) < 1e-8


@pytest.mark.skipif(bool(_core.cholmod), reason="built with CHOLMOD")
def test_a_build_without_cholmod_says_so():
    with pytest.raises(RuntimeError, match="this build has no CHOLMOD"):
        linear.CholmodReference(linear.LaplacianMatrix(**blob().arrays))


def iterations(name, length, periodic, tolerance=1e-6):
    cloud = pipe(spacing=SPACING, diameter=0.2, length=length, periodic=periodic)
    b = noise(cloud)
    if not periodic:  # an inflow at the near end, an outlet at the far one: the worst long wave
        b += 10 * (cloud.position[:, 0] < 2 * SPACING)
    solution = solve(
        name,
        cloud,
        b,
        dirichlet=None if periodic else outlet(cloud),
        period=length if periodic else 0.0,
        tolerance=tolerance,
        max_iterations=3000,
    )
    assert solution.converged
    return solution.iterations


@pytest.mark.parametrize("periodic", [True, False])
@pytest.mark.parametrize(("name", "most"), [("additive", 35), ("deflation", 25)])
def test_a_pipe_four_times_longer_takes_no_more_iterations(name, most, periodic):
    short, long = iterations(name, 1.0, periodic), iterations(name, 4.0, periodic)
    assert long <= short + 2
    assert long <= most


def test_without_the_coarse_space_a_longer_pipe_takes_more_iterations():
    """Which says that the pipes of the test above are long enough to tell."""
    assert iterations("jacobi", 4.0, False) > 2.5 * iterations("jacobi", 1.0, False)


@pytest.mark.parametrize("name", TWO_LEVEL)
def test_a_chain_of_ten_thousand_is_solved_exactly(name):
    """A unit flux through it falls by one from link to link."""
    cloud = chain(10_000)
    b, d = np.zeros(10_000), np.zeros(10_000)
    b[0], d[-1] = 1, 1
    solution = solve(name, cloud, b, dirichlet=d, tolerance=1e-10)
    assert solution.converged
    assert solution.iterations < 60
    np.testing.assert_allclose(solution.x, np.arange(10_000, 0, -1), rtol=1e-6)


@pytest.mark.parametrize("name", METHODS)
def test_isolated_particles_stay_at_zero_and_do_not_disturb_the_others(name):
    cloud = blob()
    far = [lone([0.5, 0.5, k * 0.2]) for k in range(3)]
    with_lone = apart(far[0], cloud, *far[1:])
    b = noise(with_lone)
    solution = solve(name, with_lone, b)
    assert solution.converged
    assert np.all(solution.x[[0, -2, -1]] == 0)
    assert relative(solution.x[1:-2], pseudo_inverse(cloud, b[1:-2])) < 1e-8


def test_only_isolated_particles_are_solved_at_once():
    cloud = apart(*(lone([k * 0.2, 0, 0]) for k in range(5)))
    for name in METHODS:
        solution = solve(name, cloud, np.arange(5.0))
        assert solution.converged
        assert np.all(solution.x == 0)


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("mixed", [False, True])
@pytest.mark.parametrize("held", [False, True])
def test_detached_clusters_are_solved_each_by_itself(name, mixed, held):
    """Far apart, or in the same coarse cells; one of them with known values, or none."""
    first, second = blob(seed=2), blob(seed=3)
    if not mixed:
        second = second.moved([1, 0, 0])
    both = apart(first, second)
    n = len(first.position)
    d = np.concatenate([outlet(first), np.zeros(len(second.position))]) if held else None
    b = noise(both) + 2
    solution = solve(name, both, b, dirichlet=d)
    assert solution.converged
    assert relative(solution.x[:n], pseudo_inverse(first, b[:n], outlet(first) * held)) < 1e-8
    assert relative(solution.x[n:], pseudo_inverse(second, b[n:])) < 1e-8


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("thread", [1e-5, 1e-8, 1e-12, 1e-30])
def test_clusters_that_hang_by_a_thread_are_solved(name, thread):
    """At the edge of the kernel a weight goes to zero, and the coarse matrix towards singular."""
    both = apart(blob(count=2000, seed=2), blob(count=2000, seed=3).moved([1, 0, 0]))
    n = len(both.position)
    weight = csr_array((both.weight, both.column, both.row), shape=(n, n))
    link = csr_array(([thread, thread], ([0, n - 1], [n - 1, 0])), shape=(n, n))
    hanging = Cloud.of(both.position, csr_array(weight + link, dtype=np.float32), spacing=SPACING)
    half = noise(hanging)[: n // 2]
    b = np.concatenate([half - half.mean(), half - half.mean()])
    solution = solve(name, hanging, b, tolerance=1e-8)
    assert solution.converged
    left = b - hanging.matrix() @ solution.x
    assert np.linalg.norm(left) < 1e-7 * np.linalg.norm(b)


def test_clusters_are_told_apart():
    cloud = apart(lone([0.9, 0, 0]), blob(seed=2), blob(seed=3).moved([2, 0, 0]), chain(10))
    d = np.zeros(len(cloud.position))
    d[400] = 1  # in the second ball
    matrix = linear.LaplacianMatrix(**cloud.arrays, dirichlet=d)
    assert matrix.cluster_count == 4
    one, ball, row = matrix.floating_clusters
    assert one.tolist() == [0]
    assert ball.tolist() == list(range(1, 301))
    assert row.tolist() == list(range(601, 611))


def test_a_weight_of_zero_joins_nothing():
    cloud = chain(6)
    weight = cloud.weight.copy()
    weight[[4, 5]] = 0  # both directions of the link from 2 to 3
    assert cloud.column[4] == 3
    assert cloud.column[5] == 2
    matrix = linear.LaplacianMatrix(row=cloud.row, column=cloud.column, weight=weight)
    assert [c.tolist() for c in matrix.floating_clusters] == [[0, 1, 2], [3, 4, 5]]


def test_a_link_in_the_middle_of_a_row_joins_two_clusters():
    """Two hubs with leaves before and after both, and one link between the hubs."""
    hubs, leaves = (4, 5), ((0, 1, 6, 7), (2, 3, 8, 9))
    pairs = [(h, leaf) for h, own in zip(hubs, leaves, strict=True) for leaf in own] + [hubs]
    i, j = np.array(pairs).T
    ones = np.ones(2 * len(pairs), np.float32)
    graph = csr_array((ones, np.concatenate([[i, j], [j, i]], axis=1)), shape=(10, 10))
    cloud = Cloud.of(np.zeros((10, 3)), graph, spacing=SPACING)
    assert linear.LaplacianMatrix(**cloud.arrays).cluster_count == 1


@pytest.mark.parametrize("name", TWO_LEVEL)
def test_holes_as_large_as_coarse_cells_do_not_matter(name):
    cloud = pipe(spacing=SPACING, diameter=0.2, length=1.0, periodic=True)
    x, y, z = cloud.position.T
    hollow = (np.hypot(y, z) > 0.06) & ((x < 0.4) | (x > 0.6) | (z < 0))
    cloud = joined(cloud.position[hollow], spacing=SPACING, period=1.0)
    b = noise(cloud)
    solution = solve(name, cloud, b, period=1.0, tolerance=1e-6)
    assert solution.converged
    assert solution.iterations < 45


@pytest.mark.parametrize("name", METHODS)
def test_a_right_hand_side_that_is_not_a_number_is_reported_not_iterated(name):
    cloud = blob()
    for wrong in (np.nan, np.inf):
        b = noise(cloud)
        b[17] = wrong
        solution = solve(name, cloud, b, max_iterations=10**9)
        assert solution.broken
        assert not solution.converged
        assert solution.iterations == 0


@pytest.mark.parametrize("name", METHODS)
def test_a_matrix_that_is_not_a_number_or_not_definite_is_reported(name):
    cloud = blob()
    weight = cloud.weight.copy()
    weight[100] = np.nan
    assert solve(name, replace(cloud, weight=weight), noise(cloud), max_iterations=10**9).broken
    d = np.full(len(cloud.position), -1e3)
    assert solve(name, cloud, noise(cloud), dirichlet=d, max_iterations=10**9).broken


@pytest.mark.parametrize("name", TWO_LEVEL)
def test_a_particle_flung_out_of_the_domain_does_not_stop_the_solve(name):
    cloud = blob()
    for place in ([1e30, 0, 0], [np.nan, np.inf, 0]):
        position = cloud.position.copy()
        position[5] = place
        space = linear.CoarseSpace(position=position, particle_spacing=SPACING)
        assert (space.cell[5] == len(space)) == (not np.isfinite(place).all())
        flung = replace(cloud, position=position)
        assert solve(name, flung, noise(cloud)).converged


@pytest.mark.parametrize("name", METHODS)
def test_nothing_to_solve_takes_no_iteration(name):
    cloud = blob()
    for b in (np.zeros(300), np.full(300, 0.1)):  # a constant has no part that can be solved for
        solution = solve(name, cloud, b, start=noise(cloud))
        assert solution.converged
        assert solution.iterations == 0
        assert np.all(solution.x == 0)


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("tolerance", [1e-12, 1e-13])
def test_a_small_residual_is_a_true_one(name, tolerance):
    cloud = pipe(spacing=SPACING, diameter=0.2, length=4.0, periodic=True)
    b = noise(cloud) + 3
    solution = solve(name, cloud, b, period=4.0, tolerance=tolerance, max_iterations=3000)
    assert solution.converged
    left = b - b.mean() - cloud.matrix() @ solution.x
    assert np.linalg.norm(left) < 3e-12 * np.linalg.norm(b)


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("threads", [2, 3])
def test_the_solution_does_not_depend_on_the_threads(name, threads):
    cloud = pipe(spacing=SPACING, diameter=0.2, length=1.0, periodic=True)
    b = noise(cloud)
    one = solve(name, cloud, b, period=1.0)
    many = solve(name, cloud, b, period=1.0, threads=threads)
    assert np.array_equal(one.x, many.x)
    assert one.iterations == many.iterations


@pytest.mark.parametrize("name", METHODS)
def test_the_solution_as_start_takes_no_iteration_and_a_near_one_few(name):
    cloud = blob()
    b, d = noise(cloud), outlet(cloud)
    cold = solve(name, cloud, b, dirichlet=d)
    again = solve(name, cloud, b, dirichlet=d, start=cold.x, tolerance=1e-8)
    assert again.iterations == 0
    near = solve(name, cloud, b, dirichlet=d, start=cold.x + 1e-6 * noise(cloud, seed=2))
    assert 0 < near.iterations < 0.8 * cold.iterations
    assert relative(near.x, cold.x) < 1e-8


@pytest.mark.parametrize("name", METHODS)
def test_a_constant_in_the_start_does_not_matter(name):
    cloud = blob()
    b = noise(cloud)
    cold = solve(name, cloud, b)
    again = solve(name, cloud, b, start=cold.x + 1e5, tolerance=1e-8)
    assert again.iterations == 0
    assert relative(again.x, cold.x) < 1e-8


def test_too_few_iterations_are_reported_as_neither_converged_nor_broken():
    cloud = blob()
    solution = solve("jacobi", cloud, noise(cloud), max_iterations=3)
    assert solution.iterations == 3
    assert not solution.converged
    assert not solution.broken
    assert solution.residual > 1e-10
    assert "exhausted" in repr(solution)


def test_a_kept_coarse_factor_still_serves_after_the_particles_moved():
    """They drift, change their order, and one comes in where there was none."""
    old = pipe(spacing=SPACING, diameter=0.2, length=1.0, periodic=True, seed=4)
    matrix = linear.LaplacianMatrix(**old.arrays)
    kept = preconditioner("additive", matrix, old, period=1.0)

    rng = np.random.default_rng(5)
    position = old.position + SPACING * rng.normal([0.7, 0, 0], 0.1, old.position.shape)
    position = np.concatenate([position, [[0.5, 0.3, 0.3]]])
    position[:, 0] %= 1.0
    new = joined(position, spacing=SPACING, period=1.0)
    matrix = linear.LaplacianMatrix(**new.arrays)
    kept.follow(matrix, position=new.position)
    b = noise(new)
    stale = linear.conjugate_gradients(matrix, b, preconditioner=kept, tolerance=1e-6)
    fresh = solve("additive", new, b, period=1.0, tolerance=1e-6)
    assert stale.converged
    assert stale.iterations <= fresh.iterations + 5
    assert relative(stale.x, fresh.x) < 1e-5


def test_the_additive_preconditioner_is_symmetric_and_definite():
    cloud = blob()
    matrix = linear.LaplacianMatrix(**cloud.arrays, dirichlet=outlet(cloud))
    m = preconditioner("additive", matrix, cloud)
    columns = np.column_stack([m.apply(e) for e in np.eye(300)])
    np.testing.assert_allclose(columns, columns.T, rtol=1e-6, atol=1e-9 * np.abs(columns).max())
    assert np.linalg.eigvalsh((columns + columns.T) / 2).min() > 0


def test_deflation_leaves_no_error_in_the_coarse_space():
    """What it makes of a residual has, times the matrix, the residual's sum over each cell."""
    cloud = pipe(spacing=SPACING, diameter=0.2, length=0.4, periodic=False)
    matrix = linear.LaplacianMatrix(**cloud.arrays, dirichlet=outlet(cloud))
    m = preconditioner("deflation", matrix, cloud)
    space = linear.CoarseSpace(position=cloud.position, particle_spacing=SPACING)
    r = noise(cloud)
    left = r - matrix.apply(m.apply(r))
    sums = np.bincount(space.cell, weights=left, minlength=len(space))
    assert np.abs(sums).max() < 1e-4 * np.abs(np.bincount(space.cell, weights=r)).max()


@pytest.mark.parametrize("spacing", [0.0175, 0.0145, 0.009])
def test_sparse_rim_cells_are_merged_within_their_slab(spacing):
    length = 12 * spacing
    cloud = pipe(spacing=spacing, diameter=0.2, length=length, periodic=True)
    space = linear.CoarseSpace(position=cloud.position, particle_spacing=spacing, period=length)
    count = np.bincount(space.cell)
    assert len(count) == len(space)
    assert count.min() >= 0.3 * 27 * 0.8  # cells fitted to the box may hold less than 27
    slab = np.floor(cloud.position[:, 0] % length / (3 * spacing)).astype(int)
    for cell in range(len(space)):
        assert len(set(slab[space.cell == cell])) == 1


@pytest.mark.parametrize("name", TWO_LEVEL)
@pytest.mark.parametrize("seed", range(4))
def test_a_constant_that_rounding_leaves_in_a_residual_is_not_blown_up(name, seed):
    """No matrix of a floating cluster could give it; its coarse matrix is singular."""
    cloud = pipe(spacing=SPACING, diameter=0.2, length=1.0, periodic=True, seed=seed)
    m = preconditioner(name, linear.LaplacianMatrix(**cloud.arrays), cloud, period=1.0)
    n = len(cloud.position)
    assert np.abs(m.apply(np.ones(n))).max() < n


def test_cells_that_touch_are_near_in_number():
    """Also across the ends of a periodic pipe: what keeps the coarse factor narrow."""
    cloud = pipe(spacing=SPACING, diameter=0.2, length=4.0, periodic=True)
    space = linear.CoarseSpace(position=cloud.position, particle_spacing=SPACING, period=4.0)
    cell = space.cell.astype(int)
    apart = np.abs(np.repeat(cell, np.diff(cloud.row)) - cell[cloud.column])
    assert apart.max() < 3.2 * len(space) / 67


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"row": np.array([0, 3, 2], np.uint32)}, "row must rise"),
        ({"row": np.array([], np.uint32)}, "row must have shape"),
        ({"column": np.array([1, 2], np.uint32)}, "column must be less than"),
        ({"weight": np.ones(3, np.float32)}, "weight must have one value"),
        ({"dirichlet": np.ones(3)}, "dirichlet must have one value"),
    ],
)
def test_a_matrix_that_cannot_be_is_refused(change, message):
    arrays = {
        "row": np.array([0, 1, 2], np.uint32),
        "column": np.array([1, 0], np.uint32),
        "weight": np.ones(2, np.float32),
    }
    linear.LaplacianMatrix(**arrays)
    with pytest.raises(ValueError, match=message):
        linear.LaplacianMatrix(**arrays | change)


def test_bad_calls_name_the_argument():
    cloud = blob()
    matrix = linear.LaplacianMatrix(**cloud.arrays)
    jacobi = linear.Jacobi(matrix)
    with pytest.raises(ValueError, match="right_hand_side"):
        linear.conjugate_gradients(matrix, np.ones(5), preconditioner=jacobi)
    with pytest.raises(ValueError, match="start"):
        linear.conjugate_gradients(matrix, np.ones(300), preconditioner=jacobi, start=np.ones(5))
    for tolerance in (0, 1e-14, np.nan):
        with pytest.raises(ValueError, match="tolerance must be >= 1e-13"):
            linear.conjugate_gradients(
                matrix, np.ones(300), preconditioner=jacobi, tolerance=tolerance
            )
    with pytest.raises(TypeError):
        linear.conjugate_gradients(matrix, np.ones(300), preconditioner=None)
    with pytest.raises(ValueError, match="position must have one row"):
        linear.TwoLevelAdditive(matrix, position=np.ones((5, 3)), particle_spacing=1)
    with pytest.raises(ValueError, match="particle_spacing must be > 0"):
        linear.TwoLevelAdditive(matrix, position=cloud.position, particle_spacing=-1)


def test_an_empty_cloud_is_no_error():
    matrix = linear.LaplacianMatrix(
        row=np.zeros(1, np.uint32), column=np.empty(0, np.uint32), weight=np.empty(0, np.float32)
    )
    for two_level in (linear.TwoLevelAdditive, linear.TwoLevelDeflation):
        m = two_level(matrix, position=np.empty((0, 3)), particle_spacing=1)
        solution = linear.conjugate_gradients(matrix, np.empty(0), preconditioner=m)
        assert solution.converged
        assert solution.x.shape == (0,)
