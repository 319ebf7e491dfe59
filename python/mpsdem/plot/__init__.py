"""Figures of a run, with matplotlib; each function returns a figure and touches no settings."""

from mpsdem.plot.curves import positions_over_time, pressure_gradient_over_time
from mpsdem.plot.figures import save_figures, save_report
from mpsdem.plot.head_loss import draw_head_loss
from mpsdem.plot.histories import along_the_pipe, transport_history
from mpsdem.plot.ledgers import ledger_history
from mpsdem.plot.liquid_curves import (
    liquid_velocity_profile,
    pressure_along_axis,
    solver_history,
)
from mpsdem.plot.liquid_scenes import liquid_middle_plane, liquid_sections
from mpsdem.plot.profiles import solids_fraction, velocities, velocity_distribution
from mpsdem.plot.scenes import cross_sections, side_view, silhouettes
from mpsdem.plot.still import save_still, still_picture

__all__ = [
    "along_the_pipe",
    "cross_sections",
    "draw_head_loss",
    "ledger_history",
    "liquid_middle_plane",
    "liquid_sections",
    "liquid_velocity_profile",
    "positions_over_time",
    "pressure_along_axis",
    "pressure_gradient_over_time",
    "save_figures",
    "save_report",
    "save_still",
    "side_view",
    "silhouettes",
    "solids_fraction",
    "solver_history",
    "still_picture",
    "transport_history",
    "velocities",
    "velocity_distribution",
]
