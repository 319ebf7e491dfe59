"""Coarse solids through pipes: what the program gives beside correlations, and what must hold.

These runs are the two cases ``newitt_1inch`` and ``glass5mm_100mm`` at other velocities and
inclinations, liquid on nodes and two-way at quick fidelity: 1 to 10 minutes each, some 25 in all.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial
from typing import Any

import numpy as np

from mpsdem.analysis.head_loss import DHLLDV, Measured, measured
from mpsdem.case import Case
from mpsdem.validation.head_loss import MIEDEMA
from mpsdem.validation.program import results_of
from mpsdem.validation.registry import Check, Source

GRAVITY = 9.81  # [m/s2]
FRICTION = 0.4  # [-] of gravel on steel, Wilson et al. (2006)

EQUILIBRIUM = Source(cite="balance of forces")
VLASAK = Source(
    cite="Vlasak et al. (2017)",
    reference="J. Hydrol. Hydromech. 65, 183-191, measured with basalt of 11 mm: conclusions",
)
DELIVERED = Source(
    cite="Durand & Condolios (1952)",
    reference="shape of the curve of a constant delivered concentration",
)
WILSON = Source(
    cite="Wilson et al. (2006)",
    reference="doi:10.1007/b101079, p. 116: gravel slides on steel with 0.4",
)

_WATER = {"density": 998.2, "kinematic_viscosity": 1.004e-6}
_SOLIDS = {
    "friction": FRICTION,
    "restitution": 0.9,
    "youngs_modulus": 1e7,
    "poisson_ratio": 0.2,
    "arrangement": {"kind": "random"},
}


def rig(velocity: float, inclination: float = 0.0, concentration: float = 0.1) -> Case:
    """Gravel of 4.5 mm through the pipe of an inch of Newitt and others.

    Parameters
    ----------
    velocity : float
        Of liquid and solids [m/s].
    inclination : float
        Rise of the pipe [rad].
    concentration : float
        In situ [-].
    """
    return _case(
        {"radius": 0.0127, "length": 0.254, "inclination": inclination},
        {"diameter": 4.5e-3, "density": 2600.0, "volume_fraction": concentration},
        velocity,
        end_time=5.0,
    )


def glass(velocity: float) -> Case:
    """Glass of 5 mm through a pipe of 100 mm, 5 % in situ.

    Parameters
    ----------
    velocity : float
        Of liquid and solids [m/s].
    """
    return _case(
        {"radius": 0.05, "length": 0.5},
        {"diameter": 5e-3, "density": 2500.0, "volume_fraction": 0.05},
        velocity,
        end_time=4.0,
    )


def checks() -> Iterator[Check]:
    """All checks of this module."""
    for velocity in (1.0, 1.5, 2.0, 2.5, 3.0):
        yield from _beside_the_framework("newitt-1inch", rig, velocity, 0.30)
    for velocity, tolerance in ((2.0, 0.30), (3.0, 0.30), (4.0, 0.15), (5.0, 0.15)):
        yield from _beside_the_framework("glass-100mm", glass, velocity, tolerance)
    yield from _bed()
    yield from _least()
    yield from _inclined()


def _beside_the_framework(
    name: str, scene: Callable[[float], Case], velocity: float, tolerance: float
) -> Iterator[Check]:
    run = partial(_conveyed, scene, velocity)
    yield Check(
        id=f"conveying/{name}/{velocity}/gradient",
        claim="coarse solids cost what the framework says of as many in situ",
        expected=1.0,
        measure=_of(run, lambda got: got.beside_framework),
        relative=tolerance,
        unit="DHLLDV",
        source=MIEDEMA,
        slow=True,
    )
    yield Check(
        id=f"conveying/{name}/{velocity}/balance",
        claim="what the walls take from liquid and solids is what the pressure overcomes",
        expected=1.0,
        measure=_of(run, lambda got: (got.friction + got.rubbing) / got.point.gradient),
        relative=0.03,
        unit="gradient",
        source=EQUILIBRIUM,
        slow=True,
    )
    yield Check(
        id=f"conveying/{name}/{velocity}/holdup",
        claim="solids lag: less is delivered than is in situ, the ratio lies between 0 and 1",
        expected=0.5,
        measure=_of(run, lambda got: got.delivered_share),
        absolute=0.5,
        source=VLASAK,
        slow=True,
    )


def _bed() -> Iterator[Check]:
    yield Check(
        id="conveying/newitt-1inch/1.0/excess",
        claim="a sliding bed costs its friction: excess gradient over its weight in water",
        expected=FRICTION,
        measure=_of(partial(_conveyed, rig, 1.0), lambda got: got.relative_excess),
        relative=0.1,
        source=WILSON,
        slow=True,
    )


def _least() -> Iterator[Check]:
    """As many solids delivered at 0.4, 0.6 and 1 m/s, of which the more are in situ the slower."""
    yield Check(
        id="conveying/newitt-1inch/least",
        claim="the same delivery costs least in between: over slower and faster flow less than 1",
        expected=0.5,
        measure=_least_loss,
        absolute=0.5,
        source=DELIVERED,
        slow=True,
    )


def _inclined() -> Iterator[Check]:
    """At 2 m/s through the pipe of an inch, 30 degrees up and down, and upright."""
    up = partial(_conveyed, rig, 2.0, math.radians(30))
    down = partial(_conveyed, rig, 2.0, math.radians(-30))
    upright = partial(_conveyed, rig, 2.0, math.radians(90))
    level = partial(_conveyed, rig, 2.0)
    yield Check(
        id="conveying/inclined/holdup",
        claim="of as many in situ fewer are delivered up than down, the ratio is less than 1",
        expected=0.5,
        measure=lambda: up().delivered_share / down().delivered_share,
        absolute=0.5,
        source=VLASAK,
        slow=True,
    )
    yield Check(
        id="conveying/inclined/friction",
        claim="friction, static head apart, is less upright than level, the ratio is less than 1",
        expected=0.5,
        measure=lambda: upright().of_friction / level().of_friction,
        absolute=0.5,
        source=VLASAK,
        slow=True,
    )
    for name, run in (("up", up), ("down", down), ("upright", upright)):
        yield Check(
            id=f"conveying/inclined/{name}/balance",
            claim="walls and weight of the mixture are what the pressure overcomes",
            expected=1.0,
            measure=_of(
                run, lambda got: (got.friction + got.rubbing + got.lifting) / got.point.gradient
            ),
            relative=0.03,
            unit="gradient",
            source=EQUILIBRIUM,
            slow=True,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Conveyed:
    """Means over the second half of a run.

    Attributes
    ----------
    point : Measured
        Loss of pressure, and at what.
    friction, rubbing : float
        What the walls take from the liquid, and from the solids [Pa/m].
    """

    point: Measured
    friction: float
    rubbing: float

    @property
    def beside_framework(self) -> float:
        """Loss of pressure over that of DHLLDV at the same in-situ concentration [-]."""
        return self.point.gradient / DHLLDV.gradient(self.point.flow)

    @property
    def relative_excess(self) -> float:
        """Loss of pressure less that of the liquid alone, over the weight of the solids [-]."""
        flow = self.point.flow
        return (self.point.gradient - flow.clear_gradient) / flow.bed_weight

    @property
    def lifting(self) -> float:
        """Weight of the solids along the pipe [Pa/m]."""
        return self.point.flow.bed_weight * math.sin(self.point.inclination)

    @property
    def of_friction(self) -> float:
        """Loss of pressure, weight apart [Pa/m]."""
        return self.point.gradient - self.lifting

    @property
    def delivered_share(self) -> float:
        """Delivered over in-situ concentration [-]."""
        return self.point.delivered / self.point.flow.concentration


def _case(pipe: dict[str, Any], solids: dict[str, Any], velocity: float, end_time: float) -> Case:
    parts: dict[str, Any] = {
        "pipe": pipe,
        "liquid": _WATER | {"bulk_velocity": velocity},
        "solids": _SOLIDS | solids,
        "fidelity": {"level": "quick", "threads": 1},
        "output": {"every": 0.05, "figures": False},
    }
    return Case(end_time=end_time, gravity=GRAVITY, **parts)


@cache
def _conveyed(scene: Callable[..., Case], *arguments: float) -> Conveyed:
    with results_of(scene(*arguments).to_toml()) as results:
        later = results.time >= results.time[-1] / 2
        numbers = results.diagnostics
        walls = numbers["wall_force"][later].mean(axis=0)
        return Conveyed(
            point=measured(results),
            friction=float(numbers["pressure_gradient_friction"][later].mean()),
            rubbing=-float(walls[0]) / results.case.pipe.bore_volume,
        )


def _least_loss() -> float:
    """Loss at 0.6 m/s over the lesser of those at 0.4 and 1 m/s, as much delivered [-]."""
    slow = _conveyed(rig, 0.4, 0.0, 0.2)
    delivered = slow.point.delivered

    def loss(velocity: float, concentrations: tuple[float, float]) -> float:
        runs = [_conveyed(rig, velocity, 0.0, share) for share in concentrations]
        shares = [run.point.delivered for run in runs]
        return float(np.interp(delivered, shares, [run.point.gradient for run in runs]))

    between = loss(0.6, (0.1, 0.2))
    return between / min(slow.point.gradient, loss(1.0, (0.05, 0.1)))


def _of(run: Callable[[], Conveyed], what: Callable[[Conveyed], float]) -> Callable[[], float]:
    """Measure one number of a run."""
    return lambda: what(run())
