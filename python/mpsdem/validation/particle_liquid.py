"""The particle liquid: exact laminar flows, turbulent friction, long runs, the liquid at rest."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator
from functools import cache, partial
from typing import TypeVar

import numpy as np

from mpsdem.analysis import turbulent_profile
from mpsdem.geometry import Kind
from mpsdem.validation import exact_flows as exact
from mpsdem.validation.liquid_runs import (
    RADIUS,
    Laminar,
    Turbulent,
    oscillation,
    poiseuille,
    start_up,
    turbulent,
)
from mpsdem.validation.pipe import COLEBROOK, LOG_LAW, POISEUILLE
from mpsdem.validation.program import results_of
from mpsdem.validation.registry import Check, Source

HYDROSTATICS = Source(cite="hydrostatics")
SERIES = Source(cite="Szymanski (1932)", reference="J. Math. Pures Appl. 11, 67")
WOMERSLEY = Source(cite="Womersley (1955)", reference="doi:10.1113/jphysiol.1955.sp005276")
CONSERVATION = Source(cite="conservation")

T = TypeVar("T")

ACROSS = (10, 16, 24)

FEW_RINGS = (
    "the mean of the particles takes a parabola at the middles of the rings that they start on, "
    "half of (2 dx / D)^2 high, until the flow has mixed them; one of five rings does not"
)

REST_CASE = """
end_time = 5.0
gravity = 9.81
[pipe]
radius = 0.1
length = 0.2
inclination = "{angle} deg"
[liquid]
model = "lagrangian"
density = 1000.0
kinematic_viscosity = 1e-6
bulk_velocity = 0.0
[fidelity]
level = "quick"
[output]
every = 1.0
liquid_stride = 1
figures = false
"""


def checks() -> Iterator[Check]:
    """All checks of this module."""
    yield from _rest()
    yield from _poiseuille()
    yield from _start_up()
    yield from _oscillation()
    yield from _friction()
    yield from _long_runs()


def _rest() -> Iterator[Check]:
    """Five seconds at a bulk velocity of zero, through the whole program."""
    for angle in (0, 50, 90):
        at_rest = partial(_at_rest, angle)
        yield Check(
            id=f"particle-liquid/rest/{angle}deg/pressure",
            claim="the wall of a pipe at rest bears the weight of the liquid above, over rho g D",
            expected=0.0,
            measure=_of(at_rest, lambda flow: flow[0]),
            absolute=0.01,
            source=HYDROSTATICS,
        )
        yield Check(
            id=f"particle-liquid/rest/{angle}deg/speed",
            claim="and no liquid moves, over sqrt(g D)",
            expected=0.0,
            measure=_of(at_rest, lambda flow: flow[1]),
            absolute=1e-3,
            source=HYDROSTATICS,
        )


def _poiseuille() -> Iterator[Check]:
    for across, tolerance in zip(ACROSS, (0.006, 0.003, 0.0015), strict=True):
        run = partial(poiseuille, across)
        yield Check(
            id=f"particle-liquid/poiseuille/{across}/velocity",
            claim="a parabola stays what it is, cross-flow counted, by its root mean square",
            expected=0.0,
            measure=_of(run, lambda flow: flow.error),
            absolute=tolerance,
            source=POISEUILLE,
            slow=across > 16,
        )
        yield Check(
            id=f"particle-liquid/poiseuille/{across}/axial",
            claim="and so does its axial velocity",
            expected=0.0,
            measure=_of(run, lambda flow: flow.axial_error),
            absolute=tolerance,
            source=POISEUILLE,
            slow=across > 16,
        )
        yield Check(
            id=f"particle-liquid/poiseuille/{across}/bulk",
            claim="a gradient of 32 mu U / D^2 drives a flow rate of U",
            expected=1.0,
            measure=_of(run, lambda flow: flow.bulk),
            relative=0.003,
            unit="U",
            source=POISEUILLE,
            slow=across > 16,
        )
        yield Check(
            id=f"particle-liquid/poiseuille/{across}/mean-of-particles",
            claim="and the mean of the particles is that flow rate",
            expected=1.0,
            measure=_of(run, lambda flow: flow.mean_of_particles),
            relative=0.003,
            unit="U",
            source=POISEUILLE,
            differs=FEW_RINGS if across == 10 else "",
            slow=across > 16,
        )


def _start_up() -> Iterator[Check]:
    for across, tolerance in zip(ACROSS, (0.02, 0.01, 0.005), strict=True):
        run = partial(start_up, across)
        yield Check(
            id=f"particle-liquid/start-up/{across}/velocity",
            claim="a flow that starts from rest is halfway where the series says, cross-flow "
            "counted, by its root mean square",
            expected=0.0,
            measure=_of(run, lambda flow: flow.error),
            absolute=tolerance,
            source=SERIES,
            slow=across > 16,
        )

    for name, error in (
        ("order", lambda flow: flow.error),
        ("axial-order", lambda flow: flow.axial_error),
    ):
        yield Check(
            id=f"particle-liquid/start-up/{name}",
            claim="and the error falls with the spacing to the power 1.5 or more; 2 counts in full",
            expected=2.0,
            measure=partial(_order, error),
            absolute=0.5,
            source=SERIES,
            slow=True,
        )


def _oscillation() -> Iterator[Check]:
    for womersley in (1.0, 3.0, 10.0):
        for where in ("flow-rate", "axis"):
            got = partial(_got_phasor, womersley, where)
            phasor = _exact_phasor(womersley, where)
            yield Check(
                id=f"particle-liquid/oscillation/{womersley:g}/{where}/amplitude",
                claim="in an oscillating gradient the amplitude is Womersley's, over the steady",
                expected=abs(phasor),
                measure=_of(got, abs),
                relative=0.03,
                source=WOMERSLEY,
                slow=True,
            )
            yield Check(
                id=f"particle-liquid/oscillation/{womersley:g}/{where}/lag",
                claim="and lags as far behind the gradient",
                expected=_lag(phasor),
                measure=_of(got, _lag),
                absolute=3.0,
                unit="deg",
                source=WOMERSLEY,
                slow=True,
            )


def _friction() -> Iterator[Check]:
    """Twenty diameters at 16 spacings across, the second ten of them measured."""
    for name, reynolds, roughness in (
        ("smooth-1e4", 1e4, 0.0),
        ("smooth-1e5", 1e5, 0.0),
        ("smooth-2e5", 2e5, 0.0),
        ("smooth-5e5", 5e5, 0.0),
        ("rough-1e5", 1e5, 2e-3),
    ):
        run = partial(turbulent, reynolds, across=16, length=1.0, time=20.0, roughness=roughness)
        yield Check(
            id=f"particle-liquid/turbulent/{name}/friction",
            claim="a turbulent flow has Colebrook's friction",
            expected=exact.colebrook(reynolds, roughness),
            measure=_of(run, lambda flow: flow.friction),
            relative=0.05,
            source=COLEBROOK,
            slow=True,
        )
        yield Check(
            id=f"particle-liquid/turbulent/{name}/profile",
            claim="and the log law's velocity in every ring of one spacing, at its middle",
            expected=0.0,
            measure=_of(run, partial(_beside_log_law, reynolds, roughness)),
            absolute=0.03,
            source=LOG_LAW,
            slow=True,
        )
        yield Check(
            id=f"particle-liquid/turbulent/{name}/momentum",
            claim="what drives it goes into wall shear and change of momentum, over the friction",
            expected=0.0,
            measure=_of(
                run,
                lambda flow: (
                    (flow.friction - flow.wall_friction - flow.change) / flow.wall_friction
                ),
            ),
            absolute=0.02,
            source=CONSERVATION,
            slow=True,
        )
        yield Check(
            id=f"particle-liquid/turbulent/{name}/ledger",
            claim="with what the pressure's error puts in, nothing is missing",
            expected=0.0,
            measure=_of(
                run,
                lambda flow: (
                    (flow.friction - flow.wall_friction - flow.change + flow.unexplained)
                    / flow.wall_friction
                ),
            ),
            absolute=1e-6,
            source=CONSERVATION,
            slow=True,
        )


def _long_runs() -> Iterator[Check]:
    """At a Reynolds number of 2e5; 100 diameters are 20 s of 1 m/s in a pipe of 0.2 m."""
    for length, across, time in ((3.0, 16, 100.0), (20.0, 10, 100.0), (80.0, 10, 5.0)):
        run = partial(turbulent, 2e5, across=across, length=length, time=time)
        path = f"particle-liquid/long/{length:g}D"
        yield Check(
            id=f"{path}/energy",
            claim="the kinetic energy of a turbulent flow does not grow",
            expected=0.0,
            measure=_of(run, lambda flow: flow.growth),
            absolute=1e-3,
            source=CONSERVATION,
            slow=True,
        )
        yield Check(
            id=f"{path}/outside",
            claim="and no particle leaves the bore, in any step",
            expected=0.0,
            measure=_of(run, lambda flow: float(flow.outside)),
            absolute=0.5,
            unit="particles",
            source=CONSERVATION,
            slow=True,
        )
        yield Check(
            id=f"{path}/mass",
            claim="so that the mass in the bore is what it was",
            expected=1.0,
            measure=_of(run, lambda flow: flow.mass),
            relative=1e-12,
            source=CONSERVATION,
            slow=True,
        )
        yield Check(
            id=f"{path}/density",
            claim="the number density scatters little, in every step",
            expected=0.0,
            measure=_of(run, lambda flow: flow.largest_scatter),
            absolute=0.03,
            source=CONSERVATION,
            slow=True,
        )
        yield Check(
            id=f"{path}/noise",
            claim="and the pressure changes little from step to step, by its root mean square",
            expected=0.0,
            measure=_of(run, lambda flow: flow.noise),
            absolute=0.005,
            unit="rho U2",
            source=CONSERVATION,
            slow=True,
        )


@cache
def _at_rest(angle: int) -> tuple[float, float]:
    """Largest error of the wall's pressure over rho g D, and largest speed over sqrt(g D) [-]."""
    with results_of(REST_CASE.format(angle=angle)) as results:
        case, liquid = results.case, results.liquid
        bore = 2 * case.pipe.radius
        wall = liquid.kind == Kind.WALL
        moving = liquid.kind == Kind.LIQUID
        rise = math.radians(angle)
        error = speed = 0.0
        for frame in range(len(results.time)):
            x = liquid.position[frame]
            height = x[:, 0] * math.sin(rise) + x[:, 2] * math.cos(rise)
            pressure = liquid.full_pressure(frame) / (1000.0 * 9.81 * bore)
            error = max(error, float(np.abs(pressure + height / bore)[wall].max()))
            fastest = np.linalg.norm(liquid.velocity[frame][moving], axis=1).max()
            speed = max(speed, float(fastest) / math.sqrt(9.81 * bore))
    return error, speed


def _beside_log_law(reynolds: float, roughness: float, flow: Turbulent) -> float:
    """Largest deviation of a ring's velocity from the log law with Colebrook's friction [-]."""
    expected = turbulent_profile(
        RADIUS * flow.ring_middles,
        pipe_radius=RADIUS,
        friction_velocity=math.sqrt(exact.colebrook(reynolds, roughness) / 8),
        kinematic_viscosity=1 / reynolds,
        roughness=roughness,
    )
    return float(np.abs(flow.profile / expected - 1).max())


def _order(error: Callable[[Laminar], float]) -> float:
    """Order of the start-up's error in the spacing, from the coarsest to the finest; at most 2."""
    errors = [error(start_up(across)) for across in ACROSS]
    slope, _ = np.polyfit(-np.log(ACROSS), np.log(errors), 1)
    return min(float(slope), 2.0)


def _exact_phasor(womersley: float, where: str) -> complex:
    if where == "flow-rate":
        return exact.mean_oscillation(womersley)
    return complex(exact.oscillation(np.zeros(1), womersley)[0])


def _got_phasor(womersley: float, where: str) -> complex:
    ratio = oscillation(womersley, 24)
    return _exact_phasor(womersley, where) * (
        ratio.flow_rate if where == "flow-rate" else ratio.axis
    )


def _lag(phasor: complex) -> float:
    """How far it lags behind the gradient [deg]."""
    return -math.degrees(cmath.phase(phasor))


def _of(run: Callable[[], T], what: Callable[[T], float]) -> Callable[[], float]:
    """Measure one number of a run."""
    return lambda: what(run())
