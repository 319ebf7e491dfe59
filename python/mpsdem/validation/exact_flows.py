"""Flows in a full round pipe that theory knows, computed without the kernels.

Radii are over that of the pipe; velocities over the scales that each function names.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy import optimize, special

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_TERMS = 60  # of the series: the last counts less than exp(-500) from a hundredth of R^2 / nu on


def parabola(share: FloatArray) -> FloatArray:
    """Velocity of a laminar flow over its bulk velocity.

    Parameters
    ----------
    share : (n,) float64 ndarray
        Distances from the axis over the pipe's radius [-].

    Returns
    -------
    (n,) float64 ndarray
        [-].
    """
    return 2 * (1 - share**2)


def start_up(share: FloatArray, time: float) -> FloatArray:
    """Velocity over the bulk velocity at the end, a time after a gradient set in on a flow at rest.

    Parameters
    ----------
    share : (n,) float64 ndarray
        Distances from the axis over the pipe's radius R [-].
    time : float
        Over R^2 / nu [-].

    Returns
    -------
    (n,) float64 ndarray
        [-].

    References
    ----------
    Szymanski (1932), J. Math. Pures Appl. 11, 67.
    """
    root = special.jn_zeros(0, _TERMS)
    factor = 8 * np.exp(-(root**2) * time) / (root**3 * special.j1(root))
    return 2 * (1 - share**2 - special.j0(np.outer(share, root)) @ factor)


def oscillation(share: FloatArray, womersley: float) -> ComplexArray:
    """Velocity in a gradient K cos(w t), as u / (K R^2 / (4 nu)) = real part of phasor exp(i w t).

    Parameters
    ----------
    share : (n,) float64 ndarray
        Distances from the axis over the pipe's radius R [-].
    womersley : float
        R sqrt(w / nu) [-].

    Returns
    -------
    (n,) complex128 ndarray
        [-]; the parabola's velocity on the axis is 1.

    References
    ----------
    Womersley (1955), doi:10.1113/jphysiol.1955.sp005276.
    """
    argument = womersley * np.exp(0.75j * np.pi)
    bessel = special.jv(0, argument * share) / special.jv(0, argument)
    phasor: ComplexArray = -4j / womersley**2 * (1 - bessel)
    return phasor


def mean_oscillation(womersley: float) -> complex:
    """Mean over the bore of `oscillation`, over K R^2 / (8 nu), the mean of the parabola.

    Parameters
    ----------
    womersley : float
        R sqrt(w / nu) [-].
    """
    argument = womersley * np.exp(0.75j * np.pi)
    bessel = special.jv(1, argument) / special.jv(0, argument)
    return complex(-8j / womersley**2 * (1 - 2 / argument * bessel))


def colebrook(reynolds: float, roughness: float = 0.0) -> float:
    """Darcy friction factor of a turbulent flow.

    Parameters
    ----------
    reynolds : float
        Of bulk velocity and diameter [-].
    roughness : float
        Sand grains over the diameter [-].

    References
    ----------
    Colebrook (1939), doi:10.1680/ijoti.1939.13150.
    """

    def excess(root: float) -> float:
        """Of 1 / sqrt(f), which is `root`."""
        return root + 2 * math.log10(roughness / 3.7 + 2.51 * root / reynolds)

    return float(optimize.brentq(excess, 1.0, 20.0, xtol=1e-14)) ** -2
