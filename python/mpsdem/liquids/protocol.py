"""What the rest of the program knows of a liquid."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mpsdem._core import coupling, mps

FloatArray = NDArray[np.float64]
Stored = NDArray[Any] | int | float


class Liquid(Protocol):
    """What the rest of the program knows of a liquid."""

    @property
    def sound(self) -> bool:
        """Whether all is well after the last advance."""

    def advance(self, dt: float) -> None:
        """Go on by dt [s]."""

    def velocity_at(self, position: FloatArray) -> FloatArray:
        """Velocity at points, (n, 3) [m/s]; both seen from the pipe."""

    def static_fields(self) -> Mapping[str, ArrayLike]:
        """Fields of the results that do not change."""

    def frame(self) -> tuple[Mapping[str, ArrayLike], Mapping[str, ArrayLike]]:
        """Fields and diagnostics for the results, since the last frame."""

    def state(self) -> dict[str, Stored]:
        """All that changes, for a checkpoint."""

    def restore(self, state: Mapping[str, Any]) -> None:
        """Go on from a `state`."""


@runtime_checkable
class ComputedLiquid(Liquid, Protocol):
    """A liquid that can feel solids."""

    @property
    def core(self) -> mps.LagrangianLiquid | mps.EulerianLiquid:
        """What an exchange with solids finds its way in."""

    def advance(self, dt: float, exchange: coupling.Exchange | None = None) -> None:
        """Go on by dt [s], with what the solids of an exchange give."""
