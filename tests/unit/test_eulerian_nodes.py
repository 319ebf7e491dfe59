"""Nodes of a pipe, the operators between them, and the direct solver on them."""

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse import linalg

from mpsdem._core import linear, mps
from mpsdem.geometry import node_layout

RADIUS = 0.1


def layout(across=16, length=0.4):
    return node_layout(radius=RADIUS, length=length, spacing=2 * RADIUS / across)


def section(nodes):
    return {
        "place": nodes.place,
        "area": nodes.area,
        "wall_count": nodes.wall_count,
        "pipe_radius": RADIUS,
        "spacing": nodes.spacing,
    }


@pytest.fixture(scope="module")
def nodes():
    return layout()


@pytest.fixture(scope="module")
def operators(nodes):
    return mps.section_operators(**section(nodes))


@pytest.mark.parametrize("across", [6, 10, 16, 24, 40])
def test_the_areas_integrate_a_quartic_over_the_bore(across):
    nodes = layout(across)
    y, z = nodes.place.T
    assert np.all(nodes.area > 0)
    assert nodes.area.sum() == pytest.approx(np.pi * RADIUS**2, rel=1e-12)
    # int (y^4 + y^2 z + z^2 y^2) dA = pi R^6 (1/8 + 1/24)
    assert nodes.area @ (y**4 + y**2 * z + y**2 * z**2) == pytest.approx(
        np.pi * RADIUS**6 / 6, rel=1e-12
    )


def images(nodes):
    """Each node's image in the z axis and in the y axis, (2, nodes), and how far it is off it."""
    away = [
        np.linalg.norm(nodes.place[:, None] * sign - nodes.place, axis=2)
        for sign in ([-1, 1], [1, -1])
    ]
    return np.argmin(away, axis=2).astype(np.uint32), np.max(np.min(away, axis=2))


@pytest.mark.parametrize("across", [6, 10, 16, 24, 27, 40])
def test_the_pattern_is_its_own_mirror_image(across):
    assert images(layout(across))[1] < 1e-12


@pytest.mark.parametrize("length", [0.05, 0.1, 0.37, 1.0, 2.9, 8.8])
def test_the_stations_suit_the_kernels_and_the_transform(length):
    nodes = layout(16, length)
    assert nodes.stations % 4 == 0
    rest = nodes.stations
    for factor in (2, 3, 5):
        while rest % factor == 0:
            rest //= factor
    assert rest == 1
    if length >= 0.37:
        assert nodes.axial_spacing == pytest.approx(nodes.spacing, rel=0.08)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"spacing": 0.04}, "must be at most 0.0333"),
        ({"radius": -1.0}, "radius = -1.0: must be > 0 m"),
        ({"length": 0.005}, "must be at most 0.005 m"),
    ],
)
def test_a_pipe_without_room_for_nodes_is_refused(change, message):
    with pytest.raises(ValueError, match=message):
        node_layout(**{"radius": 0.1, "length": 1.0, "spacing": 0.01} | change)


def test_the_operators_are_exact_for_quadratics_at_every_node(nodes, operators):
    y, z = nodes.place.T
    f = 3 - 20 * y + 50 * z + 100 * y**2 + 700 * z**2 - 300 * y * z
    assert operators["gradient_y"] @ f == pytest.approx(-20 + 200 * y - 300 * z, abs=1e-9)
    assert operators["gradient_z"] @ f == pytest.approx(50 + 1400 * z - 300 * y, abs=1e-9)
    assert operators["laplacian"] @ f == pytest.approx(1600, abs=1e-7)
    for name in ("damping_y", "damping_z"):
        assert operators[name] @ f == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("across", [10, 16, 24])
def test_upwind_damping_damps(across):
    """Its eigenvalues with a wall at rest lie on the side of decay, short waves fastest."""
    nodes = layout(across)
    operators = mps.section_operators(**section(nodes))
    inner = slice(0, -nodes.wall_count)
    for name in ("damping_y", "damping_z"):
        rates = np.linalg.eigvals(operators[name][inner, inner]).real * nodes.spacing
        assert rates.min() > -1e-12
        assert 0.3 < rates.max() < 0.5


@pytest.mark.parametrize("across", [10, 16, 24])
def test_the_laplacian_with_a_wall_at_rest_has_the_modes_of_a_drum(across):
    """The slowest of them decay at the squares of the zeros of J0 and J1, to second order."""
    nodes = layout(across)
    inner = slice(0, -nodes.wall_count)
    laplacian = mps.section_operators(**section(nodes))["laplacian"]
    rates = np.sort(-np.linalg.eigvals(laplacian[inner, inner]).real) * RADIUS**2
    exact = np.array([2.404826, 3.831706, 3.831706]) ** 2
    assert rates[:3] == pytest.approx(exact, rel=4 / across**2 + 0.02)


def pressure_problem(nodes, stations=12):
    """A and B of the pressure of a pipe, and what a second difference makes of each wave."""
    operators = mps.section_operators(**section(nodes))
    walls = nodes.wall_count
    y, z = nodes.place[-walls:].T / RADIUS
    angle = 2 * np.pi * np.arange(stations // 2 + 1) / stations
    return {
        "interior": operators["laplacian"][:-walls].copy(),
        "wall": y[:, None] * operators["gradient_y"][-walls:]
        + z[:, None] * operators["gradient_z"][-walls:],
        "axial": (2 * np.cos(angle) - 2) / nodes.spacing**2,
        "stations": stations,
    }


def residual(problem, p, right_hand_side, spacing):
    """How far A p + d2p/dx2 and B p are from the right-hand side."""
    along = (np.roll(p, 1, axis=1) - 2 * p + np.roll(p, -1, axis=1)) / spacing**2
    inner = len(problem["interior"])
    return np.concatenate(
        [
            problem["interior"] @ p + along[:inner] - right_hand_side[:inner],
            problem["wall"] @ p - right_hand_side[inner:],
        ]
    )


def test_the_direct_solver_solves(nodes):
    problem = pressure_problem(nodes)
    solver = linear.CrossSectionSolver(**problem)
    # a right-hand side that some p has; the constant is free
    p = np.random.default_rng(2).standard_normal((len(nodes.place), problem["stations"]))
    b = residual(problem, p, np.zeros_like(p), nodes.spacing)
    solution = solver.solve(b)
    left = residual(problem, solution, b, nodes.spacing)
    assert np.abs(left).max() < 1e-10 * np.abs(b).max()
    difference = solution - p
    assert np.ptp(difference) < 1e-10


def test_the_direct_solver_agrees_with_a_dense_one():
    """Over one station the axis drops out: least squares of LAPACK on A and B."""
    problem = pressure_problem(layout(10), stations=4)
    matrix = np.concatenate([problem["interior"], problem["wall"]])
    p = np.random.default_rng(3).standard_normal(len(matrix))
    b = np.repeat((matrix @ p)[:, None], 4, axis=1)
    dense = np.linalg.lstsq(matrix, b[:, 0], rcond=None)[0]
    solution = linear.CrossSectionSolver(**problem).solve(b)
    for station in solution.T:
        assert station - station.mean() == pytest.approx(dense - dense.mean(), abs=1e-10)


def test_the_direct_solver_agrees_with_a_factor_of_the_whole_pipe(nodes):
    """LU of SuperLU: on rings the matrix is not symmetric, so that Cholesky has no say."""
    problem = pressure_problem(nodes)
    n, inner = problem["stations"], len(problem["interior"])
    around = sparse.eye_array(n)
    along = sparse.csr_array(np.roll(np.eye(n), 1, axis=1) + np.roll(np.eye(n), -1, axis=1))
    on_inner = sparse.eye_array(inner, len(nodes.place))
    matrix = sparse.vstack(
        [
            sparse.kron(sparse.csr_array(problem["interior"]), around)
            + sparse.kron(on_inner, (along - 2 * around) / nodes.spacing**2),
            sparse.kron(sparse.csr_array(problem["wall"]), around),
        ]
    ).tocsc()
    p = np.random.default_rng(4).standard_normal(matrix.shape[0])
    b = matrix @ p
    whole = np.append(0.0, linalg.splu(matrix[1:, 1:]).solve(b[1:]))  # p is 0 at its first place
    solution = linear.CrossSectionSolver(**problem).solve(b.reshape(-1, n)).ravel()
    assert solution - solution[0] == pytest.approx(whole, abs=1e-9)


@pytest.mark.parametrize("across", [6, 10, 16, 27])
def test_even_and_odd_parts_solved_apart_are_the_whole_solution(across):
    nodes = layout(across)
    problem = pressure_problem(nodes)
    p = np.random.default_rng(5).standard_normal((len(nodes.place), problem["stations"]))
    b = residual(problem, p, np.zeros_like(p), nodes.spacing)
    whole = linear.CrossSectionSolver(**problem).solve(b)
    apart = linear.CrossSectionSolver(**problem, mirrors=images(nodes)[0]).solve(b)
    assert apart == pytest.approx(whole, abs=1e-10)


def test_mirrors_that_the_operators_do_not_share_change_nothing(nodes):
    problem = pressure_problem(nodes)
    problem["interior"][0, [0, 5]] += 1e-6 * problem["interior"][0, 0] * np.array([1, -1])
    b = np.random.default_rng(6).standard_normal((len(nodes.place), problem["stations"]))
    whole = linear.CrossSectionSolver(**problem).solve(b)
    mirrored = linear.CrossSectionSolver(**problem, mirrors=images(nodes)[0]).solve(b)
    assert np.array_equal(whole, mirrored)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda of: np.roll(of, 1, axis=1), "its own inverse"),
        (lambda of: of[:, :-1], "one image per node"),
        (lambda of: of[:1], "must have shape"),
    ],
)
def test_mirrors_that_are_none_are_refused(nodes, change, message):
    mirrors = np.ascontiguousarray(change(images(nodes)[0]))
    with pytest.raises(ValueError, match=message):
        linear.CrossSectionSolver(**pressure_problem(nodes), mirrors=mirrors)


def test_a_source_that_no_pressure_has_is_dropped_not_amplified(nodes):
    problem = pressure_problem(nodes)
    b = np.zeros((len(nodes.place), problem["stations"]))
    b[: -nodes.wall_count] = 1.0
    assert np.abs(linear.CrossSectionSolver(**problem).solve(b)).max() < RADIUS**2


def test_the_solver_does_not_depend_on_threads(nodes):
    problem = pressure_problem(nodes, stations=300)
    solver = linear.CrossSectionSolver(**problem)
    b = np.random.default_rng(4).standard_normal((len(nodes.place), 300))
    one = solver.solve(b, threads=1)
    for threads in (2, 3):
        assert np.array_equal(one, solver.solve(b, threads=threads))


def test_an_operator_that_grows_is_refused(nodes):
    problem = pressure_problem(nodes)
    problem["interior"] = -problem["interior"]
    with pytest.raises(RuntimeError, match="growing mode"):
        linear.CrossSectionSolver(**problem)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"stations": 10}, "multiple of 4"),
        ({"axial": np.zeros(3)}, "one value per wave"),
        ({"wall": np.zeros((3, 7))}, "one column per node"),
    ],
)
def test_a_problem_that_does_not_fit_together_is_refused(nodes, change, message):
    with pytest.raises(ValueError, match=message):
        linear.CrossSectionSolver(**pressure_problem(nodes) | change)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"wall_count": 49}, "half a spacing from the wall"),
        ({"wall_count": 51}, "must lie on the wall"),
        ({"area": np.ones(3)}, "one value per node"),
        ({"spacing": 0.0}, "spacing must be > 0 m"),
    ],
)
def test_a_section_that_is_none_is_refused(nodes, change, message):
    with pytest.raises(ValueError, match=message):
        mps.section_operators(**section(nodes) | change)
