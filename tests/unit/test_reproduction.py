"""The statements of the papers: what holds, and what the page says of it."""

import math
from pathlib import Path

import numpy as np
import pytest

from mpsdem.validation.reproduction.__main__ import filled
from mpsdem.validation.reproduction.horizontal import HORIZONTAL, rear_middle_front
from mpsdem.validation.reproduction.inclined import INCLINED
from mpsdem.validation.reproduction.measured import Measured
from mpsdem.validation.reproduction.page import number
from mpsdem.validation.reproduction.runs import LEVELS, cases
from mpsdem.validation.reproduction.scene import Instant
from mpsdem.validation.reproduction.statement import Statement

ROOT = Path(__file__).parents[2]
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


def test_rear_middle_and_front_are_tenths_of_the_solids_in_their_order():
    along = np.random.default_rng(1).permutation(100.0 * np.arange(100))
    nothing = np.zeros(100)
    instant = Instant(
        along=along,
        height=nothing,
        away=nothing,
        outwards=nothing,
        velocity=np.zeros((100, 3)),
        liquid=nothing,
        radius=nothing,
        pipe_radius=0.1,
        length=4.0,
    )
    rear, middle, front = (set(along[part]) for part in rear_middle_front(instant))
    assert rear == set(100.0 * np.arange(10))
    assert middle == set(100.0 * np.arange(45, 55))
    assert front == set(100.0 * np.arange(90, 100))


def test_the_page_has_a_row_for_every_statement():
    for said in (*HORIZONTAL, *INCLINED):
        assert f"| {said.claim} | {said.number} |" in PAGE
    assert len({said.id for said in (*HORIZONTAL, *INCLINED)}) == len(HORIZONTAL) + len(INCLINED)


def test_a_table_replaces_the_one_between_its_marks():
    text = "a\n<!-- table A -->\nold\n<!-- end A -->\nb"
    assert filled(text, {"A": "new\n"}) == "a\n<!-- table A -->\nnew\n<!-- end A -->\nb"


def test_a_number_shows_two_digits_of_its_error():
    assert number(Measured(mean=0.48791, error=0.0058)) == "0.4879 +- 0.0058"


@pytest.mark.parametrize("level", LEVELS)
def test_the_runs_of_the_page_are_those_of_the_shipped_cases(level):
    found = cases(level, ROOT / "cases")
    assert {case.fidelity.level for case in found.values()} == {level}
    assert {name.split("_case")[0].split("+")[0] for name in found} >= {"paper001"}
