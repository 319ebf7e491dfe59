"""The plan takes what a scene needs, and steps that resolve it."""

import math

import fluids
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mpsdem.case import Case, CaseError
from mpsdem.contacts import Impact, Stiffness
from mpsdem.plan import Clock, absurd_speed, impacts, make_plan, spring_stiffness, terminal_velocity
from mpsdem.plan.scales import fastest_flow, turbulence

WATER = {"model": "profile", "density": 1000.0, "kinematic_viscosity": 1e-6, "bulk_velocity": 1.0}
AUTO = {"model": "auto"}
NODULES = {
    "diameter": 0.02,
    "density": 2700.0,
    "youngs_modulus": 1e8,
    "arrangement": {"kind": "block", "counts": [11, 7, 7], "count": 512},
}
RAYLEIGH_TIME = 2.78e-4  # [s] of such a nodule


def case(*, liquid=WATER, solids=(), **parts):
    parts = {"end_time": 2.0, "pipe": {"radius": 0.1, "length": 4.0}} | parts
    return Case(liquid=liquid, solids=NODULES | dict(solids), **parts)


def names(stages):
    return [stage.name for stage in stages]


def test_quick_looks_at_the_liquid_half_as_often_unless_solids_crowd_the_pipe():
    def turn(level, fraction):
        some = {"volume_fraction": fraction, "arrangement": {"kind": "random"}, "count": None}
        plan = make_plan(case(solids=some, fidelity={"level": level}))
        return min(limit.value for limit in plan.coupling_step.limits)

    assert turn("quick", 0.05) == pytest.approx(2 * turn("balanced", 0.05))
    assert turn("quick", 0.3) == turn("balanced", 0.3)


@pytest.mark.parametrize(("level", "fraction"), [("quick", 0.3), ("balanced", 0.1), ("fine", 0.05)])
def test_the_solids_take_the_level_s_share_of_the_rayleigh_time(level, fraction):
    plan = make_plan(case(fidelity={"level": level}))
    assert plan.solid_step.binding.value == pytest.approx(fraction * RAYLEIGH_TIME, rel=2e-3)
    assert 0.95 * plan.solid_step.binding.value < plan.solid_step.value
    assert plan.solid_step.value <= plan.solid_step.binding.value


def test_the_smallest_solid_sets_the_step():
    sizes = {"kind": "sieve", "diameters": [0.02, 0.002], "fractions": [0.5, 0.5]}
    plan = make_plan(case(solids={"diameter": sizes}))
    assert plan.solid_step.binding.value == pytest.approx(RAYLEIGH_TIME / 100, rel=2e-3)


def test_contacts_a_hundred_times_softer_take_steps_ten_times_as_long_where_solids_are_slow():
    still = case(liquid=WATER | {"bulk_velocity": 0.0}, gravity=0.0)
    stiff, soft = (
        make_plan(still.with_(fidelity={"stiffness_factor": factor})).solid_step.binding.value
        for factor in (1.0, 0.01)
    )
    assert soft == pytest.approx(10 * stiff, rel=1e-9)


def test_fast_collisions_bind_before_the_rayleigh_time():
    plan = make_plan(case(liquid=WATER | {"bulk_velocity": 8.0}))
    assert "collision at 8 m/s" in plan.solid_step.binding.name
    assert plan.solid_step.value < 0.1 * RAYLEIGH_TIME


def test_a_stiffer_wall_shortens_the_step():
    plan = make_plan(case(solids={"wall": {"youngs_modulus": 4e8}}))
    assert plan.solid_step.binding.value < 0.99 * make_plan(case()).solid_step.binding.value


def test_a_given_spring_is_resolved_whatever_youngs_modulus_says():
    spring = {"contact": "linear_spring", "normal_stiffness": 1e4, "youngs_modulus": 1e3}
    mass = 2700 * math.pi / 6 * 0.02**3
    duration = math.pi * math.sqrt(mass / 2 / 1e4)
    step = make_plan(case(solids=spring, fidelity={"level": "balanced"})).solid_step
    assert step.binding.value == pytest.approx(duration / 30, rel=1e-9)


def test_strong_damping_shortens_the_step_of_a_spring():
    spring = {"contact": "linear_spring", "normal_stiffness": 1e4}
    free, damped = (
        make_plan(case(solids=spring | {"normal_damping": damping})).solid_step.value
        for damping in (0.0, 1000.0)
    )
    assert damped < free / 10


def test_a_derived_spring_gives_way_as_far_as_the_hertz_contact():
    soft = case(solids={"contact": "linear_spring"})
    for impact, stiffness in zip(
        impacts(soft, diameter=0.02, speed=0.7), spring_stiffness(soft, 0.7), strict=True
    ):
        assert impact.on_spring(stiffness)[0] == pytest.approx(impact.overlap, rel=1e-12)


def test_a_spring_that_nothing_determines_is_asked_for():
    still = case(liquid=None, gravity=0.0, solids={"contact": "linear_spring"})
    with pytest.raises(CaseError, match=r"solids\.impact_speed.*give it, in m/s"):
        make_plan(still)


@pytest.mark.parametrize(
    ("fidelity", "limit"),
    [
        ({"solid_step": 2e-4}, "1.391e-04|0.0001391 s, 0.5 of the smallest solid's Rayleigh time"),
        ({"coupling_step": 0.02}, "0.5 of the time to cross a diameter"),
    ],
)
def test_a_step_above_its_limit_is_refused_and_the_limit_named(fidelity, limit):
    (name,) = fidelity
    with pytest.raises(CaseError, match=rf"fidelity\.{name} = .*: must be <= .*({limit})"):
        make_plan(case(fidelity=fidelity))


def test_a_viscoelastic_contact_that_nothing_closes_is_refused():
    still = case(liquid=None, gravity=0.0, solids={"contact": "hertz_viscoelastic"})
    with pytest.raises(CaseError, match="take 'hertz_mindlin'"):
        make_plan(still)


def test_solids_that_meet_head_on_are_judged_by_their_closing_speed():
    pair = {
        "kind": "list",
        "positions": [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
        "velocities": [[3.0, 0.0, 0.0], [-3.0, 0.0, 0.0]],
    }
    plan = make_plan(case(liquid=None, gravity=0.0, solids={"arrangement": pair}))
    assert plan.impact_speed == 6.0


def test_a_step_that_is_given_is_not_exceeded():
    plan = make_plan(case(fidelity={"solid_step": 1e-6, "coupling_step": 1e-4}))
    assert 0.99e-6 < plan.solid_step.value <= 1e-6
    assert 0.99e-4 < plan.coupling_step.value <= 1e-4


@given(
    end_time=st.floats(0.1, 1000),
    share=st.floats(0.001, 1),
    steps_per_frame=st.integers(1, 1000),
)
def test_the_clock_reaches_every_frame_and_the_end_to_the_bit(end_time, share, steps_per_frame):
    every = share * end_time
    clock = Clock(end_time=end_time, every=every, steps_per_frame=steps_per_frame, substeps=1)
    n = steps_per_frame
    frames = [clock.time(n * frame) for frame in range(clock.frames + 1)]
    assert frames[:-1] == [frame * every for frame in range(clock.frames)]
    assert frames[-1] == end_time
    for step in (1, n, clock.steps - 1, clock.steps):
        gone = clock.time(step) - clock.time(step - 1) if step else clock.length(1)
        assert gone == pytest.approx(clock.length(max(step, 1)), abs=1e-12 * end_time)
        assert 0 < clock.length(max(step, 1)) <= every / n * (1 + 1e-9)


@pytest.mark.parametrize("end_time", [0.3, 0.7, 1.1, 34.0])
def test_round_off_adds_no_frame(end_time):
    plan = make_plan(case(end_time=end_time))
    assert plan.clock.frames == round(end_time / 0.1)


def test_every_part_of_the_scene_brings_its_stages_and_no_more():
    both = make_plan(case())
    assert names(both.stages) == [
        "SampleLiquid",
        "FindVoidFraction",
        "DragForce",
        "AdvanceSolids",
        "Record",
    ]
    dry = make_plan(case(liquid=None))
    assert names(dry.stages) == ["AdvanceSolids", "Record"]
    assert "liquid" in names(dry.left_out)
    clear = make_plan(case().with_(solids=None))
    assert names(clear.stages) == ["Record"]
    assert "solids" in names(clear.left_out)
    for plan in (both, dry, clear):
        assert all(stage.reason for stage in (*plan.stages, *plan.left_out))


@pytest.mark.parametrize(
    "solids",
    [
        {"drag": "schiller_naumann"},
        {"arrangement": {"kind": "list", "positions": [[1.0, 0.0, 0.0]]}},
    ],
)
def test_nobody_looks_for_neighbors_that_do_not_matter(solids):
    plan = make_plan(case(solids=solids))
    assert "FindVoidFraction" not in names(plan.stages)
    assert "FindVoidFraction" in names(plan.left_out)


def test_too_many_solids_for_a_prescribed_liquid_are_warned_of():
    few = case(solids={"arrangement": {"kind": "random"}, "count": 20})
    assert "would yield" in " ".join(make_plan(case()).warnings)
    assert "would yield" not in " ".join(make_plan(few).warnings)


def test_a_contact_that_is_too_soft_is_warned_of():
    soft = make_plan(case(fidelity={"stiffness_factor": 1e-3}))
    assert any("of the radius" in warning for warning in soft.warnings)
    assert not any("of the radius" in warning for warning in make_plan(case()).warnings)


def test_contacts_that_solids_would_go_through_are_refused_with_a_modulus_that_holds():
    with pytest.raises(CaseError, match="of the radius deep, through what it hits") as refused:
        make_plan(case(solids={"youngs_modulus": 1e4}))
    (problem,) = refused.value.problems
    assert (problem.field, problem.value, problem.unit) == ("solids.youngs_modulus", 1e4, "Pa")
    least = float(problem.rule.split()[3])
    assert 1e4 < least < 1e5
    assert make_plan(case(solids={"youngs_modulus": 1.1 * least}))


@pytest.mark.parametrize("roughness", [0.0, 1e-3])
@pytest.mark.parametrize("gradient", [0.1, 10.0, -1000.0])
def test_a_liquid_that_a_gradient_drives_is_planned_for_the_speed_it_comes_to(gradient, roughness):
    """From rest as much as from that speed: the friction there balances the gradient."""
    pipe = {"radius": 0.1, "length": 4.0, "roughness": roughness}
    driven = Case(
        end_time=2.0,
        pipe=pipe,
        liquid=WATER | {"model": "lagrangian", "bulk_velocity": 0.0, "pressure_gradient": gradient},
    )
    speed = fastest_flow(driven)
    friction = fluids.friction_factor(Re=speed * 0.2 / 1e-6, eD=roughness / 0.2, Method="Colebrook")
    assert friction * 1000.0 * speed**2 / 0.4 == pytest.approx(abs(gradient), rel=2e-3)
    held = driven.with_(liquid={"bulk_velocity": speed})
    assert make_plan(driven).liquid_step.value == make_plan(held).liquid_step.value
    assert turbulence(driven) == turbulence(held) == "mixing_length"


def test_a_gradient_too_weak_for_turbulence_leads_to_a_parabola():
    oil = {"kinematic_viscosity": 1e-3, "bulk_velocity": 0.0, "pressure_gradient": 100.0}
    driven = Case(end_time=2.0, pipe={"radius": 0.1, "length": 4.0}, liquid=WATER | oil | AUTO)
    assert fastest_flow(driven) == pytest.approx(100.0 * 0.1**2 / (8 * 1000.0 * 1e-3), rel=1e-12)
    assert turbulence(driven) is None


def test_solids_in_a_liquid_that_starts_from_rest_are_looked_at_as_often_as_in_one_that_flows():
    """Steps judged by the start alone were a thousand times too long, and solids left the bore."""
    start = {"model": "eulerian", "bulk_velocity": 0.0, "pressure_gradient": 100.0}
    from_rest = case(liquid=WATER | start, gravity=1e-8)
    moving = from_rest.with_(liquid={"bulk_velocity": fastest_flow(from_rest)})
    assert make_plan(from_rest).coupling_step.value == make_plan(moving).coupling_step.value


def test_a_speed_too_small_to_square_is_a_speed_nonetheless():
    still = case(liquid=WATER | {"bulk_velocity": 1e-245}, gravity=0.0)
    assert make_plan(still).solid_step.value > 0
    with pytest.raises(CaseError, match="impact_speed"):
        make_plan(still.with_(solids={"contact": "linear_spring"}))


def test_no_speed_is_absurd_that_weight_or_pump_can_drive():
    steep = {"pipe": {"inclination": 1.57}, "liquid": {"model": "eulerian"}}
    packed = {"count": None, "volume_fraction": 0.3, "arrangement": {"kind": "random"}}
    crowd = case(solids=packed).with_(**steep)
    # the bore as one falling column, whose friction balances the submerged weight
    weight = 0.3 * (NODULES["density"] - 1000.0) * 9.807
    falling = math.sqrt(2 * weight * 2 * crowd.pipe.radius / (0.02 * 1000.0))
    assert absurd_speed(crowd) > falling
    assert absurd_speed(case(liquid=WATER | {"bulk_velocity": 30.0})) > 2 * 30.0
    slow = case(solids={"contact": "linear_spring", "impact_speed": 1e-3})
    assert absurd_speed(slow) == pytest.approx(absurd_speed(case()))
    assert absurd_speed(case(liquid=None)) == math.inf


def test_a_shake_harder_than_any_that_was_measured_is_warned_of():
    def warned(amplitude):
        part = {"direction": "z", "frequency": 50.0, "amplitude": amplitude, "ramp": 0.0}
        shaken = case().with_(motion={"vibration": [part]}, solids={"youngs_modulus": 1e9})
        return any("acceleration" in warning for warning in make_plan(shaken).warnings)

    assert warned(0.011)  # (100 pi)^2 0.011 = 1086 m/s2
    assert not warned(0.009)


def test_the_time_and_memory_of_a_fine_section_are_foreseen():
    def planned(across):
        fine = {"liquid": {"model": "eulerian"}, "fidelity": {"particle_spacing": 0.2 / across}}
        return make_plan(case().with_(solids=None, **fine))

    assert any("before the first step" in warning for warning in planned(100).warnings)
    assert not any("before the first step" in warning for warning in planned(60).warnings)
    assert planned(60).estimate.memory_bytes > 3e8


def test_threads_are_left_out_where_they_would_lose():
    assert make_plan(case()).threads == 1
    assert make_plan(case(fidelity={"threads": 2})).threads == 2


def test_glass_settles_in_water_as_tabulated():
    """2 mm of glass, Schiller-Naumann: 0.26764 m/s (validation catalogue, C1)."""
    water = {"density": 998.2, "kinematic_viscosity": 1.004e-6, "bulk_velocity": 0.0}
    glass = {"diameter": 0.002, "density": 2500.0, "drag": "schiller_naumann"}
    assert terminal_velocity(case(liquid=water, solids=glass, gravity=9.80665)) == pytest.approx(
        0.26764, rel=1e-3
    )


def test_solids_that_nothing_pulls_do_not_settle():
    assert terminal_velocity(case(gravity=0.0)) == 0
    assert terminal_velocity(case(solids={"density": 1000.0})) == 0


@pytest.mark.parametrize(
    ("impact", "bodies", "sphere", "overlap", "duration"),
    [
        (
            Impact.between,
            [(4.8e10, 0.2), (4.8e10, 0.2)],
            {"diameter": 0.02, "density": 2800.0, "speed": 20.0},
            274.11e-6,
            40.34e-6,
        ),
        (
            Impact.at_wall,
            [(7e10, 0.3), (math.inf, 0.3)],
            {"diameter": 0.2, "density": 2699.0, "speed": 0.2},
            49.717e-6,
            731.66e-6,
        ),
    ],
    ids=["glass on glass", "aluminium on a rigid wall"],
)
def test_hertz_impacts_are_those_of_chung_and_ooi(impact, bodies, sphere, overlap, duration):
    """Chung & Ooi (2011) doi:10.1007/s10035-011-0277-0, tests 1 and 2."""
    found = impact(stiffness=Stiffness.of(*bodies), **sphere)
    assert found.overlap == pytest.approx(overlap, rel=1e-4)
    assert found.duration == pytest.approx(duration, rel=1e-4)
