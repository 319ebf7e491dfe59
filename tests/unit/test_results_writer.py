"""Results as they are written: whole frames, whatever happens to the run or the disk."""

import errno
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from synthetic_results import CASE, KIND, cluster, frame, open_writer, particle_frame, write_run

from mpsdem.results import OutputError, Results, ResultsError, ResultsWriter

ENDLESS_RUN = """
import itertools, sys
sys.path.insert(0, sys.argv[2])
from synthetic_results import frame, open_writer
writer = open_writer(sys.argv[1])
for k in itertools.count():
    writer.append(k / 4, **frame(k / 4))
    if k == 20:
        print("going", flush=True)
"""


def assert_frames_are_right(directory, times):
    with Results(directory) as results:
        np.testing.assert_array_equal(results.time, times)
        for k, time_ in enumerate(times):
            np.testing.assert_array_equal(results.solids.velocity[k], cluster(time_)[1])
            expected = frame(time_)["solids"]["position"]
            np.testing.assert_array_equal(results.solids.position[k], expected)


@pytest.mark.parametrize("delay", [0.0, 0.011, 0.05])
def test_a_killed_run_leaves_every_frame_it_finished_and_can_be_continued(tmp_path, delay):
    command = [sys.executable, "-c", ENDLESS_RUN, str(tmp_path), str(Path(__file__).parent)]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as run:
        assert run.stdout.readline() == b"going\n"
        time.sleep(delay)
        run.send_signal(signal.SIGKILL)
    with Results(tmp_path) as results:
        times = results.time
    assert len(times) > 20
    assert_frames_are_right(tmp_path, np.arange(len(times)) / 4)
    with ResultsWriter.reopen(tmp_path, time=4.0) as writer:
        writer.append(4.25, **frame(4.25))
    assert_frames_are_right(tmp_path, np.arange(18) / 4)


def test_continued_results_equal_those_of_an_undisturbed_run(tmp_path):
    write_run(tmp_path / "whole")
    write_run(tmp_path / "stopped", times=np.arange(0.0, 5.25, 0.5))
    with ResultsWriter.reopen(tmp_path / "stopped", time=3.0) as writer:
        assert writer.frames == 7
        for t in np.arange(3.5, 8.25, 0.5):
            writer.append(t, **frame(t))
    whole, continued = Results(tmp_path / "whole"), Results(tmp_path / "stopped")
    np.testing.assert_array_equal(continued.time, whole.time)
    np.testing.assert_array_equal(continued.pressure_gradient, whole.pressure_gradient)
    for name in ("position", "velocity", "spin", "laps", "radius", "density"):
        np.testing.assert_array_equal(getattr(continued.solids, name), getattr(whole.solids, name))
    assert continued.solids.spin.unit == "rad/s"
    assert continued.provenance == whole.provenance
    assert continued.case_toml == whole.case_toml


def test_a_liquid_of_particles_is_continued_too(tmp_path):
    write_run(tmp_path, times=[0.0, 0.5, 1.0], liquid="particles")
    with ResultsWriter.reopen(tmp_path, time=0.5) as writer:
        writer.append(2.0, **frame(2.0, liquid="particles"))
    liquid = Results(tmp_path).liquid
    for k, time_ in enumerate([0.0, 0.5, 2.0]):
        fields, _ = particle_frame(time_, CASE)
        np.testing.assert_array_equal(liquid.position[k], fields["position"])
        np.testing.assert_array_equal(liquid.velocity_profile[k], fields["velocity_profile"])
    np.testing.assert_array_equal(liquid.kind, KIND)


def test_a_run_can_be_continued_from_its_first_frame(tmp_path):
    write_run(tmp_path)
    with ResultsWriter.reopen(tmp_path, time=0.0) as writer:
        writer.append(0.25, **frame(0.25))
    assert_frames_are_right(tmp_path, [0.0, 0.25])


def test_a_run_continued_to_a_later_end_records_it(tmp_path):
    write_run(tmp_path)
    ResultsWriter.reopen(tmp_path, time=8.0, case=CASE.with_(end_time=9.0)).close()
    assert Results(tmp_path).case.end_time == 9.0
    assert "end_time = 9.0" in (tmp_path / "case.toml").read_text("utf-8")


def test_a_new_run_forgets_the_old_one(tmp_path):
    write_run(tmp_path)
    (tmp_path / "checkpoint.h5").write_bytes(b"of the old run")
    open_writer(tmp_path).close()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["case.toml"]


def test_frames_come_in_order_and_hold_the_same_fields(tmp_path):
    with open_writer(tmp_path) as writer:
        writer.append(0.0, **frame(0.0))
        with pytest.raises(ValueError, match="cannot follow"):
            writer.append(0.0, **frame(0.0))
        with pytest.raises(ValueError, match=r"same fields.*contacts"):
            writer.append(1.0, solids=frame(1.0)["solids"])
        with pytest.raises(ValueError, match=r"same fields.*pressure"):
            writer.append(1.0, **frame(1.0), liquid={"pressure": [0.0]})
        with pytest.raises(ValueError, match="colour"):
            writer.append(1.0, diagnostics={"colour": 1.0})
        writer.append(1.0, **frame(1.0))
    assert_frames_are_right(tmp_path, [0.0, 1.0])


def test_a_directory_below_a_file_is_refused(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match=r"file/out.*not a directory"):
        open_writer(tmp_path / "file" / "out")
    with pytest.raises(OutputError, match="in the way"):
        open_writer(tmp_path / "file")


@pytest.mark.parametrize(
    ("number", "words"),
    [
        (errno.EACCES, "permission denied"),
        (errno.EROFS, "read-only"),
        (errno.ENOSPC, "disk is full"),
    ],
)
def test_a_directory_that_cannot_be_written_says_why(tmp_path, monkeypatch, number, words):
    def refuse(*_args, **_options):
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(Path, "mkdir", refuse)
    with pytest.raises(OutputError, match=words):
        open_writer(tmp_path / "out")


@pytest.fixture
def small_disk(tmp_path):
    """A file system of 1.5 MB, where one may be mounted."""
    path = tmp_path / "small"
    path.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", "size=1500k", "tmpfs", str(path)]
    if not shutil.which("mount") or subprocess.run(command, capture_output=True).returncode:
        pytest.skip("may not mount a small file system here")
    yield path
    subprocess.run(["umount", "-l", str(path)], check=True)


FILL = """
import itertools, sys
sys.path.insert(0, sys.argv[2])
from mpsdem.results import OutputError
from synthetic_results import frame, open_writer
with open_writer(sys.argv[1]) as writer:
    try:
        for k in itertools.count():
            writer.append(k / 4, **frame(k / 4))
    except OutputError as error:
        print(k, error)
"""


def test_a_full_disk_is_an_error_in_words_and_costs_no_frame(small_disk):
    # In a process of its own: HDF5 crashes at exit where a write has failed in it.
    command = [sys.executable, "-c", FILL, str(small_disk), str(Path(__file__).parent)]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    count, words = run.stdout.split(maxsplit=1)
    assert "disk is full: free some space" in words
    assert int(count) > 20
    assert_frames_are_right(small_disk, np.arange(int(count)) / 4)


def test_a_full_disk_keeps_the_results_that_were_to_be_continued(tmp_path, monkeypatch):
    write_run(tmp_path)

    def full(*_args):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "posix_fallocate", full)
    with pytest.raises(OutputError, match="disk is full"):
        ResultsWriter.reopen(tmp_path, time=4.0)
    assert len(Results(tmp_path).time) == 17
    assert not list(tmp_path.glob("*.new"))


def test_damaged_results_cannot_be_continued(tmp_path):
    (tmp_path / "results.h5").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(500))
    with pytest.raises(ResultsError, match="damaged"):
        ResultsWriter.reopen(tmp_path, time=0.0)
