"""Two runs never write to one directory."""

import os
import signal
import subprocess
import sys

import pytest

from mpsdem.results import DirectoryLock, LockError, OutputError

HOLD = """
import sys, time
from mpsdem.results import DirectoryLock
with DirectoryLock(sys.argv[1]):
    print("held", flush=True)
    time.sleep(60)
"""


def test_a_second_run_is_refused_with_the_process_of_the_first(tmp_path):
    with DirectoryLock(tmp_path), pytest.raises(LockError, match=rf"process id {os.getpid()}\b"):
        DirectoryLock(tmp_path).__enter__()


def test_a_directory_is_free_after_its_run(tmp_path):
    for _ in range(2):
        with DirectoryLock(tmp_path / "new" / "directory"):
            pass


def test_a_killed_run_leaves_its_directory_free(tmp_path):
    with subprocess.Popen([sys.executable, "-c", HOLD, tmp_path], stdout=subprocess.PIPE) as run:
        assert run.stdout.readline() == b"held\n"
        with pytest.raises(LockError, match=rf"process id {run.pid}\b"):
            DirectoryLock(tmp_path).__enter__()
        run.send_signal(signal.SIGKILL)
    with DirectoryLock(tmp_path):
        pass


def test_a_directory_that_cannot_be_made_is_named(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match=r"file/out.*not a directory"):
        DirectoryLock(tmp_path / "file" / "out").__enter__()
