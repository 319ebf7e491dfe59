"""The plan: what a case requires, and why. Pure functions of a case; nothing is run."""

from mpsdem.plan.clock import Clock
from mpsdem.plan.limits import Limit, Step
from mpsdem.plan.plan import SOFT, Estimate, Number, Plan, Planned, make_plan
from mpsdem.plan.scales import (
    COMPUTED,
    DRAG_LAWS,
    DragLaw,
    clear_gradient,
    gravity,
    impact_speed,
    impacts,
    lubrication,
    materials,
    mean_diameter,
    outlet_length,
    pipe_profile,
    spring_stiffness,
    stirring_speed,
    terminal_velocity,
    turbulence,
)

__all__ = [
    "COMPUTED",
    "DRAG_LAWS",
    "SOFT",
    "Clock",
    "DragLaw",
    "Estimate",
    "Limit",
    "Number",
    "Plan",
    "Planned",
    "Step",
    "clear_gradient",
    "gravity",
    "impact_speed",
    "impacts",
    "lubrication",
    "make_plan",
    "materials",
    "mean_diameter",
    "outlet_length",
    "pipe_profile",
    "spring_stiffness",
    "stirring_speed",
    "terminal_velocity",
    "turbulence",
]
