"""Spheres that settle or are fluidised, in closed form and computed without the kernels.

A drag law is a function of the superficial Reynolds number ``eps |r| d / nu`` and the void fraction
eps, that returns the drag of Model A over ``3 pi mu d eps |r|``; r is the slip, liquid less solid.
The ``force_ratio`` of the program's own laws is one, too.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from scipy.optimize import brentq

DragLaw = Callable[[float, float], float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Sphere:
    """A sphere, its liquid, and what pulls at them.

    Attributes
    ----------
    diameter : float
        [m].
    density : float
        [kg/m3]; above that of the liquid.
    liquid_density : float
        [kg/m3].
    kinematic_viscosity : float
        Of the liquid [m2/s].
    gravity : float
        [m/s2].
    """

    diameter: float
    density: float
    liquid_density: float
    kinematic_viscosity: float
    gravity: float = 9.81

    @property
    def archimedes(self) -> float:
        """Weight in the liquid over viscous forces, g d^3 (rho_s / rho - 1) / nu^2 [-]."""
        relative = self.density / self.liquid_density - 1
        return self.gravity * relative * self.diameter**3 / self.kinematic_viscosity**2

    @property
    def viscous_velocity(self) -> float:
        """Velocity at which its Reynolds number is 1 [m/s]."""
        return self.kinematic_viscosity / self.diameter


def schiller_naumann(reynolds: float, void_fraction: float) -> float:
    """Drag law of a lone sphere [-].

    References
    ----------
    Schiller & Naumann (1933), Z. Ver. Dtsch. Ing. 77, 318-320; constant C_d above 1000.
    """
    own = reynolds / void_fraction
    return 1 + 0.15 * math.pow(own, 0.687) if own < 1000 else 0.44 / 24 * own


def di_felice(reynolds: float, void_fraction: float) -> float:
    """Drag law from a packed bed to a lone sphere [-].

    References
    ----------
    Di Felice (1994), doi:10.1016/0301-9322(94)90011-6.
    """
    if reynolds == 0:
        return 0.96 * math.pow(void_fraction, -3.7)
    coefficient = (0.63 + 4.8 / math.sqrt(reynolds)) ** 2
    exponent = 3.7 - 0.65 * math.exp(-((1.5 - math.log10(reynolds)) ** 2) / 2)
    return coefficient * reynolds / 24 * math.pow(void_fraction, -exponent)


def balance_slip(sphere: Sphere, law: DragLaw, void_fraction: float = 1.0) -> float:
    """Slip at which the drag carries the sphere [m/s].

    In Model B the drag over eps is weight less buoyancy: 18 Re_0 law(eps Re_0, eps) = Ar, with
    Re_0 = |r| d / nu.
    """

    def excess(own: float) -> float:
        return 18 * own * law(void_fraction * own, void_fraction) - sphere.archimedes

    fastest = sphere.archimedes / 9  # no drag law gives less than half of Stokes's drag
    root = brentq(excess, 0.0, fastest, xtol=1e-14 * fastest, rtol=1e-14)
    return float(root) * sphere.viscous_velocity


def terminal_velocity(sphere: Sphere, law: DragLaw) -> float:
    """Velocity at which a lone sphere sinks in a liquid at rest [m/s]."""
    return balance_slip(sphere, law)


def settling_velocity(sphere: Sphere, law: DragLaw, void_fraction: float) -> float:
    """Velocity at which many spheres sink where the volumes of liquid and solids balance [m/s].

    What sinks displaces liquid upwards, eps u + (1 - eps) v = 0, so that v is -eps r.
    """
    return void_fraction * balance_slip(sphere, law, void_fraction)


def packed_bed_gradient(sphere: Sphere, superficial_velocity: float, void_fraction: float) -> float:
    """Pressure loss along a packed bed, static head apart [Pa/m].

    Parameters
    ----------
    sphere : Sphere
    superficial_velocity : float
        Flow rate over the area of the bed [m/s].
    void_fraction : float
        [-].

    References
    ----------
    Ergun (1952), Chem. Eng. Prog. 48, 89-94.
    """
    viscous, inertial = _ergun(void_fraction)
    reynolds = superficial_velocity / sphere.viscous_velocity
    scale = sphere.liquid_density * sphere.viscous_velocity**2 / sphere.diameter
    return scale * (viscous + inertial * reynolds) * reynolds


def fluidised_bed_gradient(sphere: Sphere, void_fraction: float) -> float:
    """Pressure loss along a bed that the liquid carries, static head apart [Pa/m].

    The weight of the solids in the liquid over the volume, whatever the velocity.
    """
    excess = sphere.density - sphere.liquid_density
    return (1 - void_fraction) * excess * sphere.gravity


def minimum_fluidisation_velocity(sphere: Sphere, void_fraction: float) -> float:
    """Superficial velocity at which Ergun's packed bed is carried [m/s]."""
    viscous, inertial = _ergun(void_fraction)
    weight = (1 - void_fraction) * sphere.archimedes
    reynolds = 2 * weight / (viscous + math.sqrt(viscous**2 + 4 * inertial * weight))
    return reynolds * sphere.viscous_velocity


def _ergun(void_fraction: float) -> tuple[float, float]:
    """Factors of Re and Re^2 in the pressure loss of a packed bed [-]."""
    solid, cube = 1 - void_fraction, void_fraction**3
    return 150 * solid**2 / cube, 1.75 * solid / cube
