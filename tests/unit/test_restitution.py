"""A collision returns what it was given, head-on and oblique."""

import numpy as np
import pytest

from mpsdem._core import dem
from slow_dem import Bore, Flat, scene

SPEEDS = [0.01, 0.3, 3.0]  # [m/s]
RESTITUTIONS = [0.1, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0]
RADIUS, DENSITY = 0.01, 2500.0
MASS = DENSITY * 4 / 3 * np.pi * RADIUS**3


def hertz(restitution, friction=0.0):
    return dem.HertzMindlin(
        youngs_modulus=1e8, poisson_ratio=0.2, restitution=restitution, friction=friction
    )


def linear(restitution, friction=0.0):
    return dem.LinearSpring.with_restitution(
        normal_stiffness=1e5,
        tangential_stiffness=1e5,
        restitution=restitution,
        friction=friction,
    )


both_laws = pytest.mark.parametrize("law_with", [hertz, linear])


def after(solids, dt, most=100_000):
    """Run until all that touched has parted."""
    touched = False
    for _ in range(most // 50):
        touched = solids.advance(dt, 50).largest_overlap > 0 or touched
        if touched and len(solids.contacts()["overlap"]) == 0:
            return solids
    raise AssertionError("the solids never parted")


def step(speed, radius=RADIUS):
    """A small share of an impact under either law [s]."""
    mass = DENSITY * 4 / 3 * np.pi * radius**3
    hertz_time = 2.9 * (mass**2 / (radius * 1e16 * speed)) ** 0.2
    linear_time = 2.2 * np.sqrt(mass / 1e5)
    return min(hertz_time, linear_time) / 500


def meet(law, speed, *, radius=(RADIUS, RADIUS), axis=(1.0, 0.0, 0.0)):
    """Closing speed before over parting speed after two spheres met head-on."""
    radius, axis = np.array(radius), np.array(axis)
    gap = (1 + 1e-9) * radius.sum()
    solids = scene(
        [0 * axis, gap * axis], [speed * axis, 0 * axis], radius=radius, pair_law=law
    ).solids()
    velocity = after(solids, step(speed, radius.min())).velocity
    return (velocity[1] - velocity[0]) @ axis / speed


@both_laws
@pytest.mark.parametrize("restitution", RESTITUTIONS)
def test_a_collision_returns_the_restitution_it_was_given(law_with, restitution):
    for speed in SPEEDS:
        assert meet(law_with(restitution), speed) == pytest.approx(restitution, abs=1e-3)


@both_laws
def test_unequal_spheres_return_it_too(law_with):
    for radius in [(0.01, 0.002), (0.003, 0.01)]:
        returned = meet(law_with(0.6), 0.5, radius=radius, axis=(0.6, 0.0, 0.8))
        assert returned == pytest.approx(0.6, abs=2e-3)


@both_laws
@pytest.mark.parametrize(
    "wall", [Flat(point=(0.0, 0.0, -0.1)), Bore(radius=0.1)], ids=["flat", "bore"]
)
def test_a_wall_returns_it_too(law_with, wall):
    for restitution in (0.2, 0.6, 1.0):
        law = law_with(restitution)
        solids = scene([0, 0, -0.0899], [0, 0, -0.5], wall_law=law, walls=[wall]).solids()
        velocity = after(solids, step(0.5)).velocity
        np.testing.assert_allclose(velocity, [[0, 0, 0.5 * restitution]], atol=1e-3)


@pytest.mark.parametrize("factor", [0.1, 0.5, 1.0, 1.3, 1.5, 1.9])
def test_linear_damping_agrees_with_the_closed_form(factor):
    """Schwager & Poeschel (2007) doi:10.1007/s10035-007-0065-z, eqs. 20 and 21: no pulling."""
    beta = factor / 2  # of x'' + 2 beta x' + x = 0
    omega = np.sqrt(1 - beta**2)
    phase = np.arctan(2 * beta * omega / (omega**2 - beta**2))
    restitution = np.exp(-beta / omega * (np.pi - phase if beta < np.sqrt(0.5) else -phase))
    assert dem.damping_factor(restitution, 1, 0) == pytest.approx(factor, rel=1e-4)


@pytest.mark.parametrize("restitution", [0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9])
def test_hertz_damping_agrees_with_thornton(restitution):
    """Polynomial of Thornton, Cummins & Cleary (2013) doi:10.1016/j.powtec.2012.08.012."""
    h = [
        -6.918798,
        -16.41105,
        146.8049,
        -796.4559,
        2928.711,
        -7206.864,
        11494.29,
        -11342.18,
        6276.757,
        -1489.915,
    ]
    alpha = sum(c * restitution ** (k + 1) for k, c in enumerate(h))
    damping_ratio = np.sqrt(1 / (1 - (1 + restitution) ** 2 * np.exp(alpha)) - 1)
    factor = 2 * np.sqrt(3 / 2) * damping_ratio  # c = 2 gamma sqrt(m k), k = 3/2 sqrt(x)
    assert dem.damping_factor(restitution, 1.5, 0.25) == pytest.approx(factor, rel=1e-2)


def test_a_viscoelastic_contact_returns_more_of_a_slow_impact():
    law = dem.HertzViscoelastic(
        normal_stiffness=1e8,
        tangential_stiffness=1e8,
        normal_damping=2e6,
        tangential_damping=1e6,
        friction=0.0,
    )
    loss = [1 - meet(law, speed) for speed in (1e-5, 3e-4, 1e-2)]
    assert 0 < loss[0] < loss[1] < loss[2] < 1
    # Ramirez et al. (1999) doi:10.1103/PhysRevE.60.4465: 1 - e grows with speed^(1/5) at first.
    assert loss[1] / loss[0] == pytest.approx(30**0.2, rel=0.03)


def oblique(angle, *, speed=3.9, spin=0.0):
    """Chung & Ooi (2011) test 4: velocity and spin after 5 mm aluminium oxide hits a wall."""
    law = dem.HertzMindlin(
        youngs_modulus=3.8e11,
        poisson_ratio=0.23,
        other_youngs_modulus=np.inf,
        restitution=0.98,
        friction=0.092,
    )
    velocity = speed * np.array([np.sin(angle), 0, -np.cos(angle)])
    solids = scene(
        [0, 0, 0.0025 + 1e-6],
        velocity,
        [0, spin, 0],
        radius=0.0025,
        density=4000,
        wall_law=law,
        walls=[Flat()],
    ).solids()
    after(solids, 5e-9)
    return solids.velocity[0], solids.spin[0]


@pytest.mark.parametrize(
    ("degrees", "tangential", "spin"),
    [
        (40, 0.7829, 544.2),
        (50, 0.8471, 456.7),
        (60, 0.8948, 355.2),
        (70, 0.9337, 243.0),
        (80, 0.9679, 123.4),
    ],
)
def test_a_sliding_rebound_is_that_of_chung_and_ooi_test_4(degrees, tangential, spin):
    velocity, w = oblique(np.radians(degrees))
    incoming = 3.9 * np.sin(np.radians(degrees))
    assert velocity[0] / incoming == pytest.approx(tangential, abs=1e-3)
    assert w[1] == pytest.approx(spin, rel=5e-3)
    np.testing.assert_allclose([velocity[1], w[0], w[2]], 0, atol=1e-9)


@pytest.mark.parametrize(
    ("degrees", "tangential", "spin"),
    [(5, 0.9481, 19.3), (10, 0.6870, 213.0), (20, 0.6161, 510.6), (30, 0.6837, 616.5)],
)
def test_a_sticking_rebound_is_near_that_of_chung_and_ooi_test_4(degrees, tangential, spin):
    # digitised from curves of a law with micro-slip: 3 % and more at small angles
    velocity, w = oblique(np.radians(degrees))
    incoming = 3.9 * np.sin(np.radians(degrees))
    assert velocity[0] / incoming == pytest.approx(tangential, abs=0.06)
    assert w[1] == pytest.approx(spin, rel=0.1, abs=40)


def test_spin_alone_is_turned_into_travel():
    """Gross sliding: v = mu (1 + e) v_n, and the impulse takes 5/2 of it off r w."""
    velocity, spin = oblique(0.0, spin=20_000.0)
    gained = 0.092 * 1.98 * 3.9
    assert velocity[0] == pytest.approx(gained, rel=3e-3)
    assert 20_000 - spin[1] == pytest.approx(2.5 * gained / 0.0025, rel=3e-3)


@pytest.mark.parametrize(
    ("law_with", "restitution", "gain"),
    [
        (hertz, 0.5, 0.0),
        (hertz, 0.95, 0.0),
        (linear, 0.95, 0.0),
        (linear, 1.0, 0.0),
        # Without damping, a tangential spring that stiffens under growing overlap gains a little;
        # friction 0.5 bounds it.
        (hertz, 1.0, 2e-3),
    ],
)
def test_no_impact_gains_energy(law_with, restitution, gain):
    for friction in (0.1, 0.3, 0.5):
        law = law_with(restitution, friction)
        for angle in np.radians([0, 5, 15, 30, 50, 75]):
            for spin in (-100.0, 0.0, 30.0):
                solids = scene(
                    [0, 0, 1.0001 * RADIUS],
                    [np.sin(angle), 0, -np.cos(angle)],
                    [0, spin, 10.0],
                    wall_law=law,
                    walls=[Flat()],
                ).solids()
                before = solids.kinetic_energy
                assert after(solids, step(1.0)).kinetic_energy <= before * (1 + gain + 1e-6)
