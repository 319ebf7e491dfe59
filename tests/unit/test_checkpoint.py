"""A checkpoint gives back every bit, whole or not at all, and only to its own case."""

import errno
import os

import h5py
import numpy as np
import pytest
from synthetic_results import CASE

from mpsdem.results import CheckpointError, OutputError, read_checkpoint, write_checkpoint

STATE = {
    "solids": {
        "position": np.array([[0.1 + 0.2, -0.0, 5e-324], [np.pi, np.nan, np.inf]]),
        "pairs": np.array([[0, 2**31 - 1]], dtype=np.int32),
        "keys": np.array([2**64 - 1], dtype=np.uint64),
        "none": np.empty((0, 3)),
        "kind": "hertz_mindlin",
        "nested": {"skin": 0.3, "rebuilds": 12, "dirty": True},
    },
    "impulse": 0.1 + 0.7,
}


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "checkpoint.h5"
    write_checkpoint(path, case_toml=CASE.to_toml(), time=0.1 + 0.2, step=7, state=STATE)
    return path


def assert_same(got, expected):
    assert got.keys() == expected.keys()
    for key, value in expected.items():
        if isinstance(value, dict):
            assert_same(got[key], value)
        elif isinstance(value, np.ndarray):
            assert got[key].dtype == value.dtype
            assert got[key].shape == value.shape
            assert got[key].tobytes() == value.tobytes()
        else:
            assert type(got[key]) is type(value)
            assert got[key] == value


def test_every_bit_and_type_comes_back(path):
    checkpoint = read_checkpoint(path, CASE)
    assert (checkpoint.time, checkpoint.step) == (0.1 + 0.2, 7)
    assert_same(checkpoint.state, STATE)


def test_another_case_is_refused_and_the_keys_are_named(path):
    other = CASE.with_(solids={"density": 2500.0}, pipe={"roughness": 1e-4})
    with pytest.raises(CheckpointError) as refused:
        read_checkpoint(path, other)
    lines = str(refused.value).splitlines()[1:]
    assert [line.split(":")[0].strip() for line in lines] == ["pipe.roughness", "solids.density"]
    assert "2700.0 != 2500.0" in lines[1]


def test_what_changes_no_step_may_differ(path):
    settings = ["title=Longer", "end_time=99.0", "output.every=0.25", "fidelity.threads=3"]
    assert read_checkpoint(path, CASE.with_settings(settings)).step == 7


def test_a_missing_checkpoint_is_named(tmp_path):
    with pytest.raises(CheckpointError, match=r"no checkpoint at .*checkpoint\.h5"):
        read_checkpoint(tmp_path / "checkpoint.h5", CASE)


@pytest.mark.parametrize("keep", [0, 100, 3000])
def test_a_damaged_checkpoint_is_refused(path, keep):
    path.write_bytes(path.read_bytes()[:keep])
    with pytest.raises(CheckpointError, match="damaged"):
        read_checkpoint(path, CASE)


def test_a_checkpoint_of_which_one_bit_is_wrong_is_refused(path):
    content = bytearray(path.read_bytes())
    at = content.index(STATE["solids"]["position"].tobytes()) + 5
    content[at] ^= 1
    path.write_bytes(content)
    with pytest.raises(CheckpointError, match="damaged: its checksum"):
        read_checkpoint(path, CASE)


def test_any_program_reads_the_checkpoint_in_spite_of_its_checksum(path):
    with h5py.File(path, "r") as file:
        assert file["state/solids/position"].shape == (2, 3)


def test_the_old_checkpoint_is_replaced_and_not_overwritten(path):
    whole = path.read_bytes()
    with path.open("rb") as old:
        write_checkpoint(path, case_toml=CASE.to_toml(), time=9.0, step=9, state={})
        assert old.read() == whole
    assert read_checkpoint(path, CASE).step == 9


def test_a_full_disk_keeps_the_checkpoint_before(path, monkeypatch):
    def full(_handle):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OutputError, match="disk is full"):
        write_checkpoint(path, case_toml=CASE.to_toml(), time=9.0, step=9, state={})
    assert read_checkpoint(path, CASE).step == 7
    assert [file.name for file in path.parent.iterdir()] == ["checkpoint.h5"]
