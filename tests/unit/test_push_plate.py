"""Liquid between a push plate and an outlet, held to what goes in, what goes out and what stays."""

import numpy as np
import pytest

from mpsdem._core import mps
from mpsdem.case import Case, CaseError
from mpsdem.geometry import Kind, push_plate_layout, ring_layout
from mpsdem.plan import make_plan
from mpsdem.plan.scales import particle_count

RADIUS = 0.1
DENSITY = 1000.0
STEP = 0.015
SOLIDS = {
    "count": 5,
    "diameter": 0.02,
    "density": 2500.0,
    "youngs_modulus": 1e7,
    "poisson_ratio": 0.2,
    "friction": 0.2,
    "restitution": 0.9,
    "arrangement": {"kind": "random"},
}
DRAWS = np.random.default_rng(0).random((64, 2))


class Pipe:
    """Liquid at 1 m/s, 8 spacings across, from the developed profile on."""

    def __init__(self, *, length=0.6, stroke=0.2, settling=None, reynolds=2e5, **options):
        spacing = RADIUS / 4
        settling = RADIUS + stroke / 2 if settling is None else settling
        self.length, self.outlet = length, 3 * spacing
        self.layout = push_plate_layout(
            radius=RADIUS,
            length=length,
            spacing=spacing,
            upstream=stroke + settling,
            downstream=self.outlet,
        )
        profile = mps.PipeProfile(
            pipe_radius=RADIUS, bulk_velocity=1.0, kinematic_viscosity=2 * RADIUS / reynolds
        )
        moving = self.layout.kind == Kind.LIQUID
        plate = {
            "velocity": 1.0,
            "stroke": stroke,
            "settling": settling,
            "outlet": self.outlet,
            "draws": DRAWS,
        }
        plate |= {k: options.pop(k) for k in list(options) if k in plate}
        self.liquid = mps.LagrangianLiquid(
            **{
                "position": self.layout.position,
                "velocity": np.where(moving[:, None], profile.velocity(self.layout.position), 0.0),
                "kind": self.layout.kind,
                "particle_spacing": spacing,
                "pipe_radius": RADIUS,
                "pipe_length": length,
                "plate": mps.PushPlate(**plate),
                "density": DENSITY,
                "kinematic_viscosity": 2 * RADIUS / reynolds,
                "roughness": 0.0,
                "turbulence": mps.MixingLength(pipe_radius=RADIUS) if reynolds > 2300 else None,
                "bulk_velocity": 1.0,
            }
            | options
        )
        self.start = self.liquid.count_in_bore

    def run(self, time):
        reports = [self.liquid.advance(STEP) for _ in range(round(time / STEP))]
        assert all(report.sound for report in reports)
        return reports

    @property
    def particles(self):
        """Positions of all that are there, and which of them are liquid."""
        vacant = len(self.liquid) - len(self.layout.kind)
        kind = np.concatenate([self.layout.kind, np.full(vacant, Kind.LIQUID)])
        position = self.liquid.position
        there = np.isfinite(position[:, 0])
        return position[there], kind[there] == Kind.LIQUID


def test_the_bore_stays_full_over_many_returns():
    """Whole rings cross the ends at a time, 22 of 4000 particles, so it cannot be much nearer."""
    pipe = Pipe(length=2.0)
    counts, returns = [], 0
    for _ in range(300):
        report = pipe.liquid.advance(STEP)
        assert report.sound
        returns += report.plate_returns
        counts.append(pipe.liquid.count_in_bore)
    assert returns >= 21
    assert np.mean(counts) == pytest.approx(pipe.start, rel=0.005)
    assert np.array(counts) == pytest.approx(pipe.start, rel=0.01)


def test_as_much_leaves_as_the_plate_pushes():
    pipe = Pipe(length=1.0)
    pipe.run(1.0)
    reports = pipe.run(3.0)
    swept = 3.0 * pipe.start / pipe.length
    assert sum(report.left for report in reports) == pytest.approx(swept, rel=0.01)
    came = sum(report.entered - report.replaced for report in reports)
    assert came == pytest.approx(swept, rel=0.02)  # to within the stroke that is under way


def test_no_particle_gets_through_wall_or_plate():
    pipe = Pipe()
    for _ in range(120):
        pipe.liquid.advance(STEP)
        position, liquid = pipe.particles
        x, r = position[liquid, 0], np.hypot(*position[liquid, 1:].T)
        assert x.min() > pipe.liquid.plate_face
        assert x.max() < pipe.length + pipe.outlet
        assert r.max() < RADIUS


def test_the_plate_is_a_disc_that_goes_to_and_fro():
    pipe = Pipe(stroke=0.1)
    faces = []
    for _ in range(60):
        pipe.liquid.advance(STEP)
        position, liquid = pipe.particles
        plate = ~liquid & (np.hypot(position[:, 1], position[:, 2]) < RADIUS)
        near = position[plate, 0].max()
        assert near == pytest.approx(pipe.liquid.plate_face - RADIUS / 8, abs=1e-12)
        faces.append(pipe.liquid.plate_face)
    steps = np.diff(faces)
    back = steps < 0
    assert back.sum() == 9
    assert steps[~back] == pytest.approx(STEP, abs=1e-12)
    assert steps[back] == pytest.approx(STEP - 0.1, abs=1e-12)
    assert -0.25 <= min(faces) < max(faces) < -0.15 + STEP


def test_the_plate_carries_the_bulk_velocity_through_the_bore():
    pipe = Pipe(length=1.0)
    pipe.run(1.0)
    velocity = []
    for _ in range(100):
        pipe.liquid.advance(STEP)
        velocity.append(pipe.liquid.bulk_velocity)
    assert np.array(velocity) == pytest.approx(1.0, abs=0.002)


def test_new_liquid_is_put_nearer_than_half_a_spacing_to_no_other():
    pipe = Pipe()
    report = pipe.liquid.advance(1e-4)
    while not report.plate_returns:
        report = pipe.liquid.advance(1e-3)
    position, liquid = pipe.particles
    x = position[liquid]
    before = x[(x[:, 0] < 0) & (x[:, 0] > -RADIUS / 8)]
    behind = x[(x[:, 0] >= 0) & (x[:, 0] < RADIUS / 8)]
    apart = np.linalg.norm(before[:, None] - behind[None], axis=-1)
    assert len(before)
    assert len(behind)
    assert apart.min() >= RADIUS / 8


def test_draws_choose_the_slab():
    one, same, other = (Pipe(draws=draws) for draws in (DRAWS, DRAWS.copy(), DRAWS[::-1].copy()))
    for pipe in (one, same, other):
        pipe.run(0.3)
    assert np.array_equal(one.liquid.position, same.liquid.position, equal_nan=True)
    assert not np.array_equal(one.liquid.position, other.liquid.position, equal_nan=True)


@pytest.mark.parametrize("reynolds", [50, 2e5])
def test_results_do_not_depend_on_threads(reynolds):
    ends = []
    for threads in (1, 2):
        pipe = Pipe(reynolds=reynolds, threads=threads)
        pipe.run(0.45)
        ends.append((pipe.liquid.position, pipe.liquid.velocity, pipe.liquid.pressure))
    for one, two in zip(*ends, strict=True):
        assert np.array_equal(one, two, equal_nan=True)


def test_a_restored_liquid_goes_on_to_the_last_bit():
    """Also where the plate has jumped back since, and after the state other slabs are drawn."""
    whole, parted = Pipe(), Pipe()
    whole.run(0.45)
    parted.liquid.restore(whole.liquid.state())
    for pipe in (whole, parted):
        pipe.run(0.45)
    for name in ("position", "velocity", "pressure", "plate_face"):
        assert np.array_equal(
            getattr(whole.liquid, name), getattr(parted.liquid, name), equal_nan=True
        )


def test_a_state_of_another_liquid_is_refused():
    with pytest.raises(ValueError, match="another liquid"):
        Pipe().liquid.restore(Pipe(length=0.8).liquid.state())


def test_the_laminar_parabola_outlives_the_plate():
    pipe = Pipe(reynolds=50)
    pipe.run(1.5)
    position, liquid = pipe.particles
    velocity = pipe.liquid.velocity
    velocity = velocity[np.isfinite(velocity[:, 0])]
    bore = liquid & (position[:, 0] >= 0) & (position[:, 0] < pipe.length)
    share = np.hypot(position[bore, 1], position[bore, 2]) / RADIUS
    error = velocity[bore] - (2 * (1 - share**2))[:, None] * [1, 0, 0]
    assert np.linalg.norm(error) < 0.05 * np.linalg.norm(2 * (1 - share**2))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"velocity": 0.0}, "velocity must be > 0 m/s"),
        ({"stroke": -0.1, "settling": 0.3}, "stroke must be > 0 m"),
        ({"outlet": 0.0}, "outlet must be > 0 m"),
        ({"draws": np.zeros((0, 2))}, "draws must not be empty"),
        ({"draws": np.ones((1, 2))}, r"draws must lie in \[0, 1\)"),
        ({"draws": np.zeros(4)}, r"draws must have shape \(n, 2\)"),
        ({"length": 0.3}, "at most the pipe's length"),
        ({"pressure_gradient": 40.0}, "a plate drives the liquid"),
        ({"bulk_velocity": 2.0}, "a plate drives the liquid"),
    ],
)
def test_bad_input_names_the_field(change, message):
    with pytest.raises(ValueError, match=message):
        Pipe(**change)


def test_a_plate_lets_nothing_else_drive_the_liquid():
    with pytest.raises(ValueError, match="a plate drives the liquid"):
        Pipe().liquid.drive(bulk_velocity=0.5)


def test_the_layout_is_that_of_the_pipe_closed_by_a_disc():
    layout = push_plate_layout(
        radius=RADIUS, length=1.0, spacing=0.025, upstream=0.4, downstream=0.1
    )
    pipe = ring_layout(radius=RADIUS, length=1.5, spacing=0.025)
    count = len(pipe.kind)
    assert layout.position[:count] == pytest.approx(pipe.position - [0.4, 0, 0])
    assert np.array_equal(layout.kind[:count], pipe.kind)
    added, kind = layout.position[count:], layout.kind[count:]
    assert set(kind) == {Kind.WALL, Kind.GHOST}
    assert added[:, 0].max() < -0.4
    disc = np.hypot(added[:, 1], added[:, 2]) < RADIUS
    section = (pipe.kind == Kind.LIQUID).sum() / 60
    assert (disc & (kind == Kind.WALL)).sum() == (disc & (kind == Kind.GHOST)).sum() == section


def case(**changes):
    return Case(
        end_time=1.0,
        pipe={"radius": 0.1, "length": 2.0, "ends": "push-plate"},
        liquid={"density": 1000.0, "kinematic_viscosity": 1e-6, "bulk_velocity": 1.0},
        fidelity={"particle_spacing": 0.025},
    ).with_(**changes)


def test_a_plate_needs_particles_and_says_so():
    plan = make_plan(case())
    assert plan.liquid_model == "lagrangian"
    reason = next(stage.reason for stage in plan.stages if stage.name == "AdvanceLiquid")
    assert "a plate pushes them in strokes of 0.2 m" in reason
    assert particle_count(case()) > particle_count(
        case(pipe={"ends": "periodic"}, liquid={"model": "lagrangian"})
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"liquid": {"model": "profile"}},
            "liquid.model = 'profile': has no particles that a push plate could move; "
            "set liquid.model = 'lagrangian', or set pipe.ends = 'periodic'",
        ),
        (
            {"liquid": {"bulk_velocity": -1.0}},
            "liquid.bulk_velocity = -1.0: must be > 0 m/s, the velocity of the push plate; "
            "set pipe.ends = 'periodic'",
        ),
        (
            {"liquid": {"model": "lagrangian", "pressure_gradient": 40.0}},
            "liquid.pressure_gradient = 40.0: cannot be given where a push plate drives the "
            "liquid; leave it out, or set pipe.ends = 'periodic'",
        ),
        (
            {"pipe": {"stroke": 1.5}},
            "pipe.stroke = 1.5: 1.5 strokes and a radius must be at most 2 m, the length: a slab "
            "of the pipe's own liquid fills the gap; a stroke of at most 1.26667 m, or a longer "
            "pipe",
        ),
        (
            {"pipe": {"stroke": "4 cm"}},
            "pipe.stroke = 0.04: must be >= 0.05 m, two particle spacings",
        ),
        (
            {"pipe": {"ends": "periodic", "stroke": 0.2}},
            "pipe.stroke = 0.2: is that of a push plate, and the ends are periodic; "
            "set ends = 'push-plate', or leave it out",
        ),
        (
            {"liquid": None, "solids": SOLIDS},
            "pipe.ends = 'push-plate': a push plate moves liquid, and the case has none; "
            "set pipe.ends = 'periodic'",
        ),
    ],
)
def test_what_a_plate_cannot_do_is_refused_with_the_reason(change, message):
    with pytest.raises(CaseError) as error:
        case(**change)
    assert str(error.value) == message
