"""The liquid that fills the pipe."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import field_validator

from mpsdem.case.errors import Problem, refusal
from mpsdem.case.part import Part
from mpsdem.case.units import Quantity


class Liquid(Part):
    """Newtonian liquid.

    Parameters
    ----------
    model : {"auto", "profile"}
        How the flow is computed; ``"auto"`` leaves the choice to the plan.
    density : float
        Density [kg/m3].
    kinematic_viscosity : float
        Kinematic viscosity [m2/s].
    bulk_velocity : float
        Flow rate over the area of the bore, positive towards the outlet [m/s].
    """

    model: Literal["auto", "profile"] = "auto"
    density: Annotated[float, Quantity("kg/m3", above=0.0)]
    kinematic_viscosity: Annotated[float, Quantity("m2/s", above=0.0)]
    bulk_velocity: Annotated[float, Quantity("m/s")]

    @field_validator("model", mode="before")
    @classmethod
    def _is_here(cls, model: object) -> object:
        if model in ("eulerian", "lagrangian"):
            raise refusal(Problem(rule="is not in this version", remedy="use 'profile', or 'auto'"))
        return model
