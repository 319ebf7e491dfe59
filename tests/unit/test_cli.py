"""What a user types, and what comes back: words on the terminal, an exit code, a directory."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
from matplotlib.figure import Figure
from synthetic_results import blank
from typer.testing import CliRunner

import mpsdem
from mpsdem import Results
from mpsdem.cli import app

PACKAGE = Path(mpsdem.__file__).parents[1]  # the one that these tests run, wherever it is installed
CASE = """
title = "Short pipe"
end_time = 0.1
[pipe]
radius = 0.05
length = "50 cm"
[liquid]
model = "profile"
density = 1000.0
kinematic_viscosity = 1e-6
bulk_velocity = 1.0
[solids]
diameter = "10 mm"
density = 2500.0
youngs_modulus = 1e7
count = 20
[fidelity]
level = "quick"
[output]
every = 0.02
figures = false
"""


def type_in(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.fixture
def case_file(tmp_path):
    path = tmp_path / "short pipe.toml"
    path.write_text(CASE)
    return path


def test_run_leaves_results_and_says_where(case_file, tmp_path):
    said = type_in("run", case_file, "-o", tmp_path / "out")
    assert said.exit_code == 0
    assert f"results in {tmp_path / 'out'}" in said.stdout
    assert Results(tmp_path / "out").summary["status"] == "finished"


def test_the_command_line_overrides_the_case(case_file, tmp_path):
    options = ["--until", "0.04", "--fidelity", "fine", "--set", "solids.density=2700"]
    said = type_in("run", case_file, "-o", tmp_path / "out", *options, "--set", "solids.count=5")
    assert said.exit_code == 0, said.stderr
    case = Results(tmp_path / "out").case
    assert (case.end_time, case.fidelity.level) == (0.04, "fine")
    assert (case.solids.density, case.solids.count) == (2700.0, 5)


def test_until_leaves_out_the_figures_beyond(case_file, tmp_path):
    case_file.write_text(CASE.replace("[output]", "[output]\ntimes = [0.02, 0.1]"))
    assert type_in("run", case_file, "-o", tmp_path / "out", "--until", "0.05").exit_code == 0
    assert Results(tmp_path / "out").case.output.times == (0.02,)


def test_run_replaces_results_only_when_told_to(case_file, tmp_path):
    command = ["run", case_file, "-o", tmp_path / "out"]
    assert type_in(*command).exit_code == 0
    refused = type_in(*command)
    assert refused.exit_code == 2
    assert "--overwrite" in refused.stderr
    assert type_in(*command, "--overwrite").exit_code == 0


@pytest.mark.parametrize(
    ("option", "told"),
    [
        ("solids.denisty=2500", "did you mean 'density'?"),
        ("solids.density=-1", "solids.density = -1"),
        ("solids.diameter=5 kg", "solids.diameter"),
        ("fidelity.solid_step=1", "of a collision at 1 m/s"),
        ("solids.diameter=0.2", "bore"),
        ("end_time=0", "end_time"),
    ],
)
@pytest.mark.parametrize("command", ["run", "explain"])
def test_bad_input_is_one_message_without_a_traceback(command, option, told, case_file):
    said = type_in(command, case_file, "--set", option)
    assert said.exit_code == 2
    assert told in said.stderr
    assert "Traceback" not in said.stderr
    assert said.stdout == ""


@pytest.mark.parametrize("command", ["run", "explain", "resume", "report"])
def test_a_path_where_nothing_is_is_named(command, tmp_path):
    said = type_in(command, tmp_path / "nothing")
    assert said.exit_code == 2
    assert "nothing" in said.stderr


def test_a_diverged_run_exits_with_one(case_file, tmp_path):
    case_file.write_text(CASE[: CASE.index("[liquid]")] + CASE[CASE.index("[solids]") :])
    settings = [
        "solids.contact=linear_spring",
        "solids.impact_speed=0.01",
        "solids.arrangement.velocity=[0.0, 1e4, 0.0]",
    ]
    options = [word for setting in settings for word in ("--set", setting)]
    said = type_in("run", case_file, "-o", tmp_path / "out", *options)
    assert said.exit_code == 1
    assert "diverged" in said.stderr
    assert "Traceback" not in said.stderr


def test_explain_names_stages_limits_and_cost(case_file):
    said = type_in("explain", case_file)
    assert said.exit_code == 0
    for word in ("FindVoidFraction", "Rayleigh time", "(binds)", "Reynolds number", "memory"):
        assert word in said.stdout


def test_info_names_version_compiler_and_cholmod():
    said = type_in("info")
    assert said.exit_code == 0
    for word in ("version", "compiler", "simd", "cholmod", "available_threads", "numpy"):
        assert word in said.stdout


def test_report_tells_the_means_with_their_errors_and_draws_the_figures(
    case_file, tmp_path, monkeypatch
):
    monkeypatch.setattr(Figure, "savefig", blank)
    type_in("run", case_file, "-o", tmp_path / "out")
    said = type_in("report", tmp_path / "out")
    assert said.exit_code == 0
    for word in ("pressure_gradient", "error", "too short for a mean", "regime", "blockage"):
        assert word in said.stdout
    files = [Path(line) for line in said.stdout.splitlines() if line.startswith(str(tmp_path))]
    assert files[0].name == "report.json"
    assert len(files) > 4
    assert all(path.exists() for path in files)


def test_a_run_that_a_plug_ends_has_an_exit_code_of_its_own(case_file, tmp_path):
    plug = ["pipe.length=0.08", "pipe.radius=0.02", "solids.count=95", "solids.friction=0.8"]
    plug += ["liquid.bulk_velocity=0.2", "end_time=2", "output.every=0.2", "output.on_plug=stop"]
    settings = [word for setting in plug for word in ("--set", setting)]
    said = type_in("run", case_file, "-o", tmp_path / "out", *settings)
    assert said.exit_code == 3
    assert "plug" in said.stdout
    assert Results(tmp_path / "out").summary["status"] == "plug"


def start(*arguments):
    """Run `mpsdem` as a process of its own."""
    environment = os.environ | {"PYTHONPATH": str(PACKAGE)}
    command = [sys.executable, "-m", "mpsdem", *map(str, arguments)]
    return subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def wait_until(condition, seconds=60.0):
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, "waited in vain"
        time.sleep(0.01)


def checkpoint_time(directory):
    try:
        with h5py.File(directory / "checkpoint.h5", locking=False) as file:
            return file.attrs["time"]
    except OSError:
        return -1.0


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_ends_the_run_after_a_whole_step_with_its_own_exit_code(
    number, code, case_file, tmp_path
):
    out = tmp_path / "out"
    settings = ["--until", "1000", "--set", "output.checkpoint_every=0.1"]
    process = start("run", case_file, "-o", out, *settings)
    wait_until(lambda: checkpoint_time(out) > 0)
    process.send_signal(number)
    _, said = process.communicate(timeout=60)
    assert process.returncode == code
    assert f"mpsdem resume {out}" in said
    assert "Traceback" not in said
    with Results(out) as results:
        assert results.summary["status"] == "interrupted"
        assert results.summary["time"] == checkpoint_time(out) >= results.time[-1] > 0


def test_a_killed_run_resumes_to_the_numbers_of_one_that_was_left_alone(case_file, tmp_path):
    alone, killed = tmp_path / "alone", tmp_path / "killed"
    settings = ["--until", "4", "--set", "output.checkpoint_every=0.1"]
    process = start("run", case_file, "-o", killed, *settings)
    wait_until(lambda: checkpoint_time(killed) > 0.25)
    process.kill()
    process.communicate(timeout=60)
    assert process.returncode == -signal.SIGKILL
    assert 0 < Results(killed).time[-1] < 4  # readable, and not at its end

    assert type_in("resume", killed).exit_code == 0
    assert type_in("run", case_file, "-o", alone, *settings).exit_code == 0
    one, other = Results(alone), Results(killed)
    for name in ("position", "velocity", "spin", "laps"):
        assert np.array_equal(getattr(one.solids, name)[:], getattr(other.solids, name)[:]), name
    took = {"wall_seconds", "cpu_seconds"}
    for name in one.summary.keys() - took:
        assert one.summary[name] == other.summary[name], name


def test_two_runs_in_one_directory_are_one_run_and_a_refusal(case_file, tmp_path):
    out = tmp_path / "out"
    first = start("run", case_file, "-o", out, "--until", "1000")
    wait_until(lambda: checkpoint_time(out) == 0)
    for command in (["run", case_file, "-o", out, "--overwrite"], ["resume", out]):
        second = type_in(*command)
        assert second.exit_code == 2
        assert f"in use by a run with process id {first.pid}" in second.stderr
    first.send_signal(signal.SIGINT)
    _, said = first.communicate(timeout=60)
    assert first.returncode == 130, said
    with Results(out) as results:
        assert results.summary["status"] == "interrupted"


def test_a_second_signal_ends_a_run_at_once_and_costs_no_frame(case_file, tmp_path):
    """The first waits for the step; who cannot wait presses Ctrl-C again, or kills."""
    out = tmp_path / "out"
    settings = ["--until", "1000", "--set", "output.checkpoint_every=0.1"]
    process = start("run", case_file, "-o", out, *settings)
    wait_until(lambda: checkpoint_time(out) > 0)
    for _ in range(20):
        process.send_signal(signal.SIGTERM)
    process.communicate(timeout=60)
    assert process.returncode in (143, -signal.SIGTERM)
    assert len(Results(out).time) > 0


@pytest.mark.parametrize("name", ["checkpoint.h5", "results.h5", "case.toml"])
@pytest.mark.parametrize("keep", [0.0, 0.2])
def test_a_run_whose_files_are_damaged_is_not_resumed_and_told_of_them(
    name, keep, case_file, tmp_path
):
    out = tmp_path / "out"
    assert type_in("run", case_file, "-o", out).exit_code == 0
    content = (out / name).read_bytes()
    (out / name).write_bytes(content[: int(keep * len(content))])
    said = type_in("resume", out)
    assert said.exit_code == 2
    assert name in said.stderr
    assert "Traceback" not in said.stderr


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A run to copy and to damage."""
    folder = tmp_path_factory.mktemp("finished")
    (folder / "pipe.toml").write_text(CASE)
    assert type_in("run", folder / "pipe.toml", "-o", folder / "out").exit_code == 0
    return folder / "out"


DAMAGES = {
    "empty": lambda content: content[:0],
    "cut": lambda content: content[: len(content) // 5],
    "zeros": lambda content: bytes(len(content)),
    "another file": lambda content: b"\x89PNG\r\n\x1a\n" + content[8:],
    "a page lost": lambda content: content[:512] + bytes(4096) + content[4608:],
}


@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
@pytest.mark.parametrize("command", ["report", "export"])
def test_damaged_results_are_one_message_without_a_traceback(command, damage, finished, tmp_path):
    out = shutil.copytree(finished, tmp_path / "out")
    results = out / "results.h5"
    results.write_bytes(damage(results.read_bytes()))
    said = type_in(command, out)
    assert said.exit_code == 2
    assert str(out) in said.stderr
    assert isinstance(said.exception, SystemExit)


@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_a_damaged_summary_stops_no_report_without_its_name(damage, finished, tmp_path):
    out = shutil.copytree(finished, tmp_path / "out")
    summary = out / "summary.json"
    summary.write_bytes(damage(summary.read_bytes()))
    said = type_in("report", out)
    assert said.exit_code in (0, 2)
    assert said.exit_code == 0 or "summary.json" in said.stderr
    assert said.exception is None or isinstance(said.exception, SystemExit)


@pytest.mark.parametrize("damage", [b"\xff\xfe", b"\0\0", b"[pipe", b"= 1\n", b"[pipe]\n" * 2])
@pytest.mark.parametrize("command", ["run", "explain", "trade"])
def test_a_damaged_case_file_is_one_message_without_a_traceback(command, damage, case_file):
    case_file.write_bytes(damage + CASE.encode())
    said = type_in(command, case_file)
    assert said.exit_code == 2
    assert case_file.name in said.stderr.replace("\n", "")
    assert isinstance(said.exception, SystemExit)
    assert not (case_file.parent / "out").exists()


@pytest.mark.parametrize("missing", ["checkpoint.h5", "results.h5", "case.toml"])
def test_a_run_whose_files_are_gone_is_not_resumed_and_told_of_them(missing, case_file, tmp_path):
    out = tmp_path / "out"
    assert type_in("run", case_file, "-o", out).exit_code == 0
    (out / missing).unlink()
    said = type_in("resume", out)
    assert said.exit_code == 2
    assert missing in said.stderr


def test_a_directory_that_takes_no_file_is_named_with_the_reason(case_file):
    said = type_in("run", case_file, "-o", "/proc/mpsdem")
    assert said.exit_code == 2
    assert "cannot write /proc/mpsdem" in said.stderr
    assert "Traceback" not in said.stderr


FULL = """
import resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (4_000_000, 4_000_000))
from mpsdem.cli import main
main()
"""


def test_a_run_that_may_not_write_more_says_so_and_keeps_its_frames(case_file, tmp_path):
    out = tmp_path / "out"
    settings = ["--until", "1000", "--set", "output.checkpoint_every=0.1"]
    command = [sys.executable, "-c", FULL, "run", case_file, "-o", out, *settings]
    environment = os.environ | {"PYTHONPATH": str(PACKAGE)}
    run = subprocess.run(
        list(map(str, command)), env=environment, capture_output=True, text=True, timeout=120
    )
    assert run.returncode == 2, run.stderr
    assert f"cannot write {out / 'results.h5'}" in run.stderr
    assert "Traceback" not in run.stderr
    with Results(out) as results:
        assert len(results.time) > 0
        assert np.isfinite(results.solids.position[:]).all()
    text = (out / "case.toml").read_text().replace("end_time = 1000.0", "end_time = 0.2")
    (out / "case.toml").write_text(text)
    assert type_in("resume", out).exit_code == 0
