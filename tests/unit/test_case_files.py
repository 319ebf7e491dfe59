"""The case files that are shipped."""

import re
from pathlib import Path

import pytest

from mpsdem.case import load_case
from mpsdem.geometry import place_solids
from mpsdem.plan import make_plan
from mpsdem.validation import conveying

CASES = Path(__file__).parents[2] / "cases"


@pytest.mark.parametrize("path", sorted(CASES.glob("*.toml")), ids=lambda path: path.stem)
def test_a_shipped_case_can_be_read_placed_and_planned(path):
    case = load_case(path)
    assert len(place_solids(case).radius) == case.solids_count
    plan = make_plan(case)
    assert plan.stages
    assert plan.estimate.wall_seconds > 0


def test_the_horizontal_pipe_has_the_numbers_of_the_paper():
    case = load_case(CASES / "horizontal_pipe.toml")
    assert (case.pipe.radius, case.pipe.length, case.gravity) == (0.1, 4.0, 9.807)
    assert case.liquid.bulk_velocity * 2 * case.pipe.radius / case.liquid.kinematic_viscosity == (
        pytest.approx(2e5)
    )
    assert case.solids_count == 8**3
    assert (case.solids.diameter, case.solids.density) == (0.02, 2700.0)
    assert (case.solids.youngs_modulus, case.solids.poisson_ratio) == (1e8, 0.2)
    assert (case.solids.friction, case.solids.restitution) == (0.2, 0.9)
    assert case.end_time == 34.0


@pytest.mark.parametrize("name", ["paper000_horizontal", "paper000_push_plate"])
def test_the_paper_computes_the_horizontal_pipe_with_particles_at_its_own_spacing(name):
    case, scene = (load_case(CASES / f"{stem}.toml") for stem in (name, "horizontal_pipe"))
    assert (case.liquid.model, case.fidelity.particle_spacing) == ("lagrangian", 0.0075)
    assert (case.pipe.ends == "push-plate") == ("push" in name)
    differ = {"title", "liquid.model", "fidelity.particle_spacing", "pipe.ends"}
    assert {line.split(":")[0] for line in case.differences(scene)} <= differ


@pytest.mark.parametrize("name", ["horizontal_pipe", "paper000_horizontal", "paper000_push_plate"])
def test_a_case_of_the_first_paper_names_the_source_of_every_number(name):
    text = (CASES / f"{name}.toml").read_text(encoding="utf-8")
    sources = r"#.*(paper|ours)"
    unsourced = [
        line
        for before, line in zip(text.splitlines(), text.splitlines()[1:], strict=False)
        if re.match(r"\w+ = .*\d", line)
        and not line.startswith("title")
        and not re.search(sources, line)
        and not before.startswith("#")
    ]
    assert unsourced == []


def test_dry_solids_and_clear_liquid_are_cases_too():
    assert load_case(CASES / "dry_collapse.toml").liquid is None
    assert load_case(CASES / "clear_liquid.toml").solids is None


@pytest.mark.parametrize(
    ("name", "scene"),
    [("newitt_1inch", conveying.rig(2.0)), ("glass5mm_100mm", conveying.glass(3.0))],
)
def test_the_conveying_cases_are_those_that_are_validated(name, scene):
    shipped = load_case(CASES / f"{name}.toml")
    for part in ("pipe", "liquid", "solids", "end_time", "gravity"):
        assert getattr(shipped, part) == getattr(scene, part)
