"""A number with its error."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """A number with its standard error.

    Parameters
    ----------
    mean : float
        In the unit of the statement.
    error : float
        In the same unit; NaN where a single run cannot tell.
    """

    mean: float
    error: float

    def __sub__(self, other: Measured) -> Measured:
        return Measured(mean=self.mean - other.mean, error=math.hypot(self.error, other.error))

    def __truediv__(self, other: Measured) -> Measured:
        ratio = self.mean / other.mean
        error = math.hypot(self.error, ratio * other.error) / abs(other.mean)
        return Measured(mean=ratio, error=error)

    def times(self, factor: float) -> Measured:
        """The same in another unit."""
        return Measured(mean=self.mean * factor, error=self.error * abs(factor))
