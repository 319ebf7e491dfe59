"""A statement as a number with its error, and the bounds within which it holds."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

from mpsdem.validation.reproduction.measured import Measured
from mpsdem.validation.reproduction.scene import Scene

Scenes = Mapping[str, Scene]
Verdict = Literal["yes", "no", "open"]

_ERRORS = 2.0  # standard errors by which a bound must be kept, or broken


@dataclass(frozen=True, slots=True, kw_only=True)
class Statement:
    """What a paper says of its case.

    Parameters
    ----------
    id : str
        Short and unique.
    claim : str
        What the paper says.
    number : str
        What is measured of it, with the unit.
    measure : callable
        Scenes by name -> `Measured`, independent of the spacing.
    scenes : tuple of str
        The names it needs.
    at_least, at_most : float
        Where the statement holds, in the unit of the number.
    """

    id: str
    claim: str
    number: str
    measure: Callable[[Scenes], Measured]
    scenes: tuple[str, ...]
    at_least: float = -math.inf
    at_most: float = math.inf

    def verdict(self, measured: Measured) -> Verdict:
        """Whether it holds.

        Returns
        -------
        {"yes", "no", "open"}
            Open where a bound lies within two standard errors of the number.
        """
        room = 0.0 if math.isnan(measured.error) else _ERRORS * measured.error
        if self.at_least <= measured.mean - room and measured.mean + room <= self.at_most:
            return "yes"
        if self.at_least > measured.mean + room or measured.mean - room > self.at_most:
            return "no"
        return "open" if not math.isnan(measured.mean) else "no"
