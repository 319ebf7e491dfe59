"""The statements of the papers: what holds, and what the page says of it."""

import math
from pathlib import Path

import numpy as np
import pytest
from synthetic_results import cluster, write_run

from mpsdem.results import Results, ResultsError
from mpsdem.validation.reproduction.__main__ import filled
from mpsdem.validation.reproduction.figures import of_horizontal
from mpsdem.validation.reproduction.horizontal import (
    HORIZONTAL,
    arch,
    length,
    rear_middle_front,
    upper_less_lower,
    upper_less_lower_of_sections,
)
from mpsdem.validation.reproduction.inclined import (
    INCLINED,
    at_wall,
    fastest_away,
    gathering,
    lowest_below_largest,
    reach,
    rms_upwards,
    sliding_back,
)
from mpsdem.validation.reproduction.measured import Measured
from mpsdem.validation.reproduction.page import number
from mpsdem.validation.reproduction.reasons import REASONS, VARIANTS
from mpsdem.validation.reproduction.runs import FINEST, LEVELS, cases, scenes
from mpsdem.validation.reproduction.scene import Instant, Scene
from mpsdem.validation.reproduction.statement import Statement

ROOT = Path(__file__).parents[2]
ALL = (*HORIZONTAL, *INCLINED, *REASONS)
PAGE = (ROOT / "docs" / "reproduction.md").read_text("utf-8")


def statement(**bounds):
    return Statement(
        id="x",
        claim="x",
        number="x",
        measure=lambda _: Measured(mean=0, error=0),
        scenes=(),
        **bounds,
    )


@pytest.mark.parametrize(
    ("mean", "error", "verdict"),
    [
        (1.0, 0.1, "yes"),
        (-1.0, 0.1, "no"),
        (0.1, 0.1, "open"),
        (-0.1, 0.1, "open"),
        (1.0, math.nan, "yes"),
        (-1.0, math.nan, "no"),
        (math.nan, math.nan, "no"),
    ],
)
def test_a_statement_holds_only_beyond_two_errors_of_its_bound(mean, error, verdict):
    measured = Measured(mean=mean, error=error)
    assert statement(at_least=0.0).verdict(measured) == verdict


def test_errors_of_differences_and_ratios_add_in_squares():
    a, b = Measured(mean=3.0, error=0.3), Measured(mean=2.0, error=0.4)
    assert (a - b).error == pytest.approx(0.5)
    assert (a / b).mean == 1.5
    assert (a / b).error == pytest.approx(1.5 * math.hypot(0.1, 0.2))


def instant(**fields):
    count = len(next(iter(fields.values())))
    nothing = dict.fromkeys(("along", "height", "away", "outwards", "liquid"), np.zeros(count))
    solids = {"velocity": np.zeros((count, 3)), "radius": np.full(count, 0.01)}
    return Instant(**{**nothing, **solids, "pipe_radius": 0.1, "length": 4.0, **fields})


def test_rear_middle_and_front_are_tenths_of_the_solids_in_their_order():
    along = np.random.default_rng(1).permutation(100.0 * np.arange(100))
    rear, middle, front = (set(along[part]) for part in rear_middle_front(instant(along=along)))
    assert rear == set(100.0 * np.arange(10))
    assert middle == set(100.0 * np.arange(45, 55))
    assert front == set(100.0 * np.arange(90, 100))


def test_the_page_has_a_row_for_every_statement():
    for said in ALL:
        assert f"| {said.claim} | {said.number} |" in PAGE
    assert len({said.id for said in ALL}) == len(ALL)


def test_a_table_replaces_the_one_between_its_marks():
    text = "a\n<!-- table A -->\nold\n<!-- end A -->\nb"
    assert filled(text, {"A": "new\n"}) == "a\n<!-- table A -->\nnew\n<!-- end A -->\nb"


def test_a_number_shows_two_digits_of_its_error():
    assert number(Measured(mean=0.48791, error=0.0058)) == "0.4879 +- 0.0058"


@pytest.fixture(scope="module")
def made_up(tmp_path_factory):
    """A scene of 64 solids: layer k and row i move at 0.4 + 0.1 k + 0.02 i m/s."""
    with Results(write_run(tmp_path_factory.mktemp("cluster"))) as results:
        yield {"horizontal_pipe": Scene(results)}


@pytest.mark.parametrize(
    ("name", "value", "verdict"),
    [
        ("A/upper-5", 0.2, "yes"),
        ("A/front-5", (4 * 0.76 + 2 * 0.74 - 4 * 0.4 - 2 * 0.42) / 6, "yes"),
        ("A/upper-late", math.nan, "no"),
        ("A/collapse", 1.0, "no"),
        ("A/comes-back", 3.0, "yes"),
        ("A/upper-near-1", 0.68, "no"),
        ("A/lower-near-half", 0.48, "yes"),
    ],
)
def test_a_made_up_cluster_is_measured_as_it_was_made(made_up, name, value, verdict):
    said = next(said for said in HORIZONTAL if said.id == name)
    measured = said.measure(made_up)
    assert measured.mean == pytest.approx(value, abs=1e-9, nan_ok=True)
    assert said.verdict(measured) == verdict


def test_a_cluster_that_is_partly_through_the_outlet_is_not_torn_apart(made_up):
    low, high = np.quantile(cluster(4.0)[0][:, 0], [0.05, 0.95])
    assert low < 4 < high
    assert made_up["horizontal_pipe"].at(4.0, length).mean == pytest.approx(high - low)


def test_starts_that_agree_leave_no_error_and_a_single_one_tells_none(made_up):
    run = made_up["horizontal_pipe"].starts[0]
    assert math.isnan(Scene(run).at(2.0, gathering).error)
    assert Scene(run, run).at(2.0, gathering).error == 0


def test_a_fast_low_front_does_not_hide_that_the_top_of_each_section_is_faster():
    low, high = np.tile([0.01, 0.05], 8), np.full(8, 0.005)  # two layers, and a front
    velocity = np.zeros((24, 3))
    velocity[:, 0] = np.concatenate([np.tile([0.4, 0.43], 8), np.full(8, 0.9)])
    at = instant(
        along=np.repeat([0.05, 2.05], [16, 8]),
        height=np.concatenate([low, high]),
        velocity=velocity,
    )
    assert upper_less_lower(at) < 0
    assert upper_less_lower_of_sections(at) == pytest.approx(0.03 * 16 / 24)


def test_an_outline_with_a_hump_arches_and_one_with_a_trough_does_not():
    along, hump = np.arange(100.0), np.full(100, 0.02)
    hump[45:55] = 0.05
    assert arch(instant(along=along, height=hump)) == pytest.approx(0.03)
    hump[95:] = 0.06
    assert arch(instant(along=along, height=hump)) == pytest.approx(-0.01)


def test_where_solids_of_an_inclined_pipe_are_and_which_way_they_go():
    velocity = np.zeros((100, 3))
    velocity[:, 0] = -0.2
    velocity[:10] = 0.5, 0.0, 0.3
    away = np.full(100, 0.09)  # they touch the wall
    away[:10] = 0.02
    at = instant(away=away, height=0.1 - away, velocity=velocity)
    assert sliding_back(at) == 0.9
    assert at_wall(at) == 0.9
    assert fastest_away(at) == pytest.approx(0.2)
    assert reach(at) == pytest.approx(0.09)
    assert rms_upwards(at) == pytest.approx(0.3 * 0.1**0.5)


def test_solids_gather_as_many_times_as_the_section_is_fuller():
    even = np.arange(40) * 0.1 + 0.05
    assert gathering(instant(along=even)) == pytest.approx(1)
    assert gathering(instant(along=np.append(even, [0.01, 0.02, 4.03]))) == pytest.approx(160 / 43)


def test_a_cluster_off_the_bottom_leaves_the_lowest_layer_empty(made_up):
    assert lowest_below_largest(made_up["horizontal_pipe"]).mean == 1


def test_the_curves_show_every_spacing_that_was_run(made_up):
    parts, loss = of_horizontal({"quick": made_up, "balanced": made_up, "finest": {}}).axes
    assert len(parts.get_lines()) == 2 * 4
    assert len(loss.get_lines()) == 2


def test_every_variant_differs_from_its_case_in_what_its_name_says():
    found = cases("quick", ROOT / "cases")
    for name, (of, _) in VARIANTS.items():
        changed = {
            line.split(":")[0] for line in found[f"{of}_quick"].differences(found[f"{name}_quick"])
        }
        changed -= {key for key in changed if key.startswith(("end_time", "output"))}
        assert len({key.split(".")[0] for key in changed}) == 1


def test_a_run_of_another_case_is_refused_and_a_missing_one_left_out(tmp_path):
    assert scenes(FINEST, tmp_path, ROOT / "cases", make=False) == {}
    write_run(tmp_path / f"horizontal_pipe_{FINEST}")
    with pytest.raises(ResultsError, match=r"holds another case[\s\S]*solids"):
        scenes(FINEST, tmp_path, ROOT / "cases", make=False)


@pytest.mark.parametrize("level", LEVELS)
def test_the_runs_of_the_page_are_those_of_the_shipped_cases(level):
    found = cases(level, ROOT / "cases")
    assert {case.fidelity.level for case in found.values()} == {LEVELS[level]["level"]}
    assert f"horizontal_pipe_{level}" in found
    assert level == FINEST or f"paper001_case3_{level}" in found
