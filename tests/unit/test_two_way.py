"""A liquid that feels its solids: when, why, and what the time loop gives to whom."""

import signal
from contextlib import contextmanager, suppress
from types import SimpleNamespace

import numpy as np
import pytest

from mpsdem import Simulation, SimulationDiverged, SimulationInterrupted
from mpsdem._core import coupling, dem
from mpsdem.case import Case, CaseError
from mpsdem.plan import make_plan
from mpsdem.results import SUMMARY_KEYS
from mpsdem.simulation import run as time_loop

WATER = {"density": 1000.0, "kinematic_viscosity": 1e-6, "bulk_velocity": 1.0}
BEADS = {
    "diameter": 0.01,
    "density": 2500.0,
    "youngs_modulus": 1e7,
    "count": 20,  # 3 parts in 1000 of the bore
    "arrangement": {"kind": "random"},
}


def case(*, liquid=(), solids=(), **parts):
    parts = {
        "end_time": 0.04,
        "pipe": {"radius": 0.05, "length": 0.4},
        "fidelity": {"level": "quick"},
        "output": {"every": 0.02, "figures": False},
    } | parts
    return Case(liquid=WATER | dict(liquid), solids=BEADS | dict(solids), **parts)


def run_case(*, solids=(), **parts):
    """A case that is run, of a liquid of particles."""
    return case(liquid={"model": "lagrangian"}, solids=solids, **parts)


def names(stages):
    return [stage.name for stage in stages]


def reason(plan, name):
    (found,) = [s.reason for s in (*plan.stages, *plan.left_out) if s.name == name]
    return found


def number(plan, name):
    (found,) = [n for n in plan.numbers if n.name == name]
    return found


# The plan


def test_the_liquid_moves_after_the_solids_have_told_what_it_gave_them():
    plan = make_plan(case())
    assert names(plan.stages) == [
        "SampleLiquid",
        "FindVoidFraction",
        "DragForce",
        "AdvanceSolids",
        "ExchangeMomentum",
        "AdvanceLiquid",
        "Record",
    ]
    assert plan.two_way
    assert "fill 0.0033 of the bore, above 0.001" in reason(plan, "ExchangeMomentum")
    assert f"once in {plan.turns_per_liquid_step} turns" in reason(plan, "ExchangeMomentum")
    assert "it feels the solids" in reason(plan, "AdvanceLiquid")


@pytest.mark.parametrize("model", ["eulerian", "lagrangian"])
def test_a_computed_liquid_feels_solids_that_are_not_dilute(model):
    assert make_plan(case(liquid={"model": model})).two_way
    assert not make_plan(case(liquid={"model": model}, solids={"count": 5})).two_way


def test_a_profile_that_solids_would_change_is_computed_instead():
    assert make_plan(case()).liquid_model == "eulerian"
    assert make_plan(case(solids={"count": 5})).liquid_model == "profile"
    assert make_plan(case(fidelity={"coupling": "one-way"})).liquid_model == "profile"


def test_what_does_not_fit_a_computed_liquid_stays_a_profile_and_is_warned_of():
    short = make_plan(case(pipe={"radius": 0.05, "length": 0.04}, solids={"count": 2}))
    assert short.liquid_model == "profile"
    assert any("carried too fast" in warning for warning in short.warnings)


def test_two_way_coupling_may_be_asked_for_however_few_the_solids_are():
    plan = make_plan(case(solids={"count": 1}, fidelity={"coupling": "two-way"}))
    assert plan.two_way
    assert plan.liquid_model == "eulerian"
    assert "as was asked for" in reason(plan, "ExchangeMomentum")


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"fidelity": {"coupling": "one-way"}, "liquid": {"model": "eulerian"}}, "asked for"),
        ({"liquid": {"model": "profile"}}, "prescribed profile does not feel"),
        ({"liquid": {"model": "eulerian"}, "solids": {"count": 5}}, "no more than 0.001"),
        ({"pipe": {"radius": 0.05, "length": 0.4, "ends": "push-plate", "stroke": 0.05}}, "plate"),
    ],
)
def test_what_a_liquid_does_not_feel_is_said_with_the_reason(changes, why):
    plan = make_plan(case(**changes))
    assert why in reason(plan, "ExchangeMomentum")
    assert "ExchangeMomentum" not in names(plan.stages)


def test_only_where_the_liquid_feels_nothing_are_solids_carried_too_fast():
    one_way, two_way = (
        " ".join(make_plan(case(fidelity={"coupling": coupling})).warnings)
        for coupling in ("one-way", "two-way")
    )
    assert "carried too fast" in one_way
    assert "carried too fast" not in two_way


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"liquid": {"model": "profile"}}, "a prescribed profile feels no solids; set liquid.mod"),
        (
            {"pipe": {"radius": 0.05, "length": 0.4, "ends": "push-plate", "stroke": 0.05}},
            "a liquid that a push plate moves feels no solids; set pipe.ends = 'periodic'",
        ),
    ],
)
def test_a_coupling_that_cannot_be_is_refused_with_a_remedy(changes, said):
    with pytest.raises(CaseError) as refusal:
        case(**changes, fidelity={"coupling": "two-way"})
    assert f"fidelity.coupling = 'two-way': {said}" in str(refusal.value)


def test_a_coupling_of_one_part_alone_is_refused():
    with pytest.raises(CaseError, match=r"fidelity\.coupling.*needs \[liquid\] and \[solids\]"):
        case(fidelity={"coupling": "two-way"}).with_(solids=None)


def test_the_exchange_reaches_as_far_as_solids_and_liquid_need():
    wide = make_plan(case(solids={"diameter": 0.02, "count": 4}))
    assert wide.smoothing_radius == pytest.approx(0.05)
    fine = make_plan(case(solids={"diameter": 0.004, "count": 400}))
    assert fine.smoothing_radius == pytest.approx(3 * 0.01)


@pytest.mark.parametrize(
    ("solids", "radius", "said"),
    [
        ({"diameter": 0.02, "count": 4}, 0.025, "must be >= 0.03 m, 1.5 largest diameters"),
        ({"diameter": 0.004, "count": 400}, 0.015, "must be >= 0.02 m, two spacings"),
    ],
)
def test_an_exchange_that_would_be_noise_is_refused(solids, radius, said):
    narrow = case(solids=solids, fidelity={"level": "quick", "smoothing_radius": radius})
    with pytest.raises(CaseError, match=rf"fidelity\.smoothing_radius = {radius}.*{said}"):
        make_plan(narrow)
    one_way = {"coupling": "one-way"}
    make_plan(narrow.with_(fidelity=one_way, solids={"drag": "schiller_naumann"}))
    if "diameters" in said:  # and so would the void fraction be
        with pytest.raises(CaseError, match=r"1\.5 largest diameters"):
            make_plan(narrow.with_(fidelity=one_way))


def test_solids_that_stir_a_liquid_at_rest_bring_eddies_into_the_plan():
    plan = make_plan(case(liquid={"model": "lagrangian", "bulk_velocity": 0.0}))
    assert "mixing length" in reason(plan, "AdvanceLiquid")
    assert "the solids stir the liquid" in reason(plan, "AdvanceLiquid")
    assert "turbulence" not in names(plan.left_out)
    held = make_plan(
        case(liquid={"model": "lagrangian", "bulk_velocity": 0.0}, solids={"held": True})
    )
    assert "laminar" in reason(held, "AdvanceLiquid")
    assert "turbulence" in names(held.left_out)


def test_a_liquid_step_is_a_whole_number_of_turns_and_a_turn_of_solid_steps():
    plan = make_plan(case(fidelity={"level": "balanced", "coupling_step": 3e-4}))
    assert plan.turns_per_liquid_step > 1
    assert plan.liquid_step.value == plan.turns_per_liquid_step * plan.coupling_step.value
    assert plan.coupling_step.value == plan.clock.substeps * plan.solid_step.value
    assert plan.clock.steps_per_frame % plan.turns_per_liquid_step == 0


def test_light_solids_carry_liquid_along_and_heavy_ones_do_not():
    light, heavy = make_plan(case(solids={"density": 1500.0})), make_plan(case())
    assert light.added_mass
    assert "carry half their volume of it along" in reason(light, "DragForce")
    assert not heavy.added_mass
    assert "2.5 times as dense" in reason(heavy, "added mass")
    assert make_plan(case(fidelity={"added_mass": "on"})).added_mass
    off = make_plan(case(solids={"density": 1500.0}, fidelity={"added_mass": "off"}))
    assert reason(off, "added mass") == "switched off"


def test_a_viscous_liquid_damps_impacts():
    water, oil = make_plan(case()), make_plan(case(liquid={"kinematic_viscosity": 1e-4}))
    assert not water.lubrication
    assert "above 100" in reason(water, "lubrication")
    stokes = number(oil, "Stokes number of impacts")
    assert stokes.value == pytest.approx(2.5 * 1.0 * 0.01 / (9 * 1e-4))
    assert oil.lubrication
    assert "the liquid between damps them" in stokes.meaning
    assert "damps impacts" in reason(oil, "AdvanceSolids")
    assert any("lubrication" in limit.name for limit in oil.solid_step.limits)
    assert not make_plan(case(fidelity={"lubrication": "off"})).lubrication


def test_a_step_that_lubrication_bounds_is_one_that_the_solids_take(tmp_path):
    """A ball in syrup drops on the wall and stays: little is left of a restitution of 0.9."""
    still = Case(
        end_time=0.5,
        pipe={"radius": 0.05, "length": 0.4},
        liquid={"density": 1000.0, "kinematic_viscosity": 5e-4, "bulk_velocity": 0.0},
        solids={
            "diameter": 0.01,
            "density": 2500.0,
            "youngs_modulus": 1e6,
            "arrangement": {"kind": "list", "positions": [[0.1, 0.0, -0.04]]},
        },
        fidelity={"rayleigh_fraction": 0.5},
        output={"every": 0.01, "figures": False},
    )
    plan = make_plan(still)
    assert "lubrication" in plan.solid_step.binding.name
    results = Simulation(still, tmp_path).run(bar=False)
    upwards = results.solids.velocity[:, 0, 2]
    assert 0 < upwards.max() < -0.2 * upwards.min()
    assert results.solids.position[-1, 0, 2] == pytest.approx(-0.045, abs=2e-4)


def test_held_solids_take_no_steps():
    plan = make_plan(case(solids={"held": True}))
    assert "AdvanceSolids" not in names(plan.stages)
    assert "ExchangeMomentum" in names(plan.stages)
    assert plan.solid_step is None
    assert plan.turns_per_liquid_step == 1
    alone = make_plan(case(liquid={"model": "profile"}, solids={"held": True}))
    assert names(alone.stages)[-2:] == ["HoldSolids", "Record"]


@pytest.mark.parametrize(
    ("solids", "said"),
    [
        ({"arrangement": {"kind": "random", "velocity": [1.0, 0.0, 0.0]}}, "start at rest"),
        ({}, "without a liquid nothing moves"),
    ],
)
def test_held_solids_that_make_no_sense_are_refused(solids, said):
    liquid = WATER if solids else None
    with pytest.raises(CaseError, match=rf"solids\.held = True: .*{said}"):
        case(solids=BEADS | solids | {"held": True}).with_(liquid=liquid)


# The time loop


class Told:
    """What exchange and solids are told, step after step, and what the solids answer."""

    def __init__(self):
        self.begun, self.given, self.turns = [], [], []


@pytest.fixture
def told(monkeypatch):
    told = Told()

    class Exchange(coupling.Exchange):
        def begin(self, liquid, *, position, radius):
            told.begun.append(position)
            super().begin(liquid, position=position, radius=radius)

        def give(self, **parts):
            told.given.append(parts)
            super().give(**parts)

    class Moving(dem.Solids):
        def set_forcing(self, **parts):
            self.forcing = parts
            super().set_forcing(**parts)

        def advance(self, dt, steps):
            report = super().advance(dt, steps)
            told.turns.append((self.forcing, self.drag_impulse, self.mean_velocity))
            return report

    monkeypatch.setattr(coupling, "Exchange", Exchange)
    monkeypatch.setattr(dem, "Solids", Moving)
    return told


def test_the_liquid_gets_back_in_a_step_what_it_gave_in_all_its_turns(told, tmp_path):
    simulation = Simulation(run_case(), tmp_path)
    turns, clock = simulation.plan.turns_per_liquid_step, simulation.plan.clock
    assert turns > 1
    simulation.run(bar=False).close()
    assert len(told.turns) == clock.steps
    assert len(told.given) == clock.steps // turns
    assert len(told.begun) == 1 + clock.steps // turns  # the first is for the frame at time 0
    mass = 2500.0 * np.pi / 6 * 0.01**3
    for k, given in enumerate(told.given):
        forcing, impulse, velocity = zip(*told.turns[k * turns : (k + 1) * turns], strict=True)
        drag = mass * np.mean([parts["drag_rate"] for parts in forcing], axis=0)
        np.testing.assert_allclose(given["impulse"], np.sum(impulse, axis=0), rtol=1e-12)
        np.testing.assert_allclose(given["mean_velocity"], np.mean(velocity, axis=0), rtol=1e-12)
        np.testing.assert_allclose(given["drag"], drag, rtol=1e-12)
        assert given["duration"] == pytest.approx(turns * clock.length(1), rel=1e-12)
        assert np.array_equal(given["position"], told.begun[k + 1])


def test_the_liquid_around_a_solid_changes_from_turn_to_turn(told, tmp_path):
    simulation = Simulation(run_case(), tmp_path)
    turns = simulation.plan.turns_per_liquid_step
    simulation.run(bar=False).close()
    around = [forcing["liquid_velocity"] for forcing, _, _ in told.turns[:turns]]
    slower = [here[:, 0].mean() for here in around]  # solids at rest hold it back
    assert np.all(np.diff(slower) < 0)
    assert all(np.all(forcing["relaxation"] > 0) for forcing, _, _ in told.turns)


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


@pytest.mark.parametrize("stop", [1, 5, 7, 18])
@pytest.mark.parametrize("held", [False, True])
def test_a_stop_within_a_step_of_the_liquid_leaves_no_trace(stop, held, tmp_path):
    scene = run_case(solids={"held": held})
    with Simulation(scene, tmp_path / "whole").run(bar=False) as whole:
        with stop_after(stop), suppress(SimulationInterrupted):
            Simulation(scene, tmp_path / "stopped").run(bar=False)
        with Simulation.resume(tmp_path / "stopped").run(bar=False) as stopped:
            for name in ("position", "velocity", "liquid_velocity", "drag_force"):
                there = getattr(whole.solids, name)[:]
                assert np.array_equal(getattr(stopped.solids, name)[:], there), name
            for name, values in whole.diagnostics.items():
                assert np.array_equal(stopped.diagnostics[name], values), name
            took = {"wall_seconds", "cpu_seconds"}
            assert {k: v for k, v in stopped.summary.items() if k not in took} == {
                k: v for k, v in whole.summary.items() if k not in took
            }


@pytest.mark.parametrize("held", [False, True])
def test_the_summary_has_every_key_and_a_reason_where_it_has_no_value(held, tmp_path):
    summary = Simulation(run_case(solids={"held": held}), tmp_path).run(bar=False).summary
    assert set(SUMMARY_KEYS) <= set(summary)
    empty = {name for name, value in summary.items() if value is None}
    assert empty == set(summary["not_applicable"])
    assert summary["coupling"] == "two-way"
    assert 0 < summary["exchange_error"] < 1e-12
    assert summary["mass_error"] < 0.01
    assert summary["liquid_void_fraction_clipped"] == 0


def test_void_fractions_of_the_liquid_that_were_raised_are_counted(monkeypatch, tmp_path):
    monkeypatch.setattr(
        coupling, "Exchange", type("Clipping", (coupling.Exchange,), {"clipped": 3})
    )
    simulation = Simulation(run_case(), tmp_path)
    steps = simulation.plan.clock.steps // simulation.plan.turns_per_liquid_step
    summary = simulation.run(bar=False).summary
    assert summary["liquid_void_fraction_clipped"] == 3 * steps
    assert "void fractions of the liquid fell below the floor" in " ".join(summary["warnings"])


def test_the_drag_on_held_solids_is_what_the_exchange_gave_them(told, tmp_path):
    results = Simulation(run_case(solids={"held": True}), tmp_path).run(bar=False)
    assert told.turns == []
    for given in told.given:
        assert given["impulse"] is None
        assert not given["mean_velocity"].any()
    numbers = results.diagnostics
    assert np.array_equal(results.solids.position[-1], results.solids.position[0])
    assert numbers["drag_force"][-1, 0] == pytest.approx(
        results.solids.drag_force[-1, :, 0].sum(), rel=0.1
    )
    assert results.summary["solids_mean_velocity"] == 0


def test_held_solids_in_a_profile_cost_the_loss_of_their_drag(tmp_path):
    screen = case(liquid={"model": "profile"}, solids={"held": True, "drag": "schiller_naumann"})
    results = Simulation(screen, tmp_path).run(bar=False)
    expected = 0
    for u in results.solids.liquid_velocity[-1, :, 0]:
        expected += 0.44 * np.pi / 8 * 0.01**2 * 1000.0 * u**2  # Newton's regime
    assert results.diagnostics["drag_force"][-1, 0] == pytest.approx(expected, rel=0.05)
    loss = results.diagnostics["pressure_gradient_solids"][-1]
    assert loss * np.pi * 0.05**2 * 0.4 == pytest.approx(expected, rel=0.05)


def test_a_liquid_that_diverges_says_what_to_change(monkeypatch, tmp_path):
    class Bursting(coupling.Exchange):
        def advance(self, liquid, dt):
            report = super().advance(liquid, dt)
            names = [name for name in dir(report) if not name.startswith("_")]
            told = {name: getattr(report, name) for name in names}
            return SimpleNamespace(**told | {"sound": False})

    monkeypatch.setattr(coupling, "Exchange", Bursting)
    with pytest.raises(SimulationDiverged, match=r"smaller fidelity\.liquid_step, or a larger"):
        Simulation(run_case(), tmp_path).run(bar=False)


# Ledgers


@pytest.mark.parametrize("coupling", ["one-way", "two-way"])
def test_the_loss_of_pressure_is_that_of_walls_and_solids(coupling, tmp_path):
    """And of what slows the liquid down, as solids that gain speed take more of the flux."""
    scene = run_case(fidelity={"level": "quick", "coupling": coupling}, end_time=0.1)
    results = Simulation(scene, tmp_path).run(bar=False)
    numbers = results.diagnostics
    parts = numbers["pressure_gradient_friction"] + numbers["pressure_gradient_solids"]
    if coupling == "two-way":
        share = results.summary["insitu_concentration"]
        faster = np.diff(numbers["solids_mean_velocity"]) / np.diff(results.time)
        parts[1:] -= 1000.0 * share * faster
    assert numbers["pressure_gradient"][2:] == pytest.approx(parts[2:], rel=0.02)
    assert np.all(numbers["pressure_gradient_solids"][1:] > 10)
    assert results.summary["momentum_error"] < 0.01


def test_what_a_pump_puts_in_is_lost_or_moves_and_lifts_the_solids(tmp_path):
    """In a riser of a prescribed liquid, whose own loss is that of its friction."""
    riser = case(
        liquid={"model": "profile", "bulk_velocity": 2.0},
        pipe={"radius": 0.05, "length": 0.4, "inclination": "90 deg"},
        end_time=0.2,
    )
    results = Simulation(riser, tmp_path).run(bar=False)
    numbers, length = results.diagnostics, 0.4
    volume, mass = 20 * np.pi / 6 * 0.01**3, 2500.0 * 20 * np.pi / 6 * 0.01**3
    rise = results.solids.unwrapped_position[:, :, 0].mean(axis=1)
    stored = numbers["kinetic_energy"] + numbers["elastic_energy"] + 1500.0 * volume * 9.807 * rise
    gained = np.diff(stored) / np.diff(results.time) / length
    section = np.pi * 0.05**2
    np.testing.assert_allclose(
        numbers["power_input"], 2.0 * section * results.pressure_gradient, rtol=1e-12
    )
    np.testing.assert_allclose(
        numbers["dissipation"][1:], numbers["power_input"][1:] - gained, rtol=1e-9
    )
    assert np.all(numbers["dissipation"] > 0)
    assert mass * 9.807 * 0.6 * np.diff(rise)[-1] > 0


def test_sections_hold_all_the_solids_and_their_flow(tmp_path):
    results = Simulation(run_case(), tmp_path).run(bar=False)
    solids = results.solids
    fraction, velocity = solids.section_fraction[-1], solids.section_velocity[-1]
    assert len(solids.section_position) == len(fraction) == 8
    assert fraction.mean() == pytest.approx(results.summary["insitu_concentration"])
    assert np.array_equal(np.isnan(velocity), fraction == 0)
    flow = np.nansum(fraction * velocity) / fraction.sum()
    assert flow == pytest.approx(solids.velocity[-1, :, 0].mean())
    here = solids.position[-1, :, 0] // 0.05 == 3
    assert fraction[3] * np.pi * 0.05**2 * 0.05 == pytest.approx(here.sum() * np.pi / 6 * 0.01**3)


def test_drags_beyond_their_law_are_counted(tmp_path):
    """Schiller and Naumann's goes up to a Reynolds number of 2e5; here it is 6e5."""
    stiff = {"drag": "schiller_naumann", "youngs_modulus": 1e9}  # impacts at 60 m/s
    scene = case(solids=stiff, liquid={"bulk_velocity": 60.0})
    scene = scene.with_(end_time=1e-3, output={"every": 1e-3}, liquid={"model": "profile"})
    summary = Simulation(scene, tmp_path).run(bar=False).summary
    assert summary["drag_outside"] > 0.9
    assert "outside the range of schiller_naumann" in " ".join(summary["warnings"])


def test_a_light_sphere_lifts_half_its_volume_of_liquid_with_it(tmp_path):
    """In liquid at rest it starts with (rho - rho_s) g / (rho_s + rho / 2)."""
    ball = {"diameter": 0.01, "density": 500.0, "youngs_modulus": 1e6}
    alone = {"kind": "list", "positions": [[0.1, 0.0, 0.0]]}
    still = Case(
        end_time=1e-3,
        pipe={"radius": 0.05, "length": 0.4},
        liquid=WATER | {"bulk_velocity": 0.0},
        solids=ball | {"arrangement": alone},
        output={"every": 1e-3, "figures": False},
    )
    results = Simulation(still, tmp_path).run(bar=False)
    expected = 500.0 * 9.807 / 1000.0 * 1e-3
    assert results.solids.velocity[-1, 0, 2] == pytest.approx(expected, rel=1e-2)
    assert results.summary["momentum_error"] is None or results.summary["momentum_error"] < 1e-9
