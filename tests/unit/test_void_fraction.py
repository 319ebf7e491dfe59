"""Void fraction at the solids: a lone one, a crowd, a bed against the wall."""

import numpy as np
import pytest

from mpsdem._core import coupling

RADIUS, PERIOD, SMOOTHING = 0.1, 0.6, 0.05
SPHERE = 0.01  # [m] radius; SMOOTHING is 2.5 of its diameters


def void_fraction(
    position,
    radius=SPHERE,
    *,
    pipe_radius=RADIUS,
    period=PERIOD,
    smoothing_radius=SMOOTHING,
    **call,
):
    position = np.asarray(position, dtype=float)
    average = coupling.VoidFraction(
        pipe_radius=pipe_radius, period=period, smoothing_radius=smoothing_radius
    )
    radius = np.broadcast_to(radius, len(position)).astype(float)
    return average.at_solids(position=position, radius=radius, **call)


def kernel(r, smoothing_radius=SMOOTHING):
    q = np.minimum(r / smoothing_radius, 1)
    return 1 - 5 * q**4 + 4 * q**5


def random_solids(count, rng, *, bore=RADIUS, smallest=0.3):
    """Centres in the bore and radii; they may overlap, which the average does not mind."""
    distance = (bore - SPHERE) * np.sqrt(rng.random(count))
    angle = rng.uniform(0, 2 * np.pi, count)
    position = np.column_stack(
        [rng.uniform(0, PERIOD, count), distance * np.cos(angle), distance * np.sin(angle)]
    )
    return position, SPHERE * rng.uniform(smallest, 1, count)


def lattice(solid_fraction, offset):
    """Face-centred cubic lattice of spheres that fills the bore as far as the wall lets it."""
    edge = (4 * 4 / 3 * np.pi * SPHERE**3 / solid_fraction) ** (1 / 3)
    along = round(PERIOD / edge)
    across = np.arange(-8, 8) * edge
    cells = np.meshgrid(np.arange(along) * PERIOD / along, across, across, indexing="ij")
    basis = np.array([[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]]) * edge
    points = (np.stack(cells, axis=-1).reshape(-1, 1, 3) + basis).reshape(-1, 3)
    points += [0, *offset]
    return points[distance_from_axis(points) < RADIUS - SPHERE]


def distance_from_axis(points):
    return np.hypot(points[:, 1], points[:, 2])


@pytest.mark.parametrize("distance", [0.0, 0.05, 0.07, RADIUS - SPHERE])
def test_a_lone_sphere_sees_only_liquid(distance):
    eps, clipped = void_fraction([[0.3, 0, -distance]])
    assert eps == [1.0]
    assert clipped == 0


def test_spheres_beyond_each_others_reach_see_only_liquid():
    eps, _ = void_fraction([[0.1, 0, 0], [0.1 + 1.01 * SMOOTHING, 0, 0]])
    assert np.all(eps == 1.0)


@pytest.mark.parametrize("solid_fraction", [0.3, 0.5, 0.6])
def test_a_bed_shows_its_full_solid_fraction_away_from_the_wall(solid_fraction):
    position = lattice(solid_fraction, offset=(0.003, 0.007))
    eps, _ = void_fraction(position)
    inner = eps[distance_from_axis(position) < 0.03]
    assert 1 - inner.mean() == pytest.approx(solid_fraction, abs=0.02)


@pytest.mark.parametrize("solid_fraction", [0.3, 0.6])
def test_a_bed_at_the_wall_reads_no_thinner_than_it_is(solid_fraction):
    """Against the volume of the spheres, point by point, over the liquid and solids in the bore."""
    rng = np.random.default_rng(2)
    position = lattice(solid_fraction, offset=(0.003, 0.007))
    at_wall = np.flatnonzero(distance_from_axis(position) > 0.08)[:60]
    eps, _ = void_fraction(position)

    inside = rng.uniform(-SPHERE, SPHERE, (200, 3))
    inside = inside[np.linalg.norm(inside, axis=1) < SPHERE]
    around = rng.uniform(-SMOOTHING, SMOOTHING, (20_000, 3))
    volume = 4 / 3 * np.pi * SPHERE**3
    exact = []
    for centre in position[at_wall]:
        apart = (position - centre)[:, None] + inside
        apart[..., 0] -= PERIOD * np.round(apart[..., 0] / PERIOD)
        solid = volume * kernel(np.linalg.norm(apart, axis=2)).mean(axis=1).sum()
        in_bore = distance_from_axis(centre + around) < RADIUS
        weight = kernel(np.linalg.norm(around, axis=1)) * in_bore
        exact.append(solid / (weight.mean() * (2 * SMOOTHING) ** 3))
    assert 1 - eps[at_wall].mean() == pytest.approx(np.mean(exact), abs=0.03)


@pytest.mark.parametrize("period", [0.6, 0.13, 0.11, 0.06, 0.05])
def test_every_neighbor_and_every_periodic_image_is_found(period):
    """In a wide bore, where the wall is out of reach, the sum over all pairs is known."""
    rng = np.random.default_rng(3)
    position, radius = random_solids(round(1500 * period / PERIOD), rng)
    position[:, 0] = rng.uniform(0, period, len(position))
    volume = 4 / 3 * np.pi * radius**3
    weighted = np.zeros(len(position))
    for image in (-1, 0, 1):
        apart = position[:, None] - position + [image * period, 0, 0]
        weighted += kernel(np.linalg.norm(apart, axis=2)) @ volume
    everything = 10 / 21 * np.pi * SMOOTHING**3
    all_solids, own = weighted / everything, volume / everything
    assert 0.05 < all_solids.mean() < 0.5
    # the others' share, stretched to fill a bed of 0.6 without the solid itself
    expected = 1 - (all_solids - own) / (1 - own / 0.6)

    eps, _ = void_fraction(position, radius, pipe_radius=0.5, period=period)
    loose = all_solids < 0.6
    np.testing.assert_allclose(eps[loose], expected[loose], rtol=1e-12)
    np.testing.assert_allclose(eps[~loose], np.maximum(1 - all_solids[~loose], 0.3), rtol=1e-12)


def test_the_void_fraction_falls_without_a_jump_as_a_bed_gets_denser():
    position, _ = random_solids(500, np.random.default_rng(4))
    solid = [1 - void_fraction(position, size)[0] for size in np.linspace(0.2, 1.6, 200) * SPHERE]
    steps = np.diff(solid, axis=0)
    assert np.all(steps >= 0)
    assert np.max(solid) > 0.6
    assert np.max(steps) < 0.03


@pytest.mark.parametrize("threads", [2, 3, 4])
def test_the_result_does_not_depend_on_the_threads(threads):
    position, radius = random_solids(800, np.random.default_rng(5))
    one, _ = void_fraction(position, radius)
    many, _ = void_fraction(position, radius, threads=threads)
    assert np.array_equal(one, many)


def test_the_result_does_not_depend_on_the_order_of_the_solids():
    rng = np.random.default_rng(6)
    position, radius = random_solids(500, rng)
    shuffle = rng.permutation(500)
    eps, _ = void_fraction(position, radius)
    shuffled, _ = void_fraction(position[shuffle], radius[shuffle])
    np.testing.assert_allclose(shuffled, eps[shuffle], rtol=1e-12)


def test_the_pipe_may_be_turned_about_its_axis_and_shifted_along_it():
    position, radius = random_solids(500, np.random.default_rng(7))
    x, y, z = position.T
    turned = np.column_stack([x + 0.37, 0.6 * y - 0.8 * z, 0.8 * y + 0.6 * z])
    turned[::2, 0] -= 3 * PERIOD
    eps, _ = void_fraction(position, radius)
    np.testing.assert_allclose(void_fraction(turned, radius)[0], eps, rtol=1e-9)


def test_the_result_does_not_depend_on_the_unit_of_length():
    position, radius = random_solids(300, np.random.default_rng(8))
    eps, _ = void_fraction(position, radius)
    in_millimetres, _ = void_fraction(
        1e3 * position,
        1e3 * radius,
        pipe_radius=1e3 * RADIUS,
        period=1e3 * PERIOD,
        smoothing_radius=1e3 * SMOOTHING,
    )
    np.testing.assert_allclose(in_millimetres, eps, rtol=1e-9)


def test_solids_denser_than_any_packing_are_raised_to_the_floor_and_counted():
    pile = np.tile([0.3, 0, 0], (50, 1))
    alone = [[0.1, 0, 0]]
    eps, clipped = void_fraction(np.concatenate([pile, alone]))
    assert clipped == 50
    assert np.all(eps[:50] == 0.3)
    assert eps[50] == 1.0


def test_a_diverged_position_is_left_to_the_check_of_the_fields():
    eps, _ = void_fraction([[0.1, 0, 0], [np.nan, np.inf, 0]])
    assert np.all(np.isfinite(eps))


def test_no_solids_are_no_error():
    eps, clipped = void_fraction(np.empty((0, 3)))
    assert eps.shape == (0,)
    assert clipped == 0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"pipe_radius": 0.0}, "pipe_radius must be > 0 m"),
        ({"period": -1.0}, "period must be > 0 m"),
        ({"smoothing_radius": np.nan}, "smoothing_radius must be > 0 m"),
        ({"smoothing_radius": 0.7}, "at most the period"),
        ({"radius": 0.02}, "raise smoothing_radius"),
        ({"radius": 0.0}, "radius must be > 0 m"),
    ],
)
def test_bad_input_names_the_field(change, message):
    with pytest.raises(ValueError, match=message):
        void_fraction([[0.1, 0, 0]], **change)
