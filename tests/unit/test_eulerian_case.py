"""A case on fixed nodes: when the plan takes them, and what the results hold."""

import numpy as np
import pytest

from mpsdem import Simulation
from mpsdem.case import Case, CaseError
from mpsdem.geometry import Kind
from mpsdem.plan import make_plan

OIL = {"density": 900.0, "kinematic_viscosity": 1e-3, "bulk_velocity": 0.5}
WATER = {"density": 1000.0, "kinematic_viscosity": 1e-6, "bulk_velocity": 1.0}


def case(liquid, **parts):
    parts = {
        "pipe": {"radius": 0.1, "length": 0.4},
        "fidelity": {"level": "quick"},
        "output": {"every": 0.1, "figures": False},
        "end_time": 0.2,
    } | parts
    return Case(liquid=liquid, **parts)


def reason(plan, name):
    (found,) = [stage.reason for stage in plan.stages if stage.name == name]
    return found


def test_a_profile_that_is_known_is_not_computed():
    assert make_plan(case(WATER)).liquid_model == "profile"


def test_a_liquid_that_must_be_computed_is_computed_on_nodes_and_the_plan_says_why():
    plan = make_plan(case(WATER | {"pressure_gradient": 30.0}))
    assert plan.liquid_model == "eulerian"
    why = reason(plan, "AdvanceLiquid")
    assert "fixed nodes" in why
    assert "its pressure gradient is given" in why
    assert "straight, full, rigid and periodic" in why


@pytest.mark.parametrize("model", ["eulerian", "lagrangian"])
def test_what_is_asked_for_is_taken(model):
    plan = make_plan(case(WATER | {"model": model}))
    assert plan.liquid_model == model
    assert "were asked for" in reason(plan, "AdvanceLiquid")


def test_a_prescribed_profile_cannot_be_driven_otherwise():
    with pytest.raises(CaseError, match="drives a computed liquid only"):
        case(WATER | {"model": "profile", "pressure_gradient": 30.0})


def test_a_spacing_without_room_for_rings_is_refused():
    with pytest.raises(CaseError, match=r"particle_spacing = 0\.05.*a sixth of the bore"):
        case(WATER | {"model": "eulerian"}, fidelity={"particle_spacing": 0.05})


@pytest.mark.parametrize(("level", "warned"), [("quick", False), ("fine", True)])
def test_nodes_too_near_to_the_wall_for_its_law_are_warned_of(level, warned):
    """At Re 5000 the first ring lies at 35 wall units with 10 spacings across, at 15 with 24."""
    slow = WATER | {"bulk_velocity": 0.025, "model": "eulerian"}
    warnings = make_plan(case(slow, fidelity={"level": level})).warnings
    assert any("buffer layer" in warning for warning in warnings) == warned


@pytest.fixture(scope="module")
def laminar(tmp_path_factory):
    path = tmp_path_factory.mktemp("nodes") / "run"
    return Simulation(case(OIL | {"model": "eulerian"}), path).run(bar=False)


def test_the_results_hold_the_parabola_of_a_laminar_flow(laminar):
    liquid = laminar.liquid
    share = liquid.profile_radius / 0.1
    assert liquid.velocity_profile[-1] == pytest.approx(1.0 * (1 - share**2), abs=1e-9)
    assert laminar.pressure_gradient[-1] == pytest.approx(
        32 * 900.0 * 1e-3 * 0.5 / 0.2**2, rel=1e-9
    )
    assert laminar.diagnostics["divergence"].max() < 1e-12


def test_the_summary_says_what_it_says_of_any_computed_liquid(laminar):
    summary = laminar.summary
    assert summary["liquid_model"] == "eulerian"
    assert summary["friction_factor"] == pytest.approx(64 / 100, rel=1e-9)
    assert summary["bulk_velocity"] == pytest.approx(0.5, rel=1e-12)
    assert summary["mass_error"] < 1e-12
    assert summary["liquid_count"] > 1000


def test_recorded_nodes_stand_where_the_liquid_is(laminar):
    liquid = laminar.liquid
    away = np.hypot(*np.moveaxis(liquid.position[-1, :, 1:], -1, 0))
    assert set(np.unique(liquid.kind)) == {Kind.LIQUID, Kind.WALL}
    assert away[liquid.kind == Kind.WALL] == pytest.approx(0.1)
    inside = liquid.kind == Kind.LIQUID
    assert np.all(away[inside] < 0.1)
    assert liquid.velocity[-1, inside, 0] == pytest.approx(1 - (away[inside] / 0.1) ** 2, abs=1e-9)


def test_a_bead_of_the_liquids_density_is_carried_at_its_velocity(tmp_path):
    bead = {
        "diameter": 0.01,
        "density": 900.0,
        "youngs_modulus": 1e6,
        "poisson_ratio": 0.2,
        "friction": 0.2,
        "restitution": 0.9,
        "drag": "schiller_naumann",
        "arrangement": {
            "kind": "list",
            "positions": [[0.1, 0.0, 0.03]],
            "velocities": [[0.9, 0.0, 0.0]],
        },
    }
    scene = case(OIL | {"model": "eulerian"}, solids=bead, fidelity={"level": "balanced"})
    results = Simulation(scene, tmp_path / "run").run(bar=False)
    at_bead = results.solids.liquid_velocity[-1, 0, 0]
    assert at_bead == pytest.approx(1 - 0.3**2, abs=0.04)  # an average over the smoothing radius
    assert results.solids.velocity[-1, 0, 0] == pytest.approx(at_bead, abs=0.03)
