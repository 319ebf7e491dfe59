"""What a run kept and what it lost, added up over its time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mpsdem.results import Results, ResultsError

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Ledgers:
    """Mass, momentum and energy of a run with a computed liquid, from one of its frames on.

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
    exchanged : (n,) float64 ndarray
        Impulse between liquid and solids, whatever its direction, over the bore's volume [Pa s/m];
        0 where the liquid feels none.
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
    exchanged: FloatArray
    put_in: FloatArray
    dissipated: FloatArray
    volume_error: FloatArray
    exchange_error: FloatArray

    @property
    def stored(self) -> FloatArray:
        """Energy of motion, contacts and height since the start, (n,) [J/m]."""
        return self.put_in - self.dissipated


def ledgers(results: Results, *, first: int = 1) -> Ledgers:
    """Add up the ledgers of a run.

    Parameters
    ----------
    results : Results
        A run with a computed liquid.
    first : int
        Frame from which they are kept: by default the second, as in the first interval a liquid
        makes room for the solids that come into it.

    Raises
    ------
    ResultsError
        If its liquid is not computed, or it has no such frame.
    """
    recorded = results.diagnostics
    if "pressure_gradient_friction" not in recorded:
        raise ResultsError(f"the run in {results.directory} has no liquid that is computed")
    if len(results.time) <= first:
        raise ResultsError(f"the run in {results.directory} has no frame {first}")
    time = results.time[first:]
    interval = np.diff(time)

    def added(values: FloatArray) -> FloatArray:
        return np.concatenate([[0.0], np.cumsum(values[first + 1 :] * interval)])

    def sums(name: str) -> FloatArray:
        return added(recorded[name]) if name in recorded else np.zeros_like(time)

    def most(name: str) -> FloatArray:
        if name not in recorded:
            return np.zeros_like(time)
        return np.maximum.accumulate(np.abs(recorded[name][first:]))

    friction = sums("pressure_gradient_friction")
    if "pressure_iterations" not in recorded:
        # of nodes: the flow rate holds the wall's nodes too, which no force changes
        unexplained = sums("liquid_unexplained")
    else:
        assert results.case.liquid is not None
        flux = recorded["liquid_flux"][first:]
        given = sums("pressure_gradient") - sums("pressure_gradient_solids")
        unexplained = results.case.liquid.density * (flux - flux[0]) - given + friction
    exchanged = np.zeros_like(time)
    if "exchange_error" in recorded:
        force = np.linalg.norm(recorded["drag_force"], axis=-1)
        exchanged = added(force) / results.case.pipe.bore_volume
    return Ledgers(
        time=time,
        friction=friction,
        unexplained=unexplained,
        given_back=sums("convection_error"),
        exchanged=exchanged,
        put_in=sums("power_input") + sums("shaking_power"),
        dissipated=sums("dissipation"),
        volume_error=most("liquid_volume_error"),
        exchange_error=most("exchange_error"),
    )
