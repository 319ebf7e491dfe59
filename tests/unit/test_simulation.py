"""A run leaves what it promises, and its numbers obey mechanics."""

import json
import logging

import fluids
import numpy as np
import pytest
from matplotlib.figure import Figure
from synthetic_results import blank

from mpsdem import Results, Simulation, SimulationDiverged
from mpsdem.case import Case
from mpsdem.results import (
    SUMMARY_KEYS,
    CheckpointError,
    DirectoryLock,
    LockError,
    OutputError,
    read_checkpoint,
    write_checkpoint,
)

WATER = {
    "model": "profile",
    "density": 1000.0,
    "kinematic_viscosity": 1e-6,
    "bulk_velocity": 1.0,
}
BEADS = {
    "diameter": 0.01,
    "density": 2500.0,
    "youngs_modulus": 1e7,
    "count": 20,
    "arrangement": {"kind": "random"},
}


def case(*, liquid=WATER, solids=BEADS, **parts):
    parts = {
        "end_time": 0.1,
        "pipe": {"radius": 0.05, "length": 0.5},
        "fidelity": {"level": "quick"},
        "output": {"every": 0.02, "figures": False},
    } | parts
    return Case(liquid=liquid, solids=solids, **parts)


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    return Simulation(case(), tmp_path_factory.mktemp("both") / "run").run()


@pytest.fixture(scope="module")
def dry(tmp_path_factory):
    return Simulation(case(liquid=None), tmp_path_factory.mktemp("dry") / "run").run()


@pytest.fixture(scope="module")
def clear(tmp_path_factory):
    return Simulation(case(solids=None), tmp_path_factory.mktemp("clear") / "run").run()


def test_frames_stand_at_the_times_that_were_asked_for(both, dry, clear):
    for results in (both, dry, clear):
        np.testing.assert_allclose(results.time, [0, 0.02, 0.04, 0.06, 0.08, 0.1], rtol=1e-15)


def test_the_last_frame_stands_at_the_end_even_between_two_intervals(tmp_path):
    results = Simulation(case(end_time=0.05), tmp_path).run()
    assert results.time.tolist() == [0.0, 0.02, 0.04, 0.05]


def test_the_directory_holds_case_results_checkpoint_summary_and_log(both):
    names = {path.name for path in both.directory.iterdir()}
    assert names >= {"case.toml", "results.h5", "checkpoint.h5", "summary.json", "run.log"}
    assert Case.from_toml((both.directory / "case.toml").read_text()) == both.case == case()
    assert "AdvanceSolids" in (both.directory / "run.log").read_text()


@pytest.mark.parametrize("kind", ["both", "dry", "clear"])
def test_the_summary_has_every_key_and_a_reason_where_it_has_no_value(kind, request):
    summary = request.getfixturevalue(kind).summary
    assert set(SUMMARY_KEYS) <= set(summary)
    empty = {name for name, value in summary.items() if value is None}
    assert empty == set(summary["not_applicable"])
    assert all(summary["not_applicable"].values())
    assert (summary["status"], summary["time"]) == ("finished", 0.1)


def test_the_parts_that_a_case_lacks_are_not_made_up(dry, clear):
    assert not dry.has_liquid
    assert "pressure_gradient" not in dry.diagnostics
    assert not clear.has_solids
    assert clear.summary["solids_count"] == 0


def test_clear_water_loses_the_pressure_of_an_independent_formula(clear):
    friction = fluids.friction_factor(Re=1e5, Method="Colebrook")
    loss = friction * WATER["density"] / 2 / 0.1
    assert clear.pressure_gradient == pytest.approx(loss, rel=1e-5)
    assert clear.summary["pressure_gradient"] == pytest.approx(loss, rel=1e-5)


def test_backward_flow_loses_pressure_backwards(clear, tmp_path):
    back = Simulation(case(solids=None, liquid=WATER | {"bulk_velocity": -1.0}), tmp_path).run()
    np.testing.assert_allclose(back.pressure_gradient, -clear.pressure_gradient)


def test_a_velocity_too_small_to_square_ends_in_a_summary_all_the_same(tmp_path):
    nearly = WATER | {"model": "eulerian", "bulk_velocity": 1e-180}
    summary = Simulation(case(solids=None, liquid=nearly, end_time=0.02), tmp_path).run().summary
    assert summary["status"] == "finished"


def test_a_riser_carries_the_submerged_weight_of_its_solids(tmp_path):
    """Once the solids have settled to a speed, the liquid bears their weight less buoyancy."""
    riser = case(
        end_time=3.0,
        pipe={"radius": 0.05, "length": 0.5, "inclination": "90 deg"},
        liquid=WATER | {"bulk_velocity": 2.0},
        output={"every": 0.1, "figures": False},
    )
    summary = Simulation(riser, tmp_path).run().summary
    friction = fluids.friction_factor(Re=2e5, Method="Colebrook")
    clear = friction * 1000.0 * 2.0**2 / 2 / 0.1
    weight = summary["insitu_concentration"] * 1500.0 * 9.807  # [Pa/m]
    assert summary["pressure_gradient"] - clear == pytest.approx(weight, rel=0.02)
    assert summary["pressure_gradient_static"] == pytest.approx(1000.0 * 9.807)


def test_solids_that_weigh_as_much_as_the_liquid_travel_with_it(tmp_path):
    floating = case(end_time=4.0, solids=BEADS | {"density": 1000.0, "friction": 0.0})
    results = Simulation(floating, tmp_path).run()
    slip = results.solids.liquid_velocity[-1] - results.solids.velocity[-1]
    assert np.abs(slip).max() < 0.05
    assert results.summary["delivered_concentration"] == pytest.approx(
        results.summary["insitu_concentration"], rel=0.2
    )


@pytest.mark.parametrize("kind", ["both", "dry"])
def test_gravity_drag_and_walls_explain_all_momentum(kind, request):
    assert request.getfixturevalue(kind).summary["momentum_error"] < 1e-12


def test_a_solid_in_free_fall_gains_speed_as_gravity_says(tmp_path):
    alone = {"kind": "list", "positions": [[0.1, 0.0, 0.04]]}
    solids = {name: BEADS[name] for name in ("diameter", "density", "youngs_modulus")}
    falling = case(liquid=None, solids=solids | {"arrangement": alone}, end_time=0.08)
    results = Simulation(falling, tmp_path).run()
    np.testing.assert_allclose(results.solids.velocity[:, 0, 2], -9.807 * results.time, rtol=1e-12)


def test_the_number_of_threads_changes_no_bit(tmp_path):
    one, two = (
        Simulation(
            case(fidelity={"level": "quick", "threads": threads}), tmp_path / str(threads)
        ).run()
        for threads in (1, 2)
    )
    assert np.array_equal(one.solids.position[:], two.solids.position[:])
    assert np.array_equal(one.solids.void_fraction[:], two.solids.void_fraction[:])


def test_results_are_not_replaced_unasked(tmp_path):
    Simulation(case(solids=None), tmp_path).run()
    before = (tmp_path / "results.h5").read_bytes()
    with pytest.raises(OutputError, match=r"holds results already.*overwrite"):
        Simulation(case(), tmp_path).run()
    assert (tmp_path / "results.h5").read_bytes() == before
    assert Simulation(case(), tmp_path, overwrite=True).run().has_solids


def test_a_case_that_cannot_be_placed_leaves_old_results_alone(tmp_path):
    Simulation(case(solids=None), tmp_path).run()
    twice = {"kind": "list", "positions": [[0.1, 0.0, 0.0], [0.1, 0.0, 0.001]]}
    solids = {name: BEADS[name] for name in ("diameter", "density", "youngs_modulus")}
    with pytest.raises(ValueError, match="overlap"):
        Simulation(case(solids=solids | {"arrangement": twice}), tmp_path, overwrite=True).run()
    assert not Results(tmp_path).has_solids


def test_two_runs_do_not_share_a_directory(tmp_path):
    with DirectoryLock(tmp_path), pytest.raises(LockError, match="in use"):
        Simulation(case(), tmp_path).run()


def test_a_path_through_a_file_is_refused_with_the_path_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="file"):
        Simulation(case(), tmp_path / "file" / "out").run()


def test_a_path_may_have_spaces_and_letters_of_any_kind(tmp_path):
    results = Simulation(case(), tmp_path / "Förder leitung 管").run()
    assert json.loads((results.directory / "summary.json").read_text())["status"] == "finished"


def test_the_default_directory_tells_of_the_title(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    results = Simulation(case(title="Clear: 1 m/s", solids=None)).run()
    assert str(results.directory) == "out/clear_1_m_s"


def test_a_diverged_run_names_the_solid_and_keeps_what_was_sound(tmp_path):
    """A spring judged by a far too low speed lets a solid through the wall."""
    solids = {name: BEADS[name] for name in ("diameter", "density", "youngs_modulus")} | {
        "contact": "linear_spring",
        "impact_speed": 0.01,
        "arrangement": {
            "kind": "list",
            "positions": [[0.1, 0.0, 0.0], [0.2, 0.0, 0.0]],
            "velocities": [[0.0, 0.0, 0.0], [0.0, 1e4, 0.0]],
        },
    }
    with pytest.raises(SimulationDiverged, match="solid 1 is out of bounds") as caught:
        Simulation(case(liquid=None, solids=solids), tmp_path).run()
    assert caught.value.solid == 1
    results = Results(tmp_path)
    assert results.summary["status"] == "diverged"
    assert np.isfinite(results.solids.position[:]).all()


@pytest.mark.parametrize("model", ["eulerian", "profile"])
def test_a_run_that_is_finite_and_absurd_is_stopped_and_keeps_its_frames(
    model, tmp_path, monkeypatch
):
    """As a bed does that swings against its liquid: here by a bound below what is sound."""
    monkeypatch.setattr("mpsdem.stages.build.absurd_speed", lambda _case: 0.4)
    whose = "solids" if model == "profile" else "liquid"
    moving = BEADS | {"arrangement": {"kind": "random", "velocity": [0.39, 0.0, 0.0]}}
    scene = case(solids=moving, liquid=WATER | {"model": model}, end_time=0.5)
    with pytest.raises(
        SimulationDiverged, match=rf"mean speed, .* of the {whose} is out of bounds"
    ):
        Simulation(scene, tmp_path).run()
    assert Results(tmp_path).summary["status"] == "diverged"


def test_a_checkpoint_of_another_case_is_refused_with_the_keys_that_differ(tmp_path):
    Simulation(case(), tmp_path).run()
    heavier = case(solids=BEADS | {"density": 3000.0})
    (tmp_path / "case.toml").write_text(heavier.to_toml())
    with pytest.raises(CheckpointError, match=r"solids\.density"):
        Simulation.resume(tmp_path).run()


def _lost(part, name):
    del part[name]


def _of_another_type(part, name):
    part[name] = "of another version"


def _of_another_size(part, name):
    part[name] = np.zeros((2, 2, 2), dtype=np.float32)


def _unknown(part, name):
    part[f"{name}_of_old"] = part.pop(name)


@pytest.mark.parametrize("change", [_lost, _of_another_type, _of_another_size, _unknown])
@pytest.mark.parametrize(
    ("part", "model"),
    [("solids", "profile"), ("stages", "profile"), ("spent", "profile"), ("liquid", "eulerian")],
)
def test_a_state_of_another_version_is_refused_in_words(change, part, model, tmp_path):
    """Whole and unharmed, but not what this version keeps: a crash would be no help."""
    resumed = case(liquid=WATER | {"model": model}, end_time=0.02)
    Simulation(resumed, tmp_path).run()
    path = tmp_path / "checkpoint.h5"
    checkpoint = read_checkpoint(path)
    for name in sorted(checkpoint.state[part]):
        state = checkpoint.state | {part: dict(checkpoint.state[part])}
        change(state[part], name)
        write_checkpoint(
            path,
            case_toml=checkpoint.case_toml,
            time=checkpoint.time,
            step=checkpoint.step,
            state=state,
        )
        with pytest.raises(CheckpointError, match="this version"):
            Simulation.resume(tmp_path).run()


def test_a_finished_run_can_be_given_more_time(tmp_path):
    Simulation(case(end_time=0.06), tmp_path / "two runs").run()
    longer = case(end_time=0.1)
    (tmp_path / "two runs" / "case.toml").write_text(longer.to_toml())
    continued = Simulation.resume(tmp_path / "two runs").run()
    whole = Simulation(longer, tmp_path / "one run").run()
    assert np.array_equal(continued.solids.position[:], whole.solids.position[:])


def test_a_checkpoint_between_the_steps_of_a_changed_output_is_refused(tmp_path):
    Simulation(case(), tmp_path).run()
    (tmp_path / "case.toml").write_text(case(output={"every": 0.03}).to_toml())
    with pytest.raises(CheckpointError, match="former values"):
        Simulation.resume(tmp_path).run()


def test_where_there_is_no_terminal_the_log_tells_how_far_the_run_is(tmp_path, caplog):
    with caplog.at_level(logging.INFO, logger="mpsdem"):
        Simulation(case(), tmp_path).run()
    told = [message for message in caplog.messages if "simulated s per s" in message]
    assert 5 <= len(told) <= 11


def test_report_and_figures_are_made_where_the_case_wants_them(tmp_path, monkeypatch):
    monkeypatch.setattr(Figure, "savefig", blank)
    Simulation(case(output={"every": 0.02, "figures": True}), tmp_path).run()
    assert len(list((tmp_path / "figures").glob("*.png"))) > 3
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["status"] == "finished"


def test_every_mean_of_the_summary_has_its_error_and_says_if_the_run_is_too_short(both, clear):
    for summary in (both.summary, clear.summary):
        averages = summary["averages"]
        assert {"bulk_velocity", "pressure_gradient", "dissipation"} <= set(averages)
        for name, average in averages.items():
            assert average["mean"] == pytest.approx(summary[name])
            assert average["window"] == pytest.approx([0.06, 0.1])
    assert {"solids_mean_velocity", "delivered_concentration"} <= set(both.summary["averages"])
    assert not both.summary["averages"]["solids_mean_velocity"]["long_enough"]
    assert any("too short for the mean of" in warning for warning in both.summary["warnings"])
    assert not any("too short" in warning for warning in clear.summary["warnings"])


PLUG = {
    "end_time": 2.0,
    "pipe": {"radius": 0.02, "length": 0.08},
    "liquid": WATER | {"bulk_velocity": 0.2},
    "solids": BEADS | {"count": 95, "youngs_modulus": 1e6, "friction": 0.8},
}


def blocked(directory, on_plug):
    """Solids that fill half of a narrow pipe, which is as many as lie there at rest."""
    output = {"every": 0.2, "figures": False, "on_plug": on_plug}
    return Simulation(case(**PLUG, output=output), directory).run()


def test_a_pipe_that_solids_fill_and_stand_in_is_plugged_and_the_run_ends_if_told_to(tmp_path):
    results = blocked(tmp_path, "stop")
    summary = results.summary
    assert summary["status"] == "plug"
    assert summary["time"] == results.time[-1] < 2.0
    assert summary["plug_time"] <= summary["time"] - 1.0  # five diameters at 0.2 m/s
    assert 0 < summary["plug_position"] < 0.08
    assert any("a plug" in warning for warning in summary["warnings"])
    again = Simulation.resume(tmp_path).run()
    assert (again.summary["status"], again.time[-1]) == ("plug", results.time[-1])


def test_a_plug_is_only_a_warning_by_default(tmp_path):
    summary = blocked(tmp_path, "warn").summary
    assert (summary["status"], summary["time"]) == ("finished", 2.0)
    assert 0.2 <= summary["plug_time"] <= 0.6


def test_solids_that_are_carried_along_are_no_plug(both):
    assert both.summary["plug_time"] is None
    assert "no plug" in both.summary["not_applicable"]["plug_time"]
