"""Drag: the laws' values, settling of one solid and of a crowd, packed beds."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from mpsdem._core import coupling, dem, mps
from mpsdem.plan.scales import DragLaw
from mpsdem.validation import suspension
from mpsdem.validation.program import results_of
from mpsdem.validation.registry import Check, Source

GRAVITY = 9.81  # [m/s2]
GLASS = 2500.0  # [kg/m3]
BED_VOID_FRACTION = 0.4  # [-]

BEETSTRA = Source(cite="Beetstra et al. (2007)", reference="doi:10.1002/aic.11065")
DI_FELICE = Source(cite="Di Felice (1994)", reference="doi:10.1016/0301-9322(94)90011-6")
ERGUN = Source(cite="Ergun (1952)", reference="Chem. Eng. Prog. 48, 89-94")
KOCH_HILL = Source(cite="Koch & Hill (2001)", reference="doi:10.1146/annurev.fluid.33.1.619")
WEN_YU = Source(cite="Wen & Yu (1966)", reference="Chem. Eng. Prog. Symp. Ser. 62, 100-111")
SCHILLER_NAUMANN = Source(
    cite="Schiller & Naumann (1933)", reference="Z. Ver. Dtsch. Ing. 77, 318-320"
)

RISER_CASE = """
end_time = 0.2
gravity = 9.81
[pipe]
radius = "50 mm"
length = "200 mm"
inclination = "90 deg"
[liquid]
density = 998.2
kinematic_viscosity = 1.004e-6
bulk_velocity = 0.0
[solids]
diameter = "2 mm"
density = 2500.0
youngs_modulus = 1e7
drag = "schiller_naumann"
arrangement = { kind = "list", positions = [[0.1, 0.0, 0.0]] }
[output]
every = 0.01
figures = false
"""


def checks() -> Iterator[Check]:
    """All checks of this module."""
    yield from _laws()
    yield from _lone_solid()
    yield from _from_rest()
    yield from _crowd()
    yield from _beds()


def _laws() -> Iterator[Check]:
    """Forces over 3 pi mu d eps r in Model A, worked out from the published equations."""
    table = (
        # void fraction, Reynolds number, Di Felice, Beetstra, Koch & Hill, Ergun, Wen & Yu
        (0.4, 1, "30.05", "37.87", "37.99", "31.86", "32.60"),
        (0.4, 100, "90.06", "89.79", "86.70", "92.01", "128.9"),
        (0.6, 1, "7.30", "11.84", "11.25", "9.53", "7.42"),
        (0.6, 100, "25.35", "30.74", "24.62", "36.27", "29.35"),
        (0.8, 1, "2.68", "4.25", "4.25", "2.76", "2.60"),
        (0.8, 100, "10.31", "12.95", "11.39", "17.80", "10.27"),
        (0.8, 1000, "55.5", "71.3", "76.4", "154.5", "41.4"),
    )
    laws: tuple[tuple[str, DragLaw, Source], ...] = (
        ("di_felice", coupling.DiFelice(), DI_FELICE),
        ("beetstra", coupling.Beetstra(), BEETSTRA),
        ("koch_hill", coupling.KochHill(), KOCH_HILL),
        ("ergun", coupling.ErgunWenYu(), ERGUN),
        ("wen_yu", coupling.WenYu(), WEN_YU),
    )
    for void_fraction, reynolds, *forces in table:
        for (name, law, source), force in zip(laws, forces, strict=True):
            yield Check(
                id=f"drag/{name}/void-{void_fraction}/re-{reynolds}",
                claim="a drag law has the value of its published equation, to the printed digits",
                expected=float(force),
                measure=partial(law.force_ratio, reynolds, void_fraction),
                absolute=_half_digit(force),
                source=source,
            )


def _lone_solid() -> Iterator[Check]:
    """Glass beads in water at 20 degrees Celsius."""
    for millimetres, speed in (
        (0.1, 0.00729),
        (0.2, 0.02291),
        (0.5, 0.07347),
        (1, 0.14606),
        (2, 0.26764),
        (3, 0.36630),
        (5, 0.47289),
        (10, 0.66877),
        (15, 0.81907),
    ):
        yield Check(
            id=f"settling/lone/{millimetres}mm",
            claim="a lone bead comes to settle at its terminal velocity",
            expected=speed,
            measure=partial(
                settling_speed,
                coupling.SchillerNaumann(),
                diameter=millimetres * 1e-3,
                liquid_density=998.2,
                kinematic_viscosity=1.004e-6,
            ),
            relative=0.01,
            unit="m/s",
            source=SCHILLER_NAUMANN,
        )


def _from_rest() -> Iterator[Check]:
    """A bead let go in a riser of resting water: the whole program, from case to results."""
    for time, speed in (
        (0.01, 0.05690),
        (0.02, 0.10678),
        (0.05, 0.20422),
        (0.10, 0.25638),
        (0.20, 0.26734),
    ):
        yield Check(
            id=f"settling/from-rest/{time:.2f}s",
            claim="a bead let go gathers speed as weight and drag say",
            expected=speed,
            measure=partial(_speed_in_riser, time),
            relative=0.01,
            unit="m/s",
            source=SCHILLER_NAUMANN,
        )


def _crowd() -> Iterator[Check]:
    """Glass beads of 1 mm that settle without net flux: the liquid rises past them."""
    for void_fraction, speed in (
        (0.6, 0.034357),
        (0.7, 0.052482),
        (0.8, 0.074880),
        (0.9, 0.101946),
        (1.0, 0.134104),
    ):
        yield Check(
            id=f"settling/crowd/void-{void_fraction}",
            claim="a crowd settles at the void fraction times the slip of Di Felice's law",
            expected=speed,
            measure=partial(
                settling_speed,
                coupling.DiFelice(),
                diameter=1e-3,
                liquid_density=1000.0,
                kinematic_viscosity=1e-6,
                void_fraction=void_fraction,
            ),
            relative=1e-4,
            unit="m/s",
            source=DI_FELICE,
        )


def _beds() -> Iterator[Check]:
    """Beds of glass beads in water, void fraction 0.4."""
    for velocity, gradient in (
        (0.001, 219.5),
        (0.005, 1261.5),
        (0.01, 2932.4),
        (0.02, 7502.5),
        (0.05, 31039.0),
    ):
        yield Check(
            id=f"bed/pressure/{velocity}",
            claim="the drag of all solids is the pressure loss of a packed bed",
            expected=gradient,
            measure=partial(_bed_gradient, velocity, 2e-3),
            relative=1e-3,
            unit="Pa/m",
            source=ERGUN,
        )
    for millimetres, lift in ((1, "0.00892"), (2, "0.02239"), (3, "0.03255")):
        yield Check(
            id=f"bed/lift/{millimetres}mm/velocity",
            claim="a bed lifts where the drag of all solids is their weight in the liquid",
            expected=float(lift),
            measure=partial(_lift_velocity, millimetres * 1e-3),
            absolute=_half_digit(lift),
            unit="m/s",
            source=ERGUN,
        )
        yield Check(
            id=f"bed/lift/{millimetres}mm/pressure",
            claim="where Ergun's bed lifts, the pressure loss is the weight, whatever the diameter",
            expected=8839.6,
            measure=partial(_lift_gradient, millimetres * 1e-3),
            absolute=0.051,
            unit="Pa/m",
        )


def settling_speed(
    law: DragLaw,
    *,
    diameter: float,
    liquid_density: float,
    kinematic_viscosity: float,
    void_fraction: float = 1.0,
) -> float:
    """Speed that a glass bead comes to in resting liquid, or among many [m/s].

    Parameters
    ----------
    law : DragLaw
    diameter : float
        [m].
    liquid_density : float
        [kg/m3].
    kinematic_viscosity : float
        [m2/s].
    void_fraction : float
        Below 1, as many beads settle together, and the liquid rises with the flux that they sink
        with [-].
    """
    still = mps.PipeProfile(
        pipe_radius=1.0, bulk_velocity=0.0, kinematic_viscosity=kinematic_viscosity
    )
    solids = _bead(diameter)
    weight = -GRAVITY * (1 - liquid_density / GLASS)
    for _ in range(1500):
        rise = -(1 - void_fraction) / void_fraction * solids.velocity
        liquid_velocity = still.velocity(solids.position) + rise
        rate = coupling.drag_rate(
            law,
            liquid_velocity=liquid_velocity,
            velocity=solids.velocity,
            void_fraction=np.array([void_fraction]),
            diameter=2 * solids.radius,
            density=np.array([GLASS]),
            liquid_density=liquid_density,
            kinematic_viscosity=kinematic_viscosity,
        )
        solids.set_forcing(
            acceleration=np.array([[0.0, 0.0, weight]]),
            liquid_velocity=liquid_velocity,
            drag_rate=rate,
        )
        solids.advance(0.02 / rate[0], 1)
    return -float(solids.velocity[0, 2])


def _bead(diameter: float) -> dem.Solids:
    """One bead at rest, with nothing to touch."""
    law = dem.HertzMindlin(youngs_modulus=1e7, poisson_ratio=0.2, restitution=0.9, friction=0.2)
    return dem.Solids(
        position=np.zeros((1, 3)),
        velocity=np.zeros((1, 3)),
        spin=np.zeros((1, 3)),
        radius=np.array([diameter / 2]),
        density=np.array([GLASS]),
        pair_law=law,
        wall_law=law,
    )


def _bed_gradient(superficial_velocity: float, diameter: float) -> float:
    """Drag of the beads of a packed bed over its volume [Pa/m]."""
    bed = _bed(diameter)
    slip = superficial_velocity / BED_VOID_FRACTION
    (rate,) = coupling.drag_rate(
        coupling.ErgunWenYu(),
        liquid_velocity=np.array([[slip, 0.0, 0.0]]),
        velocity=np.zeros((1, 3)),
        void_fraction=np.array([BED_VOID_FRACTION]),
        diameter=np.array([diameter]),
        density=np.array([GLASS]),
        liquid_density=bed.liquid_density,
        kinematic_viscosity=bed.kinematic_viscosity,
    )
    return float((1 - BED_VOID_FRACTION) * GLASS * rate * slip)


def _lift_velocity(diameter: float) -> float:
    """Superficial velocity at which the drag of the beads is their weight in the liquid [m/s]."""
    weight = suspension.fluidised_bed_gradient(_bed(diameter), BED_VOID_FRACTION)
    return float(brentq(lambda u: _bed_gradient(u, diameter) - weight, 0.0, 1.0))


def _lift_gradient(diameter: float) -> float:
    """Drag over volume at the velocity where Ergun's bed lifts [Pa/m]."""
    velocity = suspension.minimum_fluidisation_velocity(_bed(diameter), BED_VOID_FRACTION)
    return _bed_gradient(velocity, diameter)


def _bed(diameter: float) -> suspension.Sphere:
    """A bead of a bed in water."""
    return suspension.Sphere(
        diameter=diameter,
        density=GLASS,
        liquid_density=998.2,
        kinematic_viscosity=1.002e-3 / 998.2,
        gravity=GRAVITY,
    )


@cache
def _fall_in_riser() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times [s] and speeds [m/s] of a bead that was let go."""
    with results_of(RISER_CASE) as results:
        return results.time, -results.solids.velocity[:, 0, 0]


def _speed_in_riser(time: float) -> float:
    return float(np.interp(time, *_fall_in_riser()))


def _half_digit(printed: str) -> float:
    """Half a unit of the last printed digit, and a little for its rounding."""
    return 0.51 * 10.0 ** -len(printed.partition(".")[2])
