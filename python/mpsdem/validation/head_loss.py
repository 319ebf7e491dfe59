"""Models of head loss: what they give beside numbers computed from their publications elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any

from mpsdem.analysis.head_loss import (
    DURAND_CONDOLIOS,
    Conveying,
    dhlldv,
    hydraulic_gradient,
    newitt,
    wilson,
)
from mpsdem.validation.registry import Check, Source

GRAVITY = 9.81  # [m/s2]
WATER = 998.2  # [kg/m3]

_HOW = "as another implementation gives it"
MIEDEMA = Source(
    cite="Miedema (2019)",
    reference=f"Slurry Transport, 2nd edition, TU Delft, chapter 7; {_HOW}",
)
DURAND = Source(
    cite="Durand & Condolios (1952)",
    reference=f"{_HOW}, with the drag coefficient that its first value implies",
)
NEWITT = Source(
    cite="Newitt et al. (1955)", reference=f"Trans. Inst. Chem. Eng. 33, 93-113; {_HOW}"
)
WILSON = Source(
    cite="Wilson & Addie (1995)",
    reference=f"with V_sm at the concentration, Wilson et al. (2006), doi:10.1007/b101079; {_HOW}",
)

#: Sand in a dredge pipe, on which the framework's parts are compared one by one.
DREDGE = Conveying(
    pipe_diameter=0.5,
    roughness=4.5e-5,
    bulk_velocity=3.0,
    diameter=4e-4,
    density=2650.0,
    liquid_density=WATER,
    kinematic_viscosity=0.001005 / WATER,
    concentration=0.1,
    gravity=9.80665,
)

Loss = Callable[[Conveying], float]


def _scene(**rest: Any) -> Conveying:
    """Solids in water at 20 degrees Celsius, through a pipe that is all but smooth."""
    water = {"liquid_density": WATER, "kinematic_viscosity": 1.004e-6, "gravity": GRAVITY}
    return Conveying(**{"pipe_diameter": 0.1, "roughness": 1.5e-6} | water | rest)


def _stratified(flow: Conveying) -> float:
    return wilson.wilson_stratified(flow, deposit_velocity=wilson.stationary_limit(flow))


#: Loss of pressure over velocity, by scene: name, what it is, velocities, hydraulic gradients of
#: the framework, of Durand, of Newitt's bed, of Wilson; limit deposit velocity.
GLASS = {"density": 2500.0, "diameter": 5e-3, "concentration": 0.05}
_SCENES: tuple[
    tuple[str, dict[str, float], tuple[float, ...], dict[str, tuple[float, ...]], float], ...
] = (
    (
        "glass-5mm-5%",
        GLASS | {"settling_drag": 0.398},
        (2, 3, 4, 5),
        {
            "water": (0.0320, 0.0668, 0.1130, 0.1700),
            "dhlldv": (0.0632, 0.0980, 0.1426, 0.1972),
            "durand": (0.0900, 0.1027, 0.1386, 0.1897),
            "newitt-bed": (0.0709, 0.1030, 0.1473, 0.2031),
            "wilson": (0.0875, 0.1170, 0.1597, 0.2142),
        },
        3.58,
    ),
    (
        "glass-5mm-10%",
        GLASS | {"concentration": 0.1, "settling_drag": 0.398},
        (2, 3, 4, 5),
        {
            "dhlldv": (0.0944, 0.1292, 0.1717, 0.2239),
            "durand": (0.1480, 0.1386, 0.1642, 0.2095),
            "wilson": (0.1383, 0.1629, 0.2023, 0.2545),
        },
        3.52,
    ),
    (
        "glass-10mm-10%",
        GLASS | {"diameter": 0.01, "concentration": 0.1, "settling_drag": 0.398},
        (2, 3, 4, 5),
        {
            "dhlldv": (0.0944, 0.1292, 0.1740, 0.2286),
            "durand": (0.1478, 0.1385, 0.1641, 0.2094),
            "wilson": (0.1338, 0.1588, 0.1986, 0.2510),
        },
        3.65,
    ),
    (
        "basalt-11mm-10%",
        {"diameter": 0.011, "density": 2895.0, "concentration": 0.1, "settling_drag": 0.407},
        (2, 3, 4, 5),
        {
            "dhlldv": (0.1108, 0.1457, 0.1918, 0.2471),
            "durand": (0.1938, 0.1670, 0.1844, 0.2251),
            "wilson": (0.1640, 0.1861, 0.2239, 0.2750),
        },
        4.50,
    ),
    (
        "glass-2mm-10%",
        GLASS | {"diameter": 2e-3, "concentration": 0.1, "pipe_diameter": 0.04},
        (1.5, 2, 3, 4),
        {
            "water": (0.0577, 0.0966, 0.2004, 0.3373),
            "dhlldv": (0.1201, 0.1590, 0.2603, 0.3909),
            "wilson": (0.1607, 0.1924, 0.2870, 0.4179),
        },
        3.00,
    ),
    (
        "sand-0.4mm-10%",
        {"diameter": 4e-4, "density": 2650.0, "concentration": 0.1},
        (2, 3, 4, 5),
        {
            "dhlldv": (0.0965, 0.0983, 0.1319, 0.1833),
            "durand": (0.0682, 0.0892, 0.1289, 0.1823),
            "newitt-heterogeneous": (0.0760, 0.0941, 0.1324, 0.1850),
        },
        2.74,
    ),
    (
        "gravel-1inch-10%",
        {"diameter": 4.5e-3, "density": 2600.0, "concentration": 0.1, "pipe_diameter": 0.0254},
        (1, 1.5, 2, 2.5, 3),
        {
            "water": (0.0492, 0.1008, 0.1682, 0.2507, 0.3476),
            "dhlldv": (0.1158, 0.1674, 0.2348, 0.3172, 0.4142),
            "newitt-bed": (0.1791, 0.2191, 0.2792, 0.3565, 0.4496),
            "wilson": (0.1570, 0.1982, 0.2588, 0.3363, 0.4295),
        },
        0.0,
    ),
)

#: Relative tolerance by model: of the printed digits, and 1 % where they took another friction
#: factor than Colebrook's.
_MODELS: dict[str, tuple[Loss, float, Source]] = {
    "water": (dhlldv.clear_gradient, 2e-3, MIEDEMA),
    "dhlldv": (dhlldv.head_loss, 2e-3, MIEDEMA),
    "durand": (DURAND_CONDOLIOS.gradient, 0.01, DURAND),
    "newitt-bed": (newitt.newitt_bed, 0.01, NEWITT),
    "newitt-heterogeneous": (newitt.newitt_heterogeneous, 0.01, NEWITT),
    "wilson": (_stratified, 0.01, WILSON),
}


def checks() -> Iterator[Check]:
    """All checks of this module."""
    yield from _regimes()
    yield from _deposits()
    yield from _gradients()


def _regimes() -> Iterator[Check]:
    """Relative excess of each regime of the framework, sand in a dredge pipe."""
    regimes: dict[str, tuple[Loss, tuple[float, float]]] = {
        "fixed-bed": (dhlldv.fixed_bed, (0.13631182, 0.441040)),
        "sliding-bed": (dhlldv.sliding_bed, (0.415, 0.415)),
        "heterogeneous": (
            partial(dhlldv.heterogeneous, drag="settling"),
            (0.2495003, 0.1451765),
        ),
        "homogeneous": (dhlldv.homogeneous, (0.0064010, 0.0105175)),
    }
    for name, (excess, values) in regimes.items():
        for velocity, expected in zip((3, 4), values, strict=True):
            yield Check(
                id=f"head-loss/dhlldv/{name}/{velocity}",
                claim="each regime has the relative excess gradient of the framework",
                expected=expected,
                measure=partial(excess, replace(DREDGE, bulk_velocity=velocity)),
                relative=5e-4,
                source=MIEDEMA,
            )


def _deposits() -> Iterator[Check]:
    """Velocities at which beds end."""
    for concentration, millimetres, expected in (
        (0.1, 0.01, 0.8288413),
        (0.1, 0.15, 3.6732779),
        (0.1, 0.4, 4.9492960),
        (0.1, 0.8, 4.8456347),
        (0.1, 2.1, 4.3325182),
        (0.0025, 0.8, 3.2844888),
        (0.0025, 2.1, 3.8770674),
    ):
        flow = replace(DREDGE, diameter=millimetres * 1e-3, concentration=concentration)
        yield Check(
            id=f"head-loss/dhlldv/deposit/{concentration}/{millimetres}mm",
            claim="no bed is left above the limit deposit velocity",
            expected=expected,
            measure=partial(dhlldv.limit_deposit_velocity, flow),
            relative=5e-4,
            unit="m/s",
            source=MIEDEMA,
        )
    for name, scene, _, _, expected in _SCENES:
        if expected:
            yield Check(
                id=f"head-loss/{name}/deposit",
                claim="no bed is left above the limit deposit velocity",
                expected=expected,
                measure=partial(dhlldv.limit_deposit_velocity, _scene(bulk_velocity=1.0, **scene)),
                relative=2e-3,
                unit="m/s",
                source=MIEDEMA,
            )
    yield Check(
        id="head-loss/glass-5mm-5%/stationary",
        claim="a bed of this much slides above Wilson's limit",
        expected=1.08,
        measure=partial(wilson.stationary_limit, _scene(bulk_velocity=1.0, **GLASS)),
        relative=5e-3,
        unit="m/s",
        source=WILSON,
    )


def _gradients() -> Iterator[Check]:
    """Hydraulic gradients of coarse and fine solids in small pipes."""
    for name, scene, velocities, columns, _ in _SCENES:
        for model, values in columns.items():
            loss, tolerance, source = _MODELS[model]
            for velocity, expected in zip(velocities, values, strict=True):
                yield Check(
                    id=f"head-loss/{name}/{model}/{velocity}",
                    claim="metres of water per metre of pipe are those of the model",
                    expected=expected,
                    measure=partial(_gradient, loss, _scene(bulk_velocity=velocity, **scene)),
                    relative=tolerance,
                    source=source,
                )


def _gradient(loss: Loss, flow: Conveying) -> float:
    return hydraulic_gradient(loss(flow), liquid_density=flow.liquid_density, gravity=flow.gravity)
