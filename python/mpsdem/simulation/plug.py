"""Look at every frame whether solids block the pipe."""

from __future__ import annotations

import math

from mpsdem.analysis import (
    full_fraction,
    longest,
    solids_flux_along_pipe,
    standing_full,
    standing_time,
    stands_since,
    station_count,
    volume_fraction_along_pipe,
)
from mpsdem.case import Case
from mpsdem.simulation.watch import LOG
from mpsdem.stages import State


def watch_for_plug(case: Case, state: State) -> bool:
    """Note in the state since when and where solids fill the pipe and stand still.

    Parameters
    ----------
    case : Case
        What is run.
    state : State
        Its ``standing_since``, ``plug_time`` and ``plug_position`` are brought up to date.

    Returns
    -------
    bool
        Whether a plug was found just now; later ones are not looked for.
    """
    liquid, pipe = case.liquid, case.pipe
    if state.population is None or liquid is None or not liquid.bulk_velocity:
        return False
    if (case.solids is not None and case.solids.held) or not math.isnan(state.plug_time):
        return False
    solids, diameter = state.solids, 2 * pipe.radius
    x, u, radius = solids.position[:, 0], solids.velocity[:, 0], solids.radius
    bins = station_count(pipe.radius, pipe.length, 2 * float(radius.max()))
    size = {"pipe_radius": pipe.radius, "length": pipe.length}
    standing = standing_full(
        volume_fraction_along_pipe(x, radius, **size, bins=bins),
        solids_flux_along_pipe(x, u, radius, **size, bins=bins),
        full=full_fraction(diameter, 2 * float(radius.mean())),
        bulk_velocity=liquid.bulk_velocity,
    )
    state.standing_since = stands_since(state.standing_since, standing, state.time)
    lasting = standing_time(diameter, liquid.bulk_velocity)
    section = longest(state.standing_since, state.time, lasting)
    if section is None:
        return False
    state.plug_time = float(state.standing_since[section])
    state.plug_position = (section + 0.5) * pipe.length / bins
    LOG.warning(
        "a plug: solids have stood still and filled the pipe at x = %.4g m since %.4g s",
        state.plug_position,
        state.plug_time,
    )
    return True
