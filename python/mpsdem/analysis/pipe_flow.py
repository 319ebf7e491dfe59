"""What theory says of the velocity in a full, straight, round pipe."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

KARMAN = 0.41  # [-]
SMOOTH_WALL = 5.2  # [-] u+ at y+ = 1 if the log law went so far
_ROUGH_WALL = 8.5  # [-] u+ at y = k on a fully rough wall


def friction_velocity(pressure_gradient: float, *, pipe_radius: float, density: float) -> float:
    """Velocity whose square times the density is the shear stress at the wall.

    Parameters
    ----------
    pressure_gradient : float
        Loss of pressure along the axis that the wall causes [Pa/m].
    pipe_radius : float
        [m]
    density : float
        Of the liquid [kg/m3].

    Returns
    -------
    float
        Friction velocity [m/s], with the sign of the loss.
    """
    square = pressure_gradient * pipe_radius / (2 * density)
    return math.copysign(math.sqrt(abs(square)), square)


def laminar_profile(radius: FloatArray, *, pipe_radius: float, bulk_velocity: float) -> FloatArray:
    """Axial velocity of a laminar flow: the parabola of Hagen and Poiseuille.

    Parameters
    ----------
    radius : (b,) float64 ndarray
        Distances from the axis [m].
    pipe_radius : float
        [m]
    bulk_velocity : float
        Flow rate over the area of the bore [m/s].

    Returns
    -------
    (b,) float64 ndarray
        Axial velocity [m/s].
    """
    return 2 * bulk_velocity * (1 - (radius / pipe_radius) ** 2)


def turbulent_profile(
    radius: FloatArray,
    *,
    pipe_radius: float,
    friction_velocity: float,
    kinematic_viscosity: float,
    roughness: float = 0.0,
) -> FloatArray:
    """Axial velocity of a turbulent flow: the log law from the wall to the axis.

    Parameters
    ----------
    radius : (b,) float64 ndarray
        Distances from the axis [m].
    pipe_radius : float
        [m]
    friction_velocity : float
        [m/s]; its sign is that of the flow.
    kinematic_viscosity : float
        [m2/s]
    roughness : float
        Sand-grain roughness k of the wall [m].

    Returns
    -------
    (b,) float64 ndarray
        Axial velocity [m/s].

    Notes
    -----
    ``u+ = ln(y+ / (1 + 0.26 k+)) / 0.41 + 5.2``, and ``u+ = y+`` where that is less, with ``y`` the
    distance from the wall. Up to 20 % high in the buffer layer, ``y+`` from 5 to 30; a few per cent
    low on the axis, where the flow has a wake.

    References
    ----------
    Pope (2000), Turbulent Flows, ch. 7; for the rough wall Nikuradse (1933), VDI-Forschungsheft
    361, with the transition of Colebrook (1939), doi:10.1680/ijoti.1939.13150.
    """
    per_metre = abs(friction_velocity) / kinematic_viscosity
    y_plus = np.maximum(pipe_radius - radius, 0) * per_metre
    smoothed = 1 + math.exp(-KARMAN * (_ROUGH_WALL - SMOOTH_WALL)) * roughness * per_metre
    with np.errstate(divide="ignore"):
        log_law = np.log(y_plus / smoothed) / KARMAN + SMOOTH_WALL
    # Held above 1, as the law falls without end where it no longer holds: close to the wall.
    return friction_velocity * np.minimum(y_plus, np.maximum(log_law, 1.0))
