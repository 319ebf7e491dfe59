"""The prescribed liquid: friction factors, profiles, pressure loss."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from mpsdem._core import mps
from mpsdem.validation.program import results_of
from mpsdem.validation.registry import Check, Source

POISEUILLE = Source(cite="Hagen-Poiseuille")
COLEBROOK = Source(cite="Colebrook (1939)", reference="doi:10.1680/ijoti.1939.13150")
MCKEON = Source(
    cite="McKeon et al. (2004)",
    reference="doi:10.1017/S0022112004009796, measured, the Oregon pipe",
)
NIKURADSE = Source(
    cite="Nikuradse (1932)",
    reference="VDI-Forschungsheft 356, measured; 5 % holds the 4.28 of later measurements too",
)
LOG_LAW = Source(cite="log law", reference="u+ = ln(y+) / 0.41 + 5.0 to 5.5")

LAMINAR_CASE = """
end_time = 1.0
[pipe]
radius = "10 mm"
length = 0.1
[liquid]
density = 1000.0
kinematic_viscosity = "10 mm^2/s"
bulk_velocity = 0.05
[output]
every = 1.0
figures = false
"""


def checks() -> Iterator[Check]:
    """All checks of this module."""
    yield from _laminar()
    yield from _friction_factors()
    yield from _turbulent_profile()


def _laminar() -> Iterator[Check]:
    """Reynolds number 100."""
    yield Check(
        id="pipe/laminar/pressure",
        claim="a laminar flow loses 32 mu U / D^2",
        expected=40.0,
        measure=_laminar_gradient,
        relative=1e-6,
        unit="Pa/m",
        source=POISEUILLE,
    )
    flow = Flow(reynolds=100.0)
    for share, expected in ((0.0, 2.0), (0.5, 1.5), (0.9, 0.38)):
        yield Check(
            id=f"pipe/laminar/velocity/{share}",
            claim="a laminar profile is a parabola",
            expected=expected,
            measure=partial(flow.velocity, share),
            relative=1e-9,
            unit="U",
            source=POISEUILLE,
        )


def _friction_factors() -> Iterator[Check]:
    for reynolds, printed in (
        (5e3, 0.03789),
        (1e4, 0.03157),
        (1e5, 0.02012),
        (2e5, 0.01856),
        (5e5, 0.01734),
    ):
        yield Check(
            id=f"pipe/friction/rough/{reynolds:.0e}",
            claim="the friction factor of a rough pipe is Colebrook's, to the printed digits",
            expected=printed,
            measure=partial(mps.friction_factor, reynolds, 4.5e-4),
            absolute=0.51e-5,
            source=COLEBROOK,
        )
    for reynolds, measured in (
        (10900, 0.03088),
        (18990, 0.02670),
        (59220, 0.02000),
        (120000, 0.01686),
        (468000, 0.01365),
    ):
        yield Check(
            id=f"pipe/friction/smooth/{reynolds}",
            claim="the friction factor of a smooth pipe is the measured one",
            expected=measured,
            measure=partial(mps.friction_factor, reynolds),
            relative=0.03,
            source=MCKEON,
        )


def _turbulent_profile() -> Iterator[Check]:
    for name, flow in (
        ("smooth-1e4", Flow(reynolds=1e4)),
        ("smooth-1e5", Flow(reynolds=1e5)),
        ("rough-1e5", Flow(reynolds=1e5, roughness=1e-3)),
    ):
        yield Check(
            id=f"pipe/turbulent/flow/{name}",
            claim="a turbulent profile carries the bulk velocity",
            expected=1.0,
            measure=flow.mean_velocity,
            relative=1e-3,
            unit="U",
        )
    flow = Flow(reynolds=1e5)
    yield Check(
        id="pipe/turbulent/axis",
        claim="the velocity on the axis exceeds the bulk's by some four friction velocities",
        expected=4.07,
        measure=lambda: (flow.velocity(0.0) - 1) / flow.profile.friction_velocity,
        relative=0.05,
        source=NIKURADSE,
    )
    yield Check(
        id="pipe/turbulent/log-layer",
        claim="100 wall units from a smooth wall the velocity is that of the log law",
        expected=5.25,
        measure=lambda: flow.velocity_in_wall_units(100.0) - np.log(100.0) / 0.41,
        absolute=0.25,
        source=LOG_LAW,
    )
    yield Check(
        id="pipe/turbulent/wall-shear",
        claim="the slope at a smooth wall is the shear stress of the friction factor",
        expected=1.0,
        measure=lambda: flow.velocity_in_wall_units(0.1) / 0.1,
        relative=0.005,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Flow:
    """Flow in a pipe of unit diameter with unit bulk velocity."""

    reynolds: float
    roughness: float = 0.0

    @property
    def profile(self) -> mps.PipeProfile:
        """What is measured."""
        return mps.PipeProfile(
            pipe_radius=0.5,
            bulk_velocity=1.0,
            kinematic_viscosity=1 / self.reynolds,
            roughness=self.roughness,
        )

    def velocity(self, share: float) -> float:
        """Velocity at a share of the radius [U]."""
        return float(self.profile.velocity(np.array([[0.0, 0.5 * share, 0.0]]))[0, 0])

    def velocity_in_wall_units(self, distance: float) -> float:
        """Velocity at a distance from the wall, both in wall units [-]."""
        speed = self.profile.friction_velocity
        share = 1 - 2 * distance / (self.reynolds * speed)
        return self.velocity(share) / speed

    def mean_velocity(self) -> float:
        """Mean over the bore, by the trapezoidal rule, fine near the wall [U]."""
        share = 1 - np.geomspace(1e-7, 1.0, 20_000)[::-1]
        points = np.zeros((len(share), 3))
        points[:, 2] = 0.5 * share
        return float(np.trapezoid(2 * share * self.profile.velocity(points)[:, 0], share))


def _laminar_gradient() -> float:
    with results_of(LAMINAR_CASE) as results:
        return float(results.pressure_gradient[-1])
