"""What a case comes to: speeds, rates, stiffnesses and the flow of the liquid alone."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from mpsdem._core import coupling, mps
from mpsdem.case import Case, CaseError, List, Material, Problem, Solids
from mpsdem.contacts import Impact, Stiffness

FloatArray = NDArray[np.float64]
DragLaw = (
    coupling.SchillerNaumann
    | coupling.WenYu
    | coupling.ErgunWenYu
    | coupling.DiFelice
    | coupling.KochHill
    | coupling.Beetstra
)
DRAG_LAWS: Mapping[str, type[DragLaw]] = {
    "schiller_naumann": coupling.SchillerNaumann,
    "wen_yu": coupling.WenYu,
    "ergun_wen_yu": coupling.ErgunWenYu,
    "gidaspow": coupling.ErgunWenYu,
    "di_felice": coupling.DiFelice,
    "koch_hill": coupling.KochHill,
    "beetstra": coupling.Beetstra,
}


def materials(case: Case) -> tuple[Material, Material]:
    """Material of the solids and of the wall, softened by the stiffness factor."""
    solids = solids_of(case)

    def softened(material: Material) -> Material:
        values = material.model_dump(include=set(Material.model_fields))
        values["youngs_modulus"] *= case.fidelity.stiffness_factor
        return Material(**values)

    return softened(solids), softened(solids.at_wall)


def impacts(case: Case, *, diameter: float, speed: float) -> tuple[Impact, Impact]:
    """Impact of two solids, and of one on the wall, of a diameter [m] at a speed [m/s]."""
    density = solids_of(case).density
    solid, wall = ((m.youngs_modulus, m.poisson_ratio) for m in materials(case))
    pair, at_wall = Stiffness.of(solid, solid), Stiffness.of(solid, wall)
    return (
        Impact.between(diameter=diameter, density=density, stiffness=pair, speed=speed),
        Impact.at_wall(diameter=diameter, density=density, stiffness=at_wall, speed=speed),
    )


def spring_stiffness(case: Case, speed: float) -> tuple[float, float]:
    """Normal stiffness between solids, and at the wall, of the linear spring [N/m].

    As given, or with the largest overlap of the Hertz contact for a solid of mean volume that
    collides at `speed` [m/s].

    Raises
    ------
    CaseError
        If it is to be derived, and nothing in the case moves.
    """
    solids = solids_of(case)
    if solids.normal_stiffness is not None:
        stiffness = case.fidelity.stiffness_factor * solids.normal_stiffness
        return stiffness, stiffness
    require_speed(speed, "solids.impact_speed", "give it, in m/s")
    pair, wall = impacts(case, diameter=mean_diameter(solids), speed=speed)
    return pair.linear_stiffness, wall.linear_stiffness


def require_speed(speed: float, field: str, remedy: str) -> None:
    """Refuse contacts that are to be derived from a speed where there is none."""
    if speed == 0:
        rule = "neither gravity, liquid nor a first velocity moves the solids into contact"
        raise CaseError([Problem(field=field, rule=rule, remedy=remedy)])


def terminal_velocity(case: Case) -> float:
    """Speed at which a lone solid of mean volume settles in the liquid at rest [m/s]."""
    solids, liquid = case.solids, case.liquid
    if solids is None or liquid is None:
        return 0.0
    diameter = mean_diameter(solids)
    weight = abs(1 - liquid.density / solids.density) * case.gravity  # [m/s2]
    # No drag law gives less than half of Stokes's drag.
    fastest = 2 * weight / drag_rate(case, diameter=diameter, slip=0.0)
    if fastest == 0:
        return 0.0
    return float(
        brentq(
            lambda slip: slip * drag_rate(case, diameter=diameter, slip=slip) - weight,
            0.0,
            fastest,
        )
    )


def drag_rate(case: Case, *, diameter: float, slip: float) -> float:
    """Drag over mass and slip of a lone solid [1/s], at a slip [m/s]."""
    solids, liquid = solids_of(case), case.liquid
    assert liquid is not None
    rate = coupling.drag_rate(
        DRAG_LAWS[solids.drag](),
        liquid_velocity=np.array([[slip, 0.0, 0.0]]),
        velocity=np.zeros((1, 3)),
        void_fraction=np.ones(1),
        diameter=np.array([diameter]),
        density=np.array([solids.density]),
        liquid_density=liquid.density,
        kinematic_viscosity=liquid.kinematic_viscosity,
    )
    return float(rate[0])


def solids_of(case: Case) -> Solids:
    """The solids of a case that has some."""
    assert case.solids is not None
    return case.solids


def mean_diameter(solids: Solids) -> float:
    """Diameter of the solid of mean volume [m]."""
    return float(np.cbrt(6 / math.pi * solids.mean_volume))


def smoothing_radius(case: Case) -> float:
    """Radius over which the void fraction is averaged [m]; 0 without solids."""
    if case.solids is None:
        return 0.0
    return case.fidelity.smoothing_radius or 2.5 * case.solids.largest_diameter


def impact_speed(case: Case) -> float:
    """Speed of the hardest collisions to expect [m/s], unless given."""
    solids, pipe = case.solids, case.pipe
    if solids is None:
        return 0.0
    if solids.impact_speed is not None:
        return solids.impact_speed
    if isinstance(solids.arrangement, List):
        starts = np.array(solids.arrangement.velocities or [(0.0, 0.0, 0.0)])
    else:
        starts = np.array([solids.arrangement.velocity])
    # Against the wall, or against each other.
    start = float(max(np.linalg.norm(starts, axis=1).max(), np.linalg.norm(np.ptp(starts, axis=0))))
    if case.liquid is not None:
        return max(start, abs(case.liquid.bulk_velocity), terminal_velocity(case))
    drop = 2 * pipe.radius * math.cos(pipe.inclination)
    drop += pipe.length * abs(math.sin(pipe.inclination))
    return math.hypot(start, math.sqrt(2 * case.gravity * drop))


def liquid_model(case: Case) -> str | None:
    """Name of the model that computes the liquid; None without any.

    What is asked for, else particles for a plate to push, else the prescribed profile while it is
    known; other pipes here being straight, full, rigid and periodic, a liquid that must be computed
    is computed on fixed nodes.
    """
    if case.liquid is None:
        return None
    if case.liquid.model != "auto":
        return case.liquid.model
    if case.pipe.has_plate:
        return "lagrangian"
    return "eulerian" if case.liquid.computed else "profile"


def turbulence(case: Case) -> Literal["mixing_length", "smagorinsky"] | None:
    """Model of the eddy viscosity of a computed liquid; None where the flow is laminar.

    Raises
    ------
    CaseError
        If one is asked for in laminar flow, which has no eddies, or on nodes that cannot bear it.
    """
    asked = case.fidelity.turbulence
    if asked == "smagorinsky" and liquid_model(case) == "eulerian":
        problem = Problem(
            field="fidelity.turbulence",
            value=asked,
            rule="is for liquid.model = 'lagrangian': on nodes its friction is a third too low",
            remedy="leave it out",
        )
        raise CaseError([problem])
    if not pipe_profile(case).laminar:
        return "mixing_length" if asked == "auto" else asked
    if asked != "auto":
        problem = Problem(
            field="fidelity.turbulence",
            value=asked,
            rule="needs turbulent flow; the Reynolds number of this pipe is below 2300",
            remedy="leave it out",
        )
        raise CaseError([problem])
    return None


def outlet_length(case: Case) -> float:
    """Length behind the outlet over which leaving liquid is kept [m].

    Longer than the reach of the operators, 2.1 spacings, so that they are whole at the outlet.
    """
    return 3 * case.fidelity.resolved_particle_spacing(case.pipe.radius)


def particle_count(case: Case) -> int:
    """Particles or nodes of the liquid, about; 0 unless it is computed."""
    if liquid_model(case) not in ("eulerian", "lagrangian"):
        return 0
    spacing = case.fidelity.resolved_particle_spacing(case.pipe.radius)
    pipe, length = case.pipe, case.pipe.length
    if pipe.has_plate:
        length += pipe.resolved_stroke + pipe.settling_length + outlet_length(case)
    return round(math.pi * pipe.radius**2 * length / spacing**3)


def pipe_profile(case: Case) -> mps.PipeProfile:
    """Developed profile of the liquid in the pipe."""
    assert case.liquid is not None
    return mps.PipeProfile(
        pipe_radius=case.pipe.radius,
        bulk_velocity=case.liquid.bulk_velocity,
        kinematic_viscosity=case.liquid.kinematic_viscosity,
        roughness=case.pipe.roughness,
    )


def gravity(case: Case) -> FloatArray:
    """Gravity in the axes of the pipe, (3,) [m/s2]."""
    return np.array(case.gravity_vector)


def clear_gradient(case: Case) -> float:
    """Pressure loss of the liquid alone along the pipe, static head apart [Pa/m]."""
    if case.liquid is None:
        return 0.0
    velocity = case.liquid.bulk_velocity
    dynamic = case.liquid.density * velocity * abs(velocity) / 2
    return float(pipe_profile(case).friction_factor * dynamic / (2 * case.pipe.radius))
