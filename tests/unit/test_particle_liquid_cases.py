"""The particle liquid as a case asks for it: which model, which solver, and what is refused."""

import numpy as np
import pytest

from mpsdem import Simulation
from mpsdem._core import cholmod
from mpsdem.case import Case, CaseError
from mpsdem.plan import make_plan, turbulence

WATER = {"model": "lagrangian", "density": 1000.0, "kinematic_viscosity": 1e-6}


def case(*, fidelity=None, liquid=None, length=0.4, end_time=0.05):
    """Clear liquid in a short pipe of 0.1 m, at a Reynolds number of 1e5."""
    return Case(
        end_time=end_time,
        pipe={"radius": 0.05, "length": length},
        liquid=WATER | {"bulk_velocity": 1.0} | (liquid or {}),
        fidelity={"level": "quick"} | (fidelity or {}),
        output={"every": end_time, "figures": False},
    )


def reason_of(case, stage):
    return next(planned.reason for planned in make_plan(case).stages if planned.name == stage)


@pytest.mark.parametrize(
    ("fidelity", "viscosity", "said"),
    [
        ({}, 1e-6, "mixing length and log-law wall function, as the flow is turbulent"),
        ({"turbulence": "mixing_length"}, 1e-6, "mixing length and log-law wall function, as was"),
        ({"turbulence": "smagorinsky"}, 1e-6, "smagorinsky and log-law wall function, as was"),
        ({}, 1e-3, "laminar, no-slip walls"),
    ],
)
def test_the_plan_says_how_the_liquid_flows_and_why(fidelity, viscosity, said):
    chosen = case(fidelity=fidelity, liquid={"kinematic_viscosity": viscosity})
    assert said in reason_of(chosen, "AdvanceLiquid")


def test_smagorinsky_comes_with_a_warning_of_its_friction():
    (warning,) = make_plan(case(fidelity={"turbulence": "smagorinsky"})).warnings
    assert "friction comes out too low" in warning
    assert make_plan(case()).warnings == ()


@pytest.mark.parametrize(("reynolds", "warnings"), [(100, 0), (1000, 1)])
def test_laminar_flow_that_keeps_its_disturbances_comes_with_a_warning(reynolds, warnings):
    plan = make_plan(case(liquid={"kinematic_viscosity": 0.1 / reynolds}))
    assert len(plan.warnings) == warnings
    assert all("do not damp a swirl" in warning for warning in plan.warnings)


def test_an_eddy_viscosity_in_laminar_flow_is_refused():
    laminar = case(fidelity={"turbulence": "smagorinsky"}, liquid={"kinematic_viscosity": 1e-3})
    with pytest.raises(CaseError, match=r"fidelity.turbulence = 'smagorinsky': needs turbulent"):
        turbulence(laminar)


@pytest.mark.parametrize(
    "change",
    [
        {"pressure_solver": "jacobi"},
        {"pressure_solver": "cholmod", "particle_spacing": 0.02},
        {"layout": "lattice"},
        {"turbulence": "smagorinsky"},
        {"courant": 2.0},
        {"particle_spacing": 0.025},
        {"pressure_tolerance": 1e-12},
        {"pressure_tolerance": 0.5},
    ],
)
def test_every_choice_of_the_method_runs_and_keeps_its_mass(change, tmp_path):
    if change.get("pressure_solver") == "cholmod" and not cholmod:
        pytest.skip("built without CHOLMOD")
    summary = Simulation(case(fidelity=change), output=tmp_path).run().summary
    assert summary["status"] == "finished"
    assert summary["bulk_velocity"] == pytest.approx(1.0, rel=1e-6)
    assert summary["mass_error"] == 0


@pytest.mark.parametrize(
    "liquid",
    [
        {"kinematic_viscosity": 1e-9},
        {"bulk_velocity": 0.0},
        {"bulk_velocity": -1.0},
        {"kinematic_viscosity": 1e-2},
    ],
)
def test_extreme_liquids_are_survived(liquid, tmp_path):
    extreme = case(liquid=liquid, end_time=0.01)
    summary = Simulation(extreme, output=tmp_path).run().summary
    assert summary["status"] == "finished"
    assert summary["bulk_velocity"] == pytest.approx(liquid.get("bulk_velocity", 1.0), abs=1e-6)


@pytest.mark.parametrize(
    ("fidelity", "length", "said"),
    [
        ({"courant": 5.0}, 0.4, "courant = 5.0: must be > 0 and <= 2"),
        ({"particle_spacing": 0.1}, 0.4, "fidelity.particle_spacing = 0.1: must be <= 0.025 m"),
        ({}, 0.04, "pipe.length = 0.04: must be >= 0.05 m, five particle spacings"),
    ],
)
def test_what_the_method_cannot_bear_is_refused_with_its_limit(fidelity, length, said):
    with pytest.raises(CaseError) as refusal:
        case(fidelity=fidelity, length=length)
    assert said in str(refusal.value)


def test_the_step_may_be_shortened_and_the_plan_names_what_binds_it():
    free, given = make_plan(case()), make_plan(case(fidelity={"liquid_step": 1e-3}))
    assert "of the liquid's time to cross a spacing" in free.liquid_step.binding.name
    assert given.liquid_step.binding.name == "fidelity.liquid_step, as given"
    assert given.liquid_step.value <= 1e-3 < free.liquid_step.value


def test_a_uniform_acceleration_of_the_full_pipe_moves_nothing(tmp_path):
    """Gravity in any direction is split off the pressure: to the last bit."""
    level = case(end_time=0.1)
    runs = {
        "level": level,
        "steep": level.with_(pipe={"inclination": 0.9}),
        "without": level.with_(gravity=0.0),
    }
    found = {name: Simulation(of, output=tmp_path / name).run() for name, of in runs.items()}
    for name in ("steep", "without"):
        for field in ("position", "velocity", "pressure"):
            here, there = (getattr(found[k].liquid, field) for k in ("level", name))
            np.testing.assert_array_equal(here, there)


def test_the_liquid_starts_at_the_bulk_velocity(tmp_path):
    results = Simulation(case(), output=tmp_path).run()
    assert results.diagnostics["bulk_velocity"][0] == pytest.approx(1.0, rel=1e-12)


def test_the_momentum_that_nothing_explains_is_reported_beside_friction(tmp_path):
    results = Simulation(case(end_time=0.5), output=tmp_path).run()
    friction = results.diagnostics["pressure_gradient_friction"][-1]
    held = results.diagnostics["pressure_gradient"][-1]
    unexplained = results.diagnostics["liquid_unexplained"][-1]
    gained = 1000.0 * np.diff(results.diagnostics["bulk_velocity"])[-1] / 0.5
    assert friction > 0
    assert gained == pytest.approx(held + unexplained - friction, abs=1e-6 * friction)
    assert results.summary["momentum_error"] == pytest.approx(abs(unexplained) / friction, abs=1e-6)
