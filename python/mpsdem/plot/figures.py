"""Every figure of a run, as files."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from matplotlib.figure import Figure

from mpsdem.analysis import Survey, report, survey
from mpsdem.analysis.head_loss import comparable
from mpsdem.plot.curves import positions_over_time, pressure_gradient_over_time
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
from mpsdem.plot.style import DOTS_PER_INCH
from mpsdem.results import Results, write_report
from mpsdem.results.files import make_directory, writing


def save_report(results: Results) -> list[Path]:
    """Write ``report.json`` and all figures into the directory of a run.

    Parameters
    ----------
    results : Results
        The run; it may still go on.

    Returns
    -------
    list of Path
        The files, the report first.

    Raises
    ------
    ResultsError
        If the run has no frames.
    OutputError
        If they cannot be written.
    """
    found, times = survey(results), results.case.output.times
    path = write_report(results.directory, report(results, found))
    figures = save_figures(results, results.directory / "figures", times=times, found=found)
    return [path, *figures]


def save_figures(
    results: Results,
    directory: str | os.PathLike[str],
    *,
    times: Sequence[float] | None = None,
    found: Survey | None = None,
) -> list[Path]:
    """Draw all figures that a run has the numbers for.

    Parameters
    ----------
    results : Results
        The run; it may still go on.
    directory : path-like
        Where the PNG files go, created where absent.
    times : sequence of float, optional
        Times of side views and sections [s]; by default the start and successive halves of the run.
    found : Survey, optional
        The run's survey, if it is there already.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    OutputError
        If they cannot be written.
    """
    folder = make_directory(Path(directory))
    paths = []
    for name, draw in _drawings(results, times, found or survey(results)):
        path = folder / f"{name}.png"
        with writing(path):
            draw().savefig(path, dpi=DOTS_PER_INCH, bbox_inches="tight")
        paths.append(path)
    return paths


def _drawings(
    results: Results, times: Sequence[float] | None, found: Survey
) -> Iterator[tuple[str, Callable[[], Figure]]]:
    if results.has_solids:
        yield "side_view", lambda: side_view(results, times)
        yield "cross_sections", lambda: cross_sections(results, times)
        yield "silhouette", lambda: silhouettes(results, times)
        yield "position", lambda: positions_over_time(results)
        yield "volume_fraction", lambda: solids_fraction(results, times, found)
        yield "velocity_distribution", lambda: velocity_distribution(results, found)
        yield "transport", lambda: transport_history(results, found)
        yield "along_pipe", lambda: along_the_pipe(results, found)
    yield "velocity", lambda: velocities(results, times, found)
    if "pressure_gradient" in results.diagnostics:
        yield "pressure_gradient", lambda: pressure_gradient_over_time(results, found)
    if comparable(results):
        yield "head_loss", lambda: draw_head_loss([results])
    if results.has_liquid and not results.liquid.is_prescribed:
        if results.liquid.has_particles:
            yield "liquid_sections", lambda: liquid_sections(results, times)
            yield "liquid_middle_plane", lambda: liquid_middle_plane(results, times)
        yield "liquid_profile", lambda: liquid_velocity_profile(results, times)
        yield "liquid_pressure", lambda: pressure_along_axis(results, times)
        yield "liquid_solver", lambda: solver_history(results)
        if len(results.time) > 2:
            yield "ledgers", lambda: ledger_history(results)
