"""How hard and how long solids collide: what a step of the solids must resolve."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self


@dataclass(frozen=True, slots=True, kw_only=True)
class Stiffness:
    """Elastic constants of the contact of two bodies.

    Parameters
    ----------
    normal : float
        E*, 1 / E* = sum of (1 - nu^2) / E over both bodies [Pa].
    tangential : float
        G*, 1 / G* = sum of 2 (2 - nu) (1 + nu) / E over both bodies [Pa].

    References
    ----------
    Di Renzo & Di Maio (2004) doi:10.1016/j.ces.2003.09.037.
    """

    normal: float
    tangential: float

    @classmethod
    def of(cls, *bodies: tuple[float, float]) -> Self:
        """Contact of two bodies, each given by Young's modulus [Pa] and Poisson's ratio [-]."""
        return cls(
            normal=1 / sum((1 - nu**2) / e for e, nu in bodies),
            tangential=1 / sum(2 * (2 - nu) * (1 + nu) / e for e, nu in bodies),
        )

    @property
    def ratio(self) -> float:
        """Tangential over normal stiffness, after Mindlin [-]."""
        return 4 * self.tangential / self.normal


@dataclass(frozen=True, slots=True, kw_only=True)
class Impact:
    """An elastic head-on impact of two like spheres, or of a sphere on a flat wall.

    Parameters
    ----------
    reduced_radius : float
        Half the radius for two spheres, the radius at a wall [m].
    reduced_mass : float
        Half the mass for two spheres, the mass at a wall [kg].
    stiffness : Stiffness
        Elastic constants of the contact.
    speed : float
        Closing speed at first touch [m/s].

    References
    ----------
    Johnson (1985) Contact Mechanics, section 11.4.
    """

    reduced_radius: float
    reduced_mass: float
    stiffness: Stiffness
    speed: float

    @classmethod
    def between(
        cls, *, diameter: float, density: float, stiffness: Stiffness, speed: float
    ) -> Self:
        """Two spheres of a diameter [m] and a density [kg/m3]."""
        return cls(
            reduced_radius=diameter / 4,
            reduced_mass=density * math.pi / 12 * diameter**3,
            stiffness=stiffness,
            speed=speed,
        )

    @classmethod
    def at_wall(
        cls, *, diameter: float, density: float, stiffness: Stiffness, speed: float
    ) -> Self:
        """A sphere of a diameter [m] and a density [kg/m3] on a flat wall."""
        return cls(
            reduced_radius=diameter / 2,
            reduced_mass=density * math.pi / 6 * diameter**3,
            stiffness=stiffness,
            speed=speed,
        )

    @property
    def overlap(self) -> float:
        """Largest overlap of the Hertz contact [m]."""
        energy = 15 / 16 * self.reduced_mass * self.speed**2
        return float((energy / (self.stiffness.normal * math.sqrt(self.reduced_radius))) ** 0.4)

    @property
    def duration(self) -> float:
        """Time from first touch to parting of the Hertz contact [s]."""
        return math.inf if self.overlap == 0 else 2.9432 * self.overlap / self.speed

    @property
    def linear_stiffness(self) -> float:
        """Linear spring with the largest overlap of the Hertz contact [N/m]; needs a speed."""
        return self.reduced_mass * (self.speed / self.overlap) ** 2

    def on_spring(self, stiffness: float) -> tuple[float, float]:
        """Largest overlap [m] and duration [s] on an undamped linear spring [N/m].

        Damping lessens the overlap and lengthens the duration.
        """
        root = math.sqrt(self.reduced_mass / stiffness)
        return self.speed * root, math.pi * root


def rayleigh_time(
    *, diameter: float, density: float, youngs_modulus: float, poisson_ratio: float
) -> float:
    """Time that a surface wave takes half around a sphere [s].

    Parameters
    ----------
    diameter : float
        [m].
    density : float
        [kg/m3].
    youngs_modulus : float
        [Pa].
    poisson_ratio : float
        [-].

    References
    ----------
    Li, Xu & Thornton (2005) doi:10.1016/j.powtec.2005.09.016.
    """
    shear_modulus = youngs_modulus / (2 * (1 + poisson_ratio))
    wave = (0.1631 * poisson_ratio + 0.8766) * math.sqrt(shear_modulus / density)
    return math.pi * diameter / 2 / wave
