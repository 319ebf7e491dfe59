"""From a case and its plan to the liquid."""

from __future__ import annotations

import numpy as np

from mpsdem._core import mps
from mpsdem.case import Case
from mpsdem.case import Liquid as Scene
from mpsdem.geometry import (
    Kind,
    Layout,
    NodeLayout,
    lattice_layout,
    node_layout,
    push_plate_layout,
    ring_layout,
)
from mpsdem.liquids.bending import bending
from mpsdem.liquids.bins import sample
from mpsdem.liquids.nodes import NodeLiquid
from mpsdem.liquids.particles import ParticleLiquid
from mpsdem.liquids.profile import ProfileLiquid
from mpsdem.liquids.protocol import Liquid
from mpsdem.plan import (
    Plan,
    clear_gradient,
    outlet_length,
    pipe_profile,
    stirring_speed,
    turbulence,
)

_SLABS = 256  # slabs that fill the gap behind a push plate, until they come again
_SMAGORINSKY = 0.1  # [-] C_s, that of shear flows


def particle_layout(case: Case) -> Layout:
    """Where the particles of a case's liquid start."""
    pipe = case.pipe
    spacing = case.fidelity.resolved_particle_spacing(pipe.radius)
    if pipe.has_plate:
        return push_plate_layout(
            radius=pipe.radius,
            length=pipe.length,
            spacing=spacing,
            upstream=pipe.resolved_stroke + pipe.settling_length,
            downstream=outlet_length(case),
        )
    layout = lattice_layout if case.fidelity.layout == "lattice" else ring_layout
    return layout(radius=pipe.radius, length=pipe.length, spacing=spacing)


def _push_plate(case: Case) -> mps.PushPlate | None:
    pipe = case.pipe
    if case.liquid is None or not pipe.has_plate:
        return None
    return mps.PushPlate(
        velocity=case.liquid.bulk_velocity,
        stroke=pipe.resolved_stroke,
        settling=pipe.settling_length,
        outlet=outlet_length(case),
        draws=np.random.default_rng(0).random((_SLABS, 2)),
    )


def node_layout_of(case: Case) -> NodeLayout:
    """Where the nodes of a case's liquid are."""
    spacing = case.fidelity.resolved_particle_spacing(case.pipe.radius)
    return node_layout(radius=case.pipe.radius, length=case.pipe.length, spacing=spacing)


def build_liquid(case: Case, plan: Plan) -> Liquid | None:
    """Make the liquid that the plan chose, with the developed profile for a start."""
    if case.liquid is None:
        return None
    if plan.liquid_model == "profile":
        return ProfileLiquid(
            profile=pipe_profile(case),
            pipe_radius=case.pipe.radius,
            bulk_velocity=case.liquid.bulk_velocity,
            pressure_gradient=clear_gradient(case),
        )
    if plan.liquid_model == "eulerian":
        return _on_nodes(case, case.liquid, plan)
    return _of_particles(case, case.liquid, plan)


def _on_nodes(case: Case, liquid: Scene, plan: Plan) -> NodeLiquid:
    pipe, layout, profile = case.pipe, node_layout_of(case), pipe_profile(case)
    position = layout.position
    nodes = mps.EulerianLiquid(
        place=layout.place,
        area=layout.area,
        wall_count=layout.wall_count,
        stations=layout.stations,
        spacing=layout.spacing,
        velocity=profile.velocity(position.reshape(-1, 3)).reshape(position.shape),
        pipe_radius=pipe.radius,
        pipe_length=pipe.length,
        density=liquid.density,
        kinematic_viscosity=liquid.kinematic_viscosity,
        roughness=pipe.roughness,
        turbulent=turbulence(case) is not None,
        bulk_velocity=liquid.bulk_velocity,
        pressure_gradient=liquid.pressure_gradient,
        convection=case.fidelity.convection,
        scheme=case.fidelity.time_scheme,
        courant=case.fidelity.courant,
        threads=plan.threads,
    )
    return NodeLiquid(
        nodes=nodes,
        layout=layout,
        pipe_radius=pipe.radius,
        pipe_length=pipe.length,
        sampling_radius=max(plan.smoothing_radius, 2.1 * layout.spacing),
        written=sample(len(layout), case.output.liquid_stride),
    )


def _eddies(case: Case, spacing: float) -> mps.MixingLength | mps.Smagorinsky | None:
    model = turbulence(case)
    if model == "smagorinsky":
        return mps.Smagorinsky(coefficient=_SMAGORINSKY, spacing=spacing)
    return None if model is None else mps.MixingLength(pipe_radius=case.pipe.radius)


def _of_particles(case: Case, liquid: Scene, plan: Plan) -> ParticleLiquid:
    pipe = case.pipe
    layout = particle_layout(case)
    inside = layout.kind == Kind.LIQUID
    velocity = np.where(inside[:, None], pipe_profile(case).velocity(layout.position), 0.0)
    if (mean := velocity[inside, 0].mean()) != 0:
        velocity *= liquid.bulk_velocity / mean  # the rings do not sample the profile evenly
    axis = case.axis if case.motion.moves_walls else None
    if axis is not None:
        velocity = axis.to_laboratory(velocity, layout.position[:, 0], 0.0)
    particles = mps.LagrangianLiquid(
        position=layout.position,
        velocity=velocity,
        kind=layout.kind,
        particle_spacing=layout.spacing,
        pipe_radius=pipe.radius,
        pipe_length=pipe.length,
        plate=_push_plate(case),
        density=liquid.density,
        kinematic_viscosity=liquid.kinematic_viscosity,
        roughness=pipe.roughness,
        turbulence=_eddies(case, layout.spacing),
        bulk_velocity=liquid.bulk_velocity,
        pressure_gradient=liquid.pressure_gradient,
        courant=case.fidelity.courant,
        tolerance=case.fidelity.pressure_tolerance,
        solver=case.fidelity.pressure_solver,
        speed=stirring_speed(case),
        threads=plan.threads,
    )
    if axis is not None:
        particles.bend(bending(axis, 0.0, 1.0))
    vacant = len(particles) - len(layout.kind)  # places for what a plate may bring in
    kind = np.concatenate([layout.kind, np.full(vacant, Kind.LIQUID, dtype=np.int8)])
    return ParticleLiquid(
        particles=particles,
        kind=kind,
        full_count=particles.count_in_bore,
        has_plate=pipe.has_plate,
        pipe_radius=pipe.radius,
        pipe_length=pipe.length,
        sampling_radius=max(plan.smoothing_radius, 2.1 * layout.spacing),
        written=sample(len(kind), case.output.liquid_stride),
        axis=axis,
    )
