"""What a run kept and what it lost, added up over its time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mpsdem.results import Results, ResultsError

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Ledgers:
    """Mass, momentum and energy of a run with a computed liquid, since its second frame.

    In the first interval solids come into the liquid, which makes room for them.

    Parameters
    ----------
    time : (n,) float64 ndarray
        [s].
    friction : (n,) float64 ndarray
        Axial impulse that the walls took from the liquid, over the bore's volume [Pa s/m].
    unexplained : (n,) float64 ndarray
        Axial momentum of the liquid that no force explains, likewise [Pa s/m].
    given_back : (n,) float64 ndarray
        What its convection between solids lost, and was given back, likewise [Pa s/m]; 0 where none
        is recorded.
    put_in, dissipated : (n,) float64 ndarray
        Energy put in, and that of it which is neither motion, contact nor height [J/m]; the rest is
        stored.
    volume_error, exchange_error : (n,) float64 ndarray
        Largest relative error of the liquid's volume, and largest relative difference of what
        liquid and solids gave each other, up to then [-]; 0 where none is recorded.
    """

    time: FloatArray
    friction: FloatArray
    unexplained: FloatArray
    given_back: FloatArray
    put_in: FloatArray
    dissipated: FloatArray
    volume_error: FloatArray
    exchange_error: FloatArray

    @property
    def stored(self) -> FloatArray:
        """Energy of motion, contacts and height since the start, (n,) [J/m]."""
        return self.put_in - self.dissipated


def ledgers(results: Results) -> Ledgers:
    """Add up the ledgers of a run.

    Parameters
    ----------
    results : Results
        A run with a computed liquid, of three frames and more.

    Raises
    ------
    ResultsError
        If its liquid is not computed, or it is too short.
    """
    recorded = results.diagnostics
    if "pressure_gradient_friction" not in recorded:
        raise ResultsError(f"the run in {results.directory} has no liquid that is computed")
    if len(results.time) < 3:
        raise ResultsError(f"the run in {results.directory} has less than three frames")
    time = results.time[1:]
    interval = np.diff(time)

    def sums(name: str) -> FloatArray:
        if name not in recorded:
            return np.zeros_like(time)
        return np.concatenate([[0.0], np.cumsum(recorded[name][2:] * interval)])

    def most(name: str) -> FloatArray:
        if name not in recorded:
            return np.zeros_like(time)
        return np.maximum.accumulate(np.abs(recorded[name][1:]))

    friction = sums("pressure_gradient_friction")
    if "pressure_iterations" not in recorded:
        # of nodes: the flow rate holds the wall's nodes too, which no force changes
        unexplained = sums("liquid_unexplained")
    else:
        assert results.case.liquid is not None
        flux = recorded["liquid_flux"][1:]
        given = sums("pressure_gradient") - sums("pressure_gradient_solids")
        unexplained = results.case.liquid.density * (flux - flux[0]) - given + friction
    return Ledgers(
        time=time,
        friction=friction,
        unexplained=unexplained,
        given_back=sums("convection_error"),
        put_in=sums("power_input") + sums("shaking_power"),
        dissipated=sums("dissipation"),
        volume_error=most("liquid_volume_error"),
        exchange_error=most("exchange_error"),
    )
