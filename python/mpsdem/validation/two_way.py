"""Liquid and solids that feel each other: settling, beds, suspensions, and what they exchange."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from mpsdem._core import coupling
from mpsdem.analysis import correlations
from mpsdem.case import Case
from mpsdem.plan import terminal_velocity
from mpsdem.validation.drag import DI_FELICE, ERGUN, SCHILLER_NAUMANN
from mpsdem.validation.program import results_of
from mpsdem.validation.registry import Check, Source

FloatArray = NDArray[np.float64]
T = TypeVar("T")

#: Liquids that feel solids; a row of each check for each of them.
MODELS = ("lagrangian", "eulerian")

GRAVITY = 9.81  # [m/s2]
GLASS = 2500.0  # [kg/m3]
WATER = 998.2  # [kg/m3]
VISCOSITY = 1.004e-6  # [m2/s] of water at 20 degrees Celsius
UPRIGHT = math.pi / 2

_ROWS_OF_THE_BED = (
    "averaged over 2.5 diameters, the void fraction at a solid of this even bed reads 0.006 too "
    "high, as its planes fall on the kernel's edge: 5 to 6 % of the drag; over 2 or 3 it does not"
)

RICHARDSON_ZAKI = Source(
    cite="Richardson & Zaki (1954)",
    reference="Trans. Inst. Chem. Eng. 32, 35-53, for solids of Newton's regime",
)
EQUILIBRIUM = Source(cite="balance of forces")
NEWTON = Source(cite="Newton's third law")


def checks() -> Iterator[Check]:
    """All checks of this module."""
    for model in MODELS:
        yield from _lone(model)
        yield from _crowd(model)
        yield from _packed(model)
        yield from _hovering(model)
        yield from _riser(model)
        yield from _sliding(model)
        yield from _resting(model)
        yield from _of_any_density(model)
        yield from _by_resolution(model)


def _lone(model: str) -> Iterator[Check]:
    """Glass beads in water at rest, with a liquid half as coarse again as they are large."""
    for millimetres in (0.5, 2, 5, 10, 15):
        yield Check(
            id=f"two-way/{model}/lone/{millimetres}mm",
            claim="a lone bead settles at its terminal velocity, though it drags the liquid along",
            expected=1.0,
            measure=_of(partial(_lone_speed, model, millimetres * 1e-3), lambda speeds: speeds[0]),
            relative=0.02,
            unit="v_t",
            source=SCHILLER_NAUMANN,
        )
    yield Check(
        id=f"two-way/{model}/lone/own-wake",
        claim="the liquid that a bead of 5 mm stirs up moves slowly, by the default smoothing",
        expected=0.0,
        measure=_of(partial(_lone_speed, model, 5e-3, spacing=0.8), lambda speeds: speeds[1]),
        absolute=0.02,
        unit="v_t",
        source=SCHILLER_NAUMANN,
    )


def _crowd(model: str) -> Iterator[Check]:
    """Glass beads of 1 mm that settle without net flux."""
    for void_fraction in (0.6, 0.7, 0.8, 0.9):
        yield Check(
            id=f"two-way/{model}/crowd/void-{void_fraction}",
            claim="a crowd settles at the void fraction times the slip of Di Felice's law",
            expected=1.0,
            measure=partial(_crowd_speed, model, void_fraction),
            relative=0.05,
            unit="eps u_r",
            source=DI_FELICE,
        )


def _packed(model: str) -> Iterator[Check]:
    """A bed of held beads of 2 mm, of void fraction 0.5."""
    for velocity in (0.005, 0.015, 0.05):
        yield Check(
            id=f"two-way/{model}/bed/pressure/{velocity}",
            claim="a packed bed costs the pressure that Ergun measured",
            expected=1.0,
            measure=partial(_bed_loss, model, velocity),
            slow=velocity < 0.01,
            relative=0.05,
            unit="Ergun",
            source=ERGUN,
        )


def _hovering(model: str) -> Iterator[Check]:
    """The same beads, free, in a liquid that rises as fast as Ergun says that they hover."""
    run = partial(_hover, model)
    yield Check(
        id=f"two-way/{model}/fluidised/onset",
        claim="a bed begins to hover where Ergun's loss is its weight",
        expected=1.0,
        measure=_of(run, lambda hovering: hovering[0]),
        relative=0.05,
        unit="U_mf",
        source=ERGUN,
    )
    yield Check(
        id=f"two-way/{model}/fluidised/plateau",
        claim="and then the pressure carries the weight of bed and liquid",
        expected=1.0,
        measure=_of(run, lambda hovering: hovering[1]),
        relative=0.01,
        unit="weight",
        source=EQUILIBRIUM,
    )


def _riser(model: str) -> Iterator[Check]:
    """A suspension of beads of 5 mm that water of 1 m/s carries up."""
    yield Check(
        id=f"two-way/{model}/riser/gradient",
        claim="less the friction, the pressure carries the weight of the mixture",
        expected=1.0,
        measure=_of(partial(_risen, model), _mixture_weight),
        relative=0.01,
        unit="weight",
        source=EQUILIBRIUM,
    )
    yield Check(
        id=f"two-way/{model}/riser/slip",
        claim="the solids lag by their hindered velocity of settling, the walls' share counted",
        expected=1.0,
        measure=_of(partial(_risen, model), _hindered_slip),
        relative=0.15,
        unit="v_t (1 - C)^1.38 10^(-d/D)",
        source=RICHARDSON_ZAKI,
    )


def _sliding(model: str) -> Iterator[Check]:
    """Beads of 20 mm on the bottom of a level pipe, in water of 1 m/s."""
    run = partial(_slid, model)
    yield Check(
        id=f"two-way/{model}/sliding/balance",
        claim="the pressure overcomes the shear of the liquid and the rubbing of the solids",
        expected=1.0,
        measure=_of(run, lambda flow: flow.of_walls / flow.gradient),
        relative=0.03,
        unit="gradient",
        source=EQUILIBRIUM,
    )
    yield Check(
        id=f"two-way/{model}/sliding/lift",
        claim="a bed on the wall weighs on the wall, and not on the liquid, over its weight",
        expected=0.0,
        measure=_of(run, lambda flow: flow.lift),
        absolute=0.01,
        unit="weight",
        source=EQUILIBRIUM,
    )
    yield Check(
        id=f"two-way/{model}/sliding/momentum",
        claim="the impulse that nothing explains is small beside that of the walls",
        expected=0.0,
        measure=_of(run, lambda flow: flow.momentum_error),
        absolute=0.02,
        unit="friction",
        source=NEWTON,
    )
    for name, flow_of in (("riser", _risen), ("sliding", _slid)):
        yield Check(
            id=f"two-way/{model}/{name}/exchange",
            claim="what the solids get is what the liquid loses, in every step, by its largest sum",
            expected=0.0,
            measure=_of(partial(flow_of, model), lambda flow: flow.exchange_error),
            absolute=1e-12,
            source=NEWTON,
        )


def _resting(model: str) -> Iterator[Check]:
    """A cloud that has settled in a level pipe, in liquid at rest."""
    yield Check(
        id=f"two-way/{model}/rest/lift",
        claim="solids that have come to rest on the wall weigh nothing on the liquid",
        expected=0.0,
        measure=_of(partial(_rested, model), lambda flow: flow.lift),
        absolute=0.01,
        unit="weight",
        source=EQUILIBRIUM,
    )


def _of_any_density(model: str) -> Iterator[Check]:
    """Solids lighter and heavier than the liquid in a level pipe at 1 m/s."""
    for ratio, end_time in ((0.5, 5.0), (1.0, 5.0), (1.05, 5.0), (10.0, 15.0)):  # the last is slow
        yield Check(
            id=f"two-way/{model}/density/{ratio}",
            claim="light or heavy, what rubs on the walls is what the pressure overcomes",
            expected=1.0,
            measure=_of(
                partial(_slid, model, ratio * WATER, end_time),
                lambda flow: flow.of_walls / flow.gradient,
            ),
            relative=0.03,
            unit="gradient",
            source=EQUILIBRIUM,
            slow=ratio > 5,
        )


def _by_resolution(model: str) -> Iterator[Check]:
    """The packed bed with other spacings of the liquid, and other footprints of the solids."""
    for per_spacing in (0.5, 1, 2, 4):
        yield Check(
            id=f"two-way/{model}/bed/spacing/{per_spacing}",
            claim="the loss of pressure in a bed does not hang on diameters per spacing",
            expected=1.0,
            measure=partial(_bed_loss, model, 0.02, spacing=1 / per_spacing),
            relative=0.05,
            unit="Ergun",
            source=ERGUN,
            slow=True,
            # From 1.2 diameters per spacing on the default smoothing radius is 2.5 diameters.
            differs=_ROWS_OF_THE_BED if per_spacing > 1 else "",
        )
    for radii in (2, 3, 4):
        yield Check(
            id=f"two-way/{model}/bed/smoothing/{radii}",
            claim="nor on the smoothing radius over diameters",
            expected=1.0,
            measure=partial(_bed_loss, model, 0.02, smoothing=radii),
            relative=0.05,
            unit="Ergun",
            source=ERGUN,
            slow=True,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Flow:
    """Means over the second half of a run.

    Attributes
    ----------
    gradient, friction, solids : float
        Loss of pressure, of the wall and by the drag of the solids [Pa/m].
    rubbing : float
        What the walls take from the solids [Pa/m].
    lift : float
        Force of the liquid on the solids across the pipe, upwards, over their weight in it [-].
    weight : float
        Of the solids in the liquid, over the volume of the bore [N/m3].
    velocity : float
        Of the solids along the pipe [m/s].
    exchange_error, momentum_error, clipped : float
        Of the whole run: the largest sum of what both got [-], impulse that nothing explains over
        that of the walls [-], and cut void fractions.
    """

    gradient: float
    friction: float
    solids: float
    rubbing: float
    lift: float
    weight: float
    velocity: float
    exchange_error: float
    momentum_error: float
    clipped: int

    @property
    def of_walls(self) -> float:
        """What all walls take up [Pa/m]."""
        return self.friction + self.rubbing


def _case(
    model: str,
    *,
    radius: float,
    length: float,
    end_time: float,
    solids: dict[str, Any],
    fidelity: dict[str, Any],
    velocity: float = 0.0,
    inclination: float = UPRIGHT,
    liquid: dict[str, Any] | None = None,
    frames: int = 20,
) -> Case:
    water = {"density": WATER, "kinematic_viscosity": VISCOSITY, "bulk_velocity": velocity}
    glass = {"density": GLASS, "youngs_modulus": 1e6}
    parts: dict[str, Any] = {
        "pipe": {"radius": radius, "length": length, "inclination": inclination},
        "liquid": {"model": model} | water | (liquid or {}),
        "solids": glass | solids,
        "fidelity": {"coupling": "two-way", "threads": 1} | fidelity,
        "output": {"every": end_time / frames, "figures": False},
    }
    return Case(end_time=end_time, gravity=GRAVITY, **parts)


def _flow(case: Case) -> Flow:
    assert case.solids is not None
    assert case.liquid is not None
    with results_of(case.to_toml()) as results:
        numbers = results.diagnostics
        half = len(results.time) // 2

        def mean(name: str) -> FloatArray:
            values: FloatArray = numbers[name][half:].mean(axis=0)
            return values

        volume = case.pipe.bore_volume
        excess = (case.solids.density - case.liquid.density) * case.gravity
        weight = case.solids_fraction * excess
        return Flow(
            gradient=float(mean("pressure_gradient")),
            friction=float(mean("pressure_gradient_friction")),
            solids=float(mean("pressure_gradient_solids")),
            rubbing=-float(mean("wall_force")[0]) / volume,
            lift=float(mean("drag_force")[2]) / (weight * volume) if weight else 0.0,
            weight=weight,
            velocity=float(mean("solids_mean_velocity")),
            exchange_error=float(numbers["exchange_error"].max()),
            momentum_error=float(results.summary["momentum_error"]),
            clipped=int(numbers["liquid_void_fraction_clipped"].sum()),
        )


@cache
def _lone_speed(model: str, diameter: float, spacing: float = 1.5) -> tuple[float, float]:
    """Speed of a bead that has fallen for six times its relaxation, and of the liquid it sees.

    Both over its terminal velocity. It does not come back into its wake.
    """

    def case(length: float, end_time: float) -> Case:
        return _case(
            model,
            radius=6 * diameter,
            length=length,
            end_time=end_time,
            solids={
                "diameter": diameter,
                "drag": "schiller_naumann",
                "arrangement": {"kind": "list", "positions": [[0.99 * length, 0.0, 0.0]]},
            },
            fidelity={"particle_spacing": spacing * diameter},
        )

    speed = terminal_velocity(case(50 * diameter, 1.0))
    relaxation = speed / GRAVITY / (1 - WATER / GLASS)
    length = max(20 * diameter, 7 * speed * relaxation)
    with results_of(case(length, 6 * relaxation).to_toml()) as results:
        got = -float(results.solids.velocity[-1, 0, 0])
        around = -float(results.solids.liquid_velocity[-1, 0, 0])
    return got / speed, around / speed


def _evenly(
    *, rings: int, planes: int, solid_fraction: float, diameter: float
) -> tuple[float, float, list[list[float]], float]:
    """Solids on rings in planes, as many for each ring's area, up to the wall.

    A random bed has fewer solids at the wall, and the liquid takes that way.

    Returns
    -------
    radius, length : float
        Of the pipe [m].
    positions : list of (x, y, z)
        [m].
    void_fraction : float
        [-].
    """
    pitch = 1.0005 * diameter
    generator = np.random.default_rng(0)
    volume = math.pi / 6 * diameter**3
    most = [1] + [int(math.pi / math.asin(1 / (2 * k + 1))) for k in range(1, rings)]
    positions, missing = [], np.zeros(rings)
    for plane in range(planes):
        for k in range(rings):
            radius = (k + 0.5) * pitch
            missing[k] += solid_fraction * 2 * math.pi * radius * pitch**2 / volume
            count = min(int(missing[k] + 1e-9), most[k])
            missing[k] -= count
            turn = 2 * math.pi * generator.random()
            for angle in turn + 2 * math.pi * np.arange(count) / max(count, 1):
                y, z = radius * math.cos(angle), radius * math.sin(angle)
                positions.append([(plane + 0.5) * pitch, y, z])
    radius, length = rings * pitch, planes * pitch
    filled = len(positions) * volume / (math.pi * radius**2 * length)
    return radius, length, positions, 1 - filled


@cache
def _crowd_speed(model: str, void_fraction: float) -> float:
    """Mean speed of an even crowd of 1 mm, over what the law says for its void fraction."""
    diameter, density, viscosity = 1e-3, 1000.0, 1e-6
    radius, length, positions, eps = _evenly(
        rings=6, planes=8, solid_fraction=1 - void_fraction, diameter=diameter
    )
    case = _case(
        model,
        radius=radius,
        length=length,
        end_time=0.15,
        solids={
            "diameter": diameter,
            "drag": "di_felice",
            "arrangement": {"kind": "list", "positions": positions},
        },
        fidelity={"particle_spacing": 1.2 * diameter},
        liquid={"density": density, "kinematic_viscosity": viscosity},
    )
    law = coupling.DiFelice()

    def excess(slip: float) -> float:
        """Drag of Model B less weight [N]."""
        ratio = law.force_ratio(eps * slip * diameter / viscosity, eps)
        drag = 3 * math.pi * viscosity * density * diameter * slip * ratio
        return drag - math.pi / 6 * diameter**3 * (GLASS - density) * GRAVITY

    return -_flow(case).velocity / (eps * float(brentq(excess, 1e-6, 10.0)))


def ergun_loss(velocity: float, void_fraction: float, diameter: float) -> float:
    """Loss of pressure in a packed bed, at a superficial velocity [Pa/m]."""
    viscous = 150 * VISCOSITY * (1 - void_fraction) / diameter
    return (
        WATER
        * (1 - void_fraction)
        / (void_fraction**3 * diameter)
        * (viscous + 1.75 * velocity)
        * velocity
    )


def packed_bed(
    model: str,
    velocity: float,
    *,
    held: bool,
    end_time: float,
    spacing: float = 1.0,
    smoothing: float = 0.0,
    planes: int = 7,
) -> tuple[Case, float]:
    """An even bed of 2 mm in a pipe that stands upright, and its void fraction."""
    diameter = 2e-3
    radius, length, positions, eps = _evenly(
        rings=6, planes=planes, solid_fraction=0.5, diameter=diameter
    )
    case = _case(
        model,
        radius=radius,
        length=length,
        end_time=end_time,
        velocity=velocity,
        solids={
            "diameter": diameter,
            "held": held,
            "arrangement": {"kind": "list", "positions": positions},
        },
        fidelity={
            "particle_spacing": spacing * diameter,
            "smoothing_radius": smoothing * diameter or None,
        },
    )
    return case, eps


@cache
def _bed_loss(model: str, velocity: float, spacing: float = 1.0, smoothing: float = 0.0) -> float:
    """Loss of pressure over Ergun's; spacing and smoothing radius in diameters, 0 by default."""
    case, eps = packed_bed(
        model,
        velocity,
        held=True,
        end_time=0.04 / velocity,
        spacing=spacing,
        smoothing=smoothing,
        planes=13 if spacing > 1 or smoothing > 0 else 7,
    )
    return _flow(case).gradient / ergun_loss(velocity, eps, 2e-3)


@cache
def _hover(model: str) -> tuple[float, float]:
    """Velocity at which the bed would stand still over Ergun's, and gradient over weight."""
    _, eps = packed_bed(model, 0.03, held=False, end_time=1.0)
    weight = (1 - eps) * (GLASS - WATER) * GRAVITY
    onset = float(brentq(lambda u: ergun_loss(u, eps, 2e-3) - weight, 1e-4, 1.0))
    case, _ = packed_bed(model, onset, held=False, end_time=0.3)
    flow = _flow(case)
    return (onset - flow.velocity) / onset, flow.gradient / flow.weight


@cache
def _risen(model: str) -> Flow:
    return _flow(
        _case(
            model,
            radius=0.05,
            length=0.16,
            end_time=1.5,
            velocity=1.0,
            solids={
                "diameter": 5e-3,
                "count": 400,
                "youngs_modulus": 1e5,
                "arrangement": {"kind": "random"},
            },
            fidelity={"level": "quick"},
        )
    )


def _hindered_slip(flow: Flow) -> float:
    """Slip of the suspension of 5 mm in the mean over the bore, over what is expected of it [-]."""
    concentration = flow.weight / ((GLASS - WATER) * GRAVITY)
    slip = (1.0 - flow.velocity) / (1 - concentration)  # at a bulk velocity of 1 m/s
    lone = correlations.terminal_velocity(
        diameter=5e-3,
        density=GLASS,
        liquid_density=WATER,
        kinematic_viscosity=VISCOSITY,
        gravity=GRAVITY,
    )
    return slip / (lone * math.pow(1 - concentration, 1.38) * math.pow(10, -5 / 100))


def _mixture_weight(flow: Flow) -> float:
    return (flow.gradient - flow.friction) / flow.weight


@cache
def _slid(model: str, density: float = 2700.0, end_time: float = 5.0) -> Flow:
    return _flow(
        _case(
            model,
            radius=0.1,
            length=0.6,
            end_time=end_time,
            velocity=1.0,
            inclination=0.0,
            solids={
                "diameter": 0.02,
                "density": density,
                "count": 64,
                "arrangement": {"kind": "random"},
            },
            fidelity={"level": "quick"},
        )
    )


@cache
def _rested(model: str) -> Flow:
    return _flow(
        _case(
            model,
            radius=0.05,
            length=0.12,
            end_time=1.2,
            inclination=0.0,
            solids={"diameter": 5e-3, "count": 800, "arrangement": {"kind": "random"}},
            fidelity={"level": "quick"},
        )
    )


def _of(run: Callable[[], T], what: Callable[[T], float]) -> Callable[[], float]:
    """Measure one number of a run."""
    return lambda: what(run())
