"""Whatever a case says: it is refused by the name of a key, or runs and keeps what must be kept."""

import copy
import math
import re
from tempfile import TemporaryDirectory

import pytest
from any_case import agreed, leaves, tables
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mpsdem import Simulation
from mpsdem.case import Case, CaseError
from mpsdem.plan import make_plan
from mpsdem.simulation import SimulationDiverged
from mpsdem.trade import choose
from mpsdem.trade.machine import Machine
from mpsdem.validation.extremes import doubts, faults, measure, timed

# Powers of ten around anything that a pipe may be, kept apart by what a plan can be made of.
WIDE = {
    "end_time": (1.0, 1e6),
    "gravity": (0.0, 1e3),
    "pipe.radius": (1e-4, 10.0),
    "pipe.length": (1e-3, 1e4),
    "pipe.roughness": (0.0, 1e-3),
    "pipe.stroke": (1e-3, 10.0),
    "liquid.density": (1e-1, 2e4),
    "liquid.kinematic_viscosity": (1e-9, 1e2),
    "liquid.bulk_velocity": (-1e3, 1e3),
    "liquid.pressure_gradient": (-1e7, 1e7),
    "solids.diameter": (1e-6, 1.0),
    "solids.diameter.smallest": (1e-6, 1e-2),
    "solids.diameter.median": (1e-5, 1e-1),
    "solids.diameter.largest": (1e-3, 1.0),
    "solids.diameter.deviation": (1e-3, 1e2),
    "solids.diameter.diameters": (1e-6, 1.0),
    "solids.density": (1e-1, 1e5),
    "solids.count": (1, 10_000),
    "solids.volume_fraction": (1e-6, 0.7),
    "solids.youngs_modulus": (1e2, 1e13),
    "solids.wall.youngs_modulus": (1e2, 1e13),
    "solids.friction": (0.0, 1e3),
    "solids.rolling_friction": (0.0, 1e3),
    "solids.normal_stiffness": (1e-3, 1e12),
    "solids.tangential_stiffness": (0.0, 1e12),
    "solids.normal_damping": (0.0, 1e6),
    "solids.impact_speed": (1e-6, 1e3),
    "solids.arrangement.counts": (1, 10),
    "solids.arrangement.count": (1, 10),
    "solids.arrangement.gap": (0.0, 10.0),
    "solids.arrangement.velocity": (-1e2, 1e2),
    "solids.arrangement.positions": (-0.01, 0.1),
    "solids.arrangement.diameters": (1e-6, 1.0),
    "motion.vibration.amplitude": (0.0, 10.0),
    "motion.vibration.frequency": (1e-6, 1e3),
    "motion.vibration.period": (1e-3, 1e6),
    "motion.vibration.mode": (0, 9),
    "motion.file": None,
    "fidelity.particle_spacing": (1e-5, 1.0),
    "fidelity.smoothing_radius": (1e-5, 10.0),
    "fidelity.solid_step": (1e-12, 1.0),
    "fidelity.liquid_step": (1e-12, 1.0),
    "fidelity.coupling_step": (1e-12, 1.0),
    "output.every": (1e-6, 1.0),
    "output.times": None,
}
# What runs fifty steps in a fraction of a second: a bore of ten spacings, some tens of solids.
SMALL = WIDE | {
    "end_time": (1.0, 1.0),
    "gravity": (0.0, 30.0),
    "pipe.radius": (0.03, 0.07),
    "pipe.length": (0.1, 0.4),
    "pipe.stroke": (0.03, 0.15),
    "liquid.density": (500.0, 2000.0),
    "liquid.kinematic_viscosity": (1e-7, 0.1),
    "liquid.bulk_velocity": (-5.0, 5.0),
    "liquid.pressure_gradient": (-1e4, 1e4),
    "solids.diameter": (4e-3, 4e-2),
    "solids.diameter.smallest": (4e-3, 1e-2),
    "solids.diameter.median": (8e-3, 2e-2),
    "solids.diameter.largest": (1e-2, 3e-2),
    "solids.diameter.deviation": (0.1, 1.0),
    "solids.diameter.diameters": (4e-3, 3e-2),
    "solids.density": (50.0, 2e4),
    "solids.count": (1, 60),
    "solids.volume_fraction": (1e-3, 0.1),
    "solids.youngs_modulus": (1e6, 1e9),
    "solids.wall.youngs_modulus": (1e6, 1e9),
    "solids.friction": (0.0, 2.0),
    "solids.rolling_friction": (0.0, 2.0),
    "solids.wall.friction": (0.0, 2.0),
    "solids.wall.rolling_friction": (0.0, 2.0),
    "solids.restitution": (0.01, 1.0),
    "solids.wall.restitution": (0.01, 1.0),
    "solids.seed": (0, 1000),
    "solids.normal_stiffness": (1e3, 1e6),
    "solids.tangential_stiffness": (0.0, 1e6),
    "solids.normal_damping": (0.0, 10.0),
    "solids.tangential_damping": (0.0, 10.0),
    "solids.impact_speed": (1.0, 10.0),
    "solids.arrangement.counts": (1, 4),
    "solids.arrangement.gap": (0.0, 1.0),
    "solids.arrangement.velocity": (-5.0, 5.0),
    "solids.arrangement.velocities": (-5.0, 5.0),
    "solids.arrangement.spins": (-100.0, 100.0),
    "solids.arrangement.positions": (-0.02, 0.1),
    "solids.arrangement.diameters": (4e-3, 3e-2),
    "motion.vibration.amplitude": (0.0, 0.02),
    "motion.vibration.frequency": (0.1, 50.0),
    "motion.vibration.period": (0.02, 10.0),
    "motion.vibration.mode": (0, 4),
    "motion.times": None,
    "motion.displacements": None,
    "fidelity.particle_spacing": (0.008, 0.02),
    "fidelity.smoothing_radius": (0.02, 0.05),
    "fidelity.courant": (0.1, 2.0),
    "fidelity.stiffness_factor": (0.1, 1.0),
    "fidelity.solid_step": (1e-7, 1e-5),
    "fidelity.liquid_step": (1e-4, 1e-1),
    "fidelity.coupling_step": (1e-6, 1e-3),
    "fidelity.rayleigh_fraction": (0.02, 0.5),
    "fidelity.pressure_tolerance": (1e-8, 0.1),
    "fidelity.pressure_solver": None,
    "output.every": (1.0, 1.0),
    "output.checkpoint_every": None,
}
FIXED = {
    "fidelity": {"level": "quick", "threads": 1},
    "output": {"figures": False, "liquid_stride": 1},
}
# What is given in every other run, for the models, laws and motions to meet each other.
ALWAYS = {
    "liquid",
    "liquid.model",
    "liquid.bulk_velocity",
    "solids",
    "solids.drag",
    "solids.contact",
    "solids.arrangement",
    "motion",
    "motion.vibration",
    "motion.vibration.amplitude",
    "fidelity",
}
RUNS = st.one_of(tables(SMALL), tables(SMALL, ALWAYS))
MOTIONS = st.none() | st.fixed_dictionaries(
    {
        "walls": st.sampled_from(["auto", "moving"]),
        "vibration": st.lists(
            st.fixed_dictionaries(
                {
                    "direction": st.sampled_from(["y", "z"]),
                    "amplitude": st.floats(1e-4, 5e-3),
                    "frequency": st.floats(0.5, 30.0),
                    "phase": st.floats(0.0, 6.28),
                    "mode": st.sampled_from([0, 0, 2, 4]),
                    "ramp": st.sampled_from([0.0, 0.1]),
                }
            ),
            min_size=1,
            max_size=3,
        ),
    }
)
MACHINE = Machine(solids=0.03, liquid=0.03)
# [-] of momentum that fifty steps may leave unexplained: at both ends the velocity of the solids is
# that of half a step before, which weighs as one over the time (0.045 is 0.007 in five times it).
ENDS = 0.1
MOST_TURNS = 200  # of walls that move, which cost milliseconds that the estimate leaves out
LONGEST = 3.0  # [s] that a run may take by its own estimate, to be drawn here
COUPLINGS = st.sampled_from(["auto", "two-way", "one-way"])
MODELS = st.sampled_from(["profile", "eulerian", "lagrangian"])


def plan_or_refusal(table):
    """What becomes of a case is a plan, or a refusal in words that name a key and a rule."""
    case = agreed(table)
    if case is None:
        return
    try:
        plan = make_plan(case)
    except CaseError as error:
        for problem in error.problems:
            assert problem.rule
            assert problem.field.split(".")[0] in Case.model_fields
        return
    assert 0 < plan.coupling_step.value <= case.output.every
    assert all(limit.value > 0 for limit in plan.coupling_step.limits)
    if plan.solid_step is not None:
        assert 0 < plan.solid_step.value <= plan.solid_step.binding.value * (1 + 1e-9)
    assert math.isfinite(plan.estimate.wall_seconds)


def a_budget_and_an_error_choose_a_plan_or_say_why_not(table, seconds, error):
    """What is chosen takes no longer, or errs no more, than was asked for."""
    case = agreed(table)
    assume(case is not None)
    refusals = []
    for asked in ({"seconds": seconds}, {"error": error}):
        try:
            chosen = choose(case, machine=MACHINE, **asked)
        except CaseError as error_told:
            refusals.extend(error_told.problems)
            continue
        assert make_plan(chosen.case).liquid_model == chosen.plan.liquid_model
        assert chosen.seconds <= asked.get("seconds", math.inf)
        assert not chosen.error > asked.get("error", math.inf)
    assert all(problem.rule for problem in refusals)


def of_kinds(table, model, coupling, motion):
    """The table with that liquid, coupling and motion, as far as they go together."""
    if motion is not None:
        table["motion"] = motion
        flexes = any(part["mode"] for part in motion["vibration"])
        if flexes or motion["walls"] == "moving":
            model, table["pipe"]["ends"] = "lagrangian", "periodic"
            motion["walls"] = "moving"
            table.get("solids", {}).pop("held", None)
    if "liquid" in table:
        table["liquid"]["model"] = model
        if model == "profile":  # steady, and takes no notice of solids
            table["liquid"].pop("pressure_gradient", None)
            coupling = "one-way" if coupling == "two-way" else coupling
    if "solids" in table:
        table.setdefault("fidelity", {})["coupling"] = coupling
    return table


def run_keeps_what_must_be_kept(table, model, coupling, motion):
    case = agreed(of_kinds(table, model, coupling, motion))
    assume(case is not None)
    try:
        case = timed(case.with_(**FIXED), 50)
        plan = make_plan(case)
        assume(plan.estimate.wall_seconds < LONGEST)
        assume(not (case.motion.moves_walls and plan.clock.steps > MOST_TURNS))
        flexing = any("walls that flex" in warning for warning in plan.warnings)
        soft = any("of the radius deep" in warning for warning in plan.warnings)
        try:
            with TemporaryDirectory() as directory, Simulation(case, directory).run() as results:
                assert list(faults(plan, results)) == []
                figures = measure(plan, results)
        except SimulationDiverged:
            assert flexing or soft  # foreseen
            return
        doubted = list(doubts(plan, figures))
        if flexing:
            doubted = []
        if soft:
            doubted = [told for told in doubted if not told.startswith("overlap")]  # as foreseen
        if figures.momentum_error is not None and figures.momentum_error <= ENDS:
            doubted = [told for told in doubted if not told.startswith("momentum")]
        assert doubted == []
        return
    except CaseError as error:
        problems = error.problems
    assert all(problem.field and problem.rule for problem in problems)


def a_value_that_cannot_be(value):
    """Values that no key takes which holds one such as `value`."""
    if isinstance(value, bool):
        return st.sampled_from([3, "yes", []])
    if isinstance(value, int | float):
        return st.sampled_from([math.nan, math.inf, -math.inf, "5 kg m", "", True, [1.0], {"a": 1}])
    if isinstance(value, str):
        return st.sampled_from([3.5, True, ["x"]])
    return st.sampled_from([3.5, True, "x", [[]]])


def a_wrong_value_is_refused_by_its_key(table, data):
    case = agreed(table)
    assume(case is not None)
    table = case.model_dump(exclude_none=True)
    path = data.draw(st.sampled_from(list(leaves(table))))
    damaged = copy.deepcopy(table)
    *parents, last = path
    part = damaged
    for key in parents:
        part = part[key]
    part[last] = data.draw(a_value_that_cannot_be(part[last]))
    with pytest.raises(CaseError) as refused:
        Case(**damaged)
    named = {re.sub(r"\[.*", "", problem.field) for problem in refused.value.problems}
    assert ".".join(path) in named


def an_unknown_key_is_refused_by_its_name(table, data):
    case = agreed(table)
    assume(case is not None)
    damaged = case.model_dump(exclude_none=True)
    parts = [damaged, *(part for part in damaged.values() if isinstance(part, dict))]
    data.draw(st.sampled_from(parts))["denisty"] = 1.0
    with pytest.raises(CaseError, match="denisty"):
        Case(**damaged)


@settings(max_examples=60)
@given(tables(WIDE))
def test_whatever_a_case_says_becomes_a_plan_or_a_refusal(table):
    plan_or_refusal(table)


@settings(max_examples=40)
@given(tables(WIDE), st.data())
def test_a_value_that_cannot_be_is_refused_by_its_key(table, data):
    a_wrong_value_is_refused_by_its_key(table, data)


@settings(max_examples=15)
@given(tables(WIDE), st.data())
def test_a_key_that_is_not_known_is_refused_by_its_name(table, data):
    an_unknown_key_is_refused_by_its_name(table, data)


@settings(max_examples=10)
@given(tables(SMALL, ALWAYS), st.floats(1.0, 1e5), st.floats(0.01, 0.5))
def test_a_budget_and_an_error_lead_to_a_plan_or_a_refusal(table, seconds, error):
    a_budget_and_an_error_choose_a_plan_or_say_why_not(table, seconds, error)


@settings(max_examples=25)
@given(RUNS, MODELS, COUPLINGS, MOTIONS)
def test_whatever_runs_keeps_its_solids_its_ledgers_and_its_numbers(table, model, coupling, motion):
    run_keeps_what_must_be_kept(table, model, coupling, motion)


@pytest.mark.slow
@settings(max_examples=5000)
@given(tables(WIDE), st.data())
def test_many_cases_become_plans_or_refusals(table, data):
    plan_or_refusal(table)
    a_wrong_value_is_refused_by_its_key(table, data)


@pytest.mark.slow
@settings(max_examples=1000)
@given(RUNS, MODELS, COUPLINGS, MOTIONS)
def test_many_runs_keep_solids_ledgers_and_numbers(table, model, coupling, motion):
    run_keeps_what_must_be_kept(table, model, coupling, motion)
