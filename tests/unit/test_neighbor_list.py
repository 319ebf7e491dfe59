"""The neighbor list against all pairs."""

import numpy as np
import pytest

from mpsdem._core.neighbors import NeighborList, cell_order


def cloud(count, seed, *, extent=(1.0, 0.6, 0.4)):
    return np.random.default_rng(seed).random((count, 3)) * extent


def all_pairs(position, radius, period=0.0):
    """Rows and columns of the pairs nearer than the radius."""
    apart = position[None, :] - position[:, None]
    if period:
        apart[..., 0] -= period * np.round(apart[..., 0] / period)
    near = np.linalg.norm(apart, axis=2) < radius
    np.fill_diagonal(near, False)
    return np.nonzero(near)


def pairs(neighbors):
    counts = np.diff(neighbors.row.astype(int))
    return np.repeat(np.arange(len(neighbors)), counts), neighbors.column


def assert_all_found(position, radius, period=0.0, **call):
    found = pairs(NeighborList(position, radius=radius, period=period, **call))
    expected = all_pairs(position, radius, period)
    np.testing.assert_array_equal(found, expected)
    return len(found[0])


@pytest.mark.parametrize("radius", [0.02, 0.1, 0.25, 0.49, 3.0])
def test_every_pair_within_the_radius_is_found_once_in_each_of_its_rows(radius):
    position = cloud(700, 1)
    assert_all_found(position, radius)
    if radius < 0.5:
        assert assert_all_found(position, radius, period=1.0) > 0


@pytest.mark.parametrize("period", [0.401, 0.5, 0.6, 0.7, 0.81, 2.0])
def test_pairs_meet_across_the_seam_however_few_cells_are_along_the_period(period):
    position = cloud(400, 2, extent=(period, 0.6, 0.4))
    assert assert_all_found(position, 0.2, period) > assert_all_found(position, 0.2)


@pytest.mark.parametrize("count", [1, 2, 7, 8, 9, 15, 16, 17, 31, 33])
def test_any_number_of_candidates_may_fill_the_registers(count):
    assert_all_found(cloud(count, 3), 0.5)
    assert assert_all_found(cloud(count, 3, extent=(0.1, 0.1, 0.1)), 1.0) == count * (count - 1)


def test_more_rows_than_a_thread_takes_at_once_are_all_found():
    position = cloud(2200, 4)
    position = position[cell_order(position, cell_size=0.08, period=1.0)]
    assert assert_all_found(position, 0.08, period=1.0) > 2200


def test_points_in_one_place_are_neighbors_but_none_is_its_own():
    position = np.array([[0.5, 0, 0], [0.5, 0, 0], [0.5, 0, 0], [2.0, 0, 0]])
    assert list(NeighborList(position, radius=0.1).column) == [1, 2, 0, 2, 0, 1]


def test_a_pair_at_exactly_the_radius_is_none():
    position = np.array([[0.0, 0, 0], [0.5, 0, 0], [0.75, 0, 0]])
    assert list(NeighborList(position, radius=0.5).column) == [2, 1]


def test_the_list_is_symmetric_where_rounding_decides_what_is_within_the_radius():
    """Lattice points at distances that equal the radius but for their last bits."""
    axis = np.arange(10) * 0.1
    position = np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)
    position += [0.07, 1.3, 3.7]
    rows, columns = pairs(NeighborList(position, radius=0.2, period=1.0))
    there = set(zip(rows.tolist(), columns.tolist(), strict=True))
    assert there == {(j, i) for i, j in there}


def test_x_outside_the_period_is_wrapped():
    position = cloud(300, 5)
    shifted = position + np.random.default_rng(6).integers(-3, 3, 300)[:, None] * [1.0, 0, 0]
    here, there = (NeighborList(x, radius=0.2, period=1.0) for x in (position, shifted))
    np.testing.assert_array_equal(here.column, there.column)


@pytest.mark.parametrize("threads", [2, 3, 8])
def test_the_list_does_not_depend_on_the_threads(threads):
    position = cloud(6000, 7)
    one = NeighborList(position, radius=0.05, period=1.0)
    many = NeighborList(position, radius=0.05, period=1.0, threads=threads)
    np.testing.assert_array_equal(one.row, many.row)
    np.testing.assert_array_equal(one.column, many.column)


def test_a_list_made_anew_forgets_the_old_points():
    neighbors = NeighborList(cloud(3000, 8), radius=0.1, period=1.0)
    for count in (500, 0, 4000):
        position = cloud(count, 9)
        neighbors.find(position)
        fresh = NeighborList(position, radius=0.1, period=1.0)
        assert len(neighbors) == count
        np.testing.assert_array_equal(neighbors.row, fresh.row)
        np.testing.assert_array_equal(neighbors.column, fresh.column)


def test_a_point_flung_far_away_costs_no_memory_and_has_no_neighbors():
    position = np.concatenate([cloud(200, 10), [[0.5, 1e9, -1e12]]])
    assert_all_found(position, 0.1, period=1.0)


def test_the_cell_order_brings_neighbors_near_in_memory():
    position = cloud(4000, 11, extent=(4.0, 0.4, 0.4))
    order = cell_order(position, cell_size=0.1, period=4.0)
    assert sorted(order) == list(range(4000))

    def spread(points):
        rows, columns = pairs(NeighborList(points, radius=0.1))
        return np.mean(np.abs(rows - columns.astype(int)))

    assert spread(position[order]) < spread(position) / 10


def test_an_order_once_made_is_kept():
    position = cloud(1000, 12)
    position = position[cell_order(position, cell_size=0.1, period=1.0)]
    np.testing.assert_array_equal(cell_order(position, cell_size=0.1, period=1.0), np.arange(1000))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"radius": 0.0}, "radius must be > 0 m"),
        ({"radius": np.nan}, "radius must be > 0 m"),
        ({"period": 0.4}, "more than two radii"),
        ({"period": -1.0}, "more than two radii"),
        ({"position": [[0.0, np.nan, 0]]}, "position must be finite"),
        ({"position": [[np.inf, 0, 0]]}, "position must be finite"),
        ({"position": [0.0, 0, 0]}, r"position must have shape \(n, 3\)"),
    ],
)
def test_bad_input_names_the_field(change, message):
    arguments = {"position": [[0.0, 0, 0]], "radius": 0.2} | change
    with pytest.raises(ValueError, match=message):
        NeighborList(**arguments)
