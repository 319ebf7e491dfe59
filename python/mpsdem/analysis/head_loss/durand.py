"""The model of Durand and Condolios."""

from __future__ import annotations

import math

from mpsdem.analysis.head_loss.conveying import Conveying, Model, Range


def durand_condolios(flow: Conveying) -> float:
    """Loss of pressure of heterogeneous flow, after Durand and Condolios.

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
    ``(i_m - i_w) / (i_w C) = 81 psi^-1.5``, ``psi = V^2 sqrt(C_d) / (g D (s - 1))``, with the drag
    coefficient of a solid that settles. The constant was fitted to sand; 150 to 180 stand for it
    where psi is defined otherwise.

    References
    ----------
    Durand & Condolios (1952), Deuxieme Journee de l'Hydraulique, Societe Hydrotechnique de France.
    """
    psi = flow.densimetric_froude * math.sqrt(flow.drag_coefficient)
    return flow.clear_gradient * (1 + 81 * flow.concentration * math.pow(psi, -1.5))


DURAND_CONDOLIOS = Model(
    name="Durand-Condolios",
    gradient=durand_condolios,
    concentration="delivered",
    ranges=(
        Range(quantity="bore", of=lambda f: f.pipe_diameter, low=0.02, high=0.6, unit="m"),
        Range(quantity="solids", of=lambda f: f.diameter, low=1e-4, high=0.025, unit="m"),
        Range(quantity="velocity", of=lambda f: f.bulk_velocity, low=0.6, high=6.0, unit="m/s"),
        Range(quantity="concentration", of=lambda f: f.concentration, low=0.02, high=0.22),
        Range(
            quantity="psi",
            of=lambda f: f.densimetric_froude * math.sqrt(f.drag_coefficient),
            low=0.7,
            why="there a bed lies still, which the model does not know",
        ),
    ),
    source="Durand & Condolios (1952)",
)
