"""The liquid on fixed nodes: exact laminar flows, turbulent friction and profile."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray
from scipy.special import jn_zeros, jv

from mpsdem._core import mps
from mpsdem.geometry import NodeLayout, node_layout
from mpsdem.validation.registry import Check, Source

FloatArray = NDArray[np.float64]

POISEUILLE = Source(cite="Hagen-Poiseuille")
SZYMANSKI = Source(cite="Szymanski (1932)", reference="J. Math. Pures Appl. 11, 67-107")
WOMERSLEY = Source(cite="Womersley (1955)", reference="doi:10.1113/jphysiol.1955.sp005276")
COLEBROOK = Source(cite="Colebrook (1939)", reference="doi:10.1680/ijoti.1939.13150")
LOG_LAW = Source(cite="log law", reference="u+ = ln(y+) / 0.41 + 5.2; Pope (2000), ch. 7")

RADIUS = 0.5  # [m]; the bore is 1 m, and the bulk velocity 1 m/s where there is one
DENSITY = 1000.0
LENGTH = 0.5  # [m] the flows checked here are the same everywhere along the pipe


def checks() -> Iterator[Check]:
    """All checks of this module."""
    yield from _poiseuille()
    yield from _decay()
    yield from _start_up()
    yield from _oscillation()
    yield from _friction()
    yield from _log_law()
    yield Check(
        id="eulerian/shaking",
        claim="shaking a full pipe across its axis at 20 m/s2 moves no liquid",
        expected=0.0,
        measure=_moved_by_shaking,
        absolute=1e-12,
        unit="U",
    )


def _poiseuille() -> Iterator[Check]:
    for across in (10, 16):
        yield Check(
            id=f"eulerian/poiseuille/{across}",
            claim="from rest, a given gradient leads to the parabola",
            expected=0.0,
            measure=partial(_poiseuille_error, across),
            absolute=1e-10,
            unit="U",
            source=POISEUILLE,
        )
    yield Check(
        id="eulerian/poiseuille/gradient",
        claim="holding the bulk velocity takes 32 mu U / D^2",
        expected=32 * DENSITY / 100,
        measure=_poiseuille_gradient,
        relative=1e-10,
        unit="Pa/m",
        source=POISEUILLE,
    )


def _decay() -> Iterator[Check]:
    for name, claim in (
        ("axial", "a mode J0 along the pipe decays, to second order in the spacing"),
        ("swirl", "a swirl J1 about the axis decays, to second order in the spacing"),
    ):
        yield Check(
            id=f"eulerian/decay/{name}/order",
            claim=claim,
            expected=2.0,
            measure=partial(_decay_order, name),
            absolute=0.1,
        )
        yield Check(
            id=f"eulerian/decay/{name}/24",
            claim="with 24 spacings across, after falling to 1/e",
            expected=0.0,
            measure=partial(_decay_error, name, 24),
            absolute=0.01,
        )


def _start_up() -> Iterator[Check]:
    for time, printed in ((0.05, 0.19962), (0.1, 0.38519), (0.2, 0.65180), (0.5, 0.93852)):
        yield Check(
            id=f"eulerian/start-up/{time}",
            claim="under a sudden gradient, on the axis, over its last value at t nu / R^2",
            expected=printed,
            measure=partial(_started, time),
            relative=0.01,
            source=SZYMANSKI,
        )


def _oscillation() -> Iterator[Check]:
    for womersley, axis, axis_lag, flow, flow_lag in (
        (1, 0.98493, 10.65, 0.98557, 9.45),
        (3, 0.52198, 64.29, 0.54835, 54.30),
        (10, 0.03975, 89.86, 0.06947, 81.31),
    ):
        for name, part, amplitude, lag in (
            ("axis", 0, axis, axis_lag),
            ("flow", 1, flow, flow_lag),
        ):
            id_ = f"eulerian/womersley/{womersley}/{name}"
            yield Check(
                id=f"{id_}/amplitude",
                claim="under a gradient that oscillates, over the steady flow",
                expected=amplitude,
                measure=partial(_oscillated, womersley, part, "amplitude"),
                relative=0.03,
                source=WOMERSLEY,
            )
            yield Check(
                id=f"{id_}/lag",
                claim="behind a gradient that oscillates",
                expected=lag,
                measure=partial(_oscillated, womersley, part, "lag"),
                absolute=3.0,
                unit="deg",
                source=WOMERSLEY,
            )


def _friction() -> Iterator[Check]:
    for reynolds in (1e4, 5e4, 2e5, 5e5):
        for across in (10, 16):
            yield Check(
                id=f"eulerian/friction/smooth/{reynolds:.0e}/{across}",
                claim="the friction factor of a smooth pipe",
                expected=float(mps.friction_factor(reynolds)),
                measure=partial(_friction_factor, reynolds, 0.0, across),
                relative=0.04,
                source=COLEBROOK,
            )
    for reynolds, roughness in ((1e5, 0.002), (1e6, 0.002), (2e5, 4.5e-4)):
        yield Check(
            id=f"eulerian/friction/rough/{reynolds:.0e}/{roughness}",
            claim="the friction factor of a rough pipe",
            expected=float(mps.friction_factor(reynolds, roughness)),
            measure=partial(_friction_factor, reynolds, roughness, 16),
            relative=0.05,
            source=COLEBROOK,
        )


def _log_law() -> Iterator[Check]:
    for share in (0.125, 0.25, 0.375):
        yield Check(
            id=f"eulerian/log-law/{share}",
            claim="velocity over the log law at a share of the radius from a smooth wall, Re 2e5",
            expected=1.0,
            measure=partial(_over_log_law, share),
            relative=0.02,
            source=LOG_LAW,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Flow:
    """A liquid, where its nodes are, and how far from the axis in radii."""

    liquid: mps.EulerianLiquid
    nodes: NodeLayout
    share: FloatArray

    def advance(self, time: float) -> None:
        """Go on by a time [s]; NaN everywhere where it is not sound."""
        if not self.liquid.advance(time).sound:
            raise ArithmeticError("the liquid ran away")

    def error(self, exact: FloatArray) -> float:
        """Norm of the velocity less the exact one, (n, 3), over that of the exact one [-]."""
        weight = self.nodes.area[:, None]
        difference = self.liquid.velocity[:, 0] - exact
        return float(np.sqrt((weight * difference**2).sum() / (weight * exact**2).sum()))


def _flow(
    across: int,
    viscosity: float,
    start: Callable[[FloatArray, FloatArray], FloatArray],
    *,
    turbulent: bool = False,
    roughness: float = 0.0,
    bulk_velocity: float = 1.0,
    pressure_gradient: float | None = None,
) -> Flow:
    """Make a liquid that starts from a velocity (n, 3) over the share of the radius and place."""
    nodes = node_layout(radius=RADIUS, length=LENGTH, spacing=2 * RADIUS / across)
    share = np.hypot(*nodes.place.T) / RADIUS
    velocity = np.repeat(start(share, nodes.place)[:, None], nodes.stations, axis=1)
    liquid = mps.EulerianLiquid(
        place=nodes.place,
        area=nodes.area,
        wall_count=nodes.wall_count,
        stations=nodes.stations,
        spacing=nodes.spacing,
        velocity=velocity,
        pipe_radius=RADIUS,
        pipe_length=LENGTH,
        density=DENSITY,
        kinematic_viscosity=viscosity,
        roughness=roughness,
        turbulent=turbulent,
        bulk_velocity=bulk_velocity,
        pressure_gradient=pressure_gradient,
    )
    return Flow(liquid=liquid, nodes=nodes, share=share)


def _along(values: FloatArray) -> FloatArray:
    """Turn axial velocities into vectors."""
    return np.outer(values, [1.0, 0.0, 0.0])


def _still(share: FloatArray, _place: FloatArray) -> FloatArray:
    return _along(0 * share)


def _parabola(share: FloatArray, _place: FloatArray | None = None) -> FloatArray:
    return _along(2 * (1 - share**2))


def _driven(across: int) -> Flow:
    """Flow at rest, under the gradient that makes U = 1 m/s; nu = R^2 / s."""
    viscosity = RADIUS**2
    gradient = 8 * DENSITY * viscosity / RADIUS**2
    return _flow(across, viscosity, _still, pressure_gradient=gradient)


def _poiseuille_error(across: int) -> float:
    flow = _driven(across)
    flow.advance(5.0)
    return float(np.abs(flow.liquid.velocity[:, 0] - _parabola(flow.share)).max())


def _poiseuille_gradient() -> float:
    flow = _flow(10, 1 / 100, _parabola)
    flow.advance(0.5)
    return float(flow.liquid.pressure_gradient)


def _mode(name: str, share: FloatArray, place: FloatArray) -> tuple[FloatArray, float]:
    """Give an exact solution at time 0, and the root of its decay rate in sqrt(nu) / R."""
    if name == "axial":
        zero = float(jn_zeros(0, 1)[0])
        return _along(jv(0, zero * share)), zero
    zero = float(jn_zeros(1, 1)[0])
    y, z = place.T
    rate = jv(1, zero * share) / np.maximum(RADIUS * share, 1e-12)
    return np.stack([0 * y, -rate * z, rate * y], axis=1), zero


@cache
def _decay_error(name: str, across: int) -> float:
    viscosity = 1 / 10
    flow = _flow(across, viscosity, lambda s, at: _mode(name, s, at)[0], pressure_gradient=0.0)
    exact, zero = _mode(name, flow.share, flow.nodes.place)
    flow.advance(RADIUS**2 / viscosity / zero**2)
    return flow.error(exact * np.exp(-1))


def _decay_order(name: str) -> float:
    return float(np.log(_decay_error(name, 10) / _decay_error(name, 24)) / np.log(2.4))


@cache
def _started(time: float) -> float:
    flow = _driven(16)
    flow.advance(time)
    return float(flow.liquid.velocity[0, 0, 0]) / 2


@cache
def _oscillation_of(womersley: int) -> tuple[complex, complex]:
    """Axis velocity and flow rate, over those of the steady flow, as complex amplitudes.

    The run starts from the exact oscillation and lasts two periods, of which the second counts; the
    slowest oscillation, whose steps are bound by viscosity, has a coarser pipe and one period.
    """
    viscosity = 1 / 10
    rate = womersley**2 * viscosity / RADIUS**2  # [rad/s]
    push = 8 * viscosity / RADIUS**2  # [m/s2] amplitude, U = 1 m/s if it were steady
    argument = womersley * np.exp(0.75j * np.pi)

    def exact(share: FloatArray, _place: FloatArray) -> FloatArray:
        wave = push / (1j * rate) * (1 - jv(0, argument * share) / jv(0, argument))
        return _along(wave.real)

    slow = womersley <= 1
    flow = _flow(16 if slow else 24, viscosity, exact, bulk_velocity=0.0, pressure_gradient=0.0)
    steps = 100  # of a period
    step = 2 * np.pi / rate / steps
    sums = np.zeros(2, dtype=complex)
    first = 0 if slow else steps
    for k in range(first + steps):
        mean = push * (np.sin(rate * (k + 1) * step) - np.sin(rate * k * step)) / (rate * step)
        flow.liquid.drive(bulk_velocity=0.0, pressure_gradient=DENSITY * mean)
        flow.advance(step)
        if k >= first:
            now = np.array([flow.liquid.velocity[0, 0, 0] / 2, flow.liquid.bulk_velocity])
            sums += now * np.exp(-1j * rate * (k + 1) * step)
    axis, bulk = 2 * sums / steps
    return complex(axis), complex(bulk)


def _oscillated(womersley: int, part: int, what: str) -> float:
    wave = _oscillation_of(womersley)[part]
    return abs(wave) if what == "amplitude" else float(-np.degrees(np.angle(wave)))


@cache
def _turbulent(reynolds: float, roughness: float, across: int) -> Flow:
    """Developed flow at U = 1 m/s, from a power law; a wall of relative roughness [-]."""
    flow = _flow(
        across,
        1 / reynolds,
        lambda share, _: _along(1.2245 * np.maximum(1 - share, 0) ** (1 / 7)),
        turbulent=True,
        roughness=roughness * 2 * RADIUS,
    )
    flow.advance(60.0)
    return flow


def _friction_factor(reynolds: float, roughness: float, across: int) -> float:
    flow = _turbulent(reynolds, roughness, across)
    return float(flow.liquid.pressure_gradient) * 2 * RADIUS / (DENSITY / 2)


def _over_log_law(share: float) -> float:
    """Mean over the ring at that share of the radius from the wall."""
    flow = _turbulent(2e5, 0.0, 16)
    ring = np.isclose(flow.share, 1 - share)
    speed = float(np.sqrt(flow.liquid.wall_shear / DENSITY))
    plus = share * RADIUS * speed * 2e5
    law = np.log(plus) / 0.41 + 5.2
    return float(flow.liquid.velocity[ring, 0, 0].mean() / speed / law)


def _moved_by_shaking() -> float:
    """Largest difference that 20 m/s2 at 5 Hz makes to a disturbed flow in half a second."""
    ends = []
    for shake in (0.0, 20.0):
        flow = _flow(10, 1 / 2e5, _disturbed, turbulent=True)
        for k in range(50):
            flow.liquid.body_force(np.array([0.0, 1.0, -1.0]) * shake * np.cos(0.1 * np.pi * k))
            flow.advance(0.01)
        ends.append(flow.liquid.velocity)
    return float(np.abs(ends[1] - ends[0]).max())


def _disturbed(share: FloatArray, place: FloatArray) -> FloatArray:
    across = 0.1 * (1 - share**2)
    return np.stack([1 + 0 * share, across, across * place[:, 0] / RADIUS], axis=1)
