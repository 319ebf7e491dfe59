"""What a run says of the loss of pressure, as a model is asked for it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mpsdem.analysis.head_loss.conveying import Conveying
from mpsdem.analysis.head_loss.dhlldv import BED_FRACTION
from mpsdem.results import Results, ResultsError

_NEEDED = ("pressure_gradient", "bulk_velocity", "solids_mean_velocity")
_BLOCKS = 5  # successive means of which the error of their mean is taken


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """Means over the second half of a run with solids.

    Attributes
    ----------
    flow : Conveying
        With the in-situ concentration; of solids of several sizes that of their mean volume.
    delivered : float
        Share of the solids in the flow rate [-].
    gradient : float
        Loss of pressure, static head apart [Pa/m].
    error : float
        Standard error of that mean, from five successive means [Pa/m].
    inclination : float
        Rise of the pipe [rad].
    """

    flow: Conveying
    delivered: float
    gradient: float
    error: float
    inclination: float


def comparable(results: Results) -> bool:
    """Whether a run has solids that settle, and what a model of head loss asks for.

    Parameters
    ----------
    results : Results
    """
    case = results.case
    if case.solids is None or case.liquid is None or case.gravity == 0 or case.solids.held:
        return False
    if not results.time.size or any(name not in results.diagnostics for name in _NEEDED):
        return False
    return (
        case.solids.density > case.liquid.density
        and case.solids_fraction < BED_FRACTION
        and float(results.diagnostics["bulk_velocity"][-1]) > 0
    )


def measured(results: Results) -> Measured:
    """Read a run.

    Parameters
    ----------
    results : Results
        A run that is `comparable`.

    Returns
    -------
    Measured

    Raises
    ------
    ResultsError
        If it is not.
    """
    if not comparable(results):
        raise ResultsError(
            f"the run in {results.directory} cannot be held against models of head loss: they are "
            "for solids heavier than a liquid that flows towards the outlet"
        )
    case, numbers = results.case, results.diagnostics
    assert case.solids is not None
    assert case.liquid is not None
    later = results.time >= results.time[-1] / 2
    gradient = results.pressure_gradient[later]
    velocity = float(numbers["bulk_velocity"][later].mean())
    volumes = 4 / 3 * math.pi * results.solids.radius**3
    concentration = float(volumes.sum()) / case.pipe.bore_volume
    of_solids = float(numbers["solids_mean_velocity"][later].mean())
    blocks = [block.mean() for block in np.array_split(gradient, min(_BLOCKS, gradient.size))]
    return Measured(
        flow=Conveying(
            pipe_diameter=2 * case.pipe.radius,
            bulk_velocity=velocity,
            diameter=math.cbrt(6 / math.pi * float(volumes.mean())),
            density=case.solids.density,
            liquid_density=case.liquid.density,
            kinematic_viscosity=case.liquid.kinematic_viscosity,
            concentration=concentration,
            roughness=case.pipe.roughness,
            gravity=case.gravity,
        ),
        delivered=min(max(concentration * of_solids / velocity, 0.0), 0.99),
        gradient=float(gradient.mean()),
        error=float(np.std(blocks)) / math.sqrt(max(len(blocks) - 1, 1)),
        inclination=case.pipe.inclination,
    )
