"""Units at the border: what a string becomes, and what is refused."""

import math
import subprocess
import sys

import numpy as np
import pytest
from pydantic_core import PydanticCustomError

from mpsdem.case.units import Quantity, Whole


@pytest.mark.parametrize(
    ("unit", "text", "si"),
    [
        ("m", "20 mm", 0.02),
        ("m", "1 inch", 0.0254),
        ("m", ".5m", 0.5),
        ("m", "-2E-3 km", -2.0),
        ("m/s", "1 ft/s", 0.3048),
        ("m/s", "1.5 m s-1", 1.5),
        ("kg/m3", "2.7 g/cm3", 2700.0),
        ("kg/m3", "2.7 g/cm^3", 2700.0),
        ("m2/s", "1 cSt", 1e-6),
        ("m2/s", "3 m²/s", 3.0),
        ("Pa", "100 MPa", 1e8),
        ("N/m", "1 kN/cm", 1e5),
        ("kg/s", "60 kg/min", 1.0),
        ("s", "2 h", 7200.0),
        ("rad", "180 deg", math.pi),
        ("rad/s", "1 turn/s", 2 * math.pi),
        ("-", "5 %", 0.05),
        ("-", "0.5", 0.5),
    ],
)
def test_a_string_becomes_the_si_number_it_means(unit, text, si):
    assert Quantity(unit).read(text) == pytest.approx(si, rel=1e-14)


@pytest.mark.parametrize("number", [3, 3.0, np.float32(3), np.int64(3)])
def test_a_plain_number_is_taken_as_si(number):
    value = Quantity("m").read(number)
    assert type(value) is float
    assert value == 3.0


@pytest.mark.parametrize(
    ("unit", "text"),
    [
        ("m", "5 kg"),
        ("m", "5"),
        ("m", "5 m2"),
        ("m", "5 deg"),
        ("kg/m3", "5 kg"),
        ("m2/s", "1 Pa s"),
        ("rad", "0.5"),
    ],
)
def test_another_dimension_is_refused_and_the_expected_unit_named(unit, text):
    with pytest.raises(PydanticCustomError, match=f"must have the dimension of {unit}"):
        Quantity(unit).read(text)


@pytest.mark.parametrize("text", ["5 kg", "5 deg"])
def test_a_coefficient_takes_no_unit_not_even_an_angle(text):
    with pytest.raises(PydanticCustomError, match="must be dimensionless"):
        Quantity().read(text)


@pytest.mark.parametrize("text", ["5 foo", "5 m 2", "5 m/0", "5 kg**", "5 m = 3", "5 __import__"])
def test_a_unit_that_does_not_exist_is_refused(text):
    with pytest.raises(PydanticCustomError, match="unknown unit"):
        Quantity("m").read(text)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, "1e999 m"])
def test_a_number_that_is_not_finite_is_refused(value):
    with pytest.raises(PydanticCustomError, match="must be finite"):
        Quantity("m").read(value)


@pytest.mark.parametrize(
    "value", [True, None, [1.0], {}, "", "mm", "nan m", "two mm", "1,5 mm", "5 1/0", 1j]
)
def test_what_is_no_number_is_refused(value):
    with pytest.raises(PydanticCustomError, match="must be a number"):
        Quantity("m").read(value)


def test_bounds_hold_after_conversion():
    assert Quantity("m", below=0.1).read("99 mm") == pytest.approx(0.099)
    with pytest.raises(PydanticCustomError, match=r"must be > 0 and < 0.1 m"):
        Quantity("m", above=0.0, below=0.1).read("100 mm")


@pytest.mark.parametrize("value", [True, 2.0, "2", None])
def test_a_count_is_a_whole_number(value):
    with pytest.raises(PydanticCustomError, match="must be a whole number"):
        Whole().read(value)


def test_a_case_in_plain_numbers_does_not_pay_for_units():
    program = (
        "import sys; from mpsdem.case import Pipe; Pipe(radius=0.1, length=1);"
        "sys.exit('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0
