"""No part of a sphere is lost, and each lies where brute force finds it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mpsdem.analysis import (
    cell_area,
    cell_volume,
    height_edges,
    insitu_concentration,
    radius_edges,
    ring_volume,
    slab_area,
    solids_flux_along_pipe,
    velocity_over_radius,
    volume_fraction_along_pipe,
    volume_fraction_over_height,
    volume_fraction_over_radius,
    volume_fraction_over_section,
)

BORE = {"pipe_radius": 0.1, "length": 0.5}
HEIGHTS, RADII = height_edges(0.1, 20), radius_edges(0.1, 10)
RINGS = np.pi * np.diff(RADII**2)


def cloud(count=300, radius=0.01, seed=0, reach=None):
    """Centres (count, 3) and radii of spheres, evenly and independently placed in the bore."""
    rng = np.random.default_rng(seed)
    reach = 0.1 - radius if reach is None else reach
    away, angle = reach * np.sqrt(rng.random(count)), rng.uniform(0, 2 * np.pi, count)
    x = rng.uniform(0, BORE["length"], count)
    place = np.column_stack([x, away * np.cos(angle), away * np.sin(angle)])
    return place, np.full(count, radius)


def balls(centre, radius, points=400_000):
    """Random points in one sphere, (points, 2), seen along the pipe."""
    p = np.random.default_rng(1).standard_normal((points, 5))  # its first three, normed, fill it
    return np.asarray(centre) + radius * (p[:, :3] / np.linalg.norm(p, axis=1)[:, None])[:, :2]


@given(st.floats(0, 0.2), st.floats(1e-3, 0.05), st.integers(1, 40))
def test_the_rings_of_a_sphere_add_up_to_it(distance, radius, bins):
    volume = ring_volume(np.array([distance]), np.array([radius]), radius_edges(0.3, bins))
    assert (volume >= -1e-12 * radius**3).all()
    assert volume.sum() == pytest.approx(4 / 3 * np.pi * radius**3, rel=1e-12)


@pytest.mark.parametrize("distance", [0.0, 0.003, 0.01, 0.05])
def test_a_ring_holds_of_a_sphere_what_random_points_say(distance):
    edges = np.array([0.0, 0.008, 0.045, 0.052, 1.0])
    volume = ring_volume(np.array([distance]), np.array([0.01]), edges)[0]
    found, _ = np.histogram(np.hypot(*balls([distance, 0.0], 0.01).T), edges)
    share = volume / (4 / 3 * np.pi * 0.01**3)
    np.testing.assert_allclose(share, found / found.sum(), atol=6e-3)


def test_a_sphere_about_the_axis_loses_its_bored_core():
    # Napkin ring: what is left of a sphere around a hole of height h is pi h^3 / 6.
    volume = ring_volume(np.array([0.0]), np.array([1.0]), np.array([0.0, 0.6, 1.0]))
    assert volume[0, 1] == pytest.approx(np.pi * 1.6**3 / 6, rel=6e-3)


@settings(max_examples=50)
@given(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2), st.floats(1e-3, 0.09), st.integers(1, 30))
def test_the_cells_of_a_sphere_add_up_to_it(y, z, radius, bins):
    edges = np.linspace(-0.3, 0.3, bins + 1)
    volume = cell_volume(np.array([y]), np.array([z]), np.array([radius]), edges)
    assert volume.sum() == pytest.approx(4 / 3 * np.pi * radius**3, rel=1e-9)
    assert (volume >= -1e-9 * radius**3).all()


def test_a_cell_holds_of_a_sphere_what_random_points_say():
    edges, centre, radius = np.linspace(-0.1, 0.1, 9), (0.011, -0.042), 0.03
    volume = cell_volume(*(np.array([c]) for c in (*centre, radius)), edges)
    found, _, _ = np.histogram2d(*balls(centre, radius).T, bins=[edges, edges])
    share = volume / (4 / 3 * np.pi * radius**3)
    np.testing.assert_allclose(share, found / found.sum(), atol=3e-3)


@given(st.integers(1, 40))
def test_the_cells_of_the_bore_add_up_to_it(bins):
    area = cell_area(0.1, height_edges(0.1, bins))
    assert area.sum() == pytest.approx(np.pi * 0.01, rel=1e-12)
    np.testing.assert_allclose(
        area.sum(axis=0), slab_area(0.1, height_edges(0.1, bins)), atol=1e-15
    )


@pytest.mark.parametrize("reach", [0.09, 0.0901])  # the second presses spheres into the wall
def test_every_way_to_cut_the_bore_returns_the_concentration_in_situ(reach):
    position, radius = cloud(reach=reach)
    position[:, 1:] *= np.where(np.hypot(*position[:, 1:].T) > 0.08, 0.0901 / 0.09, 1)[:, None]
    concentration = insitu_concentration(radius, **BORE)
    assert concentration == pytest.approx(300 * 4 / 3 * 0.01 / 0.5 * 0.01**2 / 0.01, rel=1e-12)
    over_height = volume_fraction_over_height(position, radius, **BORE, edges=HEIGHTS)
    over_radius = volume_fraction_over_radius(position, radius, **BORE, edges=RADII)
    over_section = volume_fraction_over_section(position, radius, **BORE, bins=12)
    along = volume_fraction_along_pipe(position[:, 0], radius, **BORE, bins=7)
    area = cell_area(0.1, height_edges(0.1, 12))
    for fraction, weight in (
        (over_height, slab_area(0.1, HEIGHTS)),
        (over_radius, RINGS),
        (np.nan_to_num(over_section), area),
        (along, np.ones(7)),
    ):
        assert (fraction * weight).sum() / weight.sum() == pytest.approx(concentration, rel=1e-12)


def test_an_even_suspension_is_even_over_height_radius_and_length():
    position, radius = cloud(100_000, 1e-4)
    concentration = insitu_concentration(radius, **BORE)
    inner = np.abs(HEIGHTS[1:] + HEIGHTS[:-1]) < 0.16
    over_height = volume_fraction_over_height(position, radius, **BORE, edges=HEIGHTS)
    over_radius = volume_fraction_over_radius(position, radius, **BORE, edges=RADII)
    along = volume_fraction_along_pipe(position[:, 0], radius, **BORE, bins=10)
    np.testing.assert_allclose(over_height[inner], concentration, rtol=0.08)
    np.testing.assert_allclose(over_radius[1:-1], concentration, rtol=0.08)
    np.testing.assert_allclose(along, concentration, rtol=0.04)


def test_the_section_turns_with_the_solids():
    position, radius = cloud(reach=0.06)
    position[:, 2] -= 0.02
    turned = position[:, [0, 2, 1]] * [1, -1, 1]  # y -> z, z -> -y
    straight = volume_fraction_over_section(position, radius, **BORE, bins=16)
    after = volume_fraction_over_section(turned, radius, **BORE, bins=16)
    np.testing.assert_allclose(after, np.rot90(straight), atol=1e-12)
    assert not np.allclose(np.nan_to_num(after), np.nan_to_num(straight), atol=1e-3)


def test_the_columns_of_a_section_are_its_heights():
    position, radius = cloud()
    section = volume_fraction_over_section(position, radius, **BORE, bins=20)
    area = cell_area(0.1, HEIGHTS)
    over_height = volume_fraction_over_height(position, radius, **BORE, edges=HEIGHTS)
    solid = np.nan_to_num(section) * area
    np.testing.assert_allclose(solid.sum(axis=0) / area.sum(axis=0), over_height, atol=1e-12)


def test_cells_outside_of_the_bore_have_no_volume_fraction():
    position, radius = cloud()
    section = volume_fraction_over_section(position, radius, **BORE, bins=20)
    assert np.isnan(section[[0, 0, -1, -1], [0, -1, 0, -1]]).all()
    assert np.isfinite(section[6:14, 6:14]).all()


def test_a_sphere_in_the_outlet_is_in_the_inlet_too():
    along = volume_fraction_along_pipe(np.array([0.5]), np.array([0.01]), **BORE, bins=10)
    assert along[0] == pytest.approx(along[-1], rel=1e-12)
    assert np.count_nonzero(along) == 2


def test_sections_cut_a_sphere_as_archimedes_says():
    along = volume_fraction_along_pipe(np.array([0.145]), np.array([0.01]), **BORE, bins=10)
    cap = np.pi * 0.005**2 * (0.01 - 0.005 / 3)  # 5 mm of it lie beyond 0.15 m
    section = np.pi * 0.01 * 0.05
    assert along[3] * section == pytest.approx(cap, rel=1e-12)
    assert along[2] * section == pytest.approx(4 / 3 * np.pi * 0.01**3 - cap, rel=1e-12)


def test_the_flux_of_solids_that_go_alike_is_their_share_times_their_speed():
    position, radius = cloud()
    share = volume_fraction_along_pipe(position[:, 0], radius, **BORE, bins=9)
    flux = solids_flux_along_pipe(position[:, 0], np.full(300, -0.7), radius, **BORE, bins=9)
    np.testing.assert_allclose(flux, -0.7 * share, rtol=1e-12)


def test_velocity_over_radius_gives_back_a_parabola():
    position, radius = cloud(50_000, 1e-4)
    away = np.hypot(*position[:, 1:].T)
    velocity = np.column_stack([2 - 100 * away**2, np.full_like(away, 9.0), np.zeros_like(away)])
    mean = velocity_over_radius(position, velocity, radius, edges=RADII)
    exact = 2 - 50 * (RADII[1:] ** 2 + RADII[:-1] ** 2)  # mean over a ring
    np.testing.assert_allclose(mean[:-1], exact[:-1], rtol=1e-2)
