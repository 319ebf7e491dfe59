"""What a run kept and what it lost, over its time."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mpsdem.analysis import Ledgers, ledgers
from mpsdem.plot.drawing import legend_beside
from mpsdem.plot.frames import heading
from mpsdem.plot.style import ACCENTS, style
from mpsdem.results import Results

_LEAST = 1e-17  # [-] of a logarithmic axis: round-off, and nothing


def ledger_history(results: Results) -> Figure:
    """Drift of mass, momentum and energy.

    Parameters
    ----------
    results : Results
        A run with a computed liquid.

    Returns
    -------
    Figure
        Above the largest errors of mass and exchange so far; then the liquid's momentum that
        nothing explains, and what its convection lost and was given back, over the impulse that the
        walls took; below the energy put in, dissipated and stored.

    Raises
    ------
    ResultsError
        If its liquid is not computed, or it has less than two frames.
    """
    kept = ledgers(results)
    with style():
        figure = Figure(figsize=(8.0, 6.0), layout="constrained")
        errors, momentum, energy = figure.subplots(3, 1, sharex=True)
        errors.set_title(heading(results, "mass, momentum and energy"))
        errors.plot(
            kept.time, np.maximum(kept.volume_error, _LEAST), color=ACCENTS[0],
            label="volume of\nthe liquid",
        )  # fmt: skip
        errors.plot(
            kept.time, np.maximum(kept.exchange_error, _LEAST), color=ACCENTS[2],
            label="impulse\nexchanged",
        )  # fmt: skip
        errors.set(yscale="log", ylim=(_LEAST, 1), ylabel="largest error\nso far (-)")
        _draw_momentum(momentum, kept)
        energy.plot(kept.time, kept.put_in, color=ACCENTS[1], label="put in")
        energy.plot(kept.time, kept.dissipated, color=ACCENTS[0], label="dissipated")
        energy.plot(kept.time, kept.stored, color=ACCENTS[2], label="stored")
        energy.set(xlabel="time (s)", ylabel="energy (J/m)")
        energy.set_xlim(kept.time[0], kept.time[-1])
        for axes in (errors, momentum, energy):
            legend_beside(axes)
        figure.align_ylabels()
    return figure


def _draw_momentum(axes: Axes, kept: Ledgers) -> None:
    later = kept.friction != 0
    time, whole = kept.time[later], np.abs(kept.friction[later])
    axes.plot(time, 100 * kept.unexplained[later] / whole, color=ACCENTS[0], label="unexplained")
    if kept.given_back.any():
        share = 100 * kept.given_back[later] / whole
        axes.plot(time, share, color=ACCENTS[2], label="lost by convec-\ntion, given back")
    axes.set_ylabel("momentum over\nfriction (%)")
