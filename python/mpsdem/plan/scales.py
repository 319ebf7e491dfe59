"""What a case comes to: speeds, rates, stiffnesses and the flow of the liquid alone."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from mpsdem._core import coupling, dem, mps
from mpsdem.analysis.correlations import LAMINAR_LIMIT
from mpsdem.case import Case, CaseError, List, Material, Problem, Solids
from mpsdem.contacts import Impact, Stiffness

FloatArray = NDArray[np.float64]
_BED = 0.45  # [-] void fraction of a settled bed
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

#: Models of a liquid that is computed, not prescribed.
COMPUTED = ("eulerian", "lagrangian")
#: Mean fraction of the solids above which the liquid notices them [-].
DILUTE = 1e-3
# Density of the solids over that of the liquid below which half the liquid they displace, as much
# as a sphere carries along, is more than a quarter of their own mass [-].
_LIGHT = 2.0
# Stokes number of an impact below which the liquid takes a third and more of the rebound [-]: it
# leaves exp(-35 / St) of the restitution. Legendre et al. (2005), doi:10.1063/1.2010527.
_VISCOUS = 100.0
_ABSURD = 5.0  # [-] speed over the fastest that a case names; 2 is the most of sound runs
_STILL = 1e-30  # [m/s] below which nothing moves, and whose square is still a number
LEAST_GAP = 3e-3  # [-] over the reduced radius, that lubrication takes rough surfaces to leave


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
    if speed < _STILL:
        rule = "neither gravity, liquid nor a first velocity moves the solids into contact"
        raise CaseError([Problem(field=field, rule=rule, remedy=remedy)])


def terminal_velocity(case: Case) -> float:
    """Speed at which a lone solid of mean volume settles in the liquid at rest [m/s]."""
    return _balance_slip(case, void_fraction=1.0)


def _balance_slip(case: Case, *, void_fraction: float) -> float:
    """Slip at which the drag on a solid of mean volume balances its weight in the liquid [m/s]."""
    solids, liquid = case.solids, case.liquid
    if solids is None or liquid is None:
        return 0.0
    diameter = mean_diameter(solids)
    weight = abs(1 - liquid.density / solids.density) * case.gravity  # [m/s2]

    def rate(slip: float) -> float:
        return drag_rate(case, diameter=diameter, slip=slip, void_fraction=void_fraction)

    # No drag law gives less than half of Stokes's drag.
    fastest = 2 * weight / rate(0.0)
    if fastest == 0:
        return 0.0
    return float(brentq(lambda slip: slip * rate(slip) - weight, 0.0, fastest))


def response_time(case: Case) -> float:
    """Time in which a bed that hovers would bring the liquid in it to its own velocity [s].

    1 / L = eps rho u_r / ((1 - eps) (rho_s - rho) g), u_r the slip at which drag balances weight;
    infinite where the liquid feels no solids, or these are held or have no weight.
    """
    if case.liquid is None or case.solids is None or not is_two_way(case) or case.solids.held:
        return math.inf
    slip = _balance_slip(case, void_fraction=_BED)
    if slip == 0:
        return math.inf
    weight = abs(case.solids.density / case.liquid.density - 1) * case.gravity  # [m/s2]
    return _BED * slip / ((1 - _BED) * weight)


def drag_rate(case: Case, *, diameter: float, slip: float, void_fraction: float = 1.0) -> float:
    """Drag of a solid over its mass and slip [1/s], at a slip [m/s]; alone unless told otherwise.

    `void_fraction` is the share of liquid around it [-].
    """
    solids, liquid = solids_of(case), case.liquid
    assert liquid is not None
    rate = coupling.drag_rate(
        DRAG_LAWS[solids.drag](),
        liquid_velocity=np.array([[slip, 0.0, 0.0]]),
        velocity=np.zeros((1, 3)),
        void_fraction=np.array([void_fraction]),
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


def needs_void_fraction(case: Case) -> bool:
    """Whether the drag depends on how much liquid is around a solid."""
    return case.solids_count > 1 and solids_of(case).drag != "schiller_naumann"


def smoothing_radius(case: Case) -> float:
    """Radius over which void fraction and exchange are averaged [m]; 0 without solids.

    Raises
    ------
    CaseError
        If it is so small that what solids and liquid exchange would be noise, or so large that a
        solid would meet itself around a periodic pipe.
    """
    if case.solids is None:
        return 0.0
    diameter, spacing = case.solids.largest_diameter, 0.0
    if liquid_model(case) in COMPUTED:
        spacing = case.fidelity.resolved_particle_spacing(case.pipe.radius)
    given = case.fidelity.smoothing_radius
    radius = max(2.5 * diameter, 3 * spacing) if given is None else given
    if is_two_way(case) and 2 * radius > case.pipe.length:
        problem = Problem(
            field="fidelity.smoothing_radius",
            value=radius,
            unit="m",
            rule=f"must be <= {case.pipe.length / 2:g} m, half the length of the pipe",
            remedy="take a longer pipe, or fidelity.coupling = 'one-way'",
        )
        raise CaseError([problem])
    if given is None:
        return radius
    resolved = 2 * spacing if is_two_way(case) else 0.0
    least = max(1.5 * diameter if needs_void_fraction(case) or resolved else 0.0, resolved)
    if given < least:
        what = "two spacings of the liquid, which feels the solids"
        if least > resolved:
            what = "1.5 largest diameters: a solid that fills more of it has no surroundings"
        problem = Problem(
            field="fidelity.smoothing_radius",
            value=given,
            unit="m",
            rule=f"must be >= {least:g} m, {what}",
            remedy="leave it out",
        )
        raise CaseError([problem])
    return given


def impact_speed(case: Case) -> float:
    """Speed of the hardest collisions to expect [m/s], unless given."""
    if case.solids is None:
        return 0.0
    if case.solids.impact_speed is not None:
        return case.solids.impact_speed
    return _expected_impact_speed(case)


def _expected_impact_speed(case: Case) -> float:
    solids, pipe = solids_of(case), case.pipe
    if isinstance(solids.arrangement, List):
        starts = np.array(solids.arrangement.velocities or [(0.0, 0.0, 0.0)])
    else:
        starts = np.array([solids.arrangement.velocity])
    # Against the wall, or against each other.
    start = float(max(np.linalg.norm(starts, axis=1).max(), np.linalg.norm(np.ptp(starts, axis=0))))
    if case.liquid is not None:
        carried = max(start, fastest_flow(case), terminal_velocity(case))
        return carried + shaken_speed(case)
    drop = 2 * pipe.radius * math.cos(pipe.inclination)
    drop += pipe.length * abs(math.sin(pipe.inclination))
    return math.hypot(start, math.sqrt(2 * case.gravity * drop)) + shaken_speed(case)


def shaken_speed(case: Case) -> float:
    """Speed that the motion of the pipe gives to solids, seen from it [m/s]; 0 at rest.

    That of solids without drag, which stay behind the pipe as far as their density differs from
    that of the liquid.
    """
    if case.solids is None or case.solids.held:
        return 0.0
    return abs(lightness(case)) * case.motion.peak_speed


def lightness(case: Case) -> float:
    """Share of its weight that a solid has left in the liquid [-]; 1 in a dry case."""
    return 1 - 1 / density_ratio(case)


def liquid_model(case: Case) -> str | None:
    """Name of the model that computes the liquid; None without any.

    What is asked for, else particles for a plate or moving walls to push, else the prescribed
    profile while it is known; other pipes here being straight, full, rigid and periodic, a liquid
    that must be computed is computed on fixed nodes.
    """
    if case.liquid is None:
        return None
    if case.liquid.model != "auto":
        return case.liquid.model
    if case.pipe.has_plate or case.motion.moves_walls:
        return "lagrangian"
    return "eulerian" if case.liquid.computed or must_feel_solids(case) else "profile"


def must_feel_solids(case: Case) -> bool:
    """Whether the solids change the flow so much that its profile is not known.

    As was asked for, else where they are not dilute and the pipe has room for a computed liquid.
    """
    coupling = case.fidelity.coupling
    if case.solids is None or coupling == "one-way":
        return False
    if coupling == "two-way":
        return True
    return case.solids_fraction > DILUTE and not any(case.spacing_problems())


def is_two_way(case: Case) -> bool:
    """Whether the liquid feels the solids."""
    if case.liquid is None or case.solids is None or case.pipe.has_plate:
        return False
    if case.fidelity.coupling != "auto":
        return case.fidelity.coupling == "two-way"
    return liquid_model(case) in COMPUTED and case.solids_fraction > DILUTE


def has_added_mass(case: Case) -> bool:
    """Whether the solids carry liquid along."""
    if case.liquid is None or case.solids is None or case.solids.held:
        return False
    asked = case.fidelity.added_mass
    return asked == "on" or (asked == "auto" and density_ratio(case) < _LIGHT)


def density_ratio(case: Case) -> float:
    """Density of the solids over that of the liquid [-]; infinite in a dry case."""
    return math.inf if case.liquid is None else solids_of(case).density / case.liquid.density


def impact_stokes(case: Case) -> float:
    """Stokes number of the hardest impacts to expect, rho_s v d / (9 mu) [-]."""
    solids, liquid = solids_of(case), case.liquid
    if liquid is None:
        return math.inf
    speed = impact_speed(case)
    return density_ratio(case) * speed * mean_diameter(solids) / (9 * liquid.kinematic_viscosity)


def has_lubrication(case: Case) -> bool:
    """Whether the liquid in the gap between two solids damps their impact."""
    if case.liquid is None or case.solids is None or case.solids.held:
        return False
    asked = case.fidelity.lubrication
    return asked == "on" or (asked == "auto" and impact_stokes(case) < _VISCOUS)


def lubrication(case: Case) -> dem.Lubrication | None:
    """Viscous force in the gaps between solids, and at the wall; None where it does not matter."""
    if case.liquid is None or not has_lubrication(case):
        return None
    viscosity = case.liquid.density * case.liquid.kinematic_viscosity
    return dem.Lubrication(viscosity=viscosity, least_gap=LEAST_GAP)


def lubrication_time(case: Case) -> float:
    """Time in which lubrication slows the smallest solid at the least gap, at the wall [s]."""
    solids, liquid = solids_of(case), case.liquid
    assert liquid is not None
    radius = solids.smallest_diameter / 2
    mass = solids.density * 4 / 3 * math.pi * radius**3
    reduced = 1 / (1 / radius - 1 / (2 * case.pipe.radius))  # at a bore, of its mean curvature
    viscosity = liquid.density * liquid.kinematic_viscosity
    return mass / (6 * math.pi * viscosity * reduced * (1 / LEAST_GAP - 1))


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
    if not fastest_profile(case).laminar or _stirred(case):
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


def stirring_speed(case: Case) -> float:
    """Speed at which solids stir a liquid that feels them [m/s]; 0 where none do."""
    if not is_two_way(case) or solids_of(case).held:
        return 0.0
    return slip_speed(case)


def slip_speed(case: Case) -> float:
    """Speed at which weight and shaking drive a solid through the liquid [m/s]."""
    return terminal_velocity(case) + shaken_speed(case)


def _stirred(case: Case) -> bool:
    """Whether solids make a flow turbulent that would be laminar without them.

    Where their speed in the bore has a Reynolds number above 2300, their wakes are turbulent at the
    scale that is computed, and a particle liquid without eddy viscosity would keep every swirl.
    """
    if case.liquid is None or liquid_model(case) != "lagrangian":
        return False
    reynolds = stirring_speed(case) * 2 * case.pipe.radius / case.liquid.kinematic_viscosity
    return reynolds > 2300


def outlet_length(case: Case) -> float:
    """Length behind the outlet over which leaving liquid is kept [m].

    Longer than the reach of the operators, 2.1 spacings, so that they are whole at the outlet.
    """
    return 3 * case.fidelity.resolved_particle_spacing(case.pipe.radius)


def particle_count(case: Case) -> int:
    """Particles or nodes of the liquid, about; 0 unless it is computed."""
    if liquid_model(case) not in COMPUTED:
        return 0
    spacing = case.fidelity.resolved_particle_spacing(case.pipe.radius)
    pipe, length = case.pipe, case.pipe.length
    if pipe.has_plate:
        length += pipe.resolved_stroke + pipe.settling_length + outlet_length(case)
    return round(math.pi * pipe.radius**2 * length / spacing**3)


def pipe_profile(case: Case) -> mps.PipeProfile:
    """Developed profile of the liquid in the pipe, at the bulk velocity of the case."""
    assert case.liquid is not None
    return _profile(case, case.liquid.bulk_velocity)


def fastest_profile(case: Case) -> mps.PipeProfile:
    """Developed profile at the fastest flow that the liquid may come to."""
    return _profile(case, fastest_flow(case))


def fastest_flow(case: Case) -> float:
    """Bulk speed of the case, or the one that a given pressure gradient leads to [m/s]."""
    assert case.liquid is not None
    return max(abs(case.liquid.bulk_velocity), _driven_flow(case))


def absurd_speed(case: Case) -> float:
    """Speed that the mean energy of liquid and solids reaches only if steps are too long [m/s].

    `_ABSURD` times the fastest that the case names: what solids hit with, the flow of the liquid
    and of one that the weight of its solids drives, the motion of the pipe. Infinite in a dry case,
    where nothing holds a solid that slides.
    """
    if case.liquid is None:
        return math.inf
    fastest = max(fastest_flow(case), case.motion.peak_speed)
    if case.solids is not None:
        pull = abs(case.solids.density - case.liquid.density) * case.gravity  # [Pa/m]
        pull *= case.solids_fraction * abs(math.sin(case.pipe.inclination))
        fastest = max(fastest, _expected_impact_speed(case), _driven_flow(case, pull))
    return _ABSURD * fastest if fastest > _STILL else math.inf


def _driven_flow(case: Case, pull: float = 0.0) -> float:
    """Bulk speed at which the friction of the walls balances gradient and `pull` [Pa/m] [m/s].

    Hagen-Poiseuille's, else Colebrook's, which is explicit where the gradient is known:
    U = sqrt(2 D G / rho) / sqrt(f), Re sqrt(f) = D sqrt(2 D G / rho) / nu.
    """
    liquid, bore = case.liquid, 2 * case.pipe.radius
    gradient = pull + abs((liquid and liquid.pressure_gradient) or 0.0)  # [Pa/m]
    if liquid is None or gradient == 0:
        return 0.0
    force = gradient / liquid.density  # [m/s2]
    laminar = force * bore**2 / (32 * liquid.kinematic_viscosity)
    if laminar <= (fastest := LAMINAR_LIMIT * liquid.kinematic_viscosity / bore):
        return laminar
    scale = math.sqrt(2 * bore * force)
    smooth = 2.51 * liquid.kinematic_viscosity / (bore * scale)
    turbulent = -2 * scale * math.log10(case.pipe.roughness / (3.7 * bore) + smooth)
    return max(fastest, turbulent)


def _profile(case: Case, bulk_velocity: float) -> mps.PipeProfile:
    assert case.liquid is not None
    return mps.PipeProfile(
        pipe_radius=case.pipe.radius,
        bulk_velocity=bulk_velocity,
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
