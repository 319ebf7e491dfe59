"""Figures of a run, with matplotlib; each function returns a figure and touches no settings."""

from mpsdem.plot.curves import (
    positions_over_time,
    pressure_gradient_over_time,
    solids_fraction_over_height,
    solids_velocity_over_height,
)
from mpsdem.plot.figures import save_figures
from mpsdem.plot.scenes import cross_sections, side_view, silhouettes

__all__ = [
    "cross_sections",
    "positions_over_time",
    "pressure_gradient_over_time",
    "save_figures",
    "side_view",
    "silhouettes",
    "solids_fraction_over_height",
    "solids_velocity_over_height",
]
