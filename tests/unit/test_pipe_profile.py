"""The prescribed liquid: what it carries, how it leaves the wall, what it costs in pressure."""

from itertools import pairwise

import fluids
import numpy as np
import pytest
from scipy.integrate import quad

from mpsdem._core import mps

RADIUS, VISCOSITY = 0.1, 1e-6


def profile(reynolds, *, relative_roughness=0.0, sign=1):
    return mps.PipeProfile(
        pipe_radius=RADIUS,
        bulk_velocity=sign * reynolds * VISCOSITY / (2 * RADIUS),
        kinematic_viscosity=VISCOSITY,
        roughness=relative_roughness * 2 * RADIUS,
    )


def axial(liquid, distance):
    distance = np.atleast_1d(distance).astype(float)
    zero = np.zeros_like(distance)
    return liquid.velocity(np.column_stack([zero, 0.6 * distance, 0.8 * distance]))[:, 0]


def flow_rate(liquid):
    edges = RADIUS - np.concatenate([[0], np.geomspace(1e-9, RADIUS, 40)])[::-1]
    parts = [
        quad(lambda r: 2 * np.pi * r * axial(liquid, r)[0], a, b)[0] for a, b in pairwise(edges)
    ]
    return sum(parts)


SMOOTH_AND_ROUGH = [
    (100, 0),
    (2299, 0),
    (2300, 0),
    (5e3, 0),
    (2e5, 0),
    (2e7, 0),
    (2e5, 1e-4),
    (2e5, 1e-2),
    (1e7, 0.04),
]
every_flow = pytest.mark.parametrize(("reynolds", "relative_roughness"), SMOOTH_AND_ROUGH)


@every_flow
@pytest.mark.parametrize("sign", [1, -1])
def test_the_profile_carries_the_bulk_velocity(reynolds, relative_roughness, sign):
    liquid = profile(reynolds, relative_roughness=relative_roughness, sign=sign)
    bulk_velocity = sign * reynolds * VISCOSITY / (2 * RADIUS)
    assert flow_rate(liquid) / (np.pi * RADIUS**2) == pytest.approx(bulk_velocity, rel=1e-8)
    assert liquid.reynolds == pytest.approx(reynolds)


@every_flow
def test_the_liquid_is_slowest_at_the_wall_and_fastest_on_the_axis(reynolds, relative_roughness):
    liquid = profile(reynolds, relative_roughness=relative_roughness)
    velocity = axial(liquid, RADIUS - np.concatenate([[0], np.geomspace(1e-9, RADIUS, 500)]))
    assert velocity[0] == 0
    assert np.all(np.diff(velocity) > -1e-4 * velocity[-1])
    assert np.max(velocity) < 1.001 * velocity[-1]


@pytest.mark.parametrize("reynolds", [500, 5300, 2e5, 2e6])
def test_the_slope_at_a_smooth_wall_is_the_shear_of_the_friction_factor(reynolds):
    liquid = profile(reynolds)
    bulk_velocity = reynolds * VISCOSITY / (2 * RADIUS)
    gap = 1e-3 * VISCOSITY / liquid.friction_velocity
    shear = VISCOSITY * axial(liquid, RADIUS - gap)[0] / gap  # over density [m2/s2]
    assert shear == pytest.approx(liquid.friction_factor * bulk_velocity**2 / 8, rel=0.012)


@pytest.mark.parametrize("reynolds", [2e5, 2e6])
def test_the_layer_near_a_smooth_wall_follows_the_log_law(reynolds):
    liquid = profile(reynolds)
    viscous_length = VISCOSITY / liquid.friction_velocity
    y_plus = np.geomspace(50, 0.1 * RADIUS / viscous_length, 20)
    velocity = axial(liquid, RADIUS - y_plus * viscous_length) / liquid.friction_velocity
    np.testing.assert_allclose(velocity, np.log(y_plus) / 0.41 + 5.2, rtol=0.03)


def test_the_layer_near_a_fully_rough_wall_follows_the_log_law_of_the_roughness():
    relative_roughness = 0.002
    liquid = profile(1e8, relative_roughness=relative_roughness)
    depth = np.array([3, 10, 20]) * relative_roughness * 2 * RADIUS
    velocity = axial(liquid, RADIUS - depth) / liquid.friction_velocity
    expected = np.log(depth / (relative_roughness * 2 * RADIUS)) / 0.41 + 8.5
    np.testing.assert_allclose(velocity, expected, rtol=0.05)


def test_the_core_is_as_peaked_as_in_a_direct_simulation():
    """Centre over bulk at Re 5300: 1.31, Eggels et al. 1994, doi:10.1017/S002211209400131X."""
    liquid = profile(5300)
    bulk_velocity = 5300 * VISCOSITY / (2 * RADIUS)
    assert axial(liquid, 0)[0] / bulk_velocity == pytest.approx(1.31, rel=0.02)


def test_a_rough_wall_moves_the_flow_to_the_core():
    smooth, rough = profile(2e5), profile(2e5, relative_roughness=0.01)
    assert axial(rough, 0)[0] > axial(smooth, 0)[0]
    assert axial(rough, 0.97 * RADIUS)[0] < axial(smooth, 0.97 * RADIUS)[0]


def test_a_laminar_liquid_is_twice_as_fast_on_the_axis_as_on_average():
    liquid = profile(1000)
    assert liquid.laminar
    assert axial(liquid, 0)[0] == pytest.approx(2 * 1000 * VISCOSITY / (2 * RADIUS), rel=1e-14)


def test_the_liquid_flows_along_the_pipe_alike_on_all_sides():
    points = np.array([[0, 0.05, 0], [7.0, 0, 0.05], [-3.0, -0.03, -0.04]])
    velocity = profile(2e5).velocity(points)
    assert np.all(velocity[:, 1:] == 0)
    np.testing.assert_allclose(velocity[:, 0], velocity[0, 0], rtol=1e-12)


def test_a_reversed_flow_is_the_mirror_image():
    forth, back = profile(2e5), profile(2e5, sign=-1)
    distance = np.linspace(0, RADIUS, 50)
    assert np.array_equal(axial(back, distance), -axial(forth, distance))
    assert back.friction_factor == forth.friction_factor


def test_a_liquid_at_rest_rests():
    liquid = profile(0)
    assert np.all(axial(liquid, np.linspace(0, RADIUS, 20)) == 0)
    assert liquid.friction_factor == 0
    assert liquid.friction_velocity == 0


def test_there_is_no_flow_outside_the_bore():
    assert np.all(axial(profile(2e5), [RADIUS, 1.1 * RADIUS, 1e9, np.nan]) == 0)


@pytest.mark.parametrize(
    ("reynolds", "smooth", "rough"),
    [
        (5e3, 0.03739, 0.03789),
        (1e4, 0.03088, 0.03157),
        (1e5, 0.01799, 0.02012),
        (2e5, 0.01564, 0.01856),
        (5e5, 0.01316, 0.01734),
    ],
)
def test_the_friction_factor_is_that_of_prandtl_and_of_colebrook(reynolds, smooth, rough):
    assert mps.friction_factor(reynolds) == pytest.approx(smooth, abs=1e-5)
    assert mps.friction_factor(reynolds, 4.5e-4) == pytest.approx(rough, abs=1e-5)


@pytest.mark.parametrize(
    ("reynolds", "measured"),
    [(10900, 0.03088), (18990, 0.0267), (59220, 0.02), (120e3, 0.01686), (468e3, 0.01365)],
)
def test_a_smooth_pipe_has_the_measured_friction(reynolds, measured):
    """McKeon et al. 2004, doi:10.1017/S0022112004009796, scatter included."""
    assert mps.friction_factor(reynolds) == pytest.approx(measured, rel=0.03)


@pytest.mark.parametrize("reynolds", [2300, 1e4, 1e6, 1e9])
@pytest.mark.parametrize("relative_roughness", [0, 1e-6, 1e-3, 0.05])
def test_the_friction_factor_solves_colebrooks_equation(reynolds, relative_roughness):
    oracle = fluids.friction.Colebrook(reynolds, relative_roughness)
    assert mps.friction_factor(reynolds, relative_roughness) == pytest.approx(oracle, rel=1e-12)


def test_laminar_friction_is_that_of_poiseuille():
    assert mps.friction_factor(100) == pytest.approx(0.64)
    assert mps.friction_factor(100, 0.05) == mps.friction_factor(100)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"pipe_radius": 0.0}, "pipe_radius must be > 0 m"),
        ({"bulk_velocity": np.inf}, "bulk_velocity must be finite"),
        ({"kinematic_viscosity": 0.0}, "kinematic_viscosity must be > 0 m2/s"),
        ({"roughness": -1e-6}, "roughness must be >= 0 m"),
        ({"roughness": 0.02}, "roughness must lie in"),
    ],
)
def test_bad_input_names_the_field(change, message):
    pipe = {"pipe_radius": 0.1, "bulk_velocity": 1.0, "kinematic_viscosity": 1e-6, "roughness": 0}
    with pytest.raises(ValueError, match=message):
        mps.PipeProfile(**(pipe | change))


@pytest.mark.parametrize("reynolds", [0, -1, np.nan])
def test_a_friction_factor_needs_a_flow(reynolds):
    with pytest.raises(ValueError, match="reynolds must be > 0"):
        mps.friction_factor(reynolds)
