"""A pipe whose liquid a plate pushes, beside the periodic one: the two must agree."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, partial

from mpsdem.validation.program import results_of
from mpsdem.validation.registry import Check, Source

PERIODIC = Source(cite="periodic pipe", reference="this program's, at the same spacing")
POISEUILLE = Source(cite="Hagen-Poiseuille", reference="at 10 spacings across the bore")

_CASE = """
end_time = {end_time}
gravity = 0.0
[pipe]
radius = 0.1
length = 0.6
ends = "{ends}"
[liquid]
model = "lagrangian"
density = 1000.0
kinematic_viscosity = {viscosity}
bulk_velocity = 1.0
[fidelity]
particle_spacing = 0.02
[output]
every = {every}
liquid_stride = 0
figures = false
"""


def checks() -> Iterator[Check]:
    """All checks of this module."""
    turbulent = Flow(reynolds=2e5, end_time=8.0)
    yield Check(
        id="push-plate/turbulent/pressure",
        claim="a pushed liquid loses the pressure that a periodic one does",
        expected=1.0,
        measure=turbulent.gradient_over_periodic,
        relative=0.03,
        unit="periodic",
        source=PERIODIC,
    )
    yield Check(
        id="push-plate/turbulent/velocity",
        claim="the plate's velocity is the bulk's",
        expected=1.0,
        measure=partial(turbulent.mean, "push-plate", "bulk_velocity"),
        relative=0.003,
        unit="m/s",
    )
    laminar = Flow(reynolds=50.0, end_time=6.0)
    yield Check(
        id="push-plate/laminar/pressure",
        claim="a pushed laminar liquid loses 32 mu U / D^2",
        expected=3200.0,
        measure=partial(laminar.mean, "push-plate", "pressure_gradient"),
        relative=0.03,
        unit="Pa/m",
        source=POISEUILLE,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Flow:
    """Flow at 1 m/s in a pipe of three diameters, of which the second half of the time counts."""

    reynolds: float
    end_time: float

    def mean(self, ends: str, name: str) -> float:
        """Mean of a diagnostic."""
        return _means(self.reynolds, self.end_time, ends)[name]

    def gradient_over_periodic(self) -> float:
        """Loss of pressure over that of the periodic pipe [-]."""
        pushed, periodic = (
            self.mean(ends, "pressure_gradient") for ends in ("push-plate", "periodic")
        )
        return pushed / periodic


@cache
def _means(reynolds: float, end_time: float, ends: str) -> dict[str, float]:
    case = _CASE.format(end_time=end_time, ends=ends, viscosity=0.2 / reynolds, every=0.25)
    with results_of(case) as results:
        later = results.time > end_time / 2
        return {
            name: float(results.diagnostics[name][later].mean())
            for name in ("pressure_gradient", "bulk_velocity")
        }
