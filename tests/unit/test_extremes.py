"""The table of the extremes tells what happened, whatever happened."""

import os
import re
from dataclasses import replace
from pathlib import Path

import pytest

from mpsdem.validation.extremes import Came, markdown, rows, run_row, run_rows
from mpsdem.validation.extremes.rows import Row

TABLE = Path(__file__).parents[2] / "docs" / "extremes.md"
NAMED = {row.id: row for row in rows()}
DILUTE = Row(quantity="solids", value="five", model="profile", changes={"solids": {"count": 5}})


def hang(_row):
    while True:
        pass


def crash(_row):
    os.abort()


def stumble(_row):
    raise ZeroDivisionError("float division by zero")


def came_of(row, **options):
    (came,) = run_rows([row], **options)
    return came


def test_every_row_has_a_name_of_its_own():
    assert len(NAMED) == len(rows()) > 100


@pytest.mark.parametrize(
    ("run", "outcome", "reason"),
    [
        (hang, "hangs", "no end after 1 s"),
        (crash, "crashes", "exit code -6"),
        (stumble, "crashes", "ZeroDivisionError: float division by zero"),
    ],
)
def test_a_row_that_hangs_or_crashes_is_told_and_takes_none_along(run, outcome, reason):
    limit = 1 if run is hang else 60
    hung, next_one = (came_of(DILUTE, run=which, limit=limit) for which in (run, stumble))
    assert (hung.outcome, hung.reason) == (outcome, reason)
    assert not hung.as_expected
    assert next_one.reason.startswith("ZeroDivisionError")


def test_a_row_that_survives_has_its_figures():
    came = run_row(replace(DILUTE, steps=5))
    assert came.as_expected, came
    assert 0 < came.figures["speed"] < 2
    assert came.figures["momentum_error"] < 1e-12
    assert came.step_seconds > 0
    assert came.memory > 20


def test_a_row_that_is_refused_has_the_words_of_the_program():
    came = run_row(NAMED["Courant-number/5/eulerian"])
    assert came.as_expected
    assert "fidelity.courant = 5.0: must be > 0 and <= 2" in came.reason


def test_a_run_resumed_at_another_velocity_is_refused_by_name():
    came = run_row(replace(NAMED["jump-of-velocity/resumed-at-2-m/s/profile"], steps=5))
    assert came.outcome == "refused"
    assert "liquid.bulk_velocity: 1.0 != 2.0" in came.reason


def test_a_speed_that_is_absurd_is_not_sane():
    came = run_row(replace(DILUTE, steps=5, speed=1e-3))
    assert came.outcome == "survived"
    assert re.fullmatch(r"speed \S+, above 0\.001", *came.doubts)
    assert not came.as_expected


def test_the_table_shows_in_bold_what_is_not_as_it_must_be():
    text = markdown(
        [
            Came(row=DILUTE, outcome="survived", doubts=("speed 9, above 5",)),
            Came(row=DILUTE, outcome="hangs", reason="no end after 120 s"),
            Came(row=replace(DILUTE, outcome="refused"), outcome="refused", reason="a | b\nc"),
        ]
    )
    assert "survived | **no**" in text
    assert "**hangs**" in text
    assert "| refused |" in text
    assert text.rstrip().endswith("a \\| b c |")


def test_the_document_has_every_row_as_it_must_be():
    lines = TABLE.read_text("utf-8").split("<!-- table -->")[1].splitlines()
    cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines if "|" in line][2:]
    quantity, told = "", {}
    for what, value, model, outcome, *_ in cells:
        quantity = what or quantity
        told["/".join((quantity, value, model)).replace(" ", "-")] = outcome
    assert told == {name: row.outcome for name, row in NAMED.items()}


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMED)
def test_an_extreme_comes_out_as_it_must(name):
    came = came_of(NAMED[name])
    assert came.outcome == came.row.outcome, came.reason
