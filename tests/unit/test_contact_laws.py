"""Contact laws against theory of elasticity, and what each promises of its own."""

import numpy as np
import pytest

from mpsdem._core import dem
from slow_dem import HERTZ, LAWS, LINEAR, LINEAR_RESTITUTION, VISCOELASTIC, Flat, scene

ZERO, X, Y = np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
CONTACT = {
    "normal": X,
    "relative_velocity": ZERO,
    "overlap": 1e-4,
    "reduced_radius": 5e-3,
    "reduced_mass": 5e-3,
    "spring": ZERO,
    "dt": 0.0,
}
STEEL = {"youngs_modulus": 2e11, "poisson_ratio": 0.3}
RUBBER = {"youngs_modulus": 1e7, "poisson_ratio": 0.49}
ALUMINIUM = {"youngs_modulus": 7e10, "poisson_ratio": 0.3}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)


def normal_force(law, **changes):
    return law.contact_force(**(CONTACT | changes))[0][0]


def hertz(first, second=None, *, restitution=1.0, friction=0.3):
    other = {f"other_{name}": value for name, value in (second or first).items()}
    return dem.HertzMindlin(**first, **other, restitution=restitution, friction=friction)


def impact(law, *, radius, density, speed, walls=(), steps=400, duration):
    """Largest overlap [m] and force [N], time from first touch to parting [s] of an impact.

    Two like spheres at plus and minus the speed, or one at a wall in x = 0.
    """
    position = [[radius, 0, 0]] if walls else [[radius, 0, 0], [-radius, 0, 0]]
    velocity = [[-speed, 0, 0], [speed, 0, 0]][: len(position)]
    laws = {"pair_law": law, "wall_law": law}
    solids = scene(
        position, velocity, radius=radius, density=density, walls=list(walls), **laws
    ).solids()
    dt, overlap, force, time = duration / steps, 0.0, 0.0, 0.0
    for _ in range(2 * steps):
        solids.advance(dt, 1)
        touching = solids.contacts()
        if len(touching["overlap"]) == 0:
            break
        time += dt
        overlap = max(overlap, touching["overlap"][0])
        force = max(force, np.linalg.norm(touching["force"][0]))
    return overlap, force, time


def test_two_glass_spheres_meet_as_in_chung_and_ooi_test_1():
    law = hertz({"youngs_modulus": 4.8e10, "poisson_ratio": 0.2})
    overlap, force, time = impact(law, radius=0.01, density=2800, speed=10, duration=40.34e-6)
    assert overlap == pytest.approx(274.11e-6, rel=2e-3)
    assert force == pytest.approx(10696.9, rel=2e-3)
    assert time == pytest.approx(40.34e-6, rel=1e-2)


def test_aluminium_meets_a_rigid_wall_as_in_chung_and_ooi_test_2():
    law = hertz(ALUMINIUM, ALUMINIUM | {"youngs_modulus": np.inf})
    overlap, force, time = impact(
        law,
        radius=0.1,
        density=2699,
        speed=0.2,
        walls=[Flat(normal=(1, 0, 0))],
        duration=731.66e-6,
    )
    assert overlap == pytest.approx(49.717e-6, rel=2e-3)
    assert force == pytest.approx(11369.9, rel=2e-3)
    assert time == pytest.approx(731.66e-6, rel=1e-2)


def test_a_linear_impact_lasts_half_a_period_of_its_spring():
    law = dem.LinearSpring(
        normal_stiffness=1e3,
        tangential_stiffness=1e3,
        normal_damping=0,
        tangential_damping=0,
        friction=0,
    )
    mass = 2500 * 4 / 3 * np.pi * 0.01**3
    half_period = np.pi * np.sqrt(mass / 2 / 1e3)
    overlap, force, time = impact(law, radius=0.01, density=2500, speed=0.1, duration=half_period)
    assert time == pytest.approx(half_period, rel=5e-3)
    assert overlap == pytest.approx(2 * 0.1 * half_period / np.pi, rel=1e-4)
    assert force == pytest.approx(1e3 * overlap, rel=1e-4)


def test_a_hertz_contact_hardens_with_the_power_three_halves():
    for law in (HERTZ, VISCOELASTIC):
        ratio = normal_force(law, overlap=4e-4) / normal_force(law, overlap=1e-4)
        assert ratio == pytest.approx(8, rel=1e-12)


def test_a_larger_radius_hardens_a_hertz_contact_but_not_a_linear_one():
    wide = {"reduced_radius": 4 * CONTACT["reduced_radius"]}
    for law in (HERTZ, VISCOELASTIC):
        assert normal_force(law, **wide) == pytest.approx(2 * normal_force(law), rel=1e-12)
    assert normal_force(LINEAR, **wide) == normal_force(LINEAR)


@pytest.mark.parametrize("poisson_ratio", [0.0, 0.2, 0.3, 0.5])
def test_tangential_over_normal_stiffness_is_mindlins_ratio(poisson_ratio):
    # Mindlin (1949): 2 (1 - nu) / (2 - nu) for like bodies, at any overlap.
    law = hertz({"youngs_modulus": 1e7, "poisson_ratio": poisson_ratio}, friction=10.0)
    shift = 1e-9
    held = -law.contact_force(**(CONTACT | {"spring": shift * Y}))[1][1] / shift
    pressed = (normal_force(law, overlap=1e-4 + shift) - normal_force(law)) / shift
    assert held / pressed == pytest.approx(2 * (1 - poisson_ratio) / (2 - poisson_ratio), rel=1e-4)


def test_two_materials_touch_alike_from_either_side():
    force = hertz(STEEL, RUBBER).contact_force(**(CONTACT | {"spring": 1e-6 * Y}))
    other = hertz(RUBBER, STEEL).contact_force(**(CONTACT | {"spring": 1e-6 * Y}))
    for a, b in zip(force, other, strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-12)


def test_a_contact_is_softer_than_its_softer_body_would_make_it_on_a_rigid_one():
    rigid = STEEL | {"youngs_modulus": np.inf}
    on_rigid = normal_force(hertz(RUBBER, rigid))
    assert normal_force(hertz(RUBBER, STEEL)) == pytest.approx(on_rigid, rel=1e-3)
    assert normal_force(hertz(RUBBER, STEEL)) < on_rigid
    assert normal_force(hertz(RUBBER)) == pytest.approx(on_rigid / 2, rel=1e-12)


@pytest.mark.parametrize("law", [HERTZ, LINEAR, LINEAR_RESTITUTION])
def test_parting_bodies_do_not_pull(law):
    assert normal_force(law, relative_velocity=1e3 * X) == 0
    assert normal_force(law, relative_velocity=-0.1 * X) > normal_force(law) > 0


def test_a_viscoelastic_contact_pulls_when_it_parts_fast():
    assert normal_force(VISCOELASTIC, relative_velocity=1e3 * X) < 0


@every_law
def test_a_sliding_contact_resists_with_friction_times_the_normal_force(law):
    normal, tangential, _ = law.contact_force(
        **(CONTACT | {"relative_velocity": 5.0 * Y, "dt": 1e-2})
    )
    friction = {HERTZ: 0.4, LINEAR: 0.3, LINEAR_RESTITUTION: 0.5, VISCOELASTIC: 0.4}[law]
    np.testing.assert_allclose(tangential, -friction * normal[0] * Y, rtol=1e-12)


@pytest.mark.parametrize("law", [HERTZ, LINEAR, LINEAR_RESTITUTION])
def test_after_sliding_the_spring_holds_just_what_friction_can(law):
    """Released from a slide, the contact pushes as friction did: it kept no damping."""
    *_, spring = law.contact_force(**(CONTACT | {"relative_velocity": 5.0 * Y, "dt": 1e-2}))
    released = law.contact_force(**(CONTACT | {"spring": spring}))[1]
    sliding = law.contact_force(**(CONTACT | {"spring": 1e3 * spring}))[1]
    np.testing.assert_allclose(released, sliding, rtol=1e-9)


@every_law
def test_a_spring_gathers_the_slip(law):
    slip = 1e-3 * Y  # [m/s] too slow to slide in a hundred steps
    spring = ZERO
    for _ in range(100):
        *_, spring = law.contact_force(
            **(CONTACT | {"relative_velocity": slip, "spring": spring, "dt": 1e-5})
        )
    np.testing.assert_allclose(spring, slip * 1e-3, rtol=1e-12)


BAD = [
    (dem.HertzMindlin, "youngs_modulus", [0.0, -1.0, np.nan, np.inf]),
    (dem.HertzMindlin, "poisson_ratio", [-1.0, 0.51, np.nan]),
    (dem.HertzMindlin, "restitution", [0.0, 1.01, -0.5, np.nan]),
    (dem.HertzMindlin, "friction", [-0.1, np.nan]),
    (dem.HertzMindlin, "other_youngs_modulus", [0.0, np.nan]),
    (dem.HertzMindlin, "other_poisson_ratio", [0.6, np.nan]),
    (dem.LinearSpring, "normal_stiffness", [0.0, -1.0, np.nan]),
    (dem.LinearSpring, "tangential_stiffness", [-1.0, np.nan]),
    (dem.LinearSpring, "normal_damping", [-1.0, np.nan]),
    (dem.LinearSpring, "tangential_damping", [-1.0, np.nan]),
    (dem.LinearSpring, "friction", [-1.0, np.nan]),
    (dem.LinearSpring.with_restitution, "restitution", [0.0, 1.01, np.nan]),
    (dem.HertzViscoelastic, "normal_stiffness", [0.0, -1.0, np.nan]),
    (dem.HertzViscoelastic, "tangential_stiffness", [0.0, -1.0, np.nan]),
    (dem.HertzViscoelastic, "normal_damping", [-1.0, np.nan]),
    (dem.HertzViscoelastic, "tangential_damping", [-1.0, np.nan]),
    (dem.HertzViscoelastic, "friction", [-1.0, np.nan]),
]
SPRING = {"normal_stiffness": 1e3, "tangential_stiffness": 1e3}
DAMPER = {"normal_damping": 0.1, "tangential_damping": 0.1}
GOOD = {
    dem.HertzMindlin: {**STEEL, "restitution": 0.9, "friction": 0.1},
    dem.LinearSpring: {**SPRING, **DAMPER, "friction": 0.1},
    dem.LinearSpring.with_restitution: {**SPRING, "restitution": 0.9, "friction": 0.1},
    dem.HertzViscoelastic: {**SPRING, **DAMPER, "friction": 0.1},
}


@pytest.mark.parametrize(
    ("law", "name", "value"),
    [(law, name, value) for law, name, values in BAD for value in values],
)
def test_a_bad_parameter_is_refused_by_its_name(law, name, value):
    with pytest.raises(ValueError, match=name.removeprefix("other_")):
        law(**(GOOD[law] | {name: value}))


@pytest.mark.parametrize("law", [dem.LinearSpring, dem.HertzViscoelastic])
@pytest.mark.parametrize("name", SPRING | DAMPER)
def test_infinite_stiffness_and_damping_are_refused(law, name):
    with pytest.raises(ValueError, match="stiffness and damping must be finite"):
        law(**(GOOD[law] | {name: np.inf}))
