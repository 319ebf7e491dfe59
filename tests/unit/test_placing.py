"""Solids at the start: where they are, how large, and which starts are refused."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.distance import pdist, squareform

from mpsdem.case import Case, CaseError, load_case
from mpsdem.geometry import place_solids, sample_diameters

CASES = Path(__file__).parents[2] / "cases"
RADIUS, LENGTH = 0.1, 1.0


def with_solids(**solids):
    material = {"density": 2700.0, "youngs_modulus": 1e8, "diameter": 0.02}
    return Case(end_time=1, pipe={"radius": RADIUS, "length": LENGTH}, solids=material | solids)


def listed(positions, **keys):
    relax = keys.pop("relax", False)
    return with_solids(arrangement={"kind": "list", "positions": positions, **keys}, relax=relax)


def free_distances(placement):
    """Smallest distance between two surfaces and to the wall, every pair looked at [m]."""
    position, radius = placement.position, placement.radius
    x = position[:, :1]
    along = pdist(x)
    along = np.minimum(along, LENGTH - along)
    between = np.sqrt(along**2 + pdist(position[:, 1:]) ** 2)
    touching = squareform(radius[:, None] + radius[None, :], checks=False)
    wall = RADIUS - np.hypot(position[:, 1], position[:, 2]) - radius
    return (between - touching).min(initial=np.inf), wall.min()


def refusal(case):
    with pytest.raises(CaseError) as caught:
        place_solids(case)
    return str(caught.value)


# Blocks


def test_a_block_is_filled_layer_by_layer_along_the_pipe():
    block = {"kind": "block", "counts": [3, 2, 2], "count": 9, "at": 0.25, "gap": 0.5}
    position = place_solids(with_solids(arrangement=block)).position
    x, in_layer = np.unique(position[:, 0].round(12), return_counts=True)
    np.testing.assert_allclose(x, [0.22, 0.25, 0.28])
    assert in_layer.tolist() == [4, 4, 1]
    assert np.abs(position[:8, 1:]).min() == pytest.approx(0.015)
    assert np.abs(position[:8, 1:]).max() == pytest.approx(0.015)


def test_a_block_at_an_end_goes_on_at_the_other():
    block = {"kind": "block", "counts": [3, 1, 1], "at": 0.0, "gap": 0.0}
    placement = place_solids(with_solids(arrangement=block))
    np.testing.assert_allclose(placement.position[:, 0], [0.98, 0.0, 0.02], atol=1e-15)


def test_a_block_starts_with_the_velocity_it_is_given():
    block = {"kind": "block", "counts": [1, 2, 2], "velocity": [1, 2, 3]}
    placement = place_solids(with_solids(arrangement=block))
    assert placement.velocity.tolist() == [[1.0, 2.0, 3.0]] * 4
    assert not placement.spin.any()


def test_touching_spheres_are_no_overlap():
    block = {"kind": "block", "counts": [50, 6, 6], "gap": 0.0}
    between, wall = free_distances(place_solids(with_solids(arrangement=block)))
    assert between == pytest.approx(0.0, abs=1e-15)
    assert wall > 0


def test_a_block_of_touching_spheres_eight_wide_is_refused_naming_those_in_the_wall():
    case = load_case(CASES / "horizontal_pipe.toml").with_(
        solids={"arrangement": {"counts": [8, 8, 8], "gap": 0.0}}
    )
    message = refusal(case)
    assert "overlap of the wall by 32 of 512 solids" in message
    assert "solid 0 at (0.33, -0.07, -0.07) m reaches 0.108995 m from the axis" in message
    assert "solid 63 at (0.33, 0.07, 0.07) m" in message
    assert "... and 27 more" in message
    assert "relax = true" in message
    assert "pairs" not in message


def test_a_block_longer_than_the_pipe_meets_its_own_end():
    message = refusal(with_solids(arrangement={"kind": "block", "counts": [51, 1, 1], "gap": 0.0}))
    assert "solid 0 at (0, 0, 0) m and solid 50 at (0, 0, 0) m overlap by 0.02 m" in message


# Lists


def test_a_list_is_placed_as_written():
    placement = place_solids(
        listed(
            [[0.1, 0.01, 0.02], [0.5, 0, 0]],
            velocities=[[1, 0, 0], [0, 1, 0]],
            spins=[[0, 0, 1], [0, 0, 2]],
            diameters=["10 mm", 0.03],
        )
    )
    assert placement.position.tolist() == [[0.1, 0.01, 0.02], [0.5, 0.0, 0.0]]
    assert placement.velocity.tolist() == [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    assert placement.spin.tolist() == [[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]
    np.testing.assert_allclose(placement.radius, [0.005, 0.015])


def test_two_solids_in_one_place_are_named_with_their_coordinates():
    message = refusal(listed([[0.1, 0, 0], [0.5, 0, 0], [0.515, 0, 0]]))
    assert "overlap in 1 pairs of solids" in message
    assert "solid 1 at (0.5, 0, 0) m and solid 2 at (0.515, 0, 0) m overlap by 0.005 m" in message


def test_an_overlap_across_the_ends_is_found():
    message = refusal(listed([[0.005, 0, 0], [0.995, 0, 0]]))
    assert "solid 0 at (0.005, 0, 0) m and solid 1 at (0.995, 0, 0) m overlap by 0.01 m" in message


def test_relaxed_solids_are_apart_and_those_that_were_stay():
    placement = place_solids(
        listed([[0.1, 0, 0], [0.1, 0, 0], [0.11, 0, 0.09], [0.6, 0, 0]], relax=True)
    )
    between, wall = free_distances(placement)
    assert between >= 0
    assert wall >= 0
    assert placement.position[3].tolist() == [0.6, 0.0, 0.0]
    assert np.abs(placement.position[:3] - [0.1, 0, 0.03]).max() < 0.07


def test_relaxation_makes_the_block_fit_that_was_too_wide():
    case = load_case(CASES / "horizontal_pipe.toml").with_(
        pipe={"length": LENGTH},
        solids={"relax": True, "arrangement": {"counts": [8, 8, 8], "gap": 0.0, "at": 0.5}},
    )
    between, wall = free_distances(place_solids(case))
    assert between >= 0
    assert wall >= 0


def test_solids_that_cannot_be_pushed_apart_are_refused():
    # Spheres of 0.15 m in a bore of 0.2 m are never more than 0.05 m apart across the axis, so
    # neighbors need 0.141 m along it, and three of them 0.424 m.
    case = listed([[0.1, 0, 0], [0.2, 0, 0], [0.3, 0, 0]], diameters=[0.15] * 3, relax=True).with_(
        pipe={"length": 0.301}
    )
    assert "3 solids cannot be pushed apart" in refusal(case)


# Random starts


@pytest.mark.parametrize("fraction", [0.02, 0.3, 0.5])
def test_random_solids_fill_the_fraction_asked_for_and_do_not_overlap(fraction):
    case = with_solids(volume_fraction=fraction, arrangement={"kind": "random"})
    placement = place_solids(case)
    between, wall = free_distances(placement)
    assert between >= 0
    assert wall >= 0
    volume = (4 / 3 * np.pi * placement.radius**3).sum()
    assert volume / (np.pi * RADIUS**2 * LENGTH) == pytest.approx(fraction, rel=0.01)


def test_random_solids_of_many_sizes_do_not_overlap_and_keep_their_volume():
    size = {
        "kind": "lognormal",
        "median": 0.015,
        "deviation": 0.3,
        "smallest": 0.008,
        "largest": 0.03,
    }
    case = with_solids(volume_fraction=0.4, diameter=size, arrangement={"kind": "random"})
    placement = place_solids(case)
    between, wall = free_distances(placement)
    assert between >= 0
    assert wall >= 0
    volume = (4 / 3 * np.pi * placement.radius**3).sum()
    assert volume / (np.pi * RADIUS**2 * LENGTH) == pytest.approx(0.4, rel=0.01)


def test_a_seed_gives_the_same_start_and_another_seed_another():
    case = with_solids(count=100, seed=1, arrangement={"kind": "random"})
    first, again = place_solids(case), place_solids(case)
    assert first.position.tobytes() == again.position.tobytes()
    other = place_solids(case.with_(solids={"seed": 2}))
    assert np.abs(first.position - other.position).max() > 0.01


def test_random_solids_stay_in_their_stretch():
    stretch = {"kind": "random", "start": 0.2, "end": 0.4, "velocity": [1, 0, 0]}
    placement = place_solids(with_solids(count=400, arrangement=stretch))
    assert placement.position[:, 0].min() >= 0.2 + 0.01
    assert placement.position[:, 0].max() <= 0.4 - 0.01
    assert free_distances(placement)[0] >= 0
    assert (placement.velocity == [1.0, 0.0, 0.0]).all()


def test_random_solids_are_spread_evenly_over_the_section():
    """Half of all centres lie within 1 / sqrt(2) of the radius that centres can reach."""
    placement = place_solids(
        with_solids(count=2000, diameter=0.002, arrangement={"kind": "random"})
    )
    reach = np.hypot(placement.position[:, 1], placement.position[:, 2]) / (RADIUS - 0.001)
    assert (reach < np.sqrt(0.5)).mean() == pytest.approx(0.5, abs=0.03)


def test_a_case_without_solids_has_an_empty_placement():
    placement = place_solids(load_case(CASES / "clear_liquid.toml"))
    assert placement.position.shape == placement.velocity.shape == placement.spin.shape == (0, 3)
    assert placement.radius.shape == (0,)


# Sizes


SIEVE = {"kind": "sieve", "diameters": [0.01, 0.02, 0.03], "fractions": [0.5, 0.3, 0.2]}
UNIFORM = {"kind": "uniform", "smallest": 0.01, "largest": 0.03}
LOGNORMAL = {
    "kind": "lognormal",
    "median": 0.01,
    "deviation": 0.5,
    "smallest": 0.001,
    "largest": 0.1,
}


def drawn(size, count=1000, seed=0):
    solids = with_solids(diameter=size, arrangement={"kind": "block", "counts": [1, 1, 1]}).solids
    return sample_diameters(solids.diameter, count, np.random.default_rng(seed)), solids


def test_sieve_classes_hold_their_share_of_the_number():
    diameters, _ = drawn(SIEVE)
    assert [(diameters == d).sum() for d in SIEVE["diameters"]] == [500, 300, 200]


def test_a_sieve_class_without_solids_counts_for_nothing():
    _, solids = drawn({"kind": "sieve", "diameters": [0.01, 0.02], "fractions": [0.0, 1.0]})
    assert solids.smallest_diameter == solids.largest_diameter == 0.02


def test_lognormal_diameters_have_the_median_and_the_spread_given():
    diameters, _ = drawn(LOGNORMAL, count=20001)
    assert np.median(diameters) == pytest.approx(0.01, rel=1e-3)
    assert np.log(diameters).std() == pytest.approx(0.5, rel=1e-3)


@pytest.mark.parametrize("size", [UNIFORM, LOGNORMAL, SIEVE, 0.02], ids=str)
def test_the_mean_volume_of_a_size_is_that_of_its_solids(size):
    diameters, solids = drawn(size, count=100_000)
    mean = (np.pi / 6 * diameters**3).mean()
    assert solids.mean_volume == pytest.approx(mean, rel=1e-3)
    assert solids.smallest_diameter <= diameters.min()
    assert solids.largest_diameter >= diameters.max()


def test_a_seed_changes_the_order_of_diameters_alone():
    one, _ = drawn(UNIFORM, seed=1)
    two, _ = drawn(UNIFORM, seed=2)
    assert (one != two).any()
    assert (np.sort(one) == np.sort(two)).all()
