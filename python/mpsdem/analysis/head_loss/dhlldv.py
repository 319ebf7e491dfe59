"""The Delft Head Loss & Limit Deposit Velocity framework of Miedema and Ramsdell.

Everything here is for solids of one size at a constant in-situ concentration. Its central quantity
is the relative excess hydraulic gradient ``E = (i_m - i_l) / ((s - 1) C_vs)`` [-]: of a sliding bed
its coefficient of friction. The equations are those of Miedema (2019), Slurry Transport:
Fundamentals, A Historical Overview & The Delft Head Loss & Limit Deposit Velocity Framework, 2nd
edition, TU Delft, chapter 7 (chapter 8 of its edition at LibreTexts).
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

from scipy.optimize import brentq

from mpsdem.analysis.head_loss.conveying import Conveying, Model, Range

Drag = Literal["corrected", "settling"]
Regime = Literal["fixed bed", "sliding bed", "heterogeneous", "homogeneous"]

SLIDING_FRICTION = 0.415  # [-] mean of the beds that the framework was fitted to
BED_FRACTION = 0.6  # [-] of the volume of a bed that is solids
SLIDING_FLOW = 0.015  # [-] size over bore above which solids are too large to be carried freely
_KINETIC = 8.5  # [-] constant of the kinetic losses
_FINE = 1.8  # [-] root of Gibert's drag coefficient above which it is corrected
_KARMAN = 0.4  # [-]
_DISTRIBUTED = 3.0  # [-] constant of the homogeneous regime, A_Cv


def head_loss(flow: Conveying) -> float:
    """Loss of pressure at a constant in-situ concentration.

    Parameters
    ----------
    flow : Conveying
        With the in-situ concentration, below that of a bed.

    Returns
    -------
    float
        [Pa/m].

    Raises
    ------
    ValueError
        If the concentration reaches that of a bed.
    """
    return clear_gradient(flow) + flow.bed_weight * relative_excess(flow)


def relative_excess(flow: Conveying) -> float:
    """Relative excess hydraulic gradient of the regime that the flow is in [-].

    Parameters
    ----------
    flow : Conveying
        With the in-situ concentration, below that of a bed.
    """
    return _EXCESS[regime(flow)](flow)


def regime(flow: Conveying) -> Regime:
    """Regime of the flow: each takes over where it costs less, the homogeneous where it costs more.

    Parameters
    ----------
    flow : Conveying
        With the in-situ concentration, below that of a bed.

    Returns
    -------
    {"fixed bed", "sliding bed", "heterogeneous", "homogeneous"}
        Heterogeneous and homogeneous flow are sliding flow where the solids are too large for the
        bore, as `sliding_flow_share` says.
    """
    _require_less_than_a_bed(flow)
    found: Regime = "sliding bed"
    least = sliding_bed(flow)
    if (fixed := fixed_bed(flow)) < least:
        found, least = "fixed bed", fixed
    if (carried := heterogeneous(flow)) < least:
        found, least = "heterogeneous", carried
    # A bed is no suspension, however little it costs.
    if found == "heterogeneous" and homogeneous(flow) > least:
        found = "homogeneous"
    return found


def friction_factor(*, reynolds: float, relative_roughness: float = 0.0) -> float:
    """Darcy friction factor as the framework takes it.

    Parameters
    ----------
    reynolds : float
        Of the pipe [-].
    relative_roughness : float
        Over the diameter of the pipe [-].

    Returns
    -------
    float
        [-], within 2 % of Colebrook's.

    References
    ----------
    Swamee & Jain (1976), J. Hydraul. Div. ASCE 102, 657-664.
    """
    if reynolds < 2320:
        return 64 / reynolds
    return 1.325 / math.log(relative_roughness / 3.7 + 5.75 / math.pow(reynolds, 0.9)) ** 2


def clear_gradient(flow: Conveying) -> float:
    """Loss of pressure without solids, by the friction factor of the framework [Pa/m]."""
    return (
        _friction_factor(flow)
        * flow.liquid_density
        * flow.bulk_velocity**2
        / (2 * flow.pipe_diameter)
    )


def terminal_velocity(flow: Conveying) -> float:
    """Velocity at which a grain of sand sinks, slower than a sphere [m/s].

    References
    ----------
    Ruby & Zanke (1977), Jahrbuch der Hafenbautechnischen Gesellschaft 35.
    """
    viscous = 10 * flow.kinematic_viscosity / flow.diameter
    return viscous * (math.sqrt(1 + flow.excess * flow.gravity * flow.diameter / viscous**2) - 1)


def hindered_share(flow: Conveying) -> float:
    """Velocity of sinking among others over that alone, (1 - C / kappa_C)^beta [-].

    References
    ----------
    Richardson & Zaki (1954); exponent of Rowe (1987), doi:10.1016/0009-2509(87)85035-5.
    """
    power = math.pow(terminal_velocity(flow) * flow.diameter / flow.kinematic_viscosity, 0.75)
    exponent = (4.7 + 0.41 * power) / (1 + 0.175 * power)
    densest = 0.175 * (1 + exponent)
    return math.pow(max(1 - flow.concentration / densest, 0.0), exponent)


def sliding_flow_share(flow: Conveying) -> float:
    """Share of the solids that the flow is not large enough to carry freely [-]; they slide."""
    return max(0.0, 1 - SLIDING_FLOW * flow.pipe_diameter / flow.diameter)


def sliding_bed(flow: Conveying) -> float:  # noqa: ARG001 - one of the regimes
    """Relative excess of a sliding bed, its coefficient of friction on the wall [-]."""
    return SLIDING_FRICTION


def fixed_bed(flow: Conveying) -> float:
    """Relative excess of a flow over a bed that lies still [-].

    Parameters
    ----------
    flow : Conveying
        With the in-situ concentration, below that of a bed.

    Returns
    -------
    float
        [-]; infinite without solids.

    Notes
    -----
    All solids lie in the bed; the liquid goes through what it leaves open. The bed is as rough as
    its solids, and rougher where the flow shears it.
    """
    _require_less_than_a_bed(flow)
    if flow.concentration == 0:
        return math.inf
    bore, rl = flow.pipe_diameter, flow.liquid_density
    area = math.pi / 4 * bore**2
    half = _half_angle(flow.concentration / BED_FRACTION)
    on_wall, on_bed = (math.pi - half) * bore, bore * math.sin(half)
    open_area = area * (1 - flow.concentration / BED_FRACTION)
    hydraulic = 4 * open_area / (on_wall + on_bed)
    velocity = flow.bulk_velocity * area / open_area
    reynolds = velocity * hydraulic / flow.kinematic_viscosity
    wall = friction_factor(reynolds=reynolds, relative_roughness=flow.roughness / hydraulic)
    grains = (
        1.325 / math.log(0.27 * flow.diameter / hydraulic + 5.75 / math.pow(reynolds, 0.9)) ** 2
    )
    froude = velocity / math.sqrt(2 * flow.gravity * hydraulic * flow.excess)
    volume = flow.density / rl * math.pi / 6 * flow.diameter**3  # [m3], a fit with a dimension
    sheared = 0.83 * wall + 0.37 * math.pow(froude, 2.73) * math.pow(volume, 0.094)
    shear = rl * velocity**2 / 8 * (wall * on_wall + max(grains, sheared) * on_bed)
    return (shear / open_area - clear_gradient(flow)) / flow.bed_weight


def heterogeneous(flow: Conveying, *, drag: Drag = "corrected") -> float:
    """Relative excess of solids that the flow keeps up [-].

    Parameters
    ----------
    flow : Conveying
        With the in-situ concentration, below that of a bed.
    drag : {"corrected", "settling"}
        As in `kinetic_losses`.

    Returns
    -------
    float
        [-].

    Notes
    -----
    What they lose of their height, and of their motion at the wall. Solids larger than 0.015 of the
    bore are sliding flow: a mean with a sliding bed, by their size.
    """
    return _with_sliding(flow, potential_losses(flow) + kinetic_losses(flow, drag=drag))


def potential_losses(flow: Conveying) -> float:
    """Relative excess of lifting again what sinks [-]."""
    return terminal_velocity(flow) * hindered_share(flow) / flow.bulk_velocity


def kinetic_losses(flow: Conveying, *, drag: Drag = "corrected") -> float:
    """Relative excess of solids that hit the wall and are carried along again.

    Parameters
    ----------
    flow : Conveying
    drag : {"corrected", "settling"}
        Whose particle Froude number v_t / sqrt(g d) it takes: that of settling; or, as the later
        text does, corrected for fine and for coarse solids, where fits of Gibert and of Wilson
        differ from it. They agree from 0.5 to 1 mm and above 3 mm.

    Returns
    -------
    float
        [-].
    """
    turbulent = math.cbrt(flow.kinematic_viscosity * flow.gravity) / flow.bulk_velocity
    slowness = terminal_velocity(flow) / math.sqrt(flow.gravity * flow.diameter)
    resistance = math.pow(slowness, -10 / 9)
    if drag == "corrected":
        if resistance > _FINE:
            resistance = _FINE * math.pow(resistance / _FINE, 0.75)
        least = 0.226 * math.pow(flow.gravity / flow.diameter, 1 / 6)
        if resistance < least:
            resistance = 0.6 * resistance + 0.4 * least
    return _KINETIC**2 / _friction_factor(flow) * turbulent**2 / resistance**3


def homogeneous(flow: Conveying) -> float:
    """Relative excess of solids that are part of the liquid [-].

    Notes
    -----
    That of a liquid as dense as the mixture, less what a viscous sublayer without solids saves, by
    its thickness over their size. Large solids as in `heterogeneous`.
    """
    factor = _friction_factor(flow)
    added = flow.excess * flow.concentration
    if added == 0:
        return 0.0
    friction = math.sqrt(factor / 8)
    saved = (_DISTRIBUTED / _KARMAN * math.log1p(added) * friction + 1) ** 2
    ratio = (1 + added - saved) / (added * saved)
    sublayer = 11.6 * flow.kinematic_viscosity / (friction * flow.bulk_velocity)
    share = min(1.0, sublayer / flow.diameter)
    alone = clear_gradient(flow) / (flow.liquid_density * flow.gravity)
    return _with_sliding(flow, alone * (1 - (1 - ratio) * (1 - share)))


_EXCESS = {
    "fixed bed": fixed_bed,
    "sliding bed": sliding_bed,
    "heterogeneous": heterogeneous,
    "homogeneous": homogeneous,
}


def limit_deposit_velocity(flow: Conveying) -> float:
    """Velocity above which no bed is left, sliding or fixed.

    Parameters
    ----------
    flow : Conveying
        With the in-situ concentration, above 0 and below that of a bed; its velocity does not
        matter.

    Returns
    -------
    float
        [m/s].

    Notes
    -----
    The friction factor is that at the velocity itself, which is found by iteration. Solids of
    2 mm and more follow the theory for a rough bed, finer ones that of a smooth bed or a mean of
    both; no deposit is left below the velocity at which heterogeneous flow costs what a sliding
    bed does.
    """
    _require_less_than_a_bed(flow)
    if flow.concentration == 0:
        raise ValueError("concentration = 0: without solids there is no deposit")
    scale = math.sqrt(2 * flow.gravity * flow.excess * flow.pipe_diameter)

    def missing(velocity: float) -> float:
        return max(_froude(flow, velocity) * scale, _to_heterogeneous(flow, velocity)) - velocity

    return float(brentq(missing, 1e-3, 1e3, xtol=1e-12))


def _froude(flow: Conveying, velocity: float) -> float:
    """Limit deposit velocity over sqrt(2 g (s - 1) D), with the friction factor at a velocity."""
    factor = _friction_factor(replace(flow, bulk_velocity=velocity))
    squared = 2 * flow.gravity * flow.excess * flow.pipe_diameter
    very_small = 1.4 * math.cbrt(flow.kinematic_viscosity * flow.excess * flow.gravity)
    very_small *= math.sqrt(8 / factor / squared)
    constant = 3.4 * math.pow(1.65 / flow.excess, 2 / 9)
    crowded = hindered_share(flow) * flow.concentration
    small = constant * math.cbrt(terminal_velocity(flow) * crowded / (factor * math.sqrt(squared)))
    smooth = max(very_small, small)
    relative = flow.diameter / flow.pipe_diameter
    if relative <= SLIDING_FLOW:
        rough_bed = 0.0065 / (2 * flow.gravity * flow.excess * flow.pipe_diameter)
    else:
        rough_bed = (
            0.053 * math.sqrt(relative) / (2 * flow.gravity * flow.excess * flow.pipe_diameter)
        )
    rubbed = math.sqrt(SLIDING_FRICTION * BED_FRACTION * math.pi / 8) * math.sqrt(rough_bed)
    rough = constant * math.cbrt(crowded * rubbed / factor)
    if flow.diameter > 2e-3:
        return rough
    if smooth <= rough:
        return smooth
    share = math.exp(-flow.diameter / (5e-4 * math.sqrt(1.65 / flow.excess)))
    return smooth * share + rough * (1 - share)


def _to_heterogeneous(flow: Conveying, velocity: float) -> float:
    """Velocity at which heterogeneous flow costs what a sliding bed does [m/s]."""
    at = replace(flow, bulk_velocity=1.0)
    factor = _friction_factor(replace(flow, bulk_velocity=velocity))
    linear = potential_losses(at) / SLIDING_FRICTION
    square = kinetic_losses(at, drag="settling") * _friction_factor(at) / factor / SLIDING_FRICTION
    return (linear + math.sqrt(linear**2 + 4 * square)) / 2


def _half_angle(share: float) -> float:
    """Half of the angle under which a bed of a share of the bore is seen from the axis [rad]."""
    if share >= 1:
        return math.pi
    return float(
        brentq(lambda b: b - math.sin(b) * math.cos(b) - math.pi * share, 0.0, math.pi, xtol=1e-14)
    )


def _with_sliding(flow: Conveying, carried: float) -> float:
    share = sliding_flow_share(flow)
    return (1 - share) * carried + share * sliding_bed(flow)


def _friction_factor(flow: Conveying) -> float:
    return friction_factor(
        reynolds=flow.bulk_velocity * flow.pipe_diameter / flow.kinematic_viscosity,
        relative_roughness=flow.roughness / flow.pipe_diameter,
    )


def _require_less_than_a_bed(flow: Conveying) -> None:
    if flow.concentration >= BED_FRACTION:
        raise ValueError(
            f"concentration = {flow.concentration}: must be < {BED_FRACTION}, that of a bed"
        )


DHLLDV = Model(
    name="DHLLDV",
    gradient=head_loss,
    concentration="in-situ",
    ranges=(
        Range(
            quantity="bore",
            of=lambda f: f.pipe_diameter,
            low=0.025,
            high=1.2,
            unit="m",
            why="compared with measurements there",
        ),
        Range(
            quantity="solids",
            of=lambda f: f.diameter,
            low=1e-5,
            high=0.02,
            unit="m",
            why="compared with measurements there",
        ),
        Range(
            quantity="concentration",
            of=lambda f: f.concentration,
            high=0.5,
            why="at half of the bore and more the flow is a plug",
        ),
        Range(
            quantity="Reynolds number of the pipe",
            of=lambda f: f.bulk_velocity * f.pipe_diameter / f.kinematic_viscosity,
            low=2320.0,
            why="the flow must be turbulent",
        ),
    ),
    source="Miedema (2019)",
)
