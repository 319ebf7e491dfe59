"""Whether the pipe is about to be blocked: solids that gather, fill the bore, and stand still."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_PACKED = 0.85  # [-] volume fraction over that of a packed bed, from which a section is full
_AT_REST = 0.05  # [-] velocity of the solids over the bulk velocity
_LASTING = 5.0  # [-] diameters that the bulk flow goes while a section is full and at rest


@dataclass(frozen=True, slots=True, kw_only=True)
class Plug:
    """Solids that fill a section of the pipe and stand still.

    Parameters
    ----------
    time : float
        Since when they do [s].
    position : float
        Distance of the section from the inlet [m].
    fraction : float
        Volume fraction of the solids there [-].
    """

    time: float
    position: float
    fraction: float


def full_fraction(pipe_diameter: float, diameter: float) -> float:
    """Volume fraction from which a section of a pipe is full of solids [-].

    Parameters
    ----------
    pipe_diameter, diameter : float
        Of the bore and of the solids [m].

    Notes
    -----
    85 % of spheres packed at random in a tube, whose void fraction is 0.4 + 0.35 exp(-0.39 D/d):
    de Klerk (2003), doi:10.1002/aic.690490812. The rest is for packing that is looser, and for a
    gap under the roof.
    """
    return _PACKED * (0.6 - 0.35 * math.exp(-0.39 * pipe_diameter / diameter))


def standing_time(pipe_diameter: float, bulk_velocity: float) -> float:
    """How long a full section must stand still to be a plug: five diameters of bulk flow [s]."""
    return _LASTING * pipe_diameter / abs(bulk_velocity)


def standing_full(
    fraction: FloatArray, flux: FloatArray, *, full: float, bulk_velocity: float
) -> NDArray[np.bool_]:
    """Which sections are full of solids that stand still.

    Parameters
    ----------
    fraction : (..., sections) float64 ndarray
        Volume fraction of the solids [-].
    flux : (..., sections) float64 ndarray
        Their flow rate over the area of the bore [m/s].
    full : float
        Volume fraction from which a section is full [-], as `full_fraction` says.
    bulk_velocity : float
        [m/s], not 0.

    Returns
    -------
    (..., sections) bool ndarray
        Where the section is full, and the mean velocity of its solids below 5 % of the bulk
        velocity.
    """
    at_rest = np.abs(flux) < _AT_REST * abs(bulk_velocity) * fraction
    return np.asarray((fraction >= full) & at_rest)


def find_plug(
    time: FloatArray,
    position: FloatArray,
    fraction: FloatArray,
    standing: NDArray[np.bool_],
    *,
    lasting: float,
) -> Plug | None:
    """The first section that stayed full and at rest for long enough.

    Parameters
    ----------
    time : (f,) float64 ndarray
        Times of the frames [s].
    position : (s,) float64 ndarray
        Middles of the sections [m].
    fraction : (f, s) float64 ndarray
        Volume fraction of the solids [-].
    standing : (f, s) bool ndarray
        Where `standing_full` says so.
    lasting : float
        For how long [s], as `standing_time` says.

    Returns
    -------
    Plug or None
        None where there is no plug.
    """
    since = np.zeros(0)
    for frame, now in enumerate(time):
        since = stands_since(since, standing[frame], float(now))
        if (section := longest(since, float(now), lasting)) is not None:
            return Plug(
                time=float(since[section]),
                position=float(position[section]),
                fraction=float(fraction[frame, section]),
            )
    return None


def stands_since(since: FloatArray, standing: NDArray[np.bool_], now: float) -> FloatArray:
    """Since when each section has been full and at rest, (s,) [s]; NaN where it is not.

    Parameters
    ----------
    since : (s,) float64 ndarray
        The same at the time before [s]; empty at the first.
    standing : (s,) bool ndarray
        Where it is so now.
    now : float
        [s]
    """
    if not since.size:
        since = np.full(standing.shape, np.nan)
    return np.where(standing, np.where(np.isnan(since), now, since), np.nan)


def longest(since: FloatArray, now: float, lasting: float) -> int | None:
    """The section that has stood longest, if for long enough.

    Parameters
    ----------
    since : (s,) float64 ndarray
        As `stands_since` gives it [s].
    now, lasting : float
        The time, and how long is long enough [s].
    """
    if np.isnan(since).all():
        return None
    section = int(np.nanargmin(since))
    return section if now - since[section] >= lasting * (1 - 1e-9) else None


def accumulation(flux: FloatArray, *, length: float) -> FloatArray:
    """What flows into each section and does not flow out: growth of its volume fraction.

    Parameters
    ----------
    flux : (..., sections) float64 ndarray
        Flow rate of the solids over the area of the bore, means over equal sections of the
        periodic pipe [m/s].
    length : float
        Of the pipe [m].

    Returns
    -------
    (..., sections) float64 ndarray
        Rate [1/s]; its sum over the sections is 0, as none is lost.

    Notes
    -----
    Between two sections flows the mean of what flows in both: exact to second order in their
    length.
    """
    inlet = (flux + np.roll(flux, 1, axis=-1)) / 2
    return np.asarray((inlet - np.roll(inlet, -1, axis=-1)) * flux.shape[-1] / length)
