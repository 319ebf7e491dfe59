"""Models of head loss: what they must obey whatever their constants, and their limits."""

import itertools
import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mpsdem.analysis.head_loss import (
    DHLLDV,
    DURAND_CONDOLIOS,
    MODELS,
    NEWITT,
    WILSON_STRATIFIED,
    Conveying,
    dhlldv,
    hydraulic_gradient,
    inclined_gradient,
    newitt,
    wilson,
)

GLASS = Conveying(
    pipe_diameter=0.1,
    bulk_velocity=3.0,
    diameter=5e-3,
    density=2500.0,
    liquid_density=998.2,
    kinematic_viscosity=1.004e-6,
    concentration=0.05,
)
EACH_MODEL = pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)


def head(model, flow):
    return hydraulic_gradient(
        model.gradient(flow), liquid_density=flow.liquid_density, gravity=flow.gravity
    )


@EACH_MODEL
def test_without_solids_the_loss_is_that_of_the_liquid(model):
    clear = replace(GLASS, concentration=0.0)
    assert model.gradient(clear) == pytest.approx(clear.clear_gradient, rel=0.02)


@EACH_MODEL
def test_solids_cost_something_and_more_cost_more(model):
    losses = [model.gradient(replace(GLASS, concentration=c)) for c in (0.0, 0.02, 0.05, 0.1)]
    assert losses == sorted(losses)
    assert losses[-1] > 1.2 * losses[0]


@pytest.mark.parametrize("model", [DURAND_CONDOLIOS, NEWITT], ids=lambda model: model.name)
@given(
    metre=st.floats(0.1, 10),
    kilogram=st.floats(0.1, 10),
    second=st.floats(0.1, 10),
    velocity=st.floats(1.0, 12.0),
)
def test_metres_of_liquid_per_metre_do_not_depend_on_the_units(
    model, metre, kilogram, second, velocity
):
    flow = replace(GLASS, bulk_velocity=velocity, settling_drag=0.44)
    scaled = replace(
        flow,
        pipe_diameter=flow.pipe_diameter * metre,
        diameter=flow.diameter * metre,
        bulk_velocity=velocity * metre / second,
        density=flow.density * kilogram / metre**3,
        liquid_density=flow.liquid_density * kilogram / metre**3,
        kinematic_viscosity=flow.kinematic_viscosity * metre**2 / second,
        gravity=flow.gravity * metre / second**2,
    )
    assert head(model, scaled) == pytest.approx(head(model, flow), rel=1e-9)


def test_a_sliding_bed_costs_its_friction_on_the_wall():
    """2 m/s: of 5 % of the bore, 0.415 of the weight of the solids in water."""
    flow = replace(GLASS, bulk_velocity=2.0)
    assert dhlldv.regime(flow) == "sliding bed"
    rubbing = 0.415 * 0.05 * (2500.0 - 998.2) * 9.807
    assert DHLLDV.gradient(flow) - dhlldv.clear_gradient(flow) == pytest.approx(rubbing)


@pytest.mark.parametrize(
    ("velocity", "diameter", "expected"),
    [
        (0.8, 5e-3, "fixed bed"),
        (2.0, 5e-3, "sliding bed"),
        (5.0, 5e-3, "heterogeneous"),
        (4.0, 1e-4, "homogeneous"),
    ],
)
def test_a_faster_flow_and_finer_solids_go_through_the_regimes(velocity, diameter, expected):
    flow = replace(GLASS, bulk_velocity=velocity, diameter=diameter)
    assert dhlldv.regime(flow) == expected


@pytest.mark.parametrize("diameter", [2e-4, 1e-3, 5e-3])
def test_the_framework_has_no_jump_between_its_regimes(diameter):
    velocities = [0.3 * 1.002**k for k in range(1600)]
    losses = [
        DHLLDV.gradient(replace(GLASS, bulk_velocity=velocity, diameter=diameter))
        for velocity in velocities
    ]
    steps = [abs(b / a - 1) for a, b in itertools.pairwise(losses)]
    assert max(steps) < 0.01  # a friction factor of 2 goes as the velocity to the 1.8th


def test_at_the_limit_deposit_velocity_coarse_solids_leave_the_sliding_bed():
    fine = replace(GLASS, diameter=1e-3, density=2650.0)
    limit = dhlldv.limit_deposit_velocity(fine)
    assert dhlldv.regime(replace(fine, bulk_velocity=1.05 * limit)) == "heterogeneous"


def test_newitts_regimes_meet_where_one_takes_over():
    flow = replace(GLASS, diameter=1e-3)
    limit = newitt.bed_limit(flow)
    assert limit < newitt.homogeneous_limit(flow)
    slow, fast = (replace(flow, bulk_velocity=limit * share) for share in (0.999, 1.001))
    assert newitt.newitt(slow) == newitt.newitt_bed(slow)
    assert newitt.newitt(fast) == newitt.newitt_heterogeneous(fast)
    assert newitt.newitt(slow) == pytest.approx(newitt.newitt(fast), rel=0.01)
    at = replace(flow, bulk_velocity=newitt.homogeneous_limit(flow))
    carried = newitt.newitt_heterogeneous(at) - at.clear_gradient
    assert newitt.newitt_homogeneous(at) - at.clear_gradient == pytest.approx(carried, rel=0.02)
    beyond = replace(flow, bulk_velocity=1.01 * newitt.homogeneous_limit(flow))
    assert newitt.newitt(beyond) == newitt.newitt_homogeneous(beyond)


def test_a_delivered_concentration_costs_least_at_some_velocity():
    """The curve by which pipes are sized: dearer below, as solids pile up, and above."""
    losses = [
        DURAND_CONDOLIOS.gradient(replace(GLASS, bulk_velocity=velocity, concentration=0.1))
        for velocity in (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0)
    ]
    least = losses.index(min(losses))
    assert 0 < least < len(losses) - 1


def test_a_bed_lies_still_up_to_the_highest_velocity_at_some_concentration_between():
    largest = wilson.largest_stationary_limit(GLASS)
    limits = [
        wilson.stationary_limit(replace(GLASS, concentration=0.6 * k / 100)) for k in range(101)
    ]
    assert limits[0] == limits[-1] == 0
    assert max(limits) == pytest.approx(largest, rel=1e-3)


@pytest.mark.parametrize(("diameter", "bore"), [(5e-3, 0.1), (2e-4, 0.5)])
def test_both_branches_of_wilsons_fit_reach_the_same_top(diameter, bore):
    flow = replace(GLASS, diameter=diameter, pipe_diameter=bore)
    limits = [
        wilson.stationary_limit(replace(flow, concentration=0.6 * k / 1000)) for k in range(1000)
    ]
    assert max(limits) == pytest.approx(wilson.largest_stationary_limit(flow), rel=1e-3)


def test_rising_solids_are_lifted_and_press_less_on_the_wall():
    level, clear, weight = 900.0, 600.0, 700.0

    def at(degrees):
        return inclined_gradient(
            level, clear=clear, bed_weight=weight, inclination=math.radians(degrees)
        )

    assert at(0) == level
    assert at(90) == pytest.approx(clear + weight)
    assert at(-90) == pytest.approx(clear - weight)
    assert at(30) > level > at(-30)


@EACH_MODEL
def test_a_model_holds_within_its_range_and_says_why_not_outside(model):
    inside = replace(GLASS, concentration=0.1)
    assert model.outside(inside) == []
    far = replace(inside, pipe_diameter=4.0, kinematic_viscosity=1e-4)
    complaints = model.outside(far)
    assert complaints
    assert all(": " in complaint for complaint in complaints)


def test_a_complaint_names_quantity_value_unit_and_bound():
    assert WILSON_STRATIFIED.outside(replace(GLASS, diameter=1e-3)) == [
        "size of the solids over the bore is 0.01, below 0.018: "
        "the flow holds smaller ones in suspension"
    ]
    assert NEWITT.outside(replace(GLASS, pipe_diameter=0.2)) == [
        "bore is 0.2 m, above 0.15 m: measured at one inch, compared with others' up to six"
    ]


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("bulk_velocity", 0.0),
        ("pipe_diameter", -1.0),
        ("density", 998.2),
        ("concentration", 1.0),
        ("settling_drag", 0.0),
    ],
)
def test_what_makes_no_sense_is_refused_by_its_name(field, value):
    with pytest.raises(ValueError, match=rf"{field} = {value}.*must"):
        replace(GLASS, **{field: value})


def test_the_framework_knows_no_more_solids_than_a_bed_has():
    with pytest.raises(ValueError, match=r"concentration = 0.6: must be < 0.6"):
        dhlldv.head_loss(replace(GLASS, concentration=0.6))
