"""How long a step may be, and what limits it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from mpsdem import _core
from mpsdem.case import Case, CaseError, Problem
from mpsdem.contacts import rayleigh_time
from mpsdem.plan.scales import (
    COMPUTED,
    drag_rate,
    fastest_flow,
    fastest_profile,
    has_lubrication,
    impacts,
    is_two_way,
    liquid_model,
    lubrication_time,
    materials,
    require_speed,
    response_time,
    slip_speed,
    solids_of,
    spring_stiffness,
    stirring_speed,
)

# A step given by the user may take this share of a time that it has to resolve [-]: the restitution
# is then off by 0.014, and bulk flow still unmoved (512 spheres collapsing in a cylinder).
_LARGEST_SHARE = 0.5
# Errors were measured where a collision lasts three Rayleigh times (1 m/s, E = 1e8 Pa, d = 20 mm);
# a faster one is shorter, and is resolved by as many steps.
_COLLISION_WORTH = 1 / 3
_VISCOUS_SHARE = 0.1  # [-] of spacing^2 / viscosity, as the liquid's own step takes
# [-] of the time in which a bed's drag acts on its liquid: from 1 on, what substeps foresee of the
# liquid and what its pressure then does to it swing against each other
_RESPONSE_SHARE = 0.8
_PERIOD_SHARE = 0.05  # [-] of a period of the pipe, that a liquid which notices it may step over
# A period of the pipe's motion is worth that much of a time over which forces change: a hundred
# steps follow it, and less than twenty are refused.
_PERIOD_WORTH = 0.1
_SHARE_OF_PERIOD = 0.1  # [-] of what it is worth, at any level
SOLID_RATE = 2e7  # solids x steps per second on one thread in a dense bed; in the open 1.4e8


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """The longest step [s] that something allows."""

    name: str
    value: float


@dataclass(frozen=True, slots=True, kw_only=True)
class _Scale:
    """A time [s] that a step has to resolve, and how much of it counts [-].

    ``share`` [-] of that is what a step takes; by default what its level sets.
    """

    name: str
    time: float
    worth: float = 1.0
    share: float | None = None

    @property
    def limit(self) -> float:
        return self.worth * self.time


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """A time step [s], at or below the smallest of its limits."""

    value: float
    limits: tuple[Limit, ...]

    @property
    def binding(self) -> Limit:
        """The smallest limit."""
        return min(self.limits, key=lambda limit: limit.value)


def solid_limits(case: Case, speed: float) -> tuple[Limit, ...]:
    """Limits of the step of solids that collide at `speed` [m/s]; none where none moves.

    Raises
    ------
    CaseError
        If ``fidelity.solid_step`` is too long, or the contacts need a speed and there is none.
    """
    if case.solids is None or case.solids.held:
        return ()
    return _limits(
        "solid_step",
        given=case.fidelity.solid_step,
        share=case.fidelity.resolved_rayleigh_fraction,
        scales=tuple(_contact_scales(case, speed)),
    )


def _contact_scales(case: Case, speed: float) -> Iterator[_Scale]:
    """What a step of the solids has to resolve."""
    solids = solids_of(case)
    diameter = solids.smallest_diameter
    pair, wall = impacts(case, diameter=diameter, speed=speed)
    collision = f"a collision at {speed:.3g} m/s"
    if has_lubrication(case):
        name = "the time in which lubrication slows a solid"
        yield _Scale(name=name, time=lubrication_time(case))
    if solids.contact == "linear_spring":
        between, at_wall = spring_stiffness(case, speed)
        duration = min(pair.on_spring(between)[1], wall.on_spring(at_wall)[1])
        yield _Scale(name=collision, time=duration, worth=_COLLISION_WORTH)
        if solids.normal_damping:
            time = 2 * pair.reduced_mass / solids.normal_damping
            yield _Scale(name="the damping time 2 m*/c of a pair", time=time)
        return
    if solids.contact == "hertz_viscoelastic":
        require_speed(speed, "solids.contact", "take 'hertz_mindlin'")
    material, _ = materials(case)
    rayleigh = rayleigh_time(
        diameter=diameter,
        density=solids.density,
        youngs_modulus=material.youngs_modulus,
        poisson_ratio=material.poisson_ratio,
    )
    yield _Scale(name="the smallest solid's Rayleigh time", time=rayleigh)
    duration = min(pair.duration, wall.duration)
    yield _Scale(name=collision, time=duration, worth=_COLLISION_WORTH)


def coupling_limits(case: Case, of_solids: Sequence[Limit]) -> tuple[Limit, ...]:
    """Limits of the time between two looks at the liquid, after those of the solids.

    Raises
    ------
    CaseError
        If ``fidelity.coupling_step`` is too long.
    """
    every = Limit(name="output.every", value=case.output.every)
    if not of_solids or case.solids is None:
        return (every,)
    work = SOLID_RATE / case.solids_count * min(limit.value for limit in of_solids)
    prompt = Limit(name="a second of computing, so that a signal is obeyed", value=work)
    scales = []
    if case.liquid is not None:
        diameter = case.solids.smallest_diameter
        slip = max(fastest_flow(case), slip_speed(case))
        relaxation = 1 / drag_rate(case, diameter=diameter, slip=slip)
        scales = [_Scale(name=f"the drag's relaxation time at {slip:.3g} m/s", time=relaxation)]
        if slip > 0:
            crossing = f"the time to cross a diameter at {slip:.3g} m/s"
            scales.append(_Scale(name=crossing, time=diameter / slip))
    if math.isfinite(period := case.motion.shortest_period):
        name = f"the pipe's shortest period of motion, {period:.3g} s"
        scales.append(_Scale(name=name, time=period, worth=_PERIOD_WORTH, share=_SHARE_OF_PERIOD))
    given = case.fidelity.coupling_step
    share = case.fidelity.coupling_fraction(case.solids_fraction)
    limits = _limits("coupling_step", given=given, share=share, scales=scales)
    return (*limits, every, prompt)


def liquid_limits(case: Case) -> Iterator[Limit]:
    """Limits of the step of a computed liquid at its expected speed; none for other liquids.

    Where it is faster than expected, it parts a step itself.

    Raises
    ------
    CaseError
        If its solver was not built.
    """
    if case.liquid is None or liquid_model(case) not in COMPUTED:
        return
    spacing = case.fidelity.resolved_particle_spacing(case.pipe.radius)
    _require_solver(case)
    profile = fastest_profile(case)
    on_axis = abs(float(profile.velocity(np.zeros((1, 3)))[0, 0]))
    courant = case.fidelity.courant
    if on_axis > 0:
        name = f"{courant:g} of the liquid's time to cross a spacing at {on_axis:.3g} m/s"
        if liquid_model(case) == "eulerian" and is_two_way(case):
            name += ", parted by the liquid itself at 0.45, for its solids"
        yield Limit(name=name, value=courant * spacing / on_axis)
    if (stirring := stirring_speed(case)) > 0:
        moved = "settling" if case.motion.at_rest else "settling and shaken"
        name = f"{courant:g} of a {moved} solid's time to cross a spacing at {stirring:.3g} m/s"
        yield Limit(name=name, value=courant * spacing / stirring)
    if math.isfinite(response := response_time(case)):
        name = f"{_RESPONSE_SHARE:g} of the time in which a bed brings its liquid to rest"
        yield Limit(name=name, value=_RESPONSE_SHARE * response)
    period = case.motion.shortest_period
    if math.isfinite(period) and (is_two_way(case) or case.motion.moves_walls):
        name = f"{_PERIOD_SHARE:g} of the pipe's shortest period of motion, {period:.3g} s"
        yield Limit(name=name, value=_PERIOD_SHARE * period)
    viscous = _VISCOUS_SHARE * spacing**2 / case.liquid.kinematic_viscosity
    yield Limit(name=f"{_VISCOUS_SHARE:g} of the viscous time of a spacing", value=viscous)
    if case.fidelity.liquid_step is not None:
        yield Limit(name="fidelity.liquid_step, as given", value=case.fidelity.liquid_step)


def _require_solver(case: Case) -> None:
    if case.fidelity.pressure_solver == "cholmod" and not _core.cholmod:
        problem = Problem(
            field="fidelity.pressure_solver",
            value="cholmod",
            rule="needs CHOLMOD, which this build has not found",
            remedy="use 'two_level', or install SuiteSparse and build again",
        )
        raise CaseError([problem])


def _limits(
    name: str, *, given: float | None, share: float, scales: Sequence[_Scale]
) -> tuple[Limit, ...]:
    """Limit a step to a share of each time, or to what is given where that is not too long."""
    if given is None:
        shares = [(scale, scale.share or share) for scale in scales]
        return tuple(
            Limit(name=f"{part * scale.worth:.3g} of {scale.name}", value=part * scale.limit)
            for scale, part in shares
        )
    shortest = min(scales, key=lambda scale: scale.limit, default=None)
    if shortest is not None and given > (longest := _LARGEST_SHARE * shortest.limit):
        share = _LARGEST_SHARE * shortest.worth
        problem = Problem(
            field=f"fidelity.{name}",
            value=given,
            unit="s",
            rule=f"must be <= {longest:.4g} s, {share:.3g} of {shortest.name}",
            remedy="leave it out, and the plan chooses",
        )
        raise CaseError([problem])
    return (Limit(name=f"fidelity.{name}, as given", value=given),)
