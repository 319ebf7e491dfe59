"""The prescribed liquid."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mpsdem._core import mps
from mpsdem.liquids.protocol import FloatArray, Stored

_PROFILE_POINTS = 101  # radii of the prescribed profile in the results


@dataclass(frozen=True, slots=True, kw_only=True)
class ProfileLiquid:
    """The developed profile of the pipe, prescribed and steady."""

    profile: mps.PipeProfile
    pipe_radius: float
    bulk_velocity: float
    pressure_gradient: float  # [Pa/m] loss of the liquid alone
    sound: bool = True

    def advance(self, dt: float) -> None:
        """Do nothing: it is steady."""

    def velocity_at(self, position: FloatArray) -> FloatArray:
        return self.profile.velocity(position)

    def static_fields(self) -> dict[str, ArrayLike]:
        radius = np.linspace(0, self.pipe_radius, _PROFILE_POINTS)
        velocity = self.profile.velocity(np.outer(radius, [0.0, 0.0, 1.0]))
        return {"profile_radius": radius, "profile_velocity": velocity[:, 0]}

    def frame(self) -> tuple[dict[str, ArrayLike], dict[str, ArrayLike]]:
        diagnostics: dict[str, ArrayLike] = {
            "bulk_velocity": self.bulk_velocity,
            "pressure_gradient": self.pressure_gradient,
            "pressure_gradient_friction": self.pressure_gradient,
        }
        return {}, diagnostics

    def state(self) -> dict[str, Stored]:
        return {}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Do nothing: nothing changes."""
