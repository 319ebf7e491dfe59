"""The command line: `mpsdem run`, `resume`, `explain`, `report`, `trade`, `export`, ..."""

from __future__ import annotations

import json
import logging
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from mpsdem.case import Case, CaseError, load_case
from mpsdem.results import (
    CheckpointError,
    MissingExtraError,
    OutputError,
    Results,
    ResultsError,
)

if TYPE_CHECKING:
    from mpsdem.plan import Plan
    from mpsdem.simulation import Simulation

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Hydraulic transport of coarse solids in pipes. SI units throughout.",
)

_out = Console()
_err = Console(stderr=True)

Level = StrEnum("Level", ["quick", "balanced", "fine"])
Format = StrEnum("Format", ["vtkhdf", "vtp", "vtu", "vtk"])

CaseFile = Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file.")]
RunDirectory = Annotated[Path, typer.Argument(metavar="DIR", help="Directory of a run.")]
Until = Annotated[
    float | None, typer.Option("--until", metavar="T", help="End time in seconds, for the case's.")
]
Fidelity = Annotated[
    Level | None, typer.Option("--fidelity", help="Level of fidelity, for the case's.")
]
Settings = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Set a key, such as solids.density=2500."),
]

Budget = Annotated[
    str | None,
    typer.Option(
        "--budget", metavar="TIME", help="Most accurate fidelity for a time, such as '10 min'."
    ),
]
Error = Annotated[
    str | None,
    typer.Option("--error", metavar="E", help="Cheapest fidelity for an error, such as 5%."),
]


def main() -> None:
    """Entry point of the command `mpsdem`."""
    # Threads that wait by spinning cost a busy machine many times what they gain. Read when the
    # compiled core is loaded, which is later.
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")
    app(prog_name="mpsdem")


@app.command()
def run(
    case_file: CaseFile,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Directory for the results."),
    ] = None,
    until: Until = None,
    fidelity: Fidelity = None,
    settings: Settings = None,
    budget: Budget = None,
    error: Error = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace results that stand there.")
    ] = False,
) -> None:
    """Run a case, analyse it and draw its figures.

    Exit codes: 0 finished, 1 diverged, 2 bad input, 3 ended by a plug (where output.on_plug is
    "stop"), 128 and the number of the signal if stopped by one.
    """
    with _plain_errors():
        from mpsdem.simulation import Simulation

        case = _case(case_file, until, fidelity, settings)
        output = output or (None if case.title else Path("out", case_file.stem))
        case, expected = _chosen(case, fidelity, budget, error)
        _finish(Simulation(case, output, overwrite=overwrite, expected=expected))


@app.command()
def resume(directory: RunDirectory) -> None:
    """Go on with a run that was stopped, as if it had never been."""
    with _plain_errors():
        from mpsdem.simulation import Simulation

        _finish(Simulation.resume(directory))


@app.command()
def explain(
    case_file: CaseFile,
    until: Until = None,
    fidelity: Fidelity = None,
    settings: Settings = None,
    budget: Budget = None,
    error: Error = None,
) -> None:
    """Say what a case requires and why, what limits its steps, and what it will cost."""
    with _plain_errors():
        from mpsdem.plan import make_plan

        case = _case(case_file, until, fidelity, settings)
        case, _ = _chosen(case, fidelity, budget, error)
        _show_plan(make_plan(case))


@app.command()
def report(directory: RunDirectory) -> None:
    """Analyse a run, finished or not: write its report.json, and draw its figures anew."""
    with _plain_errors():
        from mpsdem.plot import save_report, save_still

        with Results(directory) as results:
            report, *figures = save_report(results)
            figures += save_still(results, directory / "figures", times=results.case.output.times)
        _show_report(json.loads(report.read_bytes()))
        for path in (report, *figures):
            _out.print(str(path), soft_wrap=True, markup=False, highlight=False)


@app.command()
def trade(
    case_file: CaseFile,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Directory; by default out/trade/CASE."),
    ] = None,
    quantity: Annotated[
        str | None,
        typer.Option(
            "--quantity", metavar="NAME,...", help="Names of summary.json; by default the usual."
        ),
    ] = None,
    time: Annotated[
        str, typer.Option("--time", metavar="TIME", help="What all of it may take.")
    ] = "20 min",
    scheduler: Annotated[
        str | None,
        typer.Option("--scheduler", metavar="ADDRESS", help="Of a Dask cluster to run on."),
    ] = None,
    fidelity: Fidelity = None,
    settings: Settings = None,
) -> None:
    """Measure what each knob of the fidelity costs, and how far it moves the results.

    Knobs are turned one at a time around the case's fidelity. Start it again to go on with it.
    """
    with _plain_errors():
        from mpsdem.trade import report_rows, seconds_of
        from mpsdem.trade import trade as measure

        output = output or Path("out", "trade", case_file.stem)
        outcome = measure(
            _case(case_file, None, fidelity, settings),
            output,
            quantities=quantity.split(",") if quantity else None,
            seconds=seconds_of(time, "--time"),
            scheduler=scheduler,
            tell=lambda text: _out.print(f"[dim]{escape(text)}[/]", highlight=False),
        )
        table = _table("setting", "s of computing a second", *outcome.quantities)
        for cells in report_rows(outcome):
            table.add_row(*cells)
        _out.print(table)
        for sentence in outcome.recommendation():
            _out.print(sentence, soft_wrap=True, markup=False, highlight=False)
        for out in outcome.left_out:
            _out.print(f"[dim]not run: {escape(out.setting)}: {escape(out.reason)}[/]")
        for name in ("trade.md", "trade.csv", "trade.json", "trade.png"):
            _out.print(str(output / name), soft_wrap=True, markup=False, highlight=False)


@app.command()
def export(
    directory: RunDirectory,
    to: Annotated[
        Format,
        typer.Option(
            "--to",
            help="vtkhdf: one file of all frames. vtp: a file a frame and a .pvd that lists them; "
            "needs pyvista. vtu, vtk: snapshots, the last frame by default; need meshio.",
        ),
    ] = Format.vtkhdf,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="OUT", help="Where to; by default DIR/export."),
    ] = None,
    times: Annotated[
        str | None,
        typer.Option(
            "--times", metavar="T,T,...", help="Only the frames nearest to these times in seconds."
        ),
    ] = None,
    every: Annotated[
        int | None, typer.Option("--every", metavar="N", min=1, help="Only every Nth frame.")
    ] = None,
) -> None:
    """Write solids and liquid for ParaView, as points with all their fields.

    To see the solids as spheres, add a Glyph of type Sphere, radius 1, scaled by `radius`.
    """
    if times is not None and every is not None:
        raise typer.BadParameter("leave out one of the two", param_hint="--times, --every")
    with _plain_errors():
        from mpsdem.results import export

        with Results(directory) as results:
            frames: Sequence[int] | None = None
            if times is not None:
                frames = results.frames_at(_numbers(times))
            elif every is not None:
                frames = range(0, results.time.size, every)
            paths = export(results, output or directory / "export", to=to.value, frames=frames)
        for path in paths:
            _out.print(str(path), soft_wrap=True, markup=False, highlight=False)


@app.command()
def validate(
    ids: Annotated[
        list[str] | None, typer.Argument(metavar="[ID]...", help="Checks; all by default.")
    ] = None,
) -> None:
    """Compare with exact solutions and published numbers."""
    from mpsdem import validation

    raise typer.Exit(validation.run(ids or []))


@app.command()
def info() -> None:
    """Say which program this is, and what it found on this machine."""
    from mpsdem.info import environment

    table = _table()
    for name, value in environment().items():
        table.add_row(name, escape(str(value)))
    _out.print(table)


@contextmanager
def _plain_errors() -> Iterator[None]:
    """Say in one message what went wrong; exit with 2 for bad input, 1 for a run that failed."""
    from mpsdem.simulation import SimulationDiverged, SimulationInterrupted

    try:
        yield
    except SimulationInterrupted as stop:
        _err.print(str(stop), soft_wrap=True, markup=False, highlight=False)
        raise typer.Exit(128 + stop.signal) from None
    except SimulationDiverged as error:
        _complain(error)
        raise typer.Exit(1) from None
    except (CaseError, CheckpointError, MissingExtraError, OutputError, ResultsError) as error:
        _complain(error)
        raise typer.Exit(2) from None


@contextmanager
def _log_on_stderr() -> Iterator[None]:
    """Log to where a progress bar would be, if there is no terminal to show one."""
    if _err.is_terminal:
        yield
        return
    log = logging.getLogger("mpsdem")
    handler = logging.StreamHandler(sys.stderr)
    handler.addFilter(lambda record: record.levelno < logging.ERROR)  # errors are told on their own
    log.addHandler(handler)
    try:
        yield
    finally:
        log.removeHandler(handler)


def _complain(error: Exception) -> None:
    _err.print("[bold red]error:[/]", end=" ")
    _err.print(str(error), soft_wrap=True, markup=False, highlight=False)


def _case(
    case_file: Path, until: float | None, fidelity: Level | None, settings: list[str] | None
) -> Case:
    case = load_case(case_file)
    if fidelity is not None:
        case = case.with_(fidelity={"level": fidelity.value})
    if until is not None:
        times = tuple(time for time in case.output.times or () if time <= until) or None
        every = min(case.output.every, until) if until > 0 else case.output.every
        case = case.with_(end_time=until, output={"times": times, "every": every})
    return case.with_settings(settings or [])


def _chosen(
    case: Case, fidelity: Level | None, budget: str | None, error: str | None
) -> tuple[Case, dict[str, Any] | None]:
    """The case at the fidelity that a budget or an error asks for, and what is expected of it."""
    if budget is None and error is None:
        return case, None
    if (budget, error, fidelity).count(None) < 2:
        raise typer.BadParameter("give one of them", param_hint="--budget, --error, --fidelity")
    from mpsdem.trade import choose, expectation, seconds_of, share_of

    chosen = choose(
        case,
        seconds=None if budget is None else seconds_of(budget, "--budget"),
        error=None if error is None else share_of(error, "--error"),
    )
    for line in expectation(chosen):
        _out.print(line, soft_wrap=True, markup=False, highlight=False)
    return chosen.case, chosen.as_json()


def _numbers(text: str) -> list[float]:
    try:
        return [float(number) for number in text.split(",")]
    except ValueError:
        rule = f"{text!r} must be numbers with commas between them, such as 0,2.5,5"
        raise typer.BadParameter(rule, param_hint="--times") from None


def _table(*headings: str) -> Table:
    table = Table(box=None, show_header=bool(headings), pad_edge=False, header_style="dim")
    for heading in headings or ("", ""):
        table.add_column(heading)
    return table


def _finish(simulation: Simulation) -> None:
    """Run, and say where what was found."""
    with _log_on_stderr():
        results = simulation.run()
    summary = results.summary
    table = _table()
    table.add_column()
    for name, unit in _SHOWN.items():
        if (value := summary[name]) is not None:
            shown = f"{value:.4g} {unit}" if isinstance(value, float) else str(value)
            table.add_row(name, shown, _error_bar(summary["averages"].get(name)))
    _out.print(table)
    if (expected := summary.get("expected")) is not None:
        took, foreseen = (
            f"{_duration(what['wall_seconds'])} ({_duration(what['cpu_seconds'])} of computing)"
            for what in (summary, expected)
        )
        _out.print(f"{expected['setting']}: took {took}, where about {foreseen} were expected")
    for warning in summary["warnings"]:
        _warn(warning)
    _out.print(f"results in {results.directory}", soft_wrap=True, markup=False, highlight=False)
    if simulation.case.output.figures:
        figures = results.directory / "figures"
        _out.print(f"figures in {figures}", soft_wrap=True, markup=False, highlight=False)
    if summary["status"] == "plug":
        raise typer.Exit(3)


def _error_bar(average: dict[str, Any] | None) -> str:
    if average is None or average["error"] is None:
        return ""
    return f"[dim]± {average['error']:.2g}[/]"


def _show_report(report: dict[str, Any]) -> None:
    """The averages with their errors, and what they amount to."""
    start, end = report["window"]
    table = _table(f"mean, {start:.4g} to {end:.4g} s", "", "error", "")
    for name, average in report["averages"].items():
        if average["mean"] is None:
            continue
        error = "" if average["error"] is None else f"{average['error']:.2g}"
        unit = "" if average["unit"] == "1" else average["unit"]
        short = "" if average["long_enough"] else "[yellow]too short for a mean[/]"
        table.add_row(name, f"{average['mean']:.4g} {unit}", error, short)
    _out.print(table)
    for name, told in (("regime", "regime"), ("blockage", "state")):
        if name in report:
            _out.print(f"{name}: {report[name][told]}")


_SHOWN = {
    "status": "",
    "time": "s",
    "wall_seconds": "s",
    "pressure_gradient": "Pa/m",
    "solids_mean_velocity": "m/s",
    "solids_front_position": "m",
    "bed_height": "m",
    "largest_overlap": "of the radius",
}


def _show_plan(plan: Plan) -> None:
    _heading(plan.case.title or "Case")
    table = _table("number", "", "meaning")
    for number in plan.numbers:
        table.add_row(number.name, f"{number.value:.4g} {number.unit}", number.meaning)
    _out.print(table)

    _heading("Each step")
    table = _table("stage", "why")
    for stage in plan.stages:
        table.add_row(stage.name, stage.reason)
    for stage in plan.left_out:
        table.add_row(f"[dim]without {escape(stage.name)}[/]", f"[dim]{escape(stage.reason)}[/]")
    _out.print(table)

    _heading("Steps")
    table = _table("step", "s", "limit")
    for name, step in (
        ("solids", plan.solid_step),
        ("coupling", plan.coupling_step),
        ("liquid", plan.liquid_step),
    ):
        if step is None:
            continue
        table.add_row(name, f"{step.value:.4g}", "")
        for limit in step.limits:
            mark = " [bold](binds)[/]" if limit == step.binding else ""
            table.add_row("", f"[dim]{limit.value:.4g}[/]", escape(limit.name) + mark)
    _out.print(table)

    _heading("Cost")
    clock, estimate = plan.clock, plan.estimate
    table = _table()
    steps = f"{clock.steps} coupling steps"
    if clock.substeps:
        steps += f" of {clock.substeps} solid steps, {plan.case.solids_count} solids"
    table.add_row("steps", steps)
    threads = f"{plan.threads} thread" + ("s" if plan.threads > 1 else "")
    table.add_row("time", f"about {_duration(estimate.wall_seconds)} on {threads}")
    table.add_row("memory", f"about {estimate.memory_bytes / 1e6:.0f} MB")
    table.add_row("disk", f"about {max(1.0, estimate.disk_bytes / 1e6):.0f} MB")
    _out.print(table)
    for warning in plan.warnings:
        _warn(warning)


def _heading(text: str) -> None:
    _out.print(f"\n[bold]{escape(text)}[/]")


def _warn(text: str) -> None:
    _out.print(f"[yellow]warning:[/] {escape(text)}", highlight=False)


def _duration(seconds: float) -> str:
    if seconds < 100:
        return f"{max(1.0, seconds):.0f} s"
    if seconds < 6000:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h"
