"""The case: what it refuses, in which words, and how it is changed and compared."""

import math
import pickle
import subprocess
import sys

import numpy as np
import pytest

from mpsdem.case import Case, CaseError, Pipe, Solids, Uniform, load_case

SOLIDS = {
    "diameter": 0.02,
    "density": 2700.0,
    "youngs_modulus": 1e8,
    "arrangement": {"kind": "block", "counts": [2, 2, 2]},
}
WATER = {"density": 1000.0, "kinematic_viscosity": 1e-6, "bulk_velocity": 1.0}
PIPE = {"radius": 0.1, "length": 4.0}


@pytest.fixture
def case():
    return Case(end_time=10.0, pipe=PIPE, liquid=WATER, solids=SOLIDS)


def problems(case, *settings, **changes):
    """What is wrong after the changes, one string per problem."""
    with pytest.raises(CaseError) as caught:
        case.with_settings(settings).with_(**changes)
    return [str(problem) for problem in caught.value.problems]


# What is refused


@pytest.mark.parametrize(
    ("setting", "line"),
    [
        # unknown keys
        ("solids.denisty=3", "solids.denisty = 3: unknown key; did you mean 'density'?"),
        ("solid.density=3", "solid = {'density': 3}: unknown key; did you mean 'solids'?"),
        (
            "solids.arrangement.gapp=0",
            "solids.arrangement.gapp = 0: unknown key; did you mean 'gap'?",
        ),
        ("solids.wall.fricton=0", "solids.wall.fricton = 0: unknown key; did you mean 'friction'?"),
        # dimensions
        (
            "solids.diameter=5 kg",
            "solids.diameter = '5 kg': must have the dimension of m; write for example '1 m'",
        ),
        (
            "liquid.kinematic_viscosity='1 mPa s'",
            "liquid.kinematic_viscosity = '1 mPa s': must have the dimension of m2/s; "
            "write for example '1 m2/s'",
        ),
        # signs and zeros
        ("pipe.radius=0", "pipe.radius = 0: must be > 0 m"),
        ("pipe.radius=-10 cm", "pipe.radius = '-10 cm': must be > 0 m"),
        ("pipe.length=0", "pipe.length = 0: must be > 0 m"),
        ("pipe.roughness=-1e-5", "pipe.roughness = -1e-05: must be >= 0 m"),
        ("liquid.density=-5", "liquid.density = -5: must be > 0 kg/m3"),
        ("liquid.density=0", "liquid.density = 0: must be > 0 kg/m3"),
        ("liquid.kinematic_viscosity=0", "liquid.kinematic_viscosity = 0: must be > 0 m2/s"),
        ("liquid.kinematic_viscosity=-1", "liquid.kinematic_viscosity = -1: must be > 0 m2/s"),
        ("solids.density=-5", "solids.density = -5: must be > 0 kg/m3"),
        ("solids.density=0", "solids.density = 0: must be > 0 kg/m3"),
        ("solids.diameter=0", "solids.diameter = 0: must be > 0 m"),
        ("solids.youngs_modulus=0", "solids.youngs_modulus = 0: must be > 0 Pa"),
        ("solids.youngs_modulus=-1e8", "solids.youngs_modulus = -100000000.0: must be > 0 Pa"),
        ("solids.wall.youngs_modulus=0", "solids.wall.youngs_modulus = 0: must be > 0 Pa"),
        ("end_time=0", "end_time = 0: must be > 0 s"),
        ("gravity=-9.807", "gravity = -9.807: must be >= 0 m/s2"),
        # ranges
        ("pipe.inclination=91 deg", "pipe.inclination = '91 deg': must be >= -1.5708 and "),
        ("solids.restitution=0", "solids.restitution = 0: must be > 0 and <= 1"),
        ("solids.restitution=1.01", "solids.restitution = 1.01: must be > 0 and <= 1"),
        ("solids.poisson_ratio=0.51", "solids.poisson_ratio = 0.51: must be > -1 and <= 0.5"),
        ("solids.poisson_ratio=-1", "solids.poisson_ratio = -1: must be > -1 and <= 0.5"),
        ("solids.friction=-0.1", "solids.friction = -0.1: must be >= 0"),
        ("solids.wall.restitution=2", "solids.wall.restitution = 2: must be > 0 and <= 1"),
        ("fidelity.rayleigh_fraction=0.6", "fidelity.rayleigh_fraction = 0.6: must be > 0 and "),
        ("fidelity.stiffness_factor=2", "fidelity.stiffness_factor = 2: must be > 0 and <= 1"),
        ("pipe.roughness=0.011", "pipe.roughness = 0.011: must be <= 0.01 m, a twentieth of the "),
        # choices
        (
            "solids.contact=hertz",
            "solids.contact = 'hertz': must be 'hertz_mindlin', 'linear_spring' or ",
        ),
        (
            "solids.arrangement.kind=blok",
            "solids.arrangement.kind = 'blok': must be one of 'block', 'random', 'list'",
        ),
        (
            "liquid.model=spectral",
            "liquid.model = 'spectral': must be 'auto', 'profile', 'eulerian' or 'lagrangian'",
        ),
        ("pipe.ends=open", "pipe.ends = 'open': must be 'periodic' or 'push-plate'"),
        ("liquid=3", "liquid = 3: must be a table of keys"),
        ("output.figures=1", "output.figures = 1: must be a valid boolean"),
        # zero solids
        (
            "solids.arrangement.counts=[0, 7, 7]",
            "solids.arrangement.counts[0] = 0: must be >= 1; leave out [solids] for clear liquid",
        ),
        ("solids.arrangement.count=0", "solids.arrangement.count = 0: must be >= 1; leave out "),
        ("solids.arrangement.count=9", "solids.arrangement.count = 9: must be <= 8, the product "),
        # across keys
        (
            "solids.count=5",
            "solids.count = 5: has no meaning for a block; "
            "leave it out; the arrangement says how many solids there are",
        ),
        (
            "solids.normal_stiffness=1 kN/m",
            "solids.normal_stiffness = 1000.0: has no meaning for contact = 'hertz_mindlin'; ",
        ),
        # across parts
        (
            "solids.diameter=0.2",
            "solids.diameter = 0.2: must be < 0.2 m, the bore of the pipe",
        ),
        ("pipe.length=0.03", "pipe.length = 0.03: must be >= 0.04 m, two of the largest "),
        (
            "solids.arrangement.counts=[100, 100, 100]",
            "solids.arrangement: 1000000 solids do not fit: ",
        ),
        ("output.every=11", "output.every = 11.0: must be <= 10.0 s, the end_time"),
        ("output.times=[1, 11]", "output.times[1] = 11.0: must be <= 10.0 s, the end_time"),
    ],
)
def test_a_bad_value_is_refused_by_its_key_with_value_rule_and_unit(case, setting, line):
    (found,) = problems(case, setting)
    assert found.startswith(line)


RANDOM = {**SOLIDS, "arrangement": {"kind": "random"}}


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"count": 0}, "solids.count = 0: must be >= 1; leave out [solids] for clear liquid"),
        (
            {"volume_fraction": 0.0},
            "solids.volume_fraction = 0.0: must be > 0 and < 1; "
            "leave out [solids] for clear liquid",
        ),
        ({"volume_fraction": 1e-9}, "solids.volume_fraction = 1e-09: is less than one solid of "),
        (
            {"volume_fraction": 0.7},
            "solids.volume_fraction = 0.7: 21000 solids do not fit: ",
        ),
        ({"count": 20000}, "solids.count = 20000: 20000 solids do not fit: "),
        (
            {"count": 2000, "arrangement": {"kind": "random", "end": 0.1}},
            "solids.count = 2000: 2000 solids do not fit: ",
        ),
        (
            {"count": 2, "arrangement": {"kind": "random", "end": 0.001}},
            "solids.arrangement.end = 0.001: must leave 0.02 m after the start",
        ),
        (
            {"count": 2, "arrangement": {"kind": "random", "start": 0.5, "end": 0.4}},
            "solids.arrangement.end = 0.4: must be > 0.5, the start",
        ),
        ({}, "solids.count: a random arrangement takes either count or volume_fraction; give one"),
        (
            {"count": 5, "volume_fraction": 0.1},
            "solids.count = 5: a random arrangement takes either count or volume_fraction; "
            "leave out one",
        ),
        (
            {"count": 5, "diameter": {"kind": "uniform", "smallest": 0.02, "largest": 0.01}},
            "solids.diameter.largest = 0.01: must be >= 0.02, the smallest",
        ),
        (
            {"count": 5, "diameter": {"kind": "uniform", "smallest": 0.02, "largest": 0.3}},
            "solids.diameter = 0.3: must be < 0.2 m, the bore of the pipe",
        ),
        (
            {"count": 5, "diameter": {"kind": "sieve", "diameters": [0.01], "fractions": [0.9]}},
            "solids.diameter.fractions = (0.9,): must add up to 1, not 0.9",
        ),
        (
            {"count": 5, "diameter": {"kind": "sieve", "diameters": [0.01], "fractions": []}},
            "solids.diameter.fractions = (): must have one entry per diameter",
        ),
        (
            {
                "count": 5,
                "diameter": {
                    "kind": "lognormal",
                    "median": 0.01,
                    "deviation": 0.3,
                    "smallest": 0.02,
                    "largest": 0.03,
                },
            },
            "solids.diameter.median = 0.01: must lie between smallest and largest",
        ),
    ],
)
def test_random_solids_that_cannot_be_are_refused(case, changes, line):
    (found,) = problems(case.with_(solids=None), solids=RANDOM | changes)
    assert found.startswith(line)


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"positions": []}, "solids.arrangement.positions: must name at least one solid"),
        (
            {"velocities": [[1, 0, 0]]},
            "solids.arrangement.velocities = ((1.0, 0.0, 0.0),): must have 2 entries",
        ),
        ({"positions": [[0, 0, 0], [4, 0, 0]]}, "solids.arrangement.positions[1] = 4.0: x must "),
        ({"positions": [[0, 0, 0], [1, 0]]}, "solids.arrangement.positions[1][2]: is required"),
        ({"diameters": [0.01, 0.3]}, "solids.arrangement.diameters = 0.3: must be < 0.2 m"),
    ],
)
def test_listed_solids_that_cannot_be_are_refused(case, changes, line):
    listed = {"kind": "list", "positions": [[1, 0, 0], [2, 0, 0]]} | changes
    assert problems(case, solids={"arrangement": listed})[0].startswith(line)


def test_a_number_that_is_not_one_is_refused_in_every_key():
    """Every float of a case in which nothing is left to a default."""
    listed = {
        "positions": [[1, 0, 0]],
        "velocities": [[0, 0, 0]],
        "spins": [[0, 0, 0]],
        "diameters": [0.01],
    }
    sizes = [
        {"kind": "uniform", "smallest": 0.01, "largest": 0.02},
        {
            "kind": "lognormal",
            "median": 0.01,
            "deviation": 0.1,
            "smallest": 0.01,
            "largest": 0.02,
        },
        {"kind": "sieve", "diameters": [0.01], "fractions": [1.0]},
    ]
    arrangements = [{"kind": "list", **listed}, SOLIDS["arrangement"], {"kind": "random"}]
    wall = dict.fromkeys(
        ("youngs_modulus", "poisson_ratio", "restitution", "friction", "rolling_friction"), 0.3
    )
    spring = dict.fromkeys(
        (
            "normal_stiffness",
            "tangential_stiffness",
            "normal_damping",
            "tangential_damping",
            "impact_speed",
        ),
        1.0,
    )
    numerics = {
        "rayleigh_fraction": 0.1,
        "solid_step": 1e-5,
        "coupling_step": 1e-3,
        "smoothing_radius": 0.05,
    }
    keys = set()
    for size, arrangement in zip(sizes, arrangements, strict=True):
        number = {"volume_fraction": 0.1} if arrangement["kind"] == "random" else {}
        full = Case(
            end_time=1,
            pipe=PIPE,
            liquid=WATER,
            solids=SOLIDS
            | {"contact": "linear_spring", "wall": wall, "diameter": size}
            | {"arrangement": arrangement}
            | number
            | spring,
            fidelity=numerics,
            output={"times": [0.5], "checkpoint_every": 1},
        ).model_dump()
        for path, value in leaves(full):
            if isinstance(value, float):
                keys.add(path)
                with pytest.raises(CaseError, match="must be finite") as caught:
                    Case(**replaced(full, path, math.nan))
                dotted = "".join(f"[{k}]" if isinstance(k, int) else f".{k}" for k in path)
                assert caught.value.problems[0].field == dotted[1:]
    assert len(keys) > 45


def leaves(value, path=()):
    items = value.items() if isinstance(value, dict) else enumerate(value)
    for key, entry in items:
        if isinstance(entry, dict | tuple):
            yield from leaves(entry, (*path, key))
        else:
            yield (*path, key), entry


def replaced(value, path, new):
    if not path:
        return new
    changed = dict(value) if isinstance(value, dict) else list(value)
    changed[path[0]] = replaced(value[path[0]], path[1:], new)
    return changed


def test_all_problems_of_a_case_are_reported_together(case):
    found = problems(case, "solids.density=-5", "pipe.radius=5 kg", "end_time=0", "liqid.density=1")
    assert [line.split(" = ")[0] for line in found] == [
        "end_time",
        "pipe.radius",
        "solids.density",
        "liqid",
    ]


def test_a_missing_key_is_named_with_its_unit():
    with pytest.raises(CaseError, match=r"^pipe.length: is required, in m$"):
        Case(end_time=1, pipe={"radius": 0.1}, liquid=WATER)


def test_a_case_with_neither_liquid_nor_solids_is_refused():
    with pytest.raises(CaseError, match=r"needs \[liquid\], \[solids\] or both"):
        Case(end_time=1, pipe=PIPE)


def test_a_part_built_in_python_is_refused_like_one_in_a_file():
    with pytest.raises(CaseError, match="radius = -1: must be > 0 m"):
        Pipe(radius=-1, length=1)


def test_a_problem_carries_field_value_rule_unit_and_remedy(case):
    with pytest.raises(CaseError) as caught:
        case.with_settings(["solids.arrangement.count=0"])
    (problem,) = caught.value.problems
    assert problem.field == "solids.arrangement.count"
    assert problem.value == 0
    assert problem.rule == "must be >= 1"
    assert problem.remedy == "leave out [solids] for clear liquid"
    assert pickle.loads(pickle.dumps(caught.value)).problems == (problem,)


# How it is changed and compared


def test_a_case_is_frozen_and_hashable(case):
    with pytest.raises(ValueError, match="frozen"):
        case.end_time = 2.0
    with pytest.raises(ValueError, match="frozen"):
        case.pipe.radius = 2.0
    assert len({case, case.with_(end_time=10.0), case.with_(end_time=2.0)}) == 2


def test_a_change_keeps_all_the_rest(case):
    changed = case.with_(solids={"wall": {"friction": 0.4}}, end_time=2.0)
    assert changed.end_time == 2.0
    assert changed.solids.wall.friction == 0.4
    assert changed.with_(end_time=10.0, solids={"wall": {"friction": None}}) == case


def test_another_kind_of_arrangement_keeps_no_key_of_the_former(case):
    changed = case.with_(solids={"arrangement": {"kind": "random"}, "count": 5})
    assert changed.solids.arrangement.kind == "random"
    assert changed.with_(solids={"count": None, "arrangement": case.solids.arrangement}) == case


def test_a_part_is_taken_out_by_none(case):
    assert case.with_(liquid=None).liquid is None
    assert case.with_(solids=None).solids_count == 0


def test_settings_are_toml_or_else_strings(case):
    changed = case.with_settings(
        [
            "solids.diameter=10 mm",
            "solids.density = 2500",
            "solids.relax=true",
            "title=A = B",
            'solids.arrangement={kind = "block", counts = [1, 1, 2]}',
            "solids.arrangement.at=0.25",
        ]
    )
    assert changed.solids.diameter == pytest.approx(0.01)
    assert changed.solids.density == 2500.0
    assert changed.solids.relax is True
    assert changed.title == "A = B"
    assert changed.solids.arrangement.counts == (1, 1, 2)
    assert changed.solids.arrangement.at == 0.25


@pytest.mark.parametrize("setting", ["solids.density", "=3", ""])
def test_a_setting_without_key_or_value_is_refused(case, setting):
    with pytest.raises(CaseError, match="must have the form key=value"):
        case.with_settings([setting])


def test_differences_name_the_keys_and_both_values(case):
    other = case.with_(solids={"density": 2500.0}, liquid=None)
    assert case.differences(case) == []
    assert case.differences(other) == [
        "liquid.model: 'auto' != not given",
        "liquid.density: 1000.0 != not given",
        "liquid.kinematic_viscosity: 1e-06 != not given",
        "liquid.bulk_velocity: 1.0 != not given",
        "solids.density: 2700.0 != 2500.0",
    ]


def test_the_wall_differs_from_the_solids_only_where_it_says_so():
    solids = Solids(**SOLIDS, friction=0.3, wall={"restitution": 0.5})
    assert solids.at_wall.restitution == 0.5
    assert solids.at_wall.friction == 0.3
    assert solids.at_wall.youngs_modulus == 1e8
    assert solids.restitution == 0.9


def test_a_volume_fraction_is_met_by_the_count(case):
    changed = case.with_(
        solids=RANDOM | {"volume_fraction": 0.1, "arrangement": {"kind": "random"}}
    )
    # 0.1 * pi * 0.1^2 * 4 over pi / 6 * 0.02^3
    assert changed.solids_count == 3000
    assert changed.solids_fraction == pytest.approx(0.1)


def test_arrays_are_taken_where_lists_are(case):
    positions = np.array([[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    listed = case.with_(solids={"arrangement": {"kind": "list", "positions": positions}})
    assert listed.solids_count == 2
    assert listed.solids.arrangement.positions[1] == (2.0, 0.0, 0.0)


def test_a_distribution_is_taken_as_a_part_too(case):
    sizes = Uniform(smallest=0.01, largest=0.02)
    changed = case.with_(solids={"diameter": sizes})
    assert changed.solids.diameter == sizes
    assert (changed.solids.smallest_diameter, changed.solids.largest_diameter) == (0.01, 0.02)


@pytest.mark.parametrize(("level", "fraction"), [("quick", 0.3), ("balanced", 0.1), ("fine", 0.05)])
def test_a_level_sets_the_step_unless_it_is_given(case, level, fraction):
    leveled = case.with_(fidelity={"level": level})
    assert leveled.fidelity.resolved_rayleigh_fraction == fraction
    given = leveled.with_(fidelity={"rayleigh_fraction": 0.4})
    assert given.fidelity.resolved_rayleigh_fraction == 0.4


# Files


def test_a_file_is_found_under_any_name_and_its_errors_name_it(case, tmp_path):
    path = tmp_path / "Fälle und Rohre" / "Knöllchen 海.toml"
    path.parent.mkdir()
    path.write_text(case.to_toml(), encoding="utf-8")
    assert load_case(path) == case
    path.write_text(case.to_toml().replace("end_time = 10.0", "end_time = 0"), encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_case(str(path))
    assert str(caught.value) == f"{path}:\nend_time = 0: must be > 0 s"


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (None, "cannot be read: No such file or directory"),
        (b"\xff\xfe", "is not a text file in UTF-8"),
        (b"end_time = \n", r"not valid TOML: .*line 1"),
    ],
)
def test_a_file_that_cannot_be_read_is_refused_with_the_reason(tmp_path, content, reason):
    path = tmp_path / "case.toml"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(CaseError, match=reason):
        load_case(path)


def test_the_case_imports_nothing_of_the_rest_and_nothing_compiled():
    program = """
import sys
import mpsdem.case
inside = ("mpsdem", "mpsdem.case")
print([m for m in sys.modules if m.startswith("mpsdem") and m not in inside
       and not m.startswith("mpsdem.case.")])
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[]"
