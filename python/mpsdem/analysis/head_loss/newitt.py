"""The models of Newitt and others for a sliding bed, heterogeneous and homogeneous flow."""

from __future__ import annotations

import math

from mpsdem.analysis.head_loss.conveying import Conveying, Model, Range


def newitt_bed(flow: Conveying) -> float:
    """Loss of pressure of a sliding bed, after Newitt and others.

    Parameters
    ----------
    flow : Conveying
        With the delivered concentration.

    Returns
    -------
    float
        [Pa/m].

    Notes
    -----
    ``(i_m - i_w) / (i_w C) = 66 g D (s - 1) / V^2``, which, as ``i_w = f V^2 / (2 g D)``, is a
    coefficient of friction of 33 f: 0.7 in their pipe of an inch.

    References
    ----------
    Newitt, Richardson, Abbott & Turtle (1955), Trans. Inst. Chem. Eng. 33, 93-113.
    """
    return flow.clear_gradient * (1 + 66 * flow.concentration / flow.densimetric_froude)


def newitt_heterogeneous(flow: Conveying) -> float:
    """Loss of pressure of solids that the flow keeps up, after Newitt and others.

    Parameters
    ----------
    flow : Conveying
        With the delivered concentration.

    Returns
    -------
    float
        [Pa/m].

    Notes
    -----
    ``(i_m - i_w) / (i_w C) = 1100 g D (s - 1) v_t / V^3``: the work of lifting what sinks.

    References
    ----------
    Newitt, Richardson, Abbott & Turtle (1955), Trans. Inst. Chem. Eng. 33, 93-113.
    """
    lifted = flow.terminal_velocity / flow.bulk_velocity / flow.densimetric_froude
    return flow.clear_gradient * (1 + 1100 * flow.concentration * lifted)


def newitt_homogeneous(flow: Conveying) -> float:
    """Loss of pressure of solids that are part of the liquid, after Newitt and others.

    Parameters
    ----------
    flow : Conveying
        With the delivered concentration.

    Returns
    -------
    float
        [Pa/m].

    Notes
    -----
    ``(i_m - i_w) / (i_w C) = 0.6 (s - 1)``: six tenths of what a denser liquid would add.

    References
    ----------
    Newitt, Richardson, Abbott & Turtle (1955), Trans. Inst. Chem. Eng. 33, 93-113.
    """
    return flow.clear_gradient * (1 + 0.6 * flow.excess * flow.concentration)


def bed_limit(flow: Conveying) -> float:
    """Velocity up to which solids slide as a bed, 17 terminal velocities [m/s]."""
    return 17 * flow.terminal_velocity


def homogeneous_limit(flow: Conveying) -> float:
    """Velocity from which solids are part of the liquid, (1800 g D v_t)^(1/3) [m/s]."""
    cube = 1800 * flow.gravity * flow.pipe_diameter * flow.terminal_velocity
    return math.cbrt(cube)


def newitt(flow: Conveying) -> float:
    """Loss of pressure after Newitt and others, by the formula of the regime.

    Parameters
    ----------
    flow : Conveying
        With the delivered concentration.

    Returns
    -------
    float
        [Pa/m].

    Notes
    -----
    Of coarse solids, for which the limits come in the other order, the heterogeneous regime is
    left out. The formulas meet at the limits to a few per cent.
    """
    if flow.bulk_velocity <= bed_limit(flow):
        return newitt_bed(flow)
    if flow.bulk_velocity <= homogeneous_limit(flow):
        return newitt_heterogeneous(flow)
    return newitt_homogeneous(flow)


NEWITT = Model(
    name="Newitt et al.",
    gradient=newitt,
    concentration="delivered",
    ranges=(
        Range(
            quantity="bore",
            of=lambda f: f.pipe_diameter,
            low=0.025,
            high=0.15,
            unit="m",
            why="measured at one inch, compared with others' up to six",
        ),
        Range(quantity="solids", of=lambda f: f.diameter, low=9.6e-5, high=6.4e-3, unit="m"),
        Range(quantity="excess of density", of=lambda f: f.excess, low=0.4, high=3.1),
    ),
    source="Newitt et al. (1955)",
)
