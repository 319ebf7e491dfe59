"""A case survives its own file: what is written reads back as the same case."""

import tomllib

from hypothesis import given
from hypothesis import strategies as st

from mpsdem.case import Case


def number(smallest, largest):
    return st.floats(smallest, largest, allow_subnormal=False)


share = number(0.0, 1.0)
length = number(1e-3, 0.05)
vector = st.tuples(number(-1e3, 1e3), number(-1e3, 1e3), number(-1e3, 1e3))


def table(required, optional=None):
    return st.fixed_dictionaries(required, optional=optional or {})


diameter = st.one_of(
    length,
    table({"kind": st.just("uniform"), "smallest": st.just(1e-3), "largest": length}),
    table(
        {
            "kind": st.just("lognormal"),
            "median": length,
            "deviation": number(0.01, 2.0),
            "smallest": st.just(1e-3),
            "largest": st.just(0.05),
        }
    ),
    table(
        {
            "kind": st.just("sieve"),
            "diameters": st.tuples(length, length),
            "fractions": share.map(lambda first: (first, 1 - first)),
        }
    ),
)
block = table(
    {"kind": st.just("block"), "counts": st.tuples(*[st.integers(1, 9)] * 3)},
    {"count": st.just(1), "at": share, "gap": number(0.0, 2.0), "velocity": vector},
)
stretch = table(
    {"kind": st.just("random")},
    {"start": number(0, 0.4), "end": number(0.6, 1), "velocity": vector},
)
listed = st.integers(1, 4).flatmap(
    lambda n: table(
        {
            "kind": st.just("list"),
            "positions": st.tuples(*[st.tuples(number(0.0, 9.0), share, share)] * n),
        },
        {
            "velocities": st.tuples(*[vector] * n),
            "spins": st.tuples(*[vector] * n),
            "diameters": st.tuples(*[length] * n),
        },
    )
)
material = {
    "poisson_ratio": number(-0.9, 0.5),
    "restitution": number(0.1, 1.0),
    "friction": number(0.0, 5.0),
    "rolling_friction": number(0.0, 5.0),
}
common = {
    "diameter": diameter,
    "density": number(100.0, 2e4),
    "youngs_modulus": number(1e3, 1e12),
    "contact": st.just("linear_spring"),
}
options = {
    **material,
    "seed": st.integers(0, 2**63 - 1),
    "relax": st.booleans(),
    "wall": table({}, material | {"youngs_modulus": number(1e3, 1e12)}),
    "normal_stiffness": number(1e-3, 1e9),
    "tangential_damping": number(0.0, 1e3),
    "drag": st.sampled_from(["ergun_wen_yu", "schiller_naumann", "wen_yu", "di_felice"]),
}
solids = st.one_of(
    table(common | {"arrangement": block | listed}, options),
    table(common | {"count": st.integers(1, 20)}, options),
    table(common | {"volume_fraction": number(0.01, 0.12), "arrangement": stretch}, options),
)
liquid = table(
    {
        "density": number(1.0, 2e4),
        "kinematic_viscosity": number(1e-9, 1.0),
        "bulk_velocity": number(-20.0, 20.0),
    },
    {"model": st.sampled_from(["auto", "profile"])},
)
# Surrogates are no text: no file in UTF-8 can hold them.
title = st.text(st.characters(exclude_categories=["Cs"]))
cases = table(
    {
        "end_time": number(1.0, 1e6),
        "pipe": table(
            {"radius": number(0.1, 2.0), "length": number(10.0, 1e4)},
            {"inclination": number(-1.5, 1.5), "roughness": number(0.0, 0.01)},
        ),
        "liquid": liquid,
    },
    {
        "title": title,
        "gravity": number(0.0, 30.0),
        "solids": solids,
        "fidelity": table(
            {}, {"level": st.just("fine"), "solid_step": number(1e-9, 1.0), "threads": st.just(2)}
        ),
        "output": table({}, {"figures": st.booleans(), "times": st.just((0.0, 1.0))}),
    },
).map(lambda fields: Case(**fields))


@given(cases)
def test_a_case_written_and_read_is_the_same_case(case):
    assert Case.from_toml(case.to_toml()) == case


@given(cases)
def test_a_case_written_twice_is_the_same_text(case):
    text = case.to_toml()
    assert Case.from_toml(text).to_toml() == text


@given(cases)
def test_a_change_to_nothing_changes_nothing(case):
    assert case.with_() == case
    assert case.with_settings([]) == case
    assert case.differences(case.with_()) == []


@given(cases, number(1e-3, 1e3))
def test_a_change_is_the_only_difference(case, gravity):
    changed = case.with_(gravity=gravity)
    keys = [line.split(":")[0] for line in case.differences(changed)]
    assert keys == ([] if gravity == case.gravity else ["gravity"])


@given(cases)
def test_the_written_case_leaves_no_default_to_the_reader(case):
    """Only what is deliberately not given is absent from the file."""
    written = tomllib.loads(case.to_toml())
    for name, part in case.model_dump(exclude_none=True).items():
        keys = part.keys() if isinstance(part, dict) else ()
        assert written[name].keys() == keys if keys else name in written
