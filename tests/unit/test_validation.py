"""Checks and their report: what passes, what fails, and how it is told."""

import math

import pytest
from typer.testing import CliRunner

from mpsdem import validation
from mpsdem.cli import app
from mpsdem.validation import CHECKS, Check, Source
from mpsdem.validation.registry import collect, select


def check(id_="a/b", *, got=1.0, expected=1.0, **rest):
    tolerance = {} if "absolute" in rest else {"relative": 0.01}
    return Check(
        id=id_, claim="it is so", expected=expected, measure=lambda: got, **tolerance | rest
    )


@pytest.fixture
def registry(monkeypatch):
    """Fill the registry with other checks."""

    def fill(*checks):
        monkeypatch.setattr(validation, "CHECKS", collect(checks))

    return fill


def said(*arguments):
    result = CliRunner().invoke(app, ["validate", *arguments], env={"COLUMNS": "200"})
    return result.exit_code, result.stdout


@pytest.mark.parametrize(("got", "agrees"), [(-2.01, True), (-1.99, True), (-2.03, False)])
def test_a_relative_tolerance_is_a_share_of_what_is_expected(got, agrees):
    assert check(got=got, expected=-2.0).run().agrees is agrees


@pytest.mark.parametrize(("got", "agrees"), [(-0.01, True), (0.02, True), (0.03, False)])
def test_an_absolute_tolerance_is_in_the_units_of_the_number(got, agrees):
    assert check(got=got, expected=0.0, absolute=0.02).run().agrees is agrees


@pytest.mark.parametrize("got", [math.nan, math.inf])
def test_a_number_that_is_not_finite_agrees_with_nothing(got):
    assert not check(got=got).run().agrees
    assert not check(got=got, absolute=math.inf).run().agrees


def test_the_error_keeps_its_sign():
    assert check(got=-2.1, expected=-2.0).run().error == pytest.approx(-0.05)
    assert check(got=-2.1, expected=-2.0, absolute=1.0).run().error == pytest.approx(-0.1)


@pytest.mark.parametrize(
    "rest", [{"relative": 0.0}, {"relative": 0.1, "absolute": 0.1}, {"expected": 0.0}]
)
def test_a_check_without_one_clear_tolerance_is_refused(rest):
    with pytest.raises(ValueError, match="toleranc"):
        check(**rest)


def test_two_checks_of_one_id_are_refused():
    with pytest.raises(ValueError, match="two checks have the id a/b"):
        collect([check("a/b")], [check("a/b")])


def test_a_group_is_chosen_by_the_start_of_its_path():
    checks = collect(check(id_) for id_ in ("drag/a", "drag/b/c", "dragged/d"))
    assert [chosen.id for chosen in select(checks, ["drag"])] == ["drag/a", "drag/b/c"]
    assert [chosen.id for chosen in select(checks, ["drag/b/"])] == ["drag/b/c"]
    assert [chosen.id for chosen in select(checks, ["drag/b/c", "dragged"])] == [
        "drag/b/c",
        "dragged/d",
    ]
    assert len(select(checks, [])) == 3


def test_every_published_number_names_its_source():
    for published in CHECKS.values():
        assert published.source.cite
        assert published.claim


def test_the_table_says_what_was_expected_what_came_and_where_it_stands(registry):
    source = Source(cite="Hertz (1882)", reference="doi:10.1515/crll.1882.92.156")
    registry(check("impact/force", got=10.04, expected=10.0, unit="N", source=source))
    code, words = said()
    assert code == 0
    for word in ("impact/force", "10.04", "+0.40%", "1%", "N", "Hertz (1882)", source.reference):
        assert word in words


def test_one_failure_is_an_exit_code_of_1(registry):
    registry(check("right"), check("wrong", got=2.0))
    assert said()[0] == 1
    assert "1 agree, 1 fail" in said()[1]
    assert said("right")[0] == 0


def test_a_known_difference_is_told_with_its_reason_and_fails_nothing(registry):
    registry(check(got=2.0, differs="the model leaves this out"))
    code, words = said()
    assert code == 0
    assert "0 agree, 0 fail, 1 are known to differ" in words
    assert "the model leaves this out" in words


def test_an_unknown_id_is_an_exit_code_of_2_and_a_suggestion(registry):
    registry(check("oblique/oxide"))
    code, words = said("obliqe")
    assert code == 2
    assert "no check 'obliqe'; did you mean oblique" in words
