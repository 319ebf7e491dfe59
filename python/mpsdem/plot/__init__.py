"""Figures of a run, with matplotlib; each function returns a figure and touches no settings."""

from mpsdem.plot.curves import (
    positions_over_time,
    pressure_gradient_over_time,
    solids_fraction_over_height,
    solids_velocity_over_height,
)
from mpsdem.plot.figures import save_figures
from mpsdem.plot.head_loss import draw_head_loss
from mpsdem.plot.liquid_curves import (
    liquid_velocity_profile,
    pressure_along_axis,
    solver_history,
)
from mpsdem.plot.liquid_scenes import liquid_middle_plane, liquid_sections
from mpsdem.plot.scenes import cross_sections, side_view, silhouettes
from mpsdem.plot.still import save_still, still_picture

__all__ = [
    "cross_sections",
    "draw_head_loss",
    "liquid_middle_plane",
    "liquid_sections",
    "liquid_velocity_profile",
    "positions_over_time",
    "pressure_along_axis",
    "pressure_gradient_over_time",
    "save_figures",
    "save_still",
    "side_view",
    "silhouettes",
    "solids_fraction_over_height",
    "solids_velocity_over_height",
    "solver_history",
    "still_picture",
]
