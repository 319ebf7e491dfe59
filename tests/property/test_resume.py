"""A run that was stopped and resumed cannot be told from one that never was."""

import signal
from contextlib import contextmanager, suppress
from tempfile import TemporaryDirectory

import h5py
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mpsdem import Simulation, SimulationInterrupted
from mpsdem.case import Case
from mpsdem.simulation import run as time_loop

WATER = {
    "model": "profile",
    "density": 1000.0,
    "kinematic_viscosity": 1e-6,
    "bulk_velocity": 1.0,
}
SOLIDS = {
    "diameter": {"kind": "uniform", "smallest": 0.008, "largest": 0.012},
    "density": 2700.0,
    "youngs_modulus": 1e7,
    "friction": 0.4,
    "count": 60,
    "arrangement": {"kind": "random", "velocity": [0.5, 0.1, -0.3]},
}
SPRING = {"contact": "linear_spring"}
ROLLING = {"rolling_friction": 0.05, "wall": {"rolling_friction": 0.1, "friction": 0.6}}


SHAKE = {"vibration": {"direction": [1.0, 1.0, 1.0], "amplitude": 0.005, "period": 0.1}}


def case(*, liquid=None, solids=(), coupling="one-way", motion=()):
    """Solids thrown at the wall of a short pipe; the last frame stands at an odd time."""
    return Case(
        end_time=0.11,
        pipe={"radius": 0.05, "length": 0.4},
        liquid=liquid,
        solids=SOLIDS | dict(solids),
        motion=dict(motion),
        fidelity={"level": "quick", "coupling_step": 0.002, "coupling": coupling},
        output={"every": 0.02, "figures": False},
    )


CASES = {
    "dry": case(),
    "dry, linear spring, rolling friction": case(solids=SPRING | ROLLING),
    "dry, viscoelastic": case(solids={"contact": "hertz_viscoelastic"}),
    "profile": case(liquid=WATER),
    "profile, linear spring": case(liquid=WATER, solids=SPRING),
    "profile, rolling friction": case(liquid=WATER, solids=ROLLING),
    "profile, shaken": case(liquid=WATER, motion=SHAKE),
    "lagrangian, two-way, shaken": case(
        liquid=WATER | {"model": "lagrangian"}, coupling="two-way", motion=SHAKE
    ),
    "lagrangian, two-way, flexing": case(
        liquid=WATER | {"model": "lagrangian"},
        coupling="two-way",
        motion={"vibration": SHAKE["vibration"] | {"direction": "z", "mode": 2, "phase": 1.0}},
    ),
    "dry, flexing without a ramp": case(
        motion={
            "vibration": SHAKE["vibration"] | {"direction": "z", "mode": 2, "phase": 1.0, "ramp": 0}
        }
    ),
    "profile, Schiller-Naumann": case(liquid=WATER, solids={"drag": "schiller_naumann"}),
    "clear liquid": case(liquid=WATER).with_(solids=None),
    "lagrangian": case(liquid=WATER | {"model": "lagrangian"}),
    "eulerian": case(liquid=WATER | {"model": "eulerian"}),
    "clear liquid, eulerian": case(liquid=WATER | {"model": "eulerian"}).with_(solids=None),
    "lagrangian, two-way": case(liquid=WATER | {"model": "lagrangian"}, coupling="two-way"),
    "lagrangian, two-way, light solids": case(
        liquid=WATER | {"model": "lagrangian"}, solids={"density": 1200.0}, coupling="two-way"
    ),
    "lagrangian, held solids": case(
        liquid=WATER | {"model": "lagrangian"},
        solids={"held": True, "arrangement": {"kind": "random"}},
        coupling="two-way",
    ),
    "push plate": case(liquid=WATER | {"model": "lagrangian"}).with_(
        pipe={"ends": "push-plate", "stroke": 0.05}
    ),
    "clear liquid, lagrangian": case(liquid=WATER | {"model": "lagrangian"}).with_(solids=None),
}


@contextmanager
def stop_after(steps):
    """Let the process receive SIGINT at the end of the given number of steps."""

    @contextmanager
    def progress(*_args, **_options):
        left = steps

        def show(_time):
            nonlocal left
            left -= 1
            if left == 0:
                signal.raise_signal(signal.SIGINT)

        yield show

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(time_loop, "progress", progress)
        yield


def contents(results):
    """All datasets of the results to the bit, and the summary but for the time that it took."""
    found = {}

    def note(name, item):
        if isinstance(item, h5py.Dataset):
            value = np.asarray(item[()])
            found[name] = value.tolist() if value.dtype.hasobject else value.tobytes()

    with h5py.File(results.directory / "results.h5", locking=False) as file:
        file.visititems(note)
    took = {"wall_seconds", "cpu_seconds"}
    return found | {name: value for name, value in results.summary.items() if name not in took}


@pytest.fixture(scope="module", params=CASES)
def undisturbed(request, tmp_path_factory):
    directory = tmp_path_factory.mktemp("whole")
    with Simulation(CASES[request.param], directory).run() as results:
        return CASES[request.param], contents(results)


@settings(max_examples=4)
@given(stops=st.lists(st.integers(1, 30), min_size=1, max_size=3))
def test_a_resumed_run_equals_one_that_was_never_stopped(undisturbed, stops):
    case, whole = undisturbed
    with TemporaryDirectory() as directory:
        simulation = Simulation(case, directory)
        for steps in stops:
            with stop_after(steps), suppress(SimulationInterrupted):
                simulation.run().close()
            simulation = Simulation.resume(directory)
        with simulation.run() as results:
            found = contents(results)
        assert found.keys() == whole.keys()
        assert [name for name in whole if found[name] != whole[name]] == []
