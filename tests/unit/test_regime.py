"""Regimes, beds, plugs and velocities of made-up solids that leave no doubt."""

import numpy as np
import pytest
from scipy.special import ndtri

from mpsdem.analysis import (
    Regime,
    accumulation,
    bed_height,
    by_period,
    find_plug,
    flow_regime,
    full_fraction,
    in_bed,
    radial_velocity,
    silhouette,
    standing_full,
    standing_time,
    trend,
    velocity_density,
    volume_fraction_along_pipe,
)

PIPE = {"pipe_radius": 0.1, "length": 1.0}
D = 0.02


def pile(layers, columns=3, gap=0.0, start=0.0, stations=50):
    """Spheres in layers over each other, the lowest on the wall, (n, 3): a cubic lattice."""
    pitch = D * (1 + gap)
    x = start + pitch * np.arange(stations)
    y = pitch * (np.arange(columns) - (columns - 1) / 2)
    floor = -np.sqrt(0.09**2 - y.max() ** 2)
    z = floor + pitch * np.arange(layers)
    return np.array([[a, b, c] for a in x for b in y for c in z])


def bed_of(position):
    return in_bed(position, np.full(len(position), D / 2), **PIPE)


def test_a_pile_on_the_wall_is_all_bed_and_its_height_is_known():
    position = pile(3)
    radius = np.full(len(position), D / 2)
    assert bed_of(position).all()
    top = 0.1 - np.sqrt(0.09**2 - D**2) + 2 * D + D / 2
    assert bed_height(position[:, 2], radius, **{"pipe_radius": 0.1}) == pytest.approx(top)
    surface = silhouette(position, radius, length=1.0, bins=10).upper + 0.1
    np.testing.assert_allclose(surface, top)


def test_what_floats_above_a_bed_is_not_bed():
    position = np.vstack([pile(2), pile(1) + np.array([0, 0, 0.12])])
    bed = bed_of(position)
    assert bed[:300].all()
    assert not bed[300:].any()


def test_a_bed_that_rattles_is_still_a_bed_and_one_that_is_blown_apart_is_not():
    assert bed_of(pile(3, gap=0.015, stations=48)).all()
    apart = bed_of(pile(3, gap=0.05, stations=47)).reshape(47, 3, 3)
    assert apart[:, [0, 2], 0].all()  # only what lies on the wall itself
    assert not apart[:, :, 1:].any()


def test_what_touches_the_roof_alone_is_not_bed():
    assert not bed_of(pile(1) * [1, 1, -1]).any()


def test_a_chain_through_the_outlet_holds_on_the_other_side():
    on_wall = [0.995, 0.0, -0.09]
    position = np.array([on_wall, [0.015, 0.0, -0.09 + 0.001], [0.015, 0.0, -0.07 + 0.001]])
    assert bed_of(position).all()
    assert bed_of(position[:, [0, 2, 1]])[0] == np.False_


def test_no_solids_make_no_bed():
    assert bed_of(np.empty((0, 3))).shape == (0,)


REGIMES = [
    (Regime.STATIONARY_BED, 0.9, 0.01, 0.0),
    (Regime.STATIONARY_BED, 0.9, -0.02, 0.0),
    (Regime.SLIDING_BED, 0.9, 0.4, 0.0),
    (Regime.SALTATION, 0.3, 0.4, 0.2),
    (Regime.HETEROGENEOUS, 0.05, 0.6, 0.4),
    (Regime.HOMOGENEOUS, 0.01, 0.9, 0.95),
    (Regime.HOMOGENEOUS, 0.0, np.nan, 1.0),
    (Regime.HETEROGENEOUS, 0.0, np.nan, 3.0),
]


@pytest.mark.parametrize(("regime", "share", "velocity", "even"), REGIMES)
def test_a_flow_is_called_what_an_engineer_calls_it(regime, share, velocity, even):
    told = flow_regime(bed_share=share, bed_velocity_ratio=velocity, upper_over_lower=even)
    assert told.regime is regime


def test_radial_velocity_points_from_the_axis():
    position = np.array([[0.3, 0.0, -0.05], [0.0, 0.03, 0.04], [0.1, 0.0, 0.0]])
    velocity = np.array([[9.0, 0.0, -0.2], [9.0, 0.04, -0.03], [9.0, 0.3, 0.4]])
    np.testing.assert_allclose(radial_velocity(position, velocity), [0.2, 0.0, 0.5], atol=1e-15)


def test_a_normal_law_gives_back_its_density():
    values = 0.3 + 0.1 * np.random.default_rng(0).standard_normal(200_000)
    found = velocity_density(values)
    middle = (found.edges[1:] + found.edges[:-1]) / 2
    exact = np.exp(-(((middle - 0.3) / 0.1) ** 2) / 2) / (0.1 * np.sqrt(2 * np.pi))
    np.testing.assert_allclose(found.density, exact, atol=0.08)
    assert (found.density * np.diff(found.edges)).sum() == pytest.approx(0.999, abs=2e-4)
    assert (found.mean, found.deviation) == pytest.approx((0.3, 0.1), abs=1e-3)


def test_velocities_that_are_all_alike_still_have_a_density():
    found = velocity_density(np.zeros(10))
    assert (found.density * np.diff(found.edges)).sum() == pytest.approx(1)
    assert found.deviation == 0


def test_each_period_has_its_mean_and_its_peak():
    time = 0.1 * np.arange(101)  # values are means since the time before
    values = np.where(time > 5, 3.0, 1.0) + np.sin(2 * np.pi * (time - 0.05) / 2.5)
    periods = by_period(time, values, period=2.5, start=0.0)
    np.testing.assert_allclose(periods.start, [0.0, 2.5, 5.0, 7.5])
    np.testing.assert_allclose(periods.mean, [1, 1, 3, 3], atol=1e-12)
    np.testing.assert_allclose(periods.peak, [2, 2, 4, 4], atol=0.01)
    np.testing.assert_allclose(periods.trough, [0, 0, 2, 2], atol=0.01)


def test_a_period_that_has_not_ended_is_left_out():
    time = 0.1 * np.arange(100)
    assert len(by_period(time, time, period=2.5, start=0.0).start) == 3
    assert len(by_period(time, time, period=20.0, start=0.0).start) == 0


STATION = (np.arange(10) + 0.5) / 10
FULL = full_fraction(0.2, D)


def filling(rate=0.06, moves=0.0):
    """A section that fills at a rate [1/s] until it is packed; solids elsewhere go on."""
    time = 0.5 * np.arange(41)
    fraction = np.full((41, 10), 0.05)
    fraction[:, 6] = np.minimum(rate * time, 0.56)
    velocity = np.full((41, 10), 0.6)
    velocity[fraction > 0.5] = moves
    return time, fraction, fraction * velocity


def plug_in(time, fraction, flux, **changed):
    standing = standing_full(fraction, flux, full=FULL, bulk_velocity=1.0)
    return find_plug(time, STATION, fraction, standing, lasting=standing_time(0.2, 1.0), **changed)


def test_a_section_that_fills_and_stands_is_a_plug_with_its_place_and_time():
    plug = plug_in(*filling())
    assert plug.position == pytest.approx(0.65)
    assert plug.time == pytest.approx(FULL / 0.06, abs=0.5)
    assert plug.fraction == pytest.approx(0.53, abs=0.04)


def test_a_full_section_that_moves_is_no_plug():
    assert plug_in(*filling(moves=0.2)) is None


def test_a_section_that_is_full_for_a_moment_is_no_plug():
    time, fraction, flux = filling()
    released = time > FULL / 0.06 + 0.8
    flux[released] = 0.5 * fraction[released]
    assert plug_in(time, fraction, flux) is None


def test_spheres_in_a_narrow_tube_are_full_at_a_lower_fraction():
    assert 0.35 < full_fraction(0.05, D) < full_fraction(0.2, D) < 0.52


def test_what_flows_in_and_not_out_is_what_a_section_gains():
    velocity, step = 0.3, 1e-4
    x = 0.4 + 0.08 * ndtri((np.arange(20_000) + 0.5) / 20_000)  # a bell without noise
    radius = np.full(len(x), 1e-3)

    def share(at):
        return volume_fraction_along_pipe(at, radius, **PIPE, bins=40)

    gain = (share(x + velocity * step) - share(x - velocity * step)) / (2 * step)
    found = accumulation(velocity * share(x), length=1.0)
    assert found.sum() == pytest.approx(0, abs=1e-12)
    np.testing.assert_allclose(found, gain, atol=0.05 * np.abs(gain).max())


def test_a_trend_is_found_with_its_error_and_noise_has_none():
    time = 0.1 * np.arange(1000)
    noise = np.random.default_rng(4).standard_normal((100, 1000))
    found = [trend(time, 2.0 + 0.05 * time + values) for values in noise]
    slopes = np.array([one.slope for one in found])
    assert slopes.mean() == pytest.approx(0.05, abs=1e-3)
    assert np.mean([one.error for one in found]) == pytest.approx(slopes.std(), rel=0.2)
    assert all(one.rises for one in found)
    assert not any(trend(time, values).rises for values in noise)
