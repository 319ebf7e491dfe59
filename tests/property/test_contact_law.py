"""What any contact law must obey, whatever its formula."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mpsdem._core import dem
from slow_dem import LAWS, rotation

FRICTION = {"hertz": 0.4, "linear": 0.3, "linear_restitution": 0.5, "viscoelastic": 0.4}
# Dimension of each parameter in powers of metre, kilogram and second.
PARAMETERS = {
    dem.HertzMindlin: {
        "youngs_modulus": (1e6, (-1, 1, -2)),
        "poisson_ratio": (0.2, (0, 0, 0)),
        "restitution": (0.7, (0, 0, 0)),
        "friction": (0.4, (0, 0, 0)),
    },
    dem.LinearSpring: {
        "normal_stiffness": (1e3, (0, 1, -2)),
        "tangential_stiffness": (7e2, (0, 1, -2)),
        "normal_damping": (0.3, (0, 1, -1)),
        "tangential_damping": (0.2, (0, 1, -1)),
        "friction": (0.3, (0, 0, 0)),
    },
    dem.LinearSpring.with_restitution: {
        "normal_stiffness": (1e3, (0, 1, -2)),
        "tangential_stiffness": (7e2, (0, 1, -2)),
        "restitution": (0.8, (0, 0, 0)),
        "friction": (0.5, (0, 0, 0)),
    },
    dem.HertzViscoelastic: {
        "normal_stiffness": (7e5, (-1, 1, -2)),
        "tangential_stiffness": (6e5, (-1, 1, -2)),
        "normal_damping": (1e4, (-1, 0, -1)),
        "tangential_damping": (5e3, (-1, 0, -1)),
        "friction": (0.4, (0, 0, 0)),
    },
}
CONTACT = {
    "normal": (0, 0, 0),
    "relative_velocity": (1, 0, -1),
    "overlap": (1, 0, 0),
    "reduced_radius": (1, 0, 0),
    "reduced_mass": (0, 1, 0),
    "spring": (1, 0, 0),
    "dt": (0, 0, 1),
}
FORCE = (1, 1, -2)
every_law = pytest.mark.parametrize("name", LAWS)


@st.composite
def contacts(draw):
    """A contact in any direction: stuck or sliding, approaching or parting."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    return {
        "normal": rotation(rng)[0],
        "relative_velocity": rng.normal(size=3) * 10 ** rng.uniform(-4, 1),
        "overlap": 10 ** rng.uniform(-7, -3),
        "reduced_radius": 10 ** rng.uniform(-3, -1),
        "reduced_mass": 10 ** rng.uniform(-5, 1),
        "spring": rng.normal(size=3) * 10 ** rng.uniform(-7, -3),
        "dt": 10 ** rng.uniform(-7, -4),
    }


@every_law
@given(contact=contacts())
def test_friction_stays_in_the_coulomb_cone(name, contact):
    normal, tangential, _ = LAWS[name].contact_force(**contact)
    limit = FRICTION[name] * np.linalg.norm(normal)
    assert np.linalg.norm(tangential) <= limit * (1 + 1e-12)


@every_law
@given(contact=contacts())
def test_force_and_spring_keep_to_their_directions(name, contact):
    n = contact["normal"]
    normal, tangential, spring = LAWS[name].contact_force(**contact)
    assert np.linalg.norm(np.cross(normal, n)) <= 1e-14 * np.linalg.norm(normal)
    for along_the_wall in (tangential, spring):
        assert abs(along_the_wall @ n) <= 1e-12 * np.linalg.norm(along_the_wall) + 1e-300


@every_law
@given(contact=contacts())
def test_the_force_is_opposite_seen_from_the_other_body(name, contact):
    flipped = contact | {key: -contact[key] for key in ("normal", "relative_velocity", "spring")}
    for one, other in zip(
        LAWS[name].contact_force(**contact), LAWS[name].contact_force(**flipped), strict=True
    ):
        np.testing.assert_array_equal(one, -other)


@every_law
@given(contact=contacts(), seed=st.integers(0, 2**32 - 1))
def test_the_force_turns_with_the_contact(name, contact, seed):
    turn = rotation(np.random.default_rng(seed))
    turned = contact | {
        key: turn @ contact[key] for key in ("normal", "relative_velocity", "spring")
    }
    before = LAWS[name].contact_force(**contact)
    after = LAWS[name].contact_force(**turned)
    size = np.linalg.norm(before[0]) + np.linalg.norm(before[1])
    np.testing.assert_allclose(after[0], turn @ before[0], rtol=1e-9, atol=1e-9 * size)
    np.testing.assert_allclose(after[1], turn @ before[1], rtol=1e-9, atol=1e-9 * size)


@pytest.mark.parametrize("law", PARAMETERS, ids=LAWS)
@settings(max_examples=25)
@given(
    contact=contacts(),
    metre=st.floats(0.1, 10),
    kilogram=st.floats(0.1, 10),
    second=st.floats(0.1, 10),
)
def test_the_force_does_not_depend_on_the_units(law, contact, metre, kilogram, second):
    def in_units(value, dimension):
        length, mass, time = dimension
        return value * metre**length * kilogram**mass * second**time

    parameters = PARAMETERS[law]
    here = law(**{name: value for name, (value, _) in parameters.items()})
    there = law(**{name: in_units(*parameter) for name, parameter in parameters.items()})
    in_other_units = {name: in_units(contact[name], CONTACT[name]) for name in CONTACT}
    force, force_there = here.contact_force(**contact), there.contact_force(**in_other_units)
    size = np.linalg.norm(force[0]) + np.linalg.norm(force[1])
    for one, other in zip(force[:2], force_there[:2], strict=True):
        np.testing.assert_allclose(
            other, in_units(one, FORCE), rtol=1e-9, atol=1e-9 * in_units(size, FORCE)
        )


@every_law
@given(contact=contacts())
def test_damping_and_friction_never_push_a_body_on(name, contact):
    """Without stored displacement, all but the elastic normal force takes power from the motion."""
    fresh = contact | {"spring": np.zeros(3), "dt": 0.0}
    still = fresh | {"relative_velocity": np.zeros(3)}
    normal, tangential, _ = LAWS[name].contact_force(**fresh)
    elastic = LAWS[name].contact_force(**still)[0]
    velocity = contact["relative_velocity"]
    assert tangential @ velocity <= 0
    assert (normal - elastic) @ velocity <= 1e-12 * abs(normal @ velocity)
