"""The liquid that fills the pipe."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Literal

from mpsdem.case.errors import Problem
from mpsdem.case.part import Part
from mpsdem.case.units import Quantity


class Liquid(Part):
    """Newtonian liquid.

    Parameters
    ----------
    model : {"auto", "profile", "eulerian", "lagrangian"}
        How the flow is computed; ``"auto"`` leaves the choice to the plan.
    density : float
        Density [kg/m3].
    kinematic_viscosity : float
        Kinematic viscosity [m2/s].
    bulk_velocity : float
        Flow rate over the area of the bore, positive towards the outlet [m/s]; that of liquid and
        solids where the liquid feels them.
    pressure_gradient : float, optional
        Loss of pressure along the pipe that drives a computed liquid [Pa/m]; by default the one
        that holds the bulk velocity. Where given, ``bulk_velocity`` is that of the start.
    """

    model: Literal["auto", "profile", "eulerian", "lagrangian"] = "auto"
    density: Annotated[float, Quantity("kg/m3", above=0.0)]
    kinematic_viscosity: Annotated[float, Quantity("m2/s", above=0.0)]
    bulk_velocity: Annotated[float, Quantity("m/s")]
    pressure_gradient: Annotated[float, Quantity("Pa/m")] | None = None

    @property
    def computed(self) -> bool:
        """Whether the flow is computed: asked for, or driven so that no profile is known."""
        return self.model in ("eulerian", "lagrangian") or self.pressure_gradient is not None

    def problems(self) -> Iterable[Problem]:
        if self.pressure_gradient is not None and self.model == "profile":
            yield Problem(
                field="pressure_gradient",
                value=self.pressure_gradient,
                unit="Pa/m",
                rule="drives a computed liquid only",
                remedy="set model = 'eulerian', 'lagrangian' or 'auto', or leave it out",
            )
