"""From a case and its plan to the state at time 0 and the stages that move it."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from mpsdem import case as scene
from mpsdem._core import coupling, dem, geometry
from mpsdem.case import Case, Material, Solids
from mpsdem.contacts import Impact
from mpsdem.geometry import place_solids
from mpsdem.liquids import bending, build_liquid
from mpsdem.plan import (
    DRAG_LAWS,
    Plan,
    absurd_speed,
    gravity,
    impacts,
    lubrication,
    materials,
    mean_diameter,
    spring_stiffness,
)
from mpsdem.results import ResultsWriter
from mpsdem.stages.record import Record
from mpsdem.stages.state import Stage, State
from mpsdem.stages.steps import (
    AdvanceLiquid,
    AdvanceSolids,
    BeginExchange,
    DragForce,
    ExchangeMomentum,
    FindVoidFraction,
    HoldSolids,
    SampleLiquid,
)

ADDED_MASS = 0.5  # [-] of a sphere, over the mass of the liquid that it displaces

ContactLaw = dem.LinearSpring | dem.HertzMindlin | dem.HertzViscoelastic


def build_state(case: Case, plan: Plan) -> State:
    """The state at time 0: solids at their places, at rest or with their first velocity."""
    liquid = build_liquid(case, plan)
    axis = case.axis if case.motion.moves_walls else None
    if case.solids is None:
        return State(liquid=liquid, axis=axis)
    solids, speed = case.solids, plan.impact_speed
    placement = place_solids(case)
    count = len(placement.radius)
    pair_law, wall_law = _contact_laws(case, speed)
    position, velocity = placement.position, placement.velocity
    wall: geometry.Cylinder | geometry.BentCylinder
    if axis is None:
        wall = geometry.Cylinder(radius=case.pipe.radius, velocity=np.zeros(3))
    else:
        velocity = axis.to_laboratory(velocity, position[:, 0], 0.0)
        position = axis.place(position, 0.0)
        wall = geometry.BentCylinder(radius=case.pipe.radius)
        wall.bend(bending(axis, 0.0, 1.0), 0.0)
    population = dem.Solids(
        position=position,
        velocity=velocity,
        spin=placement.spin,
        radius=placement.radius,
        density=np.full(count, solids.density),
        pair_law=pair_law,
        wall_law=wall_law,
        pair_rolling_friction=solids.rolling_friction,
        wall_rolling_friction=solids.at_wall.rolling_friction,
        walls=[wall],
        period=case.pipe.length,
        threads=plan.threads,
        lubrication=lubrication(case),
    )
    exchange = None
    if plan.two_way and case.liquid is not None:
        exchange = coupling.Exchange(
            smoothing_radius=plan.smoothing_radius,
            liquid_density=case.liquid.density,
            threads=plan.threads,
        )
    return State(
        population=population,
        liquid=liquid,
        exchange=exchange,
        axis=axis,
        void_fraction=np.ones(count),  # where no stage looks for neighbors, a solid is alone
    )


def build_stages(case: Case, plan: Plan, writer: ResultsWriter) -> Iterator[Stage]:
    """Make the stages that the plan names, in its order."""
    pipe = case.pipe
    for planned in plan.stages:
        match planned.name, case.solids, case.liquid:
            case "AdvanceLiquid", solids, _:
                held = solids is not None and solids.held
                yield AdvanceLiquid(turns=plan.turns_per_liquid_step, held=held)
            case "SampleLiquid", _, _:
                turns = plan.turns_per_liquid_step
                if plan.two_way:
                    yield BeginExchange(turns=turns, pipe_radius=pipe.radius)
                else:
                    yield SampleLiquid()
            case "FindVoidFraction", _, _:
                average = coupling.VoidFraction(
                    pipe_radius=pipe.radius,
                    period=pipe.length,
                    smoothing_radius=plan.smoothing_radius,
                )
                yield FindVoidFraction(average=average, threads=plan.threads)
            case "DragForce", Solids() as solids, scene.Liquid() as liquid:
                yield DragForce(
                    law=DRAG_LAWS[solids.drag](),
                    solid_density=np.full(case.solids_count, solids.density),
                    liquid_density=liquid.density,
                    kinematic_viscosity=liquid.kinematic_viscosity,
                )
            case "AdvanceSolids", Solids() as solids, liquid:
                displaced = liquid.density / solids.density if liquid else 0.0
                yield AdvanceSolids(
                    gravity=gravity(case),
                    lightness=1 - displaced,
                    motion=case.motion,
                    added_mass=ADDED_MASS * displaced if plan.added_mass else 0.0,
                    substeps=plan.clock.substeps,
                    dry=liquid is None,
                    pipe=pipe,
                    bulk_velocity=liquid.bulk_velocity if liquid else 0.0,
                )
            case "HoldSolids", _, _:
                yield HoldSolids()
            case "ExchangeMomentum", Solids() as solids, _:
                yield ExchangeMomentum(
                    turns=plan.turns_per_liquid_step,
                    held=solids.held,
                    pipe_radius=pipe.radius,
                )
            case "Record", _, _:
                yield Record(
                    writer=writer,
                    steps_per_frame=plan.clock.steps_per_frame,
                    absurd_speed=absurd_speed(case),
                    pipe=pipe,
                    motion=case.motion,
                    gravity=gravity(case),
                    solids_density=case.solids.density if case.solids else 0.0,
                    liquid_density=case.liquid.density if case.liquid else 0.0,
                )


def _contact_laws(case: Case, speed: float) -> tuple[ContactLaw, ContactLaw]:
    """Law between solids, and at the wall."""
    assert case.solids is not None
    solid, wall = materials(case)
    pair, at_wall = impacts(case, diameter=mean_diameter(case.solids), speed=speed)
    match case.solids.contact:
        case "hertz_mindlin":
            return _hertz_mindlin(solid, solid), _hertz_mindlin(solid, wall)
        case "hertz_viscoelastic":
            return _hertz_viscoelastic(solid, pair), _hertz_viscoelastic(wall, at_wall)
        case "linear_spring":
            between, against = spring_stiffness(case, speed)
            return (
                _linear_spring(case, solid, between, pair.stiffness.ratio),
                _linear_spring(case, wall, against, at_wall.stiffness.ratio),
            )


def _hertz_mindlin(solid: Material, other: Material) -> dem.HertzMindlin:
    """Contact of a solid with another body, which says how they rebound and rub."""
    return dem.HertzMindlin(
        youngs_modulus=solid.youngs_modulus,
        poisson_ratio=solid.poisson_ratio,
        other_youngs_modulus=other.youngs_modulus,
        other_poisson_ratio=other.poisson_ratio,
        restitution=other.restitution,
        friction=other.friction,
    )


def _linear_spring(
    case: Case, other: Material, normal_stiffness: float, ratio: float
) -> dem.LinearSpring:
    solids = case.solids
    assert solids is not None
    tangential_stiffness = ratio * normal_stiffness
    if solids.tangential_stiffness is not None:
        tangential_stiffness = case.fidelity.stiffness_factor * solids.tangential_stiffness
    if solids.normal_damping is None:
        return dem.LinearSpring.with_restitution(
            normal_stiffness=normal_stiffness,
            tangential_stiffness=tangential_stiffness,
            restitution=other.restitution,
            friction=other.friction,
        )
    damping = solids.normal_damping
    return dem.LinearSpring(
        normal_stiffness=normal_stiffness,
        tangential_stiffness=tangential_stiffness,
        normal_damping=damping,
        tangential_damping=(
            damping if solids.tangential_damping is None else solids.tangential_damping
        ),
        friction=other.friction,
    )


def _hertz_viscoelastic(other: Material, impact: Impact) -> dem.HertzViscoelastic:
    """Stiffness of Hertz and Mindlin; damping that returns the restitution at the impact's speed.

    The impact x'' + a x^(1/2) x' + x^(3/2) = 0 is scaled with the time t below, the speed, and
    their product as length.
    """
    normal = 4 / 3 * impact.stiffness.normal  # [Pa]
    root = math.sqrt(impact.reduced_radius * impact.speed)
    t = (impact.reduced_mass / (root * normal)) ** 0.4  # [s]
    damping = dem.damping_factor(other.restitution, 1.5, 0.5) / (root * t**1.5)  # [1/(m s)]
    return dem.HertzViscoelastic(
        normal_stiffness=normal,
        tangential_stiffness=8 * impact.stiffness.tangential,
        normal_damping=damping,
        tangential_damping=damping / 2,  # the usual share, Silbert et al. (2001)
        friction=other.friction,
    )
