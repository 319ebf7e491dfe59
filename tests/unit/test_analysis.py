"""Analyses of made-up solids whose answers are known without them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mpsdem.analysis import (
    extent,
    friction_velocity,
    height_edges,
    laminar_profile,
    silhouette,
    slab_area,
    slab_volume,
    turbulent_profile,
    velocity_over_height,
    volume_fraction_over_height,
)
from mpsdem.analysis.correlations import friction_factor

PIPE_RADIUS = 0.1
LENGTH = 4.0
EDGES = height_edges(PIPE_RADIUS, 20)


def spheres(*centres, radius=0.01):
    return np.array(centres, dtype=float), np.full(len(centres), radius)


@given(st.floats(-0.08, 0.08), st.floats(1e-3, 0.02), st.integers(1, 60))
def test_the_slabs_of_a_sphere_add_up_to_it(height, radius, bins):
    volume = slab_volume(np.array([height]), np.array([radius]), height_edges(PIPE_RADIUS, bins))
    assert (volume >= 0).all()
    assert volume.sum() == pytest.approx(4 / 3 * np.pi * radius**3, rel=1e-9)


def test_a_sphere_is_halved_at_its_centre():
    volume = slab_volume(np.array([0.03]), np.array([0.01]), np.array([0.0, 0.03, 1.0]))
    assert volume[0, 0] == pytest.approx(volume[0, 1], rel=1e-12)


def test_a_cap_has_its_known_volume():
    # Archimedes: the cap of height h holds pi h^2 (r - h / 3).
    volume = slab_volume(np.array([0.0]), np.array([3.0]), np.array([2.0, 5.0]))
    assert volume[0, 0] == pytest.approx(np.pi * 8 / 3, rel=1e-12)


@given(st.integers(1, 60))
def test_the_slabs_of_the_bore_add_up_to_it(bins):
    area = slab_area(PIPE_RADIUS, height_edges(PIPE_RADIUS, bins))
    assert area.sum() == pytest.approx(np.pi * PIPE_RADIUS**2, rel=1e-12)
    np.testing.assert_allclose(area, area[::-1], rtol=1e-9)


def test_the_volume_fraction_over_height_holds_all_solids():
    position, radius = spheres([0.3, 0.0, -0.083], [3.9, 0.05, 0.02])
    fraction = volume_fraction_over_height(
        position, radius, pipe_radius=PIPE_RADIUS, length=LENGTH, edges=EDGES
    )
    solid = (fraction * slab_area(PIPE_RADIUS, EDGES) * LENGTH).sum()
    assert solid == pytest.approx(2 * 4 / 3 * np.pi * 0.01**3, rel=1e-12)
    filled = (EDGES[1:] > -0.093) & (EDGES[:-1] < -0.073) | (EDGES[1:] > 0.01) & (EDGES[:-1] < 0.03)
    np.testing.assert_array_equal(fraction > 0, filled)


def test_slabs_outside_of_the_bore_have_no_volume_fraction():
    position, radius = spheres([0.3, 0.0, 0.0])
    fraction = volume_fraction_over_height(
        position, radius, pipe_radius=0.1, length=LENGTH, edges=np.array([-0.2, -0.1, 0.1, 0.2])
    )
    assert np.isnan(fraction).tolist() == [True, False, True]


def test_velocity_over_height_gives_back_a_shear():
    z = np.linspace(-0.08, 0.08, 2001)
    position = np.column_stack([np.zeros_like(z), np.zeros_like(z), z])
    velocity = np.column_stack([1 + 5 * z, np.full_like(z, 9.0), np.zeros_like(z)])
    mean = velocity_over_height(position, velocity, np.full_like(z, 0.01), edges=EDGES)
    height = (EDGES[1:] + EDGES[:-1]) / 2
    inner = np.abs(height) < 0.06
    np.testing.assert_allclose(mean[inner], 1 + 5 * height[inner], rtol=1e-3)
    assert np.isnan(mean[np.abs(height) > 0.091]).all()


def test_velocity_over_height_weighs_by_volume():
    position = np.zeros((2, 3))
    velocity = np.array([[1.0, 0, 0], [0.0, 0, 0]])
    mean = velocity_over_height(
        position, velocity, np.array([0.02, 0.01]), edges=np.array([-0.1, 0.1])
    )
    assert mean[0] == pytest.approx(8 / 9, rel=1e-12)


def test_the_silhouette_of_a_sphere_is_a_circle():
    position, radius = spheres([2.0, 0.03, -0.05], radius=0.02)
    outline = silhouette(position, radius, length=LENGTH, bins=8000)
    seen = ~np.isnan(outline.upper)
    half_height = np.sqrt(np.maximum(0.02**2 - (outline.x[seen] - 2.0) ** 2, 0))
    assert np.diff(outline.x[seen][[0, -1]])[0] == pytest.approx(0.04, abs=0.001)
    np.testing.assert_allclose(outline.upper[seen], -0.05 + half_height, atol=0.004)
    np.testing.assert_allclose(outline.upper[seen] + outline.lower[seen], -0.1, atol=1e-12)
    assert outline.upper[seen].max() == pytest.approx(-0.03, abs=1e-9)


@pytest.mark.parametrize("bins", [7, 100, 4001])
def test_no_width_of_bins_misses_a_sphere(bins):
    position, radius = spheres([2.0, 0.0, -0.05], [1.1, 0.0, 0.04])
    outline = silhouette(position, radius, length=LENGTH, bins=bins)
    assert np.nanmax(outline.upper) == pytest.approx(0.05, abs=1e-5)
    assert np.nanmin(outline.lower) == pytest.approx(-0.06, abs=1e-5)


def test_the_silhouette_goes_on_at_the_inlet_where_it_stopped_at_the_outlet():
    position, radius = spheres([3.995, 0.0, 0.0])
    outline = silhouette(position, radius, length=LENGTH, bins=400)
    seen = np.flatnonzero(~np.isnan(outline.upper))
    assert seen.tolist() == [0, 398, 399]


def test_there_is_no_silhouette_without_solids():
    outline = silhouette(np.empty((0, 3)), np.empty(0), length=LENGTH, bins=10)
    assert np.isnan(outline.lower).all()
    assert np.isnan(outline.upper).all()


def test_the_front_of_a_moving_cluster_moves_with_it():
    x = np.linspace(1.0, 2.0, 1001) + np.array([[0.0], [0.5]])
    cluster = extent(x, share=0.1)
    np.testing.assert_allclose(cluster.front, [1.9, 2.4])
    np.testing.assert_allclose(cluster.centre, [1.5, 2.0])
    np.testing.assert_allclose(cluster.tail, [1.1, 1.6])
    np.testing.assert_allclose(cluster.first, [2.0, 2.5])
    np.testing.assert_allclose(cluster.last, [1.0, 1.5])


def test_a_straggler_moves_neither_front_nor_tail():
    x = np.concatenate([np.full(98, 1.0), [0.0, 3.9]])[None]
    cluster = extent(x)
    assert cluster.front[0] == cluster.tail[0] == 1.0


R = np.linspace(0.0, PIPE_RADIUS, 20001)
VISCOSITY = 1e-6


def flow_rate(velocity):
    return np.trapezoid(velocity * 2 * np.pi * R, R)


def log_law(u_star, roughness=0.0, viscosity=VISCOSITY):
    return turbulent_profile(
        R,
        pipe_radius=PIPE_RADIUS,
        friction_velocity=u_star,
        kinematic_viscosity=viscosity,
        roughness=roughness,
    )


def test_the_friction_velocity_balances_the_pressure_loss():
    shear = 998.0 * friction_velocity(80.0, pipe_radius=PIPE_RADIUS, density=998.0) ** 2
    assert shear * 2 * np.pi * PIPE_RADIUS == pytest.approx(80.0 * np.pi * PIPE_RADIUS**2)
    assert friction_velocity(-80.0, pipe_radius=PIPE_RADIUS, density=998.0) < 0
    assert friction_velocity(0.0, pipe_radius=PIPE_RADIUS, density=998.0) == 0


def test_the_parabola_carries_the_bulk_velocity_and_sticks_to_the_wall():
    u = laminar_profile(R, pipe_radius=PIPE_RADIUS, bulk_velocity=-0.3)
    assert flow_rate(u) == pytest.approx(-0.3 * np.pi * PIPE_RADIUS**2, rel=1e-6)
    assert u[-1] == 0


@pytest.mark.parametrize(("reynolds", "roughness"), [(1e5, 0.0), (2e6, 0.0), (2e6, 2e-4)])
def test_the_log_law_carries_the_bulk_velocity_of_its_friction(reynolds, roughness):
    bulk = reynolds * VISCOSITY / (2 * PIPE_RADIUS)
    u_star = bulk * np.sqrt(friction_factor(reynolds, roughness / (2 * PIPE_RADIUS)) / 8)
    mean = flow_rate(log_law(u_star, roughness)) / (np.pi * PIPE_RADIUS**2)
    assert mean == pytest.approx(bulk, rel=0.03)


def test_at_the_wall_the_log_law_gives_way_to_viscous_shear():
    u = log_law(0.002)
    assert u[-1] == 0
    assert VISCOSITY * (u[-2] - u[-1]) / (R[-1] - R[-2]) == pytest.approx(0.002**2, rel=1e-6)
    assert (np.diff(u) < 0).all()


def test_a_wall_that_is_rough_enough_makes_viscosity_irrelevant():
    smooth, rough = (
        [log_law(0.1, roughness, viscosity)[0] for viscosity in (1e-6, 1e-7)]
        for roughness in (0.0, 5e-3)
    )
    assert smooth[1] > 1.15 * smooth[0]
    assert rough[1] == pytest.approx(rough[0], rel=2e-3)


def test_a_log_law_follows_its_flow_and_rests_with_it():
    np.testing.assert_array_equal(log_law(-0.05), -log_law(0.05))
    assert (log_law(0.0) == 0).all()
