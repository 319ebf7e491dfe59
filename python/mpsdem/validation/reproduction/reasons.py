"""Why a statement does not hold: the cases with one thing changed, at `quick`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from mpsdem.validation.reproduction import horizontal, inclined
from mpsdem.validation.reproduction.measured import Measured
from mpsdem.validation.reproduction.scene import Instant, Scene
from mpsdem.validation.reproduction.statement import Statement

LEVEL = "quick"

#: Name of the run -> name of the case, and what is changed in it.
VARIANTS: Mapping[str, tuple[str, dict[str, Any]]] = MappingProxyType(
    {
        "unslowed_liquid": (
            horizontal.SCENE,
            {"end_time": 5.0, "fidelity": {"coupling": "one-way"}},
        ),
        "a_quarter_of_the_solids": (
            inclined.STILL,
            {"end_time": 6.0, "solids": {"volume_fraction": 0.005}},
        ),
        "a_tenth_of_the_solids": (
            inclined.STILL,
            {"end_time": 6.0, "solids": {"volume_fraction": 0.002}},
        ),
        "twice_the_velocity": (
            inclined.STILL,
            {"end_time": 6.0, "liquid": {"bulk_velocity": 2.0}},
        ),
        "shaken_more": (
            inclined.UPRIGHT,
            {
                "end_time": 6.0,
                "motion": {"vibration": {"direction": "z", "amplitude": 0.2, "period": 1.0}},
            },
        ),
    }
)


def middle_height(at: Instant) -> float:
    """Median height of the centres over the diameter [-]."""
    return float(np.median(at.height) / (2 * at.radius.max()))


def _said(
    name: str,
    claim: str,
    number: str,
    measure: Callable[[Scene], Measured],
    scene: str,
    **bounds: float,
) -> Statement:
    return Statement(
        id=f"why/{name}",
        claim=claim,
        number=number,
        measure=lambda of: measure(of[scene]),
        scenes=(scene,),
        **bounds,
    )


def _mean(number: Callable[[Instant], float], factor: float = 1.0) -> Callable[[Scene], Measured]:
    return lambda scene: scene.mean(number).times(factor)


REASONS = (
    _said(
        "A-upper",
        "A: in a liquid that no bed slows (one-way) the upper solids are half again as fast",
        "upper half at 5 s [m/s], two-way 0.43",
        lambda scene: scene.at(5.0, horizontal.upper_velocity),
        "unslowed_liquid",
        at_least=0.65,
    ),
    _said(
        "A-middle",
        "A: but then the middle is at 2 s faster than the paper's 0.5 m/s",
        "middle tenth at 2 s [m/s]",
        lambda scene: scene.at(2.0, horizontal.middle_velocity),
        "unslowed_liquid",
        at_least=0.6,
    ),
    _said(
        "A-upper-lower",
        "A: and the upper part is faster than the lower",
        "upper less lower half at 5 s [m/s]",
        lambda scene: scene.at(5.0, horizontal.upper_less_lower),
        "unslowed_liquid",
        at_least=0.0,
    ),
    _said(
        "settles",
        "B: solids let go all over the section lie on the wall before they are 1 m along",
        "median height of case 1 at 0.6 s, in diameters",
        lambda scene: scene.at(0.6, middle_height),
        inclined.STILL,
        at_most=1.0,
    ),
    _said(
        "slow-liquid",
        "B: the bed of case 1 slows its liquid to less than the solids need",
        "liquid at the solids [m/s]",
        _mean(horizontal.liquid_at_solids),
        inclined.STILL,
        at_most=0.5,
    ),
    _said(
        "quarter",
        "B: of a quarter of the solids, some slide back",
        "share that moves back",
        _mean(inclined.sliding_back),
        "a_quarter_of_the_solids",
        at_least=0.05,
        at_most=0.95,
    ),
    _said(
        "tenth",
        "B: of a tenth, hardly any does",
        "share that moves back",
        _mean(inclined.sliding_back),
        "a_tenth_of_the_solids",
        at_most=0.05,
    ),
    _said(
        "tenth-climbs",
        "B: a tenth of the solids is delivered",
        "mean axial velocity of the solids [m/s]",
        _mean(inclined.axial_velocity),
        "a_tenth_of_the_solids",
        at_least=0.0,
    ),
    _said(
        "twice",
        "B: 2 m/s deliver all of them",
        "mean axial velocity of the solids [m/s]",
        _mean(inclined.axial_velocity),
        "twice_the_velocity",
        at_least=0.0,
    ),
    _said(
        "lifted",
        "B: shaken as in case 3 by 0.2 m, 7.9 m/s2, solids leave the bed",
        "share of the solids that rest on the wall or on others",
        inclined.bed_share,
        "shaken_more",
        at_most=0.9,
    ),
    _said(
        "fills",
        "B: but do not fill the section either",
        "height below which 99 % lie, of 200 [mm]",
        _mean(inclined.reach, 1e3),
        "shaken_more",
        at_most=180.0,
    ),
)
