"""Error bars are tried on series whose mean is known, and on those that have none."""

import numpy as np
import pytest
from scipy.signal import lfilter

from mpsdem.analysis import time_average

SERIES = 250


def autoregressive(values, memory, seed=0):
    """Stationary series of zero mean and unit noise, (SERIES, values)."""
    noise = np.random.default_rng(seed).standard_normal((SERIES, values))
    noise[:, 0] /= np.sqrt(1 - memory**2)
    return lfilter([1.0], [1.0, -memory], noise, axis=1)


def averages_of(series, interval=0.1):
    time = interval * np.arange(series.shape[1])
    return [time_average(time, values, window=(0.0, np.inf)) for values in series]


@pytest.mark.parametrize(("values", "memory"), [(200, 0.0), (300, 0.5), (1000, 0.8)])
def test_the_true_mean_lies_within_one_error_as_often_as_it_should(values, memory):
    found = averages_of(autoregressive(values, memory))
    away = np.array([abs(average.mean) / average.error for average in found])
    assert (away < 1).mean() == pytest.approx(0.683, abs=0.1)
    assert (away < 2).mean() == pytest.approx(0.954, abs=0.06)
    assert np.mean([average.long_enough for average in found]) > 0.95


@pytest.mark.parametrize("memory", [0.0, 0.8])
def test_correlation_makes_samples_fewer_and_the_error_larger_by_the_known_factor(memory):
    found = averages_of(autoregressive(4000, memory))
    slack = (1 + memory) / (1 - memory)
    assert np.mean([a.correlation_time for a in found]) == pytest.approx(slack * 0.05, rel=0.12)
    assert np.median([a.samples for a in found]) == pytest.approx(4000 / slack, rel=0.12)
    error = np.sqrt(np.mean([a.error**2 for a in found]))
    assert error == pytest.approx(1 / (1 - memory) / np.sqrt(4000), rel=0.06)


def test_a_series_of_a_few_correlation_times_says_that_it_is_too_short():
    found = averages_of(autoregressive(170, 0.97))
    assert np.mean([average.long_enough for average in found]) < 0.03


def test_a_constant_is_known_at_once():
    average = time_average(np.linspace(0, 10, 11), np.full(11, 0.1))
    assert average.mean == pytest.approx(0.1, rel=1e-15)
    assert (average.error, average.correlation_time) == (0, 0)
    assert average.samples == 6
    assert average.long_enough


def test_what_drifts_has_no_mean():
    time = np.linspace(0, 10, 1001)
    noise = np.random.default_rng(3).standard_normal(1001)
    assert not time_average(time, time).long_enough
    assert not time_average(time, 2.0 * time + noise).long_enough
    assert time_average(time, 100 + noise).long_enough


def test_a_steady_series_needs_no_length():
    time = np.linspace(0, 10, 21)
    assert time_average(time, 100 + 0.004 * time).long_enough
    assert not time_average(time, 100 + 0.2 * time).long_enough


def test_the_window_is_the_second_half_unless_one_is_given():
    time = np.arange(11.0)
    assert time_average(time, time).window == (5.0, 10.0)
    assert time_average(time, time).mean == 7.5
    assert time_average(time, time, window=(1.5, 4.0)).mean == 3.0


def test_a_swing_is_averaged_over_whole_periods_and_costs_no_error():
    time = 0.05 * np.arange(401)
    swing = 3.0 + np.sin(2 * np.pi * time + 0.3)
    aware = time_average(time, swing, window=(0.0, 19.7), period=1.0)
    assert aware.mean == pytest.approx(3.0, abs=1e-12)
    assert aware.error < 1e-12
    assert aware.long_enough
    assert aware.window == pytest.approx((0.75, 19.7))
    unaware = time_average(time, swing, window=(0.0, 19.7))
    assert abs(unaware.mean - 3.0) > 1e-3


def test_the_error_bar_of_a_swing_is_that_of_its_periods():
    time = 0.1 * np.arange(2000)
    each = np.random.default_rng(5).standard_normal((200, 1))  # one draw per period
    series = (each + 20 * np.sin(0.2 * np.pi * np.arange(10))).ravel()
    average = time_average(time, series, window=(0.0, np.inf), period=1.0)
    assert average.error == pytest.approx(1 / np.sqrt(200), rel=0.25)


def test_a_few_periods_have_the_error_of_their_means_and_one_has_none():
    time = 0.05 * np.arange(60)
    swing = 10 * np.sin(2 * np.pi * time) + np.repeat([1.0, 2.0, 3.0], 20)
    three = time_average(time, swing, window=(0.0, 9.0), period=1.0)
    assert (three.mean, three.error) == pytest.approx((2.0, 1 / np.sqrt(3)))
    assert three.samples <= 3
    assert not three.long_enough
    one = time_average(time, swing, window=(2.0, 9.0), period=1.0)
    assert one.mean == pytest.approx(3.0)
    assert np.isnan(one.error)
    assert not one.long_enough


def test_missing_values_are_left_out():
    time = np.arange(100.0)
    values = np.where(np.arange(100) % 3 == 0, np.nan, 2.0)
    assert time_average(time, values).mean == 2.0


@pytest.mark.parametrize("values", [[], [2.0], [np.nan, np.nan]])
def test_too_few_values_have_no_error_and_are_too_short(values):
    average = time_average(np.arange(float(len(values))), np.array(values), window=(0.0, 9.0))
    assert np.isnan(average.error)
    assert not average.long_enough


def test_an_average_scales_with_its_series():
    time, values = np.arange(100.0), np.random.default_rng(1).random(100)
    scaled, of_scaled = time_average(time, values).times(-3.0), time_average(time, -3.0 * values)
    assert scaled.mean == pytest.approx(of_scaled.mean)
    assert scaled.error == pytest.approx(of_scaled.error)
    assert scaled.samples == pytest.approx(of_scaled.samples)
