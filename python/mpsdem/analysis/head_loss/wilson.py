"""Wilson's model of fully stratified flow, and the velocity at which its bed stops."""

from __future__ import annotations

import math

from mpsdem.analysis.head_loss.conveying import Conveying, Model, Range

SLIDING_FRICTION = 0.4  # [-] of sand or gravel on steel pipe; Wilson et al. (2006), p. 116
BED_FRACTION = 0.6  # [-] of the volume of a bed that is solids


def stationary_limit(
    flow: Conveying,
    *,
    sliding_friction: float = SLIDING_FRICTION,
    bed_fraction: float = BED_FRACTION,
) -> float:
    """Velocity below which a bed lies still, at the concentration of the flow.

    Parameters
    ----------
    flow : Conveying
        With the delivered concentration; its velocity does not matter.
    sliding_friction : float
        Of the bed on the wall [-].
    bed_fraction : float
        Share of solids in the bed [-].

    Returns
    -------
    float
        V_s [m/s]; 0 without solids, and for a pipe full of them.

    References
    ----------
    Wilson (1979), Proc. Hydrotransport 6, 1-12; fit by Wilson, Addie, Sellgren & Clift (2006),
    Slurry Transport Using Centrifugal Pumps, doi:10.1007/b101079, eqs. 5.7 to 5.10.
    """
    largest = largest_stationary_limit(flow, sliding_friction=sliding_friction)
    relative = min(flow.concentration / bed_fraction, 1.0)
    if relative in (0.0, 1.0):
        return 0.0
    worst = 0.16 * math.pow(flow.pipe_diameter, 0.4) * math.pow(flow.diameter * 1e3, -0.84)
    worst *= math.pow(flow.excess / 1.65, -0.17)
    worst = min(max(worst, 0.05), 0.66)
    if worst <= 1 / 3:
        power = math.pow(relative, math.log(1 / 3) / math.log(worst))
        return 6.75 * largest * power * (1 - power) ** 2
    power = math.pow(1 - relative, math.log(2 / 3) / math.log(1 - worst))
    return 6.75 * largest * power**2 * (1 - power)


def largest_stationary_limit(
    flow: Conveying, *, sliding_friction: float = SLIDING_FRICTION
) -> float:
    """Velocity above which no bed lies still, at any concentration.

    Parameters
    ----------
    flow : Conveying
        Its velocity and its concentration do not matter.
    sliding_friction : float
        Of the bed on the wall [-].

    Returns
    -------
    float
        V_sm [m/s], V_s at the worst concentration.

    References
    ----------
    As `stationary_limit`; a fit to Wilson's nomogram, for water.
    """
    d = flow.diameter * 1e3
    d_pipe = math.pow(flow.pipe_diameter, 0.7)
    push = math.pow(sliding_friction * flow.excess / 0.66, 0.55)
    return 8.8 * push * d_pipe * math.pow(d, 1.75) / (d**2 + 0.11 * d_pipe)


def wilson_stratified(
    flow: Conveying,
    *,
    sliding_friction: float = SLIDING_FRICTION,
    deposit_velocity: float | None = None,
) -> float:
    """Loss of pressure of fully stratified flow, after Wilson and Addie.

    Parameters
    ----------
    flow : Conveying
        With the delivered concentration.
    sliding_friction : float
        Of the solids on the wall [-].
    deposit_velocity : float, optional
        V_sm, where it is known better [m/s]; by default `largest_stationary_limit`.

    Returns
    -------
    float
        [Pa/m].

    Notes
    -----
    ``(i_m - i_w) / ((s - 1) C) = (mu / 0.4) (0.55 V_sm / V)^0.25``: a fit to the balance of forces
    on a bed whose slip lessens as the flow gets faster. Some take `stationary_limit` for V_sm,
    which gives up to 5 % less.

    References
    ----------
    Wilson & Addie (1995), Proc. 8th Int. Freight Pipeline Society Symp.; Wilson et al. (2006),
    doi:10.1007/b101079, p. 116.
    """
    if deposit_velocity is None:
        deposit_velocity = largest_stationary_limit(flow, sliding_friction=sliding_friction)
    slip = math.pow(0.55 * deposit_velocity / flow.bulk_velocity, 0.25)
    rubbing = sliding_friction / 0.4 * slip
    return flow.clear_gradient + rubbing * flow.bed_weight


WILSON_STRATIFIED = Model(
    name="Wilson, stratified",
    gradient=wilson_stratified,
    concentration="delivered",
    ranges=(
        Range(
            quantity="size of the solids over the bore",
            of=lambda f: f.diameter / f.pipe_diameter,
            low=0.018,
            why="the flow holds smaller ones in suspension",
        ),
        Range(
            quantity="velocity over that at which a bed lies still",
            of=lambda f: f.bulk_velocity / largest_stationary_limit(f),
            low=1.0,
            why="the bed must slide",
        ),
        Range(
            quantity="kinematic viscosity",
            of=lambda f: f.kinematic_viscosity,
            low=0.5e-6,
            high=2e-6,
            unit="m2/s",
            why="V_sm is that of water",
        ),
    ),
    source="Wilson & Addie (1995)",
)
