"""A pipe that is shaken: its laws of motion, and what solids and pressure make of it."""

import h5py
import numpy as np
import pytest

from mpsdem import Simulation
from mpsdem.case import Case, CaseError, Motion, load_case
from mpsdem.plan import make_plan

WATER = {
    "model": "profile",
    "density": 1000.0,
    "kinematic_viscosity": 1e-6,
    "bulk_velocity": 1.0,
}
PIPE = {"radius": 0.1, "length": 1.0}
NODULES = {"diameter": 0.015, "density": 2500.0, "youngs_modulus": 1e7, "count": 60}
SHAKE = {"direction": "z", "amplitude": 0.08, "period": 1.0}


def case(*, motion=None, solids=NODULES, **parts):
    parts = {"end_time": 0.2, "pipe": PIPE, "liquid": WATER} | parts
    fidelity = {"level": "quick", "threads": 1} | parts.pop("fidelity", {})
    output = {"every": 0.02, "figures": False} | parts.pop("output", {})
    return Case(
        motion=motion or {"vibration": SHAKE},
        solids=solids,
        fidelity=fidelity,
        output=output,
        **parts,
    )


# --- laws -----------------------------------------------------------------------------------------

LAWS = {
    "harmonic": {"vibration": SHAKE},
    "no ramp, a phase": {"vibration": SHAKE | {"ramp": 0.0, "phase": "30 deg"}},
    "several": {
        "vibration": [
            SHAKE,
            {"direction": [1.0, 2.0, -1.0], "amplitude": 0.01, "frequency": 3.7, "ramp": 0.4},
        ]
    },
    "modes": {
        "vibration": [
            SHAKE | {"mode": 2},
            {"direction": "y", "amplitude": 0.03, "frequency": 2.0, "mode": 4},
            SHAKE | {"direction": "x"},
        ]
    },
    "table": {
        "times": [0.1, 0.4, 0.6, 1.5, 2.2],
        "displacements": [[0, 0, 0], [0, 0.1, 0], [0.1, 0, 0], [0, 0, 0.2], [0, 0.1, 0.1]],
    },
}


@pytest.mark.parametrize("length", [1e-200, 1e-30, 1.0, 1e200])
def test_the_length_of_a_direction_does_not_matter(length):
    part = Motion(vibration=SHAKE | {"direction": [0.0, 3 * length, -4 * length]}).vibration[0]
    assert part.axis == pytest.approx([0.0, 0.6, -0.8], abs=1e-15)


@pytest.mark.parametrize(
    ("length", "holds", "fails", "told"),
    [
        (4.0, 0.318, 0.320, r"a slope of 0\.5, "),  # 2 pi A / L
        (0.5, 0.031, 0.033, r"a curvature over that of the bore of 0\.52, "),  # (2 pi / L)^2 A R
    ],
)
def test_an_axis_too_bent_for_sections_that_move_as_one_body_is_refused(length, holds, fails, told):
    def bent(amplitude):
        part = {"direction": "z", "period": 1.0, "amplitude": amplitude, "mode": 2}
        pipe, liquid = PIPE | {"length": length}, WATER | {"model": "lagrangian"}
        return case(motion={"vibration": part}, liquid=liquid, pipe=pipe)

    bent(holds)
    with pytest.raises(CaseError, match=told):
        bent(fails)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_velocity_and_acceleration_are_derivatives_of_the_displacement(law):
    motion, h = Motion(**law), 1e-4
    # off the knots of the table and the ends of the ramps, where the jerk jumps
    time = np.linspace(0.003, 2.5, 211)
    kinks = np.array([0.4, 1.0, *(motion.times or ())])
    time = time[np.abs(time[:, None] - kinks).min(axis=1) > 3 * h][:, None]
    along = np.array([0.0, 0.3, 0.71])

    def derivative(name):
        steps = (getattr(motion.at(time + k * h, along=along), name) for k in (-2, -1, 1, 2))
        before2, before, after, after2 = steps
        return (before2 - 8 * before + 8 * after - after2) / (12 * h)

    now = motion.at(time, along=along)
    for name, rate in (("displacement", now.velocity), ("velocity", now.acceleration)):
        assert np.abs(derivative(name) - rate).max() < 1e-6 * np.abs(rate).max()


@pytest.mark.parametrize("law", [LAWS["harmonic"], LAWS["modes"]], ids=["harmonic", "modes"])
def test_a_vibration_starts_smoothly_from_rest_and_reaches_its_amplitude(law):
    motion = Motion(**law)
    start = motion.at(0.0, along=0.2)
    for value in (start.displacement, start.velocity, start.acceleration):
        np.testing.assert_array_equal(value, 0.0)
    jerk = np.diff(motion.at(np.array([0.0, 1e-6])).acceleration, axis=0)
    assert np.abs(jerk).max() < 1e-3
    grown = motion.at(np.linspace(1.0, 2.0, 1001)).displacement
    assert grown[:, 2].max() == pytest.approx(0.08, rel=1e-5)


def test_a_mode_stands_still_at_its_nodes_and_swings_against_itself_between_them():
    motion = Motion(vibration=SHAKE | {"mode": 2})
    place = motion.at(1.25, along=[0.0, 0.25, 0.5, 0.75, 1.0]).displacement[:, 2]
    np.testing.assert_allclose(place, [0.08, 0.0, -0.08, 0.0, 0.08], atol=1e-15)


def test_a_table_is_at_rest_until_it_begins_and_goes_through_its_entries():
    table = LAWS["table"]
    motion = Motion(**table)
    np.testing.assert_allclose(
        motion.at(table["times"]).displacement, table["displacements"], atol=1e-15
    )
    before = motion.at(0.0)
    np.testing.assert_allclose(before.displacement, table["displacements"][0], atol=1e-15)
    np.testing.assert_array_equal(before.velocity, 0.0)
    np.testing.assert_array_equal(before.acceleration, 0.0)
    np.testing.assert_allclose(motion.at(table["times"][0]).velocity, 0.0, atol=1e-14)


def test_the_period_of_a_sampled_sine_is_the_sine_s():
    t = np.arange(0.0, 3.0, 0.01)  # cut where it is fastest
    swing = Motion(vibration=SHAKE).at(t).displacement
    sampled = Motion(times=t, displacements=swing)
    assert sampled.shortest_period == pytest.approx(1.0, rel=0.15)
    assert sampled.peak_speed == pytest.approx(2 * np.pi * 0.08, rel=0.05)


def test_a_file_is_read_from_beside_the_case_and_the_resolved_case_needs_it_no_more(tmp_path):
    (tmp_path / "swing.csv").write_text("t,x,y,z\n0,0,0,0\n1,0,0.1,0\n2,0,0,0.25\n")
    text = case(solids=None).to_toml().split("[motion]")[0] + '[motion]\nfile = "swing.csv"\n'
    (tmp_path / "case.toml").write_text(text)
    read = load_case(tmp_path / "case.toml")
    np.testing.assert_allclose(read.motion.at(1.0).displacement, [0.0, 0.1, 0.0])
    assert Case.from_toml(read.to_toml()) == read


# --- refusals -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("motion", "words"),
    [
        ({"vibration": SHAKE | {"frequency": 1.0}}, "either period or frequency; leave out one"),
        ({"vibration": {"direction": "y", "amplitude": 0.1}}, "give one of them"),
        ({"vibration": SHAKE | {"direction": "up"}}, "'x', 'y', 'z' or a vector"),
        ({"vibration": SHAKE | {"direction": [0, 0, 0]}}, "not all zero"),
        ({"vibration": SHAKE | {"mode": 3}}, "must be even .* take 2 or 4"),
        ({"vibration": SHAKE | {"mode": 2, "direction": "x"}}, "normal to the pipe in mode 2"),
        ({"vibration": SHAKE | {"mode": 2}, "walls": "fixed"}, "flexes has no frame"),
        ({"vibration": SHAKE | {"amplitude": "-1 mm"}}, r"amplitude = '-1 mm': must be >= 0 m"),
        ({"times": [0.0, 1.0]}, "needs both times and displacements"),
        ({"times": [0, 0], "displacements": [[0, 0, 0]] * 2}, "each after the one before"),
        ({"times": [0, 1], "displacements": [[0, 0, 0]]}, "2 entries, one per time"),
        ({"times": [0, 0.1], "displacements": [[0, 0, 0]] * 2}, "must reach to 0.2 s, the end"),
        ({"file": "nowhere.csv"}, "nowhere.csv': cannot be read: No such file"),
        ({"shake": 1}, "unknown key"),
    ],
)
def test_a_motion_that_cannot_be_is_refused_in_words(motion, words):
    with pytest.raises(CaseError, match=words):
        case(motion=motion)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty"),
        ("t,y\n0,0\n", "must begin with the line 't,x,y,z'"),
        ("t,x,y,z\n0,0,0,0\n1,a,0,0\n", "four numbers in each row, unlike row 3"),
    ],
)
def test_a_file_that_is_no_table_is_refused_in_words(tmp_path, text, words):
    (tmp_path / "swing.csv").write_text(text)
    with pytest.raises(CaseError, match=words):
        Motion(file=str(tmp_path / "swing.csv"))


def test_a_period_of_less_than_twenty_steps_is_refused():
    shaken = {"vibration": SHAKE | {"period": 0.02, "amplitude": 1e-4}}
    make_plan(case(motion=shaken, fidelity={"coupling_step": 0.9e-3}))
    with pytest.raises(CaseError, match=r"<= 0\.001 s, 0\.05 of the pipe's shortest period"):
        make_plan(case(motion=shaken, fidelity={"coupling_step": 1.1e-3}))


# --- the plan -------------------------------------------------------------------------------------


def test_the_plan_says_in_which_frame_it_is_computed_and_why():
    plan = make_plan(case())
    (solids,) = [stage.reason for stage in plan.stages if stage.name == "AdvanceSolids"]
    assert "as one body" in solids
    assert "0.6 of its acceleration" in solids  # 1 - 1000/2500
    assert "moving walls" in [stage.name for stage in plan.left_out]


def test_frames_too_few_to_show_a_period_are_a_warning():
    def warned(every):
        plan = make_plan(case(output={"every": every}))
        return any("frames: take output.every <= 0.125 s" in text for text in plan.warnings)

    assert warned(0.2)
    assert not warned(0.1)


def test_fast_shaking_makes_collisions_faster_and_steps_shorter():
    slow, fast = (
        make_plan(case(motion={"vibration": SHAKE | {"amplitude": a}})) for a in (0.0, 1.0)
    )
    # solids of 0.6 lightness are left behind at up to 0.6 of the pipe's 2 pi m/s
    assert fast.impact_speed - slow.impact_speed == pytest.approx(0.6 * 2 * np.pi, rel=0.01)
    assert fast.solid_step.value < slow.solid_step.value
    assert fast.coupling_step.value < slow.coupling_step.value


# --- runs -----------------------------------------------------------------------------------------


@pytest.fixture
def run(tmp_path_factory):
    opened = []

    def go(case):
        opened.append(Simulation(case, tmp_path_factory.mktemp("run") / "run").run(bar=False))
        return opened[-1]

    yield go
    for results in opened:
        results.close()


def sphere_in_shaken_liquid(*, added_mass):
    """A lone sphere of 1 mm and 2500 kg/m3 in a liquid at rest of 0.1 Pa s, at 100 Hz."""
    return Case(
        end_time=0.08,
        gravity=0.0,
        pipe={"radius": 0.01, "length": 0.05},
        liquid={
            "model": "profile",
            "density": 1000.0,
            "kinematic_viscosity": 1e-4,
            "bulk_velocity": 0.0,
        },
        solids={
            "diameter": 1e-3,
            "density": 2500.0,
            "youngs_modulus": 1e4,
            "drag": "schiller_naumann",
            "arrangement": {"kind": "list", "positions": [[0.02, 0.0, 0.0]]},
        },
        motion={"vibration": {"direction": [1, 2, -2], "amplitude": 1e-6, "frequency": 100.0}},
        fidelity={"level": "quick", "added_mass": "on" if added_mass else "off"},
        output={"every": 0.0005, "figures": False},
    )


@pytest.mark.parametrize("added_mass", [False, True])
def test_a_sphere_in_a_shaken_liquid_follows_as_stokes_has_it(run, added_mass):
    """Of (1 + c) dv/dt = -k v - (1 - rho/rho_s) a, v seen from the pipe, amplitude and phase."""
    results = run(sphere_in_shaken_liquid(added_mass=added_mass))
    k = 18 * 0.1 / (2500 * 1e-3**2)  # [1/s]
    c = 0.5 * 1000 / 2500 if added_mass else 0.0
    rate = 2 * np.pi * 100
    drive = 0.6 * 1e-6 * rate**2  # -(1 - rho/rho_s) a = drive sin(rate t)
    exact = drive / complex(k, (1 + c) * rate)  # of the velocity, over exp(i rate t) / i
    late = results.time > 0.04
    t, velocity = results.time[late], results.solids.velocity[late, 0]
    v = velocity @ np.array([1, 2, -2]) / 3
    np.testing.assert_allclose(velocity, np.outer(v, [1, 2, -2]) / 3, atol=1e-9)
    in_phase, behind = np.linalg.lstsq(
        np.column_stack([np.sin(rate * t), np.cos(rate * t)]), v, rcond=None
    )[0]
    found = complex(in_phase, behind)
    assert abs(found) == pytest.approx(abs(exact), rel=0.02)
    assert np.angle(found) == pytest.approx(np.angle(exact), abs=0.02)


def test_dry_solids_stay_where_they_are_while_the_pipe_shakes_around_them(run):
    """In the laboratory nothing acts on a solid that touches nothing."""
    results = run(
        case(
            liquid=None,
            gravity=0.0,
            solids={
                "diameter": 0.01,
                "density": 2500.0,
                "youngs_modulus": 1e7,
                "arrangement": {"kind": "list", "positions": [[0.5, 0.0, 0.0]]},
            },
            motion={"vibration": SHAKE | {"amplitude": 0.02, "direction": [1.0, 1.0, 1.0]}},
            end_time=1.5,
            output={"every": 0.1},
        )
    )
    for frame in range(len(results.time)):
        place = results.solids.laboratory_position(frame)
        np.testing.assert_allclose(place, [[0.5, 0.0, 0.0]], atol=1e-5)
        np.testing.assert_allclose(results.solids.laboratory_velocity(frame), 0.0, atol=1e-12)
    assert np.ptp(results.solids.position[:, 0, 2]) > 0.02


@pytest.mark.parametrize(
    ("model", "coupling"),
    [("profile", "one-way"), ("eulerian", "two-way"), ("lagrangian", "two-way")],
)
def test_the_books_of_a_shaken_pipe_close(run, model, coupling):
    pipe = {"radius": 0.1, "length": 0.4}
    results = run(
        case(
            pipe=pipe,
            liquid=WATER | {"model": model},
            fidelity={"coupling": coupling},
            motion={
                "vibration": [SHAKE | {"period": 0.2, "amplitude": 0.02, "direction": [1, 1, 1]}]
            },
        )
    )
    assert results.summary["momentum_error"] < 1e-3
    if model == "profile":
        # what shaking and pressure gave is motion, height and heat: the solids end no faster
        assert results.summary["momentum_error"] < 1e-12
    assert np.abs(results.diagnostics["shaking_power"]).max() > 0


def test_the_work_of_the_shaking_is_what_solids_without_contact_gain(run):
    """Dry, weightless and apart: all of it is kinetic energy, and nothing is dissipated."""
    results = run(
        case(
            liquid=None,
            gravity=0.0,
            solids={
                "diameter": 0.01,
                "density": 2500.0,
                "youngs_modulus": 1e7,
                "arrangement": {"kind": "list", "positions": [[0.5, 0.0, 0.0]]},
            },
            motion={"vibration": SHAKE | {"amplitude": 0.02}},
        )
    )
    power = results.diagnostics["shaking_power"]
    assert power.max() > 1e-6
    np.testing.assert_allclose(results.diagnostics["dissipation"], 0.0, atol=1e-12)
    energy = results.diagnostics["kinetic_energy"][-1]
    assert power[1:].sum() * 0.02 * PIPE["length"] == pytest.approx(energy, rel=1e-9)


def test_shaking_moves_no_liquid_in_a_full_pipe(run):
    def flow(model, motion):
        return run(
            case(
                solids=None,
                pipe={"radius": 0.1, "length": 0.4},
                liquid=WATER | {"model": model},
                motion=motion,
                end_time=0.1,
            )
        ).diagnostics["pressure_gradient_friction"]

    still = {"vibration": SHAKE | {"amplitude": 0.0}}
    for model in ("eulerian", "lagrangian"):
        np.testing.assert_array_equal(flow(model, {"vibration": SHAKE}), flow(model, still))


def test_the_full_pressure_of_an_inclined_shaken_pipe_holds_its_weight_and_inertia(run):
    results = run(
        case(
            solids=None,
            pipe={"radius": 0.1, "length": 0.4, "inclination": "50 deg"},
            liquid=WATER | {"model": "lagrangian"},
            motion={"vibration": SHAKE | {"period": 0.2}},
            end_time=0.1,
        )
    )
    frame, g = -2, 9.807
    acceleration = results.diagnostics["pipe_acceleration"][frame]
    x, full = results.liquid.position[frame], results.liquid.full_pressure(frame)
    fit = np.linalg.lstsq(np.column_stack([x, np.ones(len(x))]), full, rcond=None)[0]
    loss = results.pressure_gradient[frame]
    along = -1000 * g * np.sin(np.radians(50)) - loss
    upward = -1000 * (g * np.cos(np.radians(50)) + acceleration[2])
    assert abs(acceleration[2]) > 5
    np.testing.assert_allclose(fit[[0, 2]], [along, upward], rtol=0.01)
    static = results.summary["pressure_gradient_static"]
    assert static == pytest.approx(1000 * g * np.sin(np.radians(50)), rel=0.01)


def test_the_results_say_in_which_frame_they_are_and_how_it_moves(run):
    results = run(case())
    with h5py.File(results.directory / "results.h5", locking=False) as file:
        assert file.attrs["frame_of_reference"] == "pipe"
    law = results.case.motion.at(results.time)
    for name in ("displacement", "velocity", "acceleration"):
        np.testing.assert_array_equal(results.diagnostics[f"pipe_{name}"], getattr(law, name))
    shift = results.solids.laboratory_position(-1) - results.solids.position[-1]
    np.testing.assert_allclose(shift, np.tile(law.displacement[-1], (60, 1)), atol=1e-15)
