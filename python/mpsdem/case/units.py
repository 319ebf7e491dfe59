"""Numbers at the border: a plain number is SI, a string carries its unit; inside, all is SI."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import cache
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any

from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from mpsdem.case.errors import Problem, refusal

if TYPE_CHECKING:
    import pint

_NUMBER_AND_UNIT = re.compile(
    r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([^\s\d.,].*?)?\s*"
)
_EXPONENT = re.compile(r"(?<=[A-Za-z])(-?\d+)(?![\w.])")  # the 3 of kg/m3


@dataclass(frozen=True)
class Range:
    """Which numbers a field takes.

    Parameters
    ----------
    unit : str
        SI unit, such as ``"kg/m3"``; ``"-"`` for none.
    above, below : float, optional
        Bounds that the number itself may not reach.
    at_least, at_most : float, optional
        Bounds that it may reach.
    remedy : str
        What to do when it lies outside.
    """

    unit: str = "-"
    above: float | None = None
    at_least: float | None = None
    below: float | None = None
    at_most: float | None = None
    remedy: str = ""

    def holds(self, number: float) -> bool:
        """Tell whether `number` lies within the bounds."""
        return (
            (self.above is None or number > self.above)
            and (self.at_least is None or number >= self.at_least)
            and (self.below is None or number < self.below)
            and (self.at_most is None or number <= self.at_most)
        )

    @property
    def rule(self) -> str:
        """The bounds in words, unit included."""
        signs = (">", self.above), (">=", self.at_least), ("<", self.below), ("<=", self.at_most)
        bounds = " and ".join(f"{sign} {bound:g}" for sign, bound in signs if bound is not None)
        return f"must be {bounds}" + ("" if self.unit == "-" else f" {self.unit}")

    def refuse(self, rule: str, remedy: str = "") -> PydanticCustomError:
        """Error for a number of this field."""
        return refusal(Problem(rule=rule, unit=self.unit, remedy=remedy))


@dataclass(frozen=True)
class Quantity(Range):
    """Annotation of a float field: an SI number, or a string with a unit of the same dimension.

    Examples
    --------
    >>> Quantity("m", above=0.0).read("20 mm")
    0.02
    """

    def read(self, value: object) -> float:
        """Take a value from the border.

        Parameters
        ----------
        value : object
            SI number, or a string with a number and a unit.

        Returns
        -------
        float
            The number in `unit`.

        Raises
        ------
        PydanticCustomError
            If it is no number, not finite, of another dimension or out of bounds.
        """
        if isinstance(value, str):
            number = self._converted(value)
        elif isinstance(value, Real) and not isinstance(value, bool):
            number = float(value)
        else:
            raise self.refuse(f"must be a number{self._unit_in_words}")
        if not math.isfinite(number):
            raise self.refuse("must be finite")
        if not self.holds(number):
            raise self.refuse(self.rule, self.remedy)
        return number

    def _converted(self, text: str) -> float:
        match = _NUMBER_AND_UNIT.fullmatch(text)
        if match is None:
            raise self.refuse(f"must be a number{self._unit_in_words}")
        number, unit = float(match[1]), match[2] or ""
        try:
            given = _parsed(unit)
        except Exception:  # pint's parser raises a dozen kinds, down to AssertionError
            raise self.refuse(f"unknown unit {unit!r}", self._example) from None
        target = _parsed("" if self.unit == "-" else self.unit)
        if _dimension(given) != _dimension(target):
            plain = self.unit == "-"
            rule = "must be dimensionless" if plain else f"must have the dimension of {self.unit}"
            raise self.refuse(rule, self._example)
        try:
            return float(_registry().Quantity(number, given).m_as(target))
        except Exception:  # a unit with an offset, a logarithmic one
            raise self.refuse(f"has no value in {self.unit}", self._example) from None

    @property
    def _unit_in_words(self) -> str:
        return "" if self.unit == "-" else f" in {self.unit}, or a string with a number and a unit"

    @property
    def _example(self) -> str:
        return "write a plain number" if self.unit == "-" else f"write for example '1 {self.unit}'"

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)


@dataclass(frozen=True)
class Whole(Range):
    """Annotation of an int field."""

    def read(self, value: object) -> int:
        """Take a whole number from the border, or raise PydanticCustomError."""
        if not isinstance(value, Integral) or isinstance(value, bool):
            raise self.refuse("must be a whole number")
        if not self.holds(int(value)):
            raise self.refuse(self.rule, self.remedy)
        return int(value)

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)


@cache
def _registry() -> pint.UnitRegistry[float]:
    import pint  # a third of a second, which cases in plain SI numbers need not pay

    return pint.UnitRegistry()


@cache
def _parsed(unit: str) -> pint.Unit:
    return _registry().parse_units(_EXPONENT.sub(r"**\1", unit))


def _dimension(unit: pint.Unit) -> object:
    # To pint an angle has no dimension; here "5 deg" is no friction, and "0.3" no inclination.
    root = _registry().Quantity(1.0, unit).to_root_units().units
    return unit.dimensionality, "radian" in str(root)
