"""Engineering correlations, against printed values and another library."""

import math

import fluids
import pytest
from fluids.drag import drag_sphere
from hypothesis import given
from hypothesis import strategies as st

from mpsdem.analysis.correlations import (
    durand_deposition_velocity,
    friction_factor,
    sphere_drag_coefficient,
    terminal_velocity,
    wasp_deposition_velocity,
)

GLASS_IN_WATER = {"density": 2500.0, "liquid_density": 998.2}
VISCOSITY = 1.004e-6


@pytest.mark.parametrize(
    ("millimetres", "velocity"),
    [(0.1, 0.00729), (0.5, 0.07347), (1, 0.14606), (2, 0.26764), (5, 0.47289), (15, 0.81907)],
)
def test_a_glass_bead_settles_in_water_at_its_terminal_velocity(millimetres, velocity):
    settling = terminal_velocity(
        diameter=millimetres * 1e-3, kinematic_viscosity=VISCOSITY, gravity=9.81, **GLASS_IN_WATER
    )
    assert settling == pytest.approx(velocity, abs=5.1e-6)


@given(
    diameter=st.floats(1e-6, 0.1),
    density=st.floats(100, 10_000),
    kinematic_viscosity=st.floats(1e-7, 1e-3),
)
def test_at_terminal_velocity_the_drag_carries_the_weight(diameter, density, kinematic_viscosity):
    velocity = terminal_velocity(
        diameter=diameter,
        density=density,
        liquid_density=1000.0,
        kinematic_viscosity=kinematic_viscosity,
    )
    reynolds = abs(velocity) * diameter / kinematic_viscosity
    if reynolds == 0:
        assert density == 1000.0
        return
    drag = math.pi / 8 * sphere_drag_coefficient(reynolds) * 1000.0 * velocity * abs(velocity)
    weight = math.pi / 6 * diameter * (density - 1000.0) * 9.807
    assert drag == pytest.approx(weight, rel=5e-3)


def test_a_light_sphere_rises_and_a_neutral_one_stays():
    water = {"diameter": 1e-3, "liquid_density": 1000.0, "kinematic_viscosity": 1e-6}
    assert terminal_velocity(density=1100.0, **water) > 0
    assert terminal_velocity(density=1000.0, **water) == 0
    assert terminal_velocity(density=900.0, **water) < 0


@pytest.mark.parametrize("reynolds", [1e-3, 0.1, 1, 10, 100, 500, 1000, 1e4, 1e5])
def test_a_lone_sphere_has_the_measured_drag(reynolds):
    accuracy = 0.07 if reynolds <= 1000 else 0.15
    assert sphere_drag_coefficient(reynolds) == pytest.approx(
        drag_sphere(reynolds, Method="Clift"), rel=accuracy
    )


@pytest.mark.parametrize("reynolds", [2300, 5e3, 1e5, 1e8])
@pytest.mark.parametrize("relative_roughness", [0, 1e-5, 1e-3, 0.05])
def test_the_friction_factor_solves_colebrooks_equation(reynolds, relative_roughness):
    oracle = fluids.friction.Colebrook(reynolds, relative_roughness)
    assert friction_factor(reynolds, relative_roughness) == pytest.approx(oracle, rel=1e-10)


def test_laminar_friction_is_that_of_poiseuille():
    assert friction_factor(64) == 1


def test_wasp_has_its_tabulated_deposition_velocity():
    """Glass of 5 mm, 5 % by volume, in a bore of 0.1 m."""
    velocity = wasp_deposition_velocity(
        pipe_diameter=0.1, diameter=5e-3, volume_fraction=0.05, **GLASS_IN_WATER
    )
    assert velocity == pytest.approx(1.86, abs=5e-3)


def test_durand_gives_coarse_sand_the_usual_factor():
    """F_L is near 1 for coarse sand at a few per cent; here v / sqrt(2 g D (s - 1))."""
    velocity = durand_deposition_velocity(
        pipe_diameter=0.3, diameter=2e-3, density=2650.0, liquid_density=1e3, volume_fraction=0.1
    )
    assert velocity / math.sqrt(2 * 9.807 * 0.3 * 1.65) == pytest.approx(1.0, abs=0.05)


deposition_velocities = pytest.mark.parametrize(
    "deposition_velocity", [durand_deposition_velocity, wasp_deposition_velocity]
)


@deposition_velocities
def test_heavier_coarser_and_more_solids_need_a_faster_flow(deposition_velocity):
    sand = {
        "pipe_diameter": 0.1,
        "diameter": 5e-4,
        "density": 2650.0,
        "liquid_density": 1000.0,
        "volume_fraction": 0.05,
    }
    velocity = deposition_velocity(**sand)
    for change in (
        {"density": 4000.0},
        {"diameter": 1e-3},
        {"volume_fraction": 0.1},
        {"pipe_diameter": 0.3},
        {"gravity": 20.0},
    ):
        assert deposition_velocity(**(sand | change)) > velocity
    for change in ({"density": 900.0}, {"gravity": 0.0}, {"volume_fraction": 0.0}):
        assert deposition_velocity(**(sand | change)) == 0


@deposition_velocities
@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("pipe_diameter", 0.0),
        ("diameter", -1.0),
        ("density", math.nan),
        ("liquid_density", 0.0),
        ("volume_fraction", 1.0),
    ],
)
def test_bad_input_names_the_field(deposition_velocity, field, value):
    sand = {
        "pipe_diameter": 0.1,
        "diameter": 5e-4,
        "density": 2650.0,
        "liquid_density": 1000.0,
        "volume_fraction": 0.05,
    }
    with pytest.raises(ValueError, match=f"^{field} = "):
        deposition_velocity(**(sand | {field: value}))


def test_a_friction_factor_needs_a_flow_and_a_wall_that_is_not_all_roughness():
    with pytest.raises(ValueError, match="reynolds = 0"):
        friction_factor(0)
    with pytest.raises(ValueError, match=r"relative_roughness = 0\.1"):
        friction_factor(1e5, 0.1)
