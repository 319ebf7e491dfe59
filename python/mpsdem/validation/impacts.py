"""Impacts: Hertz's solution, restitution, oblique rebounds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial

from mpsdem.validation.ball import (
    Ball,
    Rebound,
    bounce_height,
    impact_of_two,
    impact_on_linear_spring,
    impact_on_plane,
)
from mpsdem.validation.registry import Check, Source

CHUNG_OOI = Source(
    cite="Chung & Ooi (2011)",
    reference="doi:10.1007/s10035-011-0277-0, curves as digitised for the Kratos DEM benchmarks",
)
HERTZ = Source(cite="Hertz (1882)", reference="doi:10.1515/crll.1882.92.156")
KHARAZ = Source(
    cite="Kharaz et al. (2001)",
    reference="doi:10.1016/S0032-5910(01)00283-2, measured, 5 mm oxide spheres on thick glass",
)
FOERSTER = Source(
    cite="Foerster et al. (1994)",
    reference="Phys. Fluids 6, 1108-1115, measured, 3.2 mm glass spheres; read from a plot",
)

GLASS = Ball(radius=0.010, density=2800, youngs_modulus=4.8e10, poisson_ratio=0.20)
ALUMINIUM = Ball(radius=0.10, density=2699, youngs_modulus=7e10, poisson_ratio=0.30)
OXIDE = Ball(radius=0.0025, density=4000, youngs_modulus=3.8e11, poisson_ratio=0.23)
IRON = Ball(radius=0.0025, density=7000, youngs_modulus=1e11, poisson_ratio=0.25)
ALLOY = Ball(radius=0.0025, density=2700, youngs_modulus=7e10, poisson_ratio=0.33)
STEEL = Ball(radius=1e-5, density=7850, youngs_modulus=2.08e11, poisson_ratio=0.30)
LARGE_ALLOY = Ball(radius=0.1, density=2700, youngs_modulus=7e10, poisson_ratio=0.33)
COPPER = Ball(radius=0.1, density=8900, youngs_modulus=1.2e11, poisson_ratio=0.35)
# A ball that stands for a curved rigid wall.
HEAVY_ALLOY = Ball(radius=0.5, density=2.7e6, youngs_modulus=7e13, poisson_ratio=0.33)
BALL = Ball(radius=0.005, density=2500, youngs_modulus=1e8, poisson_ratio=0.20)
BEAD = Ball(radius=0.00159, density=2500, youngs_modulus=6e10, poisson_ratio=0.22)

MICRO_SLIP = (
    "at small angles the contact slips at its rim, which Mindlin's stiffness without micro-slip "
    "leaves out; the tangential restitution of the same impacts is within 3 %, and at 5 degrees "
    "the published one implies 17.6 rad/s, not 19.3"
)
MEASURED_GRIP = (
    "below 30 degrees the measured spheres keep less of their tangential speed than elastic "
    "theory with the measured friction says; from there on, sliding throughout, they agree"
)
SOFT_SPRING = (
    "the digitised sticking branch of test 5 reverses the contact patch as a spring far softer "
    "than Mindlin's would; it contradicts test 4 of the same paper, which is the same problem in "
    "dimensionless numbers, and is met within 3 %"
)
TANGENTIAL_DAMPING = (
    "the sticking branch of test 6 (restitution 0.5) depends on how the tangential motion is "
    "damped, which no theory settles; the sliding branch is met"
)


def checks() -> Iterator[Check]:
    """All checks of this module."""
    yield from _head_on()
    yield from _restitution()
    yield from _oblique()
    yield from _measured_rebounds()
    yield from _steady_normal_speed()
    yield from _spinning()
    yield from _two_spinning()


def _head_on() -> Iterator[Check]:
    glass = partial(impact_of_two, GLASS, GLASS, normal=10.0, other_normal=10.0)
    aluminium = partial(impact_on_plane, ALUMINIUM, normal=0.2)
    for name, run, overlap, force, duration in (
        ("glass-pair", glass, 274.11e-6, 10696.9, 40.34e-6),
        ("aluminium-on-plane", aluminium, 49.717e-6, 11369.9, 731.66e-6),
    ):
        for quantity, measure, expected, unit in (
            ("overlap", reading(run, lambda after: after.largest_overlap), overlap, "m"),
            ("force", reading(run, lambda after: after.largest_force), force, "N"),
            ("duration", reading(run, lambda after: after.duration), duration, "s"),
        ):
            yield Check(
                id=f"impact/{name}/{quantity}",
                claim=f"the {quantity} of an elastic impact is Hertz's",
                expected=expected,
                measure=measure,
                relative=0.01,
                unit=unit,
                source=HERTZ,
            )
    spring = partial(impact_on_linear_spring, BALL, normal=1.0, stiffness=5e4)
    for quantity, measure, expected, unit in (
        ("overlap", reading(spring, lambda after: after.largest_overlap), 161.80e-6, "m"),
        ("duration", reading(spring, lambda after: after.duration), 508.31e-6, "s"),
    ):
        yield Check(
            id=f"impact/linear-spring/{quantity}",
            claim=f"the {quantity} of an impact on a linear spring is that of half a swing",
            expected=expected,
            measure=measure,
            relative=0.01,
            unit=unit,
        )


def _restitution() -> Iterator[Check]:
    speed = 3.9
    for name, ball in (("oxide", OXIDE), ("iron", IRON)):
        for restitution in (0.2, 0.4, 0.6, 0.8, 1.0):
            run = partial(impact_on_plane, ball, normal=speed, restitution=restitution)
            yield Check(
                id=f"restitution/{name}/{restitution}",
                claim="a head-on impact returns the restitution it was given",
                expected=restitution,
                measure=reading(run, lambda after: after.normal / speed),
                relative=0.005,
                source=CHUNG_OOI,
            )
    for restitution in (0.2, 0.4, 0.6, 0.8, 1.0):
        run = partial(
            impact_on_linear_spring, BALL, normal=1.0, stiffness=5e4, restitution=restitution
        )
        yield Check(
            id=f"restitution/linear-spring/{restitution}",
            claim="and so does a linear spring",
            expected=restitution,
            measure=reading(run, lambda after: after.normal),
            relative=0.005,
        )
    yield Check(
        id="restitution/bounce",
        claim="a dropped ball comes back to e^2 of its height",
        expected=0.32,
        measure=partial(bounce_height, BALL, height=0.5, restitution=0.8),
        relative=0.005,
        unit="m",
    )


def _oblique() -> Iterator[Check]:
    """A resultant speed of 3.9 m/s at various angles from the normal; test 4."""
    # degrees: tangential restitution of oxide, of alloy, spin of oxide [rad/s]
    curves = {
        5: (0.9481, 0.8987, 19.3),
        10: (0.6870, 0.6713, 213.0),
        15: (0.6244, 0.6128, 377.8),
        20: (0.6161, 0.6087, 510.6),
        25: (0.6343, 0.6334, 599.4),
        30: (0.6837, 0.6829, 616.5),
        40: (0.7809, 0.7801, 544.8),
        60: (0.8929, 0.8913, 357.5),
        80: (0.9662, 0.9662, 126.3),
    }
    for degrees, (oxide, alloy, spin) in curves.items():
        for name, ball, expected in (("oxide", OXIDE, oxide), ("alloy", ALLOY, alloy)):
            yield Check(
                id=f"oblique/{name}/{degrees}deg/restitution",
                claim="an oblique impact keeps the published share of its tangential speed",
                expected=expected,
                measure=tangential_restitution(ball, degrees),
                relative=0.03,
                source=CHUNG_OOI,
            )
        yield Check(
            id=f"oblique/oxide/{degrees}deg/spin",
            claim="an oblique impact leaves the published spin",
            expected=spin,
            measure=reading(at_angle(OXIDE, degrees), lambda after: after.spin),
            relative=0.03,
            unit="rad/s",
            source=CHUNG_OOI,
            differs=MICRO_SLIP if degrees <= 10 else "",
        )
    for degrees, recoil in ((20, -7.54), (25, -7.54), (40, 11.57), (60, 47.79)):
        yield Check(
            id=f"oblique/alloy/{degrees}deg/recoil",
            claim="the contact patch leaves at the published angle, backwards at small angles",
            expected=recoil,
            measure=reading(
                at_angle(ALLOY, degrees),
                lambda after: math.degrees(math.atan2(after.patch, after.normal)),
            ),
            relative=0.03,
            unit="deg",
            source=CHUNG_OOI,
        )
    for degrees, restitution, spin in ((40, 0.7829, 544.2), (50, 0.8471, 456.7), (70, 0.9337, 243)):
        yield Check(
            id=f"oblique/sliding/{degrees}deg/restitution",
            claim="a contact that slides throughout takes mu (1 + e) of the normal speed",
            expected=restitution,
            measure=tangential_restitution(OXIDE, degrees),
            relative=0.005,
        )
        yield Check(
            id=f"oblique/sliding/{degrees}deg/spin",
            claim="and turns the ball by 5/2 of that",
            expected=spin,
            measure=reading(at_angle(OXIDE, degrees), lambda after: after.spin),
            relative=0.005,
            unit="rad/s",
        )


def _measured_rebounds() -> Iterator[Check]:
    for degrees, measured in (
        (9.63, 0.6728),
        (20.08, 0.5964),
        (30.22, 0.6883),
        (39.30, 0.7719),
        (49.55, 0.8469),
        (59.84, 0.9019),
    ):
        yield Check(
            id=f"oblique/measured/{degrees}deg/restitution",
            claim="an oblique impact keeps the measured share of its tangential speed",
            expected=measured,
            measure=tangential_restitution(OXIDE, degrees),
            relative=0.03,
            source=KHARAZ,
            differs=MEASURED_GRIP if degrees < 30 else "",
        )
    bead = partial(impact_on_plane, BEAD, normal=1.0, restitution=0.83, friction=0.11)
    yield Check(
        id="oblique/measured/reversal",
        claim="at small angles the contact patch of a glass bead leaves backwards",
        expected=-0.15,
        measure=lambda: min(bead(tangential=0.1 * k).patch for k in range(1, 8)),
        absolute=0.05,
        source=FOERSTER,
    )


def _steady_normal_speed() -> Iterator[Check]:
    """Test 5; velocities over friction times normal speed."""
    scale = 0.3 * 5.0

    def run(incidence: float) -> Callable[[], Rebound]:
        return partial(
            impact_on_plane,
            STEEL,
            normal=5.0,
            tangential=incidence * scale,
            restitution=1.0,
            friction=0.3,
        )

    for incidence, expected in ((2.0, 2.524), (4.006, 4.837), (6.0, 5.006), (10.0, 5.004)):
        yield Check(
            id=f"incidence/{incidence:g}/spin",
            claim="the spin after an impact grows with the incidence up to 5",
            expected=expected,
            measure=reading(run(incidence), lambda after: STEEL.radius * after.spin / scale),
            relative=0.03,
            source=CHUNG_OOI,
            differs=SOFT_SPRING if incidence < 5 else "",
        )
    yield Check(
        id="incidence/10/patch",
        claim="a sliding contact patch loses 7 of its incidence",
        expected=3.0,
        measure=reading(run(10.0), lambda after: after.patch / scale),
        relative=0.005,
    )


def _spinning() -> Iterator[Check]:
    """A spinning ball on a plane, and on a much heavier ball; tests 6 and 8."""
    friction, restitution, normal = 0.4, 0.5, 0.2

    def share(x: float) -> float:
        """Velocity of the contact patch that is left: 1 - x while the contact slides throughout."""
        return 3.5 * friction * (1 + restitution) * normal / x

    def on_plane(x: float) -> Callable[[], float]:
        spin = -share(x) / LARGE_ALLOY.radius
        run = partial(
            impact_on_plane,
            LARGE_ALLOY,
            normal=normal,
            spin=spin,
            restitution=restitution,
            friction=friction,
        )
        return reading(run, lambda after: -after.patch / share(x))

    def on_ball(x: float) -> Callable[[], float]:
        spin = -share(x) / LARGE_ALLOY.radius
        run = partial(
            impact_of_two,
            LARGE_ALLOY,
            HEAVY_ALLOY,
            normal=normal,
            spin=spin,
            restitution=restitution,
            friction=friction,
        )
        return reading(run, lambda after: -after.patch / share(x))

    for x, expected in ((0.176, -0.820), (0.352, -0.633), (0.551, -0.445), (2.093, 0.0579)):
        for name, measure in (("plane", on_plane(x)), ("ball", on_ball(x))):
            yield Check(
                id=f"spinning/{name}/{x}",
                claim="an impact reverses the published share of a spinning contact patch",
                expected=expected,
                measure=measure,
                relative=0.03,
                source=CHUNG_OOI,
                differs=TANGENTIAL_DAMPING if x > 1 else "",
            )
    for x in (0.25, 0.5, 0.75):
        yield Check(
            id=f"spinning/sliding/{x}",
            claim="a contact patch that slides throughout keeps 1 - 3.5 mu (1 + e) v_n / v_t",
            expected=x - 1,
            measure=on_plane(x),
            relative=0.005,
        )
    run = partial(impact_on_plane, BALL, normal=1.0, spin=2000.0, restitution=0.8, friction=0.3)
    yield Check(
        id="spinning/fast/tangential",
        claim="a fast spin drives the ball sideways with mu (1 + e) v_n",
        expected=0.54,
        measure=reading(run, lambda after: after.tangential),
        relative=0.005,
        unit="m/s",
    )
    yield Check(
        id="spinning/fast/spin",
        claim="and loses 5 mu (1 + e) v_n / (2 r)",
        expected=2000.0 - 270.0,
        measure=reading(run, lambda after: after.spin),
        relative=0.005,
        unit="rad/s",
    )


def _two_spinning() -> Iterator[Check]:
    """Balls that roll on each other; test 7."""
    for name, ball in (("alloy", LARGE_ALLOY), ("copper", COPPER)):
        run = partial(
            impact_of_two,
            ball,
            ball,
            normal=0.2,
            other_normal=0.2,
            spin=4.0,
            other_spin=-4.0,
            restitution=0.5,
            friction=0.4,
        )
        yield Check(
            id=f"spinning/co-rolling/{name}/spin",
            claim="balls that roll on each other as they meet keep their spin",
            expected=4.0,
            measure=reading(run, lambda after: after.spin),
            relative=1e-9,
            unit="rad/s",
            source=CHUNG_OOI,
        )
        yield Check(
            id=f"spinning/co-rolling/{name}/tangential",
            claim="and are not driven sideways",
            expected=0.0,
            measure=reading(run, lambda after: after.tangential),
            absolute=1e-12,
            unit="m/s",
            source=CHUNG_OOI,
        )


def at_angle(ball: Ball, degrees: float) -> Callable[[], Rebound]:
    """An impact at 3.9 m/s, at an angle from the normal, with e = 0.98 and mu = 0.092."""
    angle = math.radians(degrees)
    return partial(
        impact_on_plane,
        ball,
        normal=3.9 * math.cos(angle),
        tangential=3.9 * math.sin(angle),
        restitution=0.98,
        friction=0.092,
    )


def tangential_restitution(ball: Ball, degrees: float) -> Callable[[], float]:
    """Tangential speed after such an impact over that before it [-]."""
    before = 3.9 * math.sin(math.radians(degrees))
    return reading(at_angle(ball, degrees), lambda after: after.tangential / before)


def reading(run: Callable[[], Rebound], what: Callable[[Rebound], float]) -> Callable[[], float]:
    """Measure one number of an experiment."""
    return lambda: what(run())
