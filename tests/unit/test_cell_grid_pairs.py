"""Every pair that touches is found, and nothing else: `contacts()` against all pairs and images."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from slow_dem import LINEAR, Flat, block, scene

FLOATING = {"pair_law": LINEAR, "wall_law": LINEAR}


def touching(position, radius, period=0.0):
    """(pair, overlap [m], normal) of each touching image of each pair, by looking at all."""
    i, j = np.triu_indices(len(position), 1)
    found = []
    for image in range(-2, 3) if period else (0,):
        d = position[i] - position[j] + [image * period, 0, 0]
        distance = np.linalg.norm(d, axis=1)
        overlap = radius[i] + radius[j] - distance
        found += [
            ((int(i[k]), int(j[k])), overlap[k], d[k] / distance[k])
            for k in np.flatnonzero(overlap > 0)
        ]
    return sorted(found, key=lambda contact: (contact[0], contact[1]))


def reported(solids):
    contacts = solids.contacts()
    rows = zip(
        contacts["first"], contacts["second"], contacts["overlap"], contacts["normal"], strict=True
    )
    pairs = [
        ((int(min(a, b)), int(max(a, b))), overlap, normal if a < b else -normal)
        for a, b, overlap, normal in rows
    ]
    return sorted(pairs, key=lambda contact: (contact[0], contact[1]))


def assert_all_found(solids, period):
    found = reported(solids)
    expected = touching(solids.position, solids.radius, period)
    assert [pair for pair, *_ in found] == [pair for pair, *_ in expected]
    for k, tolerance in ((1, 1e-13 * max(solids.radius)), (2, 1e-9)):
        np.testing.assert_allclose(
            [contact[k] for contact in found],
            [contact[k] for contact in expected],
            rtol=0,
            atol=tolerance,
        )
    return len(found)


def crowd(rng, n, *, box, smallest=1.0, largest=1.0, speed=0.0, **parts):
    """Solids anywhere in a box, overlapping as chance has it."""
    position = rng.uniform(0, 1, (n, 3)) * box
    radius = rng.uniform(smallest, largest, n)
    velocity = rng.normal(0, speed, (n, 3)) if speed else 0.0
    return scene(position, velocity, radius=radius, **FLOATING, **parts)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("diameters", [0, 2, 2.001, 2.9, 3.3, 5, 6.7, 40])
def test_all_touching_pairs_are_found_in_periods_short_and_long(diameters, seed):
    rng = np.random.default_rng(seed)
    period = 2.0 * diameters
    cloud = crowd(rng, 60, box=[period or 10, 8, 8], period=period)
    assert assert_all_found(cloud.solids(), period) > 5


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("diameters", [0, 2, 3.3, 7])
def test_all_touching_pairs_are_found_among_sizes_from_1_to_10(diameters, seed):
    rng = np.random.default_rng(seed)
    period = 2.0 * diameters
    cloud = crowd(rng, 300, box=[period or 10, 12, 12], smallest=0.1, period=period)
    cloud.radius[:2] = 0.1, 1.0
    assert assert_all_found(cloud.solids(), period) > 50


def test_solids_on_the_border_touch_through_it():
    period = 10.0
    for x in (0.0, 1e-17, -1e-17, np.nextafter(period, 0), period, -0.5, 3 * period - 1e-12):
        solids = scene(
            [[x, 0, 0], [x + 1.9, 0, 0], [x - 1.9, 0, 0]], radius=1.0, period=period, **FLOATING
        ).solids()
        assert [pair for pair, *_ in reported(solids)] == [(0, 1), (0, 2)]
        assert np.all((solids.position[:, 0] >= 0) & (solids.position[:, 0] < period))


def test_in_the_shortest_period_a_pair_touches_through_the_border_only_once():
    solids = scene([[0, 0, 0], [2.1, 0, 0]], radius=1.0, period=4.0, **FLOATING).solids()
    assert len(reported(solids)) == 1
    assert reported(solids)[0][1] == pytest.approx(0.1)


@pytest.mark.parametrize("period", [0.0, 4.0, 9.0])
def test_all_touching_pairs_are_found_as_the_solids_move(period):
    rng = np.random.default_rng(7)
    cloud = crowd(
        rng,
        80,
        box=[period or 8, 8, 8],
        smallest=0.3,
        speed=3.0,
        period=period,
    )
    solids, sorts = cloud.solids(), 0
    for _ in range(20):
        sorts += solids.advance(2e-3, 10).sorts
        assert assert_all_found(solids, period) > 0
    assert sorts > 5


def test_pairs_that_close_as_fast_as_any_two_can_are_found_at_once():
    """All at one speed, head-on, from all distances: lists may last not a step too long."""
    rng = np.random.default_rng(8)
    gap = np.linspace(0.0, 0.8, 60)
    left = np.column_stack([0 * gap, 4.0 * np.arange(60), 0 * gap])
    start = scene(
        np.concatenate([left, left + np.column_stack([2 + gap, 0 * gap, 0 * gap])]),
        np.repeat([[1.0, 0, 0], [-1.0, 0, 0]], 60, axis=0),
        radius=1.0,
        density=1e6,
        **FLOATING,
    )
    for dt in (1e-3, 7e-3, 3e-2):
        solids, counts = start.solids(), []
        for _ in range(round(0.3 / dt)):
            solids.advance(dt * rng.uniform(0.5, 1.0), 1)
            counts.append(assert_all_found(solids, 0.0))
        assert counts[-1] > 20


@pytest.mark.parametrize(
    ("wind", "spread"), [(0.0, 1.0), (1.0, 1.0), (-0.5, 1.0), (20.0, 1.0), (1.0, 1e-3), (-1.0, 0)]
)
def test_solids_that_near_walls_as_fast_as_they_can_are_found_at_once(wind, spread):
    """Walls on both sides, and a mean velocity that lists of pairs do not care for."""
    gap = np.linspace(0.0, 3.0, 60)
    low = np.column_stack([0 * gap, 4.0 * np.arange(60), 1.0 + gap])
    high = low * [1, 1, -1] + [0, 2, 40.0]
    start = scene(
        np.concatenate([low, high]),
        np.repeat([[0, 0, wind - spread], [0, 0, wind + spread]], 60, axis=0),
        radius=1.0,
        density=1e6,
        walls=[Flat(), Flat(point=(0, 0, 40), normal=(0, 0, -1))],
        **FLOATING,
    )
    fastest = abs(wind) + spread
    for dt in (0.01 / fastest, 0.05 / fastest):
        solids, met = start.solids(), set()
        for _ in range(round(2 / fastest / dt)):
            solids.advance(dt, 1)
            height = solids.position[:, 2]
            contacts = solids.contacts()
            found = set(contacts["first"][contacts["second"] < 0].tolist())
            assert found == set(np.flatnonzero((height < 1) | (height > 39)).tolist())
            # what touches has felt it
            assert np.all(solids.velocity[list(found), 2] != start.velocity[list(found), 2])
            met |= found
        assert len(met) > 30


def test_all_touching_pairs_are_found_across_blocks():
    """More solids than one block holds, listed in no order; SciPy's tree as the oracle."""
    rng = np.random.default_rng(3)
    period = 18 * 1.99
    points = block((18, 16, 15), 1.99, rng, jitter=0.02) + 1
    rng.shuffle(points)
    solids = scene(points, radius=1.0, period=period, **FLOATING).solids()
    assert len(solids) > 4096
    tree = cKDTree(solids.position, boxsize=[period, 100, 100])
    found = [pair for pair, *_ in reported(solids)]
    assert found == sorted(tree.query_pairs(2.0))
    assert len(found) > 8000


def test_a_lone_solid_touches_nothing():
    assert reported(scene([0, 0, 0], period=0.04).solids()) == []


def test_contacts_of_walls_are_told_apart_from_pairs():
    walls = [Flat(), Flat(normal=(0, 1, 0))]
    solids = scene([[0, 0.009, 0.008], [0.1, 1, 1]], walls=walls).solids()
    contacts = solids.contacts()
    assert contacts["first"].tolist() == [0, 0]
    assert contacts["second"].tolist() == [-1, -2]
    np.testing.assert_allclose(contacts["overlap"], [0.002, 0.001])
    np.testing.assert_allclose(contacts["normal"], [[0, 0, 1], [0, 1, 0]])


def test_a_pair_pushes_apart_along_its_normal():
    solids = scene([[0, 0, 0], [0, 0, 0.019]]).solids()
    contacts = solids.contacts()
    assert contacts["first"].tolist() + contacts["second"].tolist() == [0, 1]
    np.testing.assert_allclose(contacts["normal"], [[0, 0, -1]])
    assert contacts["force"][0, 2] < 0
