"""Speed against accuracy: what is run, how runs are compared, and what is chosen by it."""

import itertools
import json
import math

import numpy as np
import pytest
from typer.testing import CliRunner

from mpsdem.case import Case, CaseError
from mpsdem.cli import app
from mpsdem.plan import make_plan
from mpsdem.results import MissingExtraError, OutputError
from mpsdem.trade import choose, front, seconds_of, share_of, trade
from mpsdem.trade.choice import candidates, errors_by_spacing, scene_of
from mpsdem.trade.document import document
from mpsdem.trade.machine import REFERENCE, Machine
from mpsdem.trade.outcome import Compared, Outcome, Row, as_json, from_json
from mpsdem.trade.quantities import Deviation, Series, applicable, deviation
from mpsdem.trade.report import percent
from mpsdem.trade.runs import Outcome as Run
from mpsdem.trade.scenes import SCENES
from mpsdem.trade.schedule import finest, make_schedule, shortened
from mpsdem.trade.settings import LeftOut, settings_of
from mpsdem.trade.table import Table, shipped_table
from mpsdem.trade.workers import InTurn, workers

WATER = {"density": 1000.0, "kinematic_viscosity": 1e-6, "bulk_velocity": 1.0}
CASE = Case(
    title="Short pipe",
    end_time=1.0,
    pipe={"radius": 0.05, "length": 0.4},
    liquid=WATER,
    solids={"diameter": 0.01, "density": 2500.0, "youngs_modulus": 1e7, "count": 30},
    fidelity={"level": "quick"},
    output={"every": 0.1, "figures": False},
)
PRESCRIBED = CASE.with_(end_time=0.1, output={"every": 0.05}, liquid={"model": "profile"})
DRY = CASE.with_(end_time=0.1, pipe={"inclination": "20 deg"}, liquid=None, output={"every": 0.05})
NAN = math.nan


def row(knob, value="", *, rate, error=0.0, bar=0.0, change=None, status="finished", number=0.0):
    errors = {"pressure_gradient": Deviation(value=error, bar=bar)} if status == "finished" else {}
    changes = {} if change is None else {"pressure_gradient": Deviation(value=change, bar=bar)}
    return Row(
        knob=knob, value=value, number=number, status=status, rate=rate, of_solids=0.5,
        planned=rate, errors=errors, changes=changes, reason="" if errors else "it blew up",
    )  # fmt: skip


def outcome(*rows, reference="level fine", exact=False, left_out=()):
    compared = Compared(unit="Pa/m", reference=80.0, bar=0.5, exact=exact)
    return Outcome(
        title="Made up", end_time=2.0, wanted=8.0, reference=reference, rows=rows,
        quantities={"pressure_gradient": compared}, left_out=tuple(left_out),
    )  # fmt: skip


# What is run


def test_no_two_settings_share_a_directory_and_each_turns_one_knob():
    settings, _ = settings_of(CASE)
    assert len({setting.name for setting in settings}) == len(settings)
    for setting in settings:
        turned = {line.split(":")[0] for line in CASE.differences(setting.case)}
        assert len(turned) <= 1, turned
    knobs = {setting.knob for setting in settings}
    assert knobs >= {"level", "liquid model", "particle spacing", "stiffness factor"}


def test_a_level_takes_out_what_a_level_sets():
    coarse = CASE.with_(fidelity={"particle_spacing": 0.012, "rayleigh_fraction": 0.3})
    fine = finest(settings_of(coarse)[0]).case.fidelity
    assert fine.particle_spacing is None
    assert fine.resolved_rayleigh_fraction < 0.1


def test_what_a_case_cannot_have_is_left_out_with_the_reason():
    pushed = CASE.with_(pipe={"ends": "push-plate", "length": 2.0}, liquid={"model": "lagrangian"})
    settings, left_out = settings_of(pushed)
    reasons = {out.setting: out.reason for out in left_out}
    assert "push plate" in reasons["liquid model eulerian"]
    assert "pressure tolerance" in {setting.knob for setting in settings}


def test_a_knob_that_changes_nothing_is_not_run():
    # the viscosity is the limit of this step, whatever the Courant number
    viscous = {"model": "lagrangian", "kinematic_viscosity": 1e-2}
    settings, left_out = settings_of(CASE.with_(solids=None, liquid=viscous))
    assert "Courant number" not in {setting.knob for setting in settings}
    assert any("changes nothing" in out.reason for out in left_out)


def schedule_of(rates, **limits):
    settings, _ = settings_of(CASE)
    rates = {s.name: rates(s) for s in settings}
    given = {"seconds": 100.0, "workers": 2, "longest": 34.0, "shortest": 4.0}
    return settings, rates, make_schedule(settings, rates, **given | limits)


def test_runs_fit_into_the_time_of_all_workers_and_the_reference_goes_first():
    settings, rates, schedule = schedule_of(lambda s: 5.0 if s.value == "fine" else 1.0)
    assert len(schedule.kept) == len(settings)
    assert schedule.cpu_seconds == pytest.approx(schedule.end_time * sum(rates.values()))
    assert schedule.cpu_seconds < 100.0 * 2
    assert schedule.kept[0] == finest(settings)


def test_no_run_lasts_longer_than_all_the_time_there_is():
    settings, rates, schedule = schedule_of(lambda s: 10.0 if s.value == "fine" else 0.01)
    assert schedule.end_time * max(rates.values()) < 100.0
    assert len(schedule.kept) == len(settings)


def test_a_level_that_takes_too_long_by_itself_is_left_out_and_the_knobs_stay():
    settings, _, schedule = schedule_of(lambda s: 50.0 if s.value == "fine" else 0.01)
    assert [out.setting for out in schedule.left_out] == ["level fine"]
    assert schedule.kept[0] == finest(schedule.kept) != finest(settings)


def test_runs_are_never_longer_than_the_case():
    _, _, schedule = schedule_of(lambda _: 1e-3)
    assert schedule.end_time == 34.0


def test_where_runs_would_be_too_short_the_dearest_knobs_are_left_out_and_named():
    settings, rates, schedule = schedule_of(
        lambda s: 50.0 if s.value == "lagrangian" else 20.0 if s.value == "D/20" else 1.0
    )
    assert schedule.end_time >= 4.0
    out = {o.setting for o in schedule.left_out}
    assert "liquid model lagrangian" in out
    assert len(out) + len(schedule.kept) == len(settings)
    kept = max(rates[s.name] for s in schedule.kept if s.knob not in ("as given", "level"))
    assert kept <= min(rates[s.name] for s in settings if str(s) in out)


def test_the_case_as_given_is_kept_though_there_is_no_time_at_all():
    _, _, schedule = schedule_of(lambda _: 1e6)
    assert {s.knob for s in schedule.kept} == {"as given", "level"}
    assert [s.value for s in schedule.kept if s.knob == "level"] == ["quick"]


# How runs are compared


def series(values):
    return Series(time=np.linspace(0, 8, len(values)), values=np.asarray(values, dtype=float))


def test_a_start_that_two_runs_share_is_not_taken_for_scatter():
    drift = np.exp(-np.linspace(0, 3, 200)) * 50 + 100
    off = deviation(series(1.02 * drift), series(drift))
    assert off.value == pytest.approx(0.02, rel=1e-6)
    alone = deviation(series(1.02 * drift), 100.0)
    assert off.bar < 0.1 * alone.bar


def test_a_run_that_is_lower_than_the_known_value_has_a_negative_error_whatever_its_sign():
    noise = np.random.default_rng(1).standard_normal(400)
    assert deviation(series(97 + noise), 100.0).value == pytest.approx(-0.03, abs=0.003)
    sinking = deviation(series(-97 + noise), -100.0)
    assert sinking.value == pytest.approx(0.03, abs=0.003)
    assert 0.0003 < sinking.bar < 0.003  # a hundredth over the root of 200


def test_what_lies_within_two_error_bars_is_not_resolved():
    assert not Deviation(value=0.01, bar=0.006).resolved
    assert Deviation(value=-0.02, bar=0.006).resolved
    assert Deviation(value=0.001, bar=0.006).size == 0.006


def test_a_run_that_still_drifts_says_that_its_error_bar_is_too_small():
    rising = series(np.linspace(90, 110, 60) + np.random.default_rng(2).standard_normal(60))
    assert not deviation(rising, 100.0).sure
    assert "?" in percent(deviation(rising, 100.0))
    level = series(100 + np.random.default_rng(2).standard_normal(400))
    assert deviation(level, 100.0).sure


def test_a_relative_error_of_nothing_is_unknown():
    assert math.isnan(deviation(series(np.ones(50)), 0.0).value)


def test_quantities_that_mean_nothing_in_a_case_are_not_asked_for():
    assert applicable(CASE.with_(solids=None)) == ["pressure_gradient"]
    upright = CASE.with_(pipe={"inclination": "90 deg"})
    assert "bed_height" not in applicable(upright)
    assert "bed_height" in applicable(CASE)


def test_nothing_on_the_front_is_beaten_and_all_else_is():
    generator = np.random.default_rng(3)
    rows = [
        row("k", str(k), rate=cost, error=error, bar=bar)
        for k, (cost, error, bar) in enumerate(generator.random((60, 3)) * [10, 0.1, 0.02])
    ]
    chosen = front(rows)

    def beats(one, other):
        return one.rate < other.rate and one.worst.size <= other.worst.size

    for one in chosen:
        assert not any(beats(other, one) for other in rows)
    for one in rows:
        if one not in chosen:
            assert any(beats(other, one) for other in chosen)
    assert [r.rate for r in chosen] == sorted(r.rate for r in chosen)


def test_a_difference_that_cannot_be_seen_buys_no_place_on_the_front():
    plain, noisy = row("a", rate=1, error=0.02), row("b", rate=2, error=0.001, bar=0.03)
    assert front([plain, noisy]) == [plain]


# What follows


def told(*rows, **options):
    return " ".join(outcome(*rows, **options).recommendation())


LEVELS = (
    row("as given", rate=10, error=0.02, bar=0.002),
    row("level", "quick", rate=1, error=0.08, bar=0.002),
    row("level", "balanced", rate=10, error=0.02, bar=0.002),
    row("level", "fine", rate=60),
)


def test_the_cheapest_setting_that_is_good_enough_is_recommended():
    said = told(*LEVELS, row("particle spacing", "D/12", rate=4, error=0.04, bar=0.002))
    assert said.startswith("Take particle spacing D/12: off by 4 ± 0.2 %, 15 times cheaper")


def test_the_reference_does_not_recommend_itself():
    assert told(LEVELS[1], LEVELS[3]).startswith("No setting comes within 5%; the nearest is level")


def test_the_finest_may_be_recommended_where_the_answer_is_known():
    assert told(LEVELS[1], LEVELS[3], exact=True).startswith("Take level fine")


def test_knobs_are_told_apart_by_what_they_cost_and_move():
    said = told(
        *LEVELS,
        row("stiffness factor", "0.1", rate=6, error=0.021, bar=0.002, change=0.001),
        row("coupling interval", "1 ms", rate=20, error=0.02, bar=0.002, change=0.001),
        row("liquid model", "profile", rate=0.5, error=0.4, bar=0.002, change=0.4),
        row("Courant number", "1.2", rate=8, status="diverged"),
    )
    assert (
        "Saves time and moves nothing beyond chance or 1 %: stiffness factor 0.1 (40% less)."
        in said
    )
    assert "Costs time and moves nothing beyond chance or 1 %: coupling interval 1 ms" in said
    assert "Moves the results: liquid model profile (40 ± 0.2 %, 0.05 times the cost)." in said
    assert "Courant number 1.2 diverges: it blew up" in said.replace("courant", "Courant")


def test_an_outcome_survives_its_file():
    whole = outcome(
        *LEVELS, row("Courant number", "1.2", rate=NAN, status="diverged"),
        left_out=[LeftOut(setting="x", reason="y")],
    )  # fmt: skip
    again = from_json(json.loads(json.dumps(as_json(whole), allow_nan=False)))
    assert again.front == whole.front
    assert again.recommendation() == whole.recommendation()
    assert again.left_out == whole.left_out


# Workers and runs


class Counting(InTurn):
    started: list[str]

    def __init__(self):
        super().__init__()
        self.started = []

    def start(self, name, case, directory):
        self.started.append(name)
        super().start(name, case, directory)


@pytest.fixture(scope="module")
def traded(tmp_path_factory):
    """A real trade, of dry solids that slide."""
    where = tmp_path_factory.mktemp("trade")
    return where, trade(DRY, where, cores=1)


def test_a_trade_leaves_table_figure_and_words(traded):
    where, found = traded
    names = {path.name for path in where.iterdir()}
    assert names >= {"trade.json", "trade.csv", "trade.md", "trade.png", "runs"}
    assert {r.knob for r in found.rows} >= {"as given", "level", "stiffness factor"}
    lines = (where / "trade.csv").read_text().splitlines()
    assert len(lines) == 1 + len(found.rows)
    assert len({line.count(",") for line in lines}) == 1
    assert all(r.rate > 0 for r in found.rows)
    assert found.recommendation()[0] in (where / "trade.md").read_text()


def test_the_case_as_given_and_its_own_level_are_one_run(traded):
    where, found = traded
    by_name = {str(r): r for r in found.rows}
    assert by_name["as given"].errors == by_name["level quick"].errors
    assert not (where / "runs" / "level_quick").exists()
    assert by_name["level quick"].changes["solids_mean_velocity"].value == 0


def test_a_trade_that_is_started_again_runs_nothing_twice(traded, monkeypatch):
    where, found = traded
    monkeypatch.setattr("mpsdem.trade.runs.Simulation", None)  # any run would fail
    assert as_json(trade(DRY, where, cores=1)) == as_json(found)


def test_another_case_is_refused_in_a_directory_that_holds_a_trade(traded):
    with pytest.raises(OutputError, match="another case"):
        trade(CASE, traded[0], cores=1)


def made_up_runs(monkeypatch, tmp_path, runs, tell, seconds=1000.0):
    """A trade of which all but the runs is real."""

    def carry_out(_case, directory):
        return runs(directory)

    monkeypatch.setattr("mpsdem.trade.trading.carry_out", carry_out)
    monkeypatch.setattr("mpsdem.trade.workers.carry_out", carry_out)
    monkeypatch.setattr("mpsdem.trade.trading.quantities_of", lambda *_: {})
    monkeypatch.setattr("mpsdem.trade.trading._no_such", lambda *_: "made up")
    return trade(PRESCRIBED, tmp_path, seconds=seconds, cores=1, tell=tell)


def test_a_run_that_diverges_is_an_outcome_with_its_reason(monkeypatch, tmp_path):
    def runs(directory):
        bad = "stiffness_factor_0.1" in directory
        status, reason = ("diverged", "velocity of solid 7") if bad else ("finished", "")
        return Run(status=status, cpu_seconds=1.0, wall_seconds=1.0, time=0.1, reason=reason)

    found = made_up_runs(monkeypatch, tmp_path, runs, lambda _: None)
    by_name = {str(r): r for r in found.rows}
    assert by_name["stiffness factor 0.1"].reason == "velocity of solid 7"
    assert by_name["stiffness factor 0.1"].errors == {}


def test_when_the_time_is_over_the_rest_is_named(monkeypatch, tmp_path):
    clock = itertools.count(0.0, 5.0)
    monkeypatch.setattr("mpsdem.trade.trading.time.monotonic", lambda: next(clock))

    def runs(_directory):
        return Run(status="finished", cpu_seconds=0.1, wall_seconds=1.0, time=0.1)

    found = made_up_runs(monkeypatch, tmp_path, runs, lambda _: None, seconds=12.0)
    late = [out for out in found.left_out if "start again" in out.reason]
    assert late
    assert found.rows


def test_a_scheduler_without_dask_is_refused(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    with pytest.raises(MissingExtraError, match="distributed"), workers("tcp://nowhere:1"):
        pass
    with workers() as crew:
        assert "distributed" in crew.said
        assert crew.count == 1


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_runs_side_by_side_give_the_same_errors_as_one_after_another(traded, tmp_path):
    pytest.importorskip("distributed")
    found = trade(DRY, tmp_path, cores=2)
    alone = {str(r): r.errors for r in traded[1].rows}
    assert {str(r): r.errors for r in found.rows} == alone


# What is chosen


def table_of(*rows, **options):
    """A table in which every scene looks alike."""
    made = outcome(*rows, **options)
    return Table(machine=REFERENCE, scenes=dict.fromkeys(SCENES, made))


SPACINGS = (
    row("particle spacing", "D/8", rate=1, error=0.12),
    row("level", "quick", rate=2, error=0.06),
    row("particle spacing", "D/12", rate=3, error=-0.07),
    row("level", "balanced", rate=5, error=0.01, bar=0.02),
    row("particle spacing", "D/20", rate=9, error=0.004),
    row("level", "fine", rate=20),
    row("liquid model", "profile", rate=0.5, error=0.3),
)
TABLE = table_of(*SPACINGS)


def test_a_coarser_spacing_never_promises_less_error():
    errors = errors_by_spacing(TABLE.scenes["case A"])
    sizes = [errors[across]["pressure_gradient"] for across in (8, 10, 12, 16, 20, 24)]
    assert sizes == [0.12, 0.07, 0.07, 0.02, 0.02, 0.02]  # nobody knows the finest's own


def test_where_the_answer_is_known_the_finest_promises_its_own_error():
    rows = [*SPACINGS[:5], row("level", "fine", rate=20, error=0.002)]
    errors = errors_by_spacing(outcome(*rows, exact=True))
    assert errors[24]["pressure_gradient"] == 0.002
    assert errors[10]["pressure_gradient"] == 0.06  # as measured, though 12 across is worse


def test_a_budget_buys_the_most_accurate_setting_that_it_pays():
    known = list(candidates(CASE, machine=REFERENCE, table=TABLE))
    for seconds in (0.5, 2.0, 5.0, 1000.0):
        if seconds < min(c.seconds for c in known):
            continue
        got = choose(CASE, seconds=seconds, machine=REFERENCE, table=TABLE)
        assert got.seconds <= seconds
        assert not any(c.error < got.error for c in known if c.seconds <= seconds)
    assert got.setting == "level fine"


def test_an_error_is_had_at_the_least_cost():
    known = list(candidates(CASE, machine=REFERENCE, table=TABLE))
    got = choose(CASE, error=0.05, machine=REFERENCE, table=TABLE)
    assert got.setting == "level balanced"
    assert got.seconds == min(c.seconds for c in known if c.error <= 0.05)
    assert choose(CASE, error=0.5, machine=REFERENCE, table=TABLE).plan.liquid_model == "profile"


def test_a_liquid_that_is_asked_for_stays():
    asked = CASE.with_(liquid={"model": "eulerian"})
    got = choose(asked, error=0.5, machine=REFERENCE, table=TABLE)
    assert got.plan.liquid_model == "eulerian"


def test_a_budget_that_pays_nothing_names_the_cheapest_and_its_cost():
    with pytest.raises(CaseError, match=r"cheapest setting, liquid model profile.* takes about"):
        choose(CASE, seconds=1e-3, machine=REFERENCE, table=TABLE)


def test_an_error_that_no_setting_has_names_the_best():
    with pytest.raises(CaseError, match=r"level balanced, is known to 2 % of pressure_gradient"):
        choose(CASE, error=1e-4, machine=REFERENCE, table=TABLE)


def test_no_error_is_promised_for_a_dry_case():
    dry = CASE.with_(liquid=None)
    assert choose(dry, seconds=1e6, machine=REFERENCE, table=TABLE).errors == {}
    with pytest.raises(CaseError, match="no scene of the table is like this case"):
        choose(dry, error=0.05, machine=REFERENCE, table=TABLE)


def test_a_machine_that_is_twice_as_slow_needs_twice_the_time():
    slow = Machine(solids=2 * REFERENCE.solids, liquid=2 * REFERENCE.liquid)
    fast = {c.setting: c for c in candidates(CASE, machine=REFERENCE, table=TABLE)}
    for other in candidates(CASE, machine=slow, table=TABLE):
        assert other.seconds == pytest.approx(2 * fast[other.setting].seconds)
        assert other.error == fast[other.setting].error


@pytest.mark.parametrize("name", SCENES)
def test_each_scene_is_the_most_like_itself(name):
    assert scene_of(SCENES[name]().case) == name


@pytest.mark.parametrize(("text", "seconds"), [("20 min", 1200.0), ("90", 90.0), ("1 h", 3600.0)])
def test_a_time_is_read_with_its_unit(text, seconds):
    assert seconds_of(text, "--time") == pytest.approx(seconds)


@pytest.mark.parametrize("text", ["5%", "5 %", "0.05"])
def test_a_share_is_read_in_percent_or_plain(text):
    assert share_of(text, "--error") == pytest.approx(0.05)


@pytest.mark.parametrize("text", ["-3 s", "soon", "3 m"])
def test_what_is_no_time_is_refused_by_name(text):
    with pytest.raises(CaseError, match="--budget"):
        seconds_of(text, "--budget")


# The shipped table


def test_the_shipped_table_holds_every_scene_with_its_spacings():
    scenes = shipped_table().scenes
    assert list(scenes) == list(SCENES)
    for name, scene in scenes.items():
        errors = errors_by_spacing(scene)
        assert set(errors) >= {10, 16, 24}, name
        assert all(math.isfinite(e) for by_name in errors.values() for e in by_name.values())


@pytest.mark.parametrize("name", ["friction", "case A", "case B"])
def test_the_plan_foresees_what_was_measured_within_a_factor_of_one_and_a_half(name):
    table, case = shipped_table(), SCENES[name]().case
    settings = {str(setting): setting for setting in settings_of(case)[0]}
    measured = table.scenes[name]
    for found in measured.rows:
        plan = make_plan(shortened(settings[str(found)].case, measured.end_time))
        solids, liquid = plan.estimate.solids_seconds, plan.estimate.liquid_seconds
        slower = table.machine.slower_than(REFERENCE, of_solids=solids / (solids + liquid))
        foreseen = slower * (solids + liquid) / measured.end_time
        assert foreseen / 1.5 < found.rate < foreseen * 1.5, found


def test_the_page_on_trades_is_that_of_the_shipped_table():
    from test_documents import REPOSITORY

    assert (REPOSITORY / "docs" / "trade.md").read_text("utf-8") == document(shipped_table())


# The command line


def type_in(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.fixture
def case_file(tmp_path):
    path = tmp_path / "pipe.toml"
    path.write_text(PRESCRIBED.to_toml())
    return path


def test_a_run_with_a_budget_says_before_what_it_expects_and_after_what_it_took(
    case_file, tmp_path
):
    said = type_in("run", case_file, "-o", tmp_path / "out", "--budget", "10 min")
    assert said.exit_code == 0, said.output
    before, after = said.stdout.split("were expected")[0].rsplit("took", 1)
    assert "of computing" in before
    assert "where about" in after
    expected = json.loads((tmp_path / "out" / "summary.json").read_text())["expected"]
    assert expected["wall_seconds"] > 0
    assert "level fine" in expected["setting"]
    assert any(text.startswith("ExchangeMomentum") for text in expected["left_out"])


def test_a_budget_that_cannot_be_met_is_bad_input(case_file):
    said = type_in("explain", case_file, "--budget", "1e-6 s")
    assert said.exit_code == 2
    assert "cheapest setting" in said.stderr


def test_budget_and_error_are_not_both_given(case_file):
    assert type_in("run", case_file, "--budget", "1 min", "--error", "5%").exit_code == 2


@pytest.mark.slow
@pytest.mark.parametrize(
    ("liquid", "end_time"), [("profile", 3.0), ("eulerian", 2.0), ("lagrangian", 0.5)]
)
def test_the_plan_foresees_the_time_within_a_factor_of_one_and_a_half(liquid, end_time, tmp_path):
    from mpsdem.simulation import Simulation

    case = CASE.with_(
        end_time=end_time,
        pipe={"radius": 0.1, "length": 1.0},
        liquid={"model": liquid},
        solids={"diameter": 0.02, "count": 100},
        fidelity={"threads": 1},
    )
    with Simulation(case, tmp_path / "run").run(bar=False) as results:
        took = results.summary["cpu_seconds"]
    estimate = make_plan(case).estimate
    total = estimate.solids_seconds + estimate.liquid_seconds
    share = estimate.solids_seconds / total
    foreseen = total * Machine.measured().slower_than(REFERENCE, of_solids=share)
    assert foreseen / 1.5 < took < foreseen * 1.5
