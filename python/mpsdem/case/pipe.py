"""The pipe: a straight circular bore."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from mpsdem.case.part import Part
from mpsdem.case.units import Quantity


class Pipe(Part):
    """Straight circular pipe along +x, its axis at y = z = 0.

    Parameters
    ----------
    radius : float
        Radius of the bore [m].
    length : float
        Length from inlet to outlet [m].
    inclination : float
        Angle by which the pipe rises towards its outlet [rad], from -pi/2 to pi/2.
    roughness : float
        Equivalent sand-grain roughness of the wall, as in Colebrook's formula [m].
    ends : {"periodic"}
        What leaves the outlet comes back at the inlet.
    """

    radius: Annotated[float, Quantity("m", above=0.0)]
    length: Annotated[float, Quantity("m", above=0.0)]
    inclination: Annotated[float, Quantity("rad", at_least=-math.pi / 2, at_most=math.pi / 2)] = 0.0
    roughness: Annotated[float, Quantity("m", at_least=0.0)] = 0.0
    ends: Literal["periodic"] = "periodic"

    @property
    def bore_volume(self) -> float:
        """Volume inside the wall [m3]."""
        return math.pi * self.radius**2 * self.length
