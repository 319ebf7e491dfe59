"""The pipe: a straight circular bore."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Annotated, Literal

from mpsdem.case.errors import Problem
from mpsdem.case.part import Part
from mpsdem.case.units import Quantity

_ROUGHEST = 0.05  # [-] sand grains over the bore; Moody (1944), doi:10.1115/1.4018140


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
    ends : {"periodic", "push-plate"}
        Solids that leave the outlet come back at the inlet. Liquid does too if periodic; else a
        plate upstream of the inlet pushes it through the pipe, and it leaves at the outlet.
    stroke : float, optional
        Way of the push plate until it jumps back [m]; by default a diameter.
    """

    radius: Annotated[float, Quantity("m", above=0.0)]
    length: Annotated[float, Quantity("m", above=0.0)]
    inclination: Annotated[float, Quantity("rad", at_least=-math.pi / 2, at_most=math.pi / 2)] = 0.0
    roughness: Annotated[float, Quantity("m", at_least=0.0)] = 0.0
    ends: Literal["periodic", "push-plate"] = "periodic"
    stroke: Annotated[float, Quantity("m", above=0.0)] | None = None

    @property
    def bore_volume(self) -> float:
        """Volume inside the wall [m3]."""
        return math.pi * self.radius**2 * self.length

    @property
    def has_plate(self) -> bool:
        """Whether a plate pushes the liquid."""
        return self.ends == "push-plate"

    @property
    def resolved_stroke(self) -> float:
        """Way of the push plate [m], a diameter unless given."""
        return 2 * self.radius if self.stroke is None else self.stroke

    @property
    def settling_length(self) -> float:
        """Pipe between the plate at the end of its stroke and the inlet [m].

        The plate turns the liquid before it round, over a radius and as much as it sweeps off the
        wall: that liquid is renewed at each return, and never gets into the bore.
        """
        return self.radius + self.resolved_stroke / 2

    def problems(self) -> Iterable[Problem]:
        if self.roughness > (roughest := _ROUGHEST * 2 * self.radius):
            yield Problem(
                field="roughness",
                value=self.roughness,
                unit="m",
                rule=f"must be <= {roughest:g} m, a twentieth of the bore, as far as Colebrook's "
                "formula reaches",
            )
        if not self.has_plate:
            if self.stroke is not None:
                yield Problem(
                    field="stroke",
                    value=self.stroke,
                    unit="m",
                    rule="is that of a push plate, and the ends are periodic",
                    remedy="set ends = 'push-plate', or leave it out",
                )
            return
        if self.resolved_stroke + self.settling_length > self.length:
            longest = (self.length - self.radius) / 1.5
            remedy = (
                f"a stroke of at most {longest:g} m, or a longer pipe"
                if longest > 0
                else "take a longer pipe"
            )
            yield Problem(
                field="stroke",
                value=self.resolved_stroke,
                unit="m",
                rule=f"1.5 strokes and a radius must be at most {self.length:g} m, the length: "
                "a slab of the pipe's own liquid fills the gap",
                remedy=remedy,
            )
