"""What a head-loss model is asked, and what it says of the range in which it holds."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from mpsdem.analysis.correlations import (
    friction_factor,
    sphere_drag_coefficient,
    terminal_velocity,
)

Concentration = Literal["in-situ", "delivered"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Conveying:
    """Solids of one size that a liquid carries through a full level pipe.

    Attributes
    ----------
    pipe_diameter : float
        Of the bore [m].
    bulk_velocity : float
        Flow rate of liquid and solids over the area of the bore [m/s], above 0.
    diameter, density : float
        Of the solids [m], [kg/m3]; they are heavier than the liquid.
    liquid_density, kinematic_viscosity : float
        [kg/m3], [m2/s].
    concentration : float
        Of the solids, in the volume of the bore or in the flow rate: each model says which [-].
    roughness : float
        Sand-grain roughness of the wall [m].
    gravity : float
        [m/s2].
    settling_drag : float, optional
        Drag coefficient of a solid at its terminal velocity [-], where it is not a smooth sphere.

    Raises
    ------
    ValueError
        If one of them makes no sense; it names it, its value and the rule.
    """

    pipe_diameter: float
    bulk_velocity: float
    diameter: float
    density: float
    liquid_density: float
    kinematic_viscosity: float
    concentration: float
    roughness: float = 0.0
    gravity: float = 9.807
    settling_drag: float | None = None

    def __post_init__(self) -> None:
        for name, unit in (
            ("pipe_diameter", "m"),
            ("bulk_velocity", "m/s"),
            ("diameter", "m"),
            ("liquid_density", "kg/m3"),
            ("kinematic_viscosity", "m2/s"),
            ("gravity", "m/s2"),
        ):
            if not (value := getattr(self, name)) > 0:
                raise ValueError(f"{name} = {value} {unit}: must be > 0")
        if not self.density > self.liquid_density:
            raise ValueError(
                f"density = {self.density} kg/m3: must be > liquid_density = "
                f"{self.liquid_density} kg/m3; models of settling solids know no others"
            )
        if not 0 <= self.concentration < 1:
            raise ValueError(f"concentration = {self.concentration}: must lie in [0, 1)")
        if self.settling_drag is not None and not self.settling_drag > 0:
            raise ValueError(f"settling_drag = {self.settling_drag}: must be > 0")

    @property
    def excess(self) -> float:
        """Density of the solids less that of the liquid, over the latter [-]."""
        return self.density / self.liquid_density - 1

    @property
    def terminal_velocity(self) -> float:
        """Velocity at which one of the solids sinks in the liquid at rest [m/s]."""
        if self.settling_drag is not None:
            square = 4 / 3 * self.gravity * self.diameter * self.excess / self.settling_drag
            return math.sqrt(square)
        return terminal_velocity(
            diameter=self.diameter,
            density=self.density,
            liquid_density=self.liquid_density,
            kinematic_viscosity=self.kinematic_viscosity,
            gravity=self.gravity,
        )

    @property
    def drag_coefficient(self) -> float:
        """Drag coefficient at the terminal velocity [-]."""
        if self.settling_drag is not None:
            return self.settling_drag
        return sphere_drag_coefficient(
            self.terminal_velocity * self.diameter / self.kinematic_viscosity
        )

    @property
    def clear_gradient(self) -> float:
        """Loss of pressure of the liquid without solids, by Colebrook's friction factor [Pa/m]."""
        reynolds = self.bulk_velocity * self.pipe_diameter / self.kinematic_viscosity
        factor = friction_factor(reynolds, self.roughness / self.pipe_diameter)
        return factor * self.liquid_density * self.bulk_velocity**2 / (2 * self.pipe_diameter)

    @property
    def bed_weight(self) -> float:
        """Weight of the solids in the liquid, over the volume of the bore [N/m3]."""
        return self.concentration * self.excess * self.liquid_density * self.gravity

    @property
    def densimetric_froude(self) -> float:
        """Square of the velocity over g D (s - 1) [-]."""
        return self.bulk_velocity**2 / (self.gravity * self.pipe_diameter * self.excess)


def hydraulic_gradient(
    pressure_gradient: float, *, liquid_density: float, gravity: float = 9.807
) -> float:
    """Loss of pressure in metres of liquid per metre of pipe.

    Parameters
    ----------
    pressure_gradient : float
        [Pa/m]
    liquid_density : float
        [kg/m3]
    gravity : float
        [m/s2]

    Returns
    -------
    float
        [-]
    """
    return pressure_gradient / (liquid_density * gravity)


def inclined_gradient(
    level: float, *, clear: float, bed_weight: float, inclination: float
) -> float:
    """Loss of pressure in a pipe that rises, from that of the same pipe when level.

    Parameters
    ----------
    level : float
        Loss of pressure in the level pipe [Pa/m].
    clear : float
        Of it, that of the liquid without solids [Pa/m].
    bed_weight : float
        Weight of the solids in the liquid over the volume of the bore, by the in-situ concentration
        [N/m3].
    inclination : float
        Rise of the pipe towards its outlet [rad].

    Returns
    -------
    float
        Static head of the liquid apart, that of the solids included [Pa/m].

    Notes
    -----
    The solids press on the wall with the cosine of their weight, and are lifted by its sine. It is
    right for a level and for an upright pipe; in a rising one up to about 35 degrees friction is
    found larger, as solids fall behind.

    References
    ----------
    Worster & Denny (1955), Proc. Inst. Mech. Eng. 169, 563-586.
    """
    return clear + (level - clear) * math.cos(inclination) + bed_weight * math.sin(inclination)


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """Bounds of one quantity within which a model holds.

    Attributes
    ----------
    quantity : str
        As a sentence calls it.
    of : callable
        The quantity at a point.
    low, high : float
    unit : str
    why : str
        Where the bounds come from.
    """

    quantity: str
    of: Callable[[Conveying], float]
    low: float = 0.0
    high: float = math.inf
    unit: str = "-"
    why: str = "measured there"

    def complaint(self, flow: Conveying) -> str:
        """Why a point is outside; empty if it is not."""
        value = self.of(flow)
        if self.low <= value <= self.high:
            return ""
        unit = "" if self.unit == "-" else f" {self.unit}"
        bound = f"below {self.low:g}" if value < self.low else f"above {self.high:g}"
        return f"{self.quantity} is {value:.3g}{unit}, {bound}{unit}: {self.why}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Model:
    """A model of the loss of pressure, and where it holds.

    Attributes
    ----------
    name : str
        As a legend shows it.
    gradient : callable
        Loss of pressure at a point [Pa/m].
    concentration : {"in-situ", "delivered"}
        Which one it takes.
    ranges : tuple of Range
    source : str
    """

    name: str
    gradient: Callable[[Conveying], float]
    concentration: Concentration
    ranges: tuple[Range, ...]
    source: str

    def outside(self, flow: Conveying) -> list[str]:
        """Why the model does not hold at a point.

        Parameters
        ----------
        flow : Conveying

        Returns
        -------
        list of str
            A sentence for each range that the point is outside of; empty where the model holds.
        """
        return [said for bounds in self.ranges if (said := bounds.complaint(flow))]
