"""The exact flows that the particle liquid is held to, by printed numbers and other programs."""

import cmath
import math

import fluids
import numpy as np
import pytest
from scipy.integrate import quad

from mpsdem.validation import exact_flows as exact

AXIS = np.zeros(1)


@pytest.mark.parametrize(
    ("time", "on_axis", "mean", "halfway"),
    [
        (0.01, 0.04000, 0.06837, 0.04000),
        (0.05, 0.19962, 0.27582, 0.18935),
        (0.2, 0.65180, 0.69897, 0.51646),
        (1.0, 0.99659, 0.99705, 0.74771),
    ],
)
def test_a_flow_that_starts_from_rest_has_the_printed_velocities(time, on_axis, mean, halfway):
    axis, half = exact.start_up(np.array([0.0, 0.5]), time) / 2
    assert axis == pytest.approx(on_axis, abs=6e-6)
    assert half == pytest.approx(halfway, abs=6e-6)
    flow_rate, _ = quad(lambda s: 2 * s * float(exact.start_up(np.array([s]), time)[0]), 0, 1)
    assert flow_rate == pytest.approx(mean, abs=6e-6)


def test_a_flow_that_starts_from_rest_becomes_the_parabola():
    share = np.linspace(0, 1, 11)
    np.testing.assert_allclose(exact.start_up(share, 10.0), exact.parabola(share), atol=1e-12)


@pytest.mark.parametrize(
    ("womersley", "on_axis", "axis_lag", "mean", "mean_lag"),
    [
        (1.0, 0.98493, 10.65, 0.98557, 9.45),
        (3.0, 0.52198, 64.29, 0.54835, 54.30),
        (10.0, 0.03975, 89.86, 0.06947, 81.31),
        (20.0, 0.01000, 90.0, 0.01864, 85.80),
    ],
)
def test_a_flow_that_oscillates_has_the_printed_sizes_and_lags(
    womersley, on_axis, axis_lag, mean, mean_lag
):
    axis = complex(exact.oscillation(AXIS, womersley)[0])
    flow_rate = exact.mean_oscillation(womersley)
    for phasor, size, lag in ((axis, on_axis, axis_lag), (flow_rate, mean, mean_lag)):
        assert abs(phasor) == pytest.approx(size, abs=6e-6)
        assert -math.degrees(cmath.phase(phasor)) == pytest.approx(lag, abs=6e-3)


@pytest.mark.parametrize("womersley", [0.1, 3.0, 10.0])
def test_the_mean_of_an_oscillation_is_that_of_its_profile(womersley):
    share = np.sqrt((np.arange(4000) + 0.5) / 4000)  # of equal shares of the bore
    mean = 2 * exact.oscillation(share, womersley).mean()
    assert mean == pytest.approx(exact.mean_oscillation(womersley), rel=1e-4)


@pytest.mark.parametrize("reynolds", [1e4, 1e5, 5e5])
@pytest.mark.parametrize("roughness", [0.0, 2e-3])
def test_the_friction_factor_is_that_of_another_program(reynolds, roughness):
    expected = fluids.friction_factor(Re=reynolds, eD=roughness, Method="Colebrook")
    assert exact.colebrook(reynolds, roughness) == pytest.approx(expected, rel=1e-9)
