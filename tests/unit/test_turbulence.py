"""Eddy viscosity and wall shear: what they must give a pipe."""

import numpy as np
import pytest

from mpsdem._core import mps

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
    rough = shear(2.0, 0.01, kinematic_viscosity=1e-9, roughness=1e-3)
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
