"""Whatever happens to a file, what reads it says so in its own words, or reads it right."""

import numpy as np
import pytest
from damage import damages
from hypothesis import given, settings
from synthetic_results import CASE, write_run

from mpsdem.case import Case, CaseError, load_case
from mpsdem.results import (
    CheckpointError,
    Results,
    ResultsError,
    read_checkpoint,
    write_checkpoint,
)

STATE = {
    "solids": {"position": np.linspace(0.0, 1.0, 300).reshape(-1, 3), "kind": "hertz_mindlin"},
    "stages": {"impulse": 0.1 + 0.7, "drags": 12, "none": np.empty((0, 3))},
}


@pytest.fixture(scope="module")
def checkpoint(tmp_path_factory):
    path = tmp_path_factory.mktemp("checkpoint") / "checkpoint.h5"
    write_checkpoint(path, case_toml=CASE.to_toml(), time=0.3, step=7, state=STATE)
    return path, path.read_bytes()


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    directory = write_run(tmp_path_factory.mktemp("run"), times=np.arange(0.0, 2.1, 0.5))
    return directory, (directory / "results.h5").read_bytes()


@pytest.fixture(scope="module")
def case_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("case") / "case.toml"
    return path, CASE.to_toml().encode()


def check_checkpoint(checkpoint, damage):
    path, whole = checkpoint
    damaged = damage(whole)
    path.write_bytes(damaged)
    if damaged == whole:
        assert read_checkpoint(path, CASE).step == 7
        return
    with pytest.raises(CheckpointError, match="damaged"):
        read_checkpoint(path, CASE)


def check_results(run, damage):
    """The numbers of a frame have no checksum; all that says what and where they are has one."""
    directory, whole = run
    (directory / "results.h5").write_bytes(damage(whole))
    try:
        with Results(directory) as results:
            assert len(results.time) <= 5
            assert results.solids.position[:].shape == (len(results.time), 64, 3)
            for name in results.diagnostics:
                assert len(results.diagnostics[name]) == len(results.time)
            assert results.solids.radius.shape == (64,)
            assert isinstance(results.case, Case)
            assert results.liquid.profile_velocity.shape == results.liquid.profile_radius.shape
        return
    except ResultsError as error:
        said = str(error)
    assert str(directory) in said


def check_case(case_file, damage):
    path, whole = case_file
    path.write_bytes(damage(whole))
    try:
        load_case(path)
        return
    except CaseError as error:
        said = str(error)
    assert said.startswith(f"{path}:\n")


@settings(max_examples=40)
@given(damages())
def test_a_damaged_checkpoint_is_never_continued(checkpoint, damage):
    check_checkpoint(checkpoint, damage)


@settings(max_examples=40)
@given(damages())
def test_damaged_results_are_refused_in_words_or_keep_their_shape(run, damage):
    check_results(run, damage)


@settings(max_examples=60)
@given(damages())
def test_a_damaged_case_file_is_refused_in_words_or_is_another_case(case_file, damage):
    check_case(case_file, damage)


@pytest.mark.slow
@settings(max_examples=3000)
@given(damages(), damages())
def test_no_file_damaged_twice_brings_a_reader_down(checkpoint, run, case_file, first, second):
    def damage(content):
        return second(first(content) or b"\0")

    check_checkpoint(checkpoint, damage)
    check_results(run, damage)
    check_case(case_file, damage)
