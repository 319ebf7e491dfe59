"""The run: a case and its plan in, a directory of results out."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from mpsdem.case import Case, load_case
from mpsdem.info import provenance
from mpsdem.liquids import section_count
from mpsdem.plan import Plan, make_plan
from mpsdem.results import (
    Checkpoint,
    CheckpointError,
    DirectoryLock,
    OutputError,
    Results,
    ResultsWriter,
    read_checkpoint,
    write_checkpoint,
    write_summary,
)
from mpsdem.results.files import write_atomically
from mpsdem.simulation.plug import watch_for_plug
from mpsdem.simulation.summary import summarize
from mpsdem.simulation.watch import (
    LOG,
    Due,
    SimulationInterrupted,
    Stopwatch,
    log_file,
    progress,
    signals,
)
from mpsdem.stages import (
    AdvanceLiquid,
    AdvanceSolids,
    ExchangeMomentum,
    SimulationDiverged,
    Stage,
    State,
    begin_exchange,
    build_stages,
    build_state,
    check,
)

_EXPECTED = "expected.json"  # what was foreseen, kept beside the results for a run that is resumed
# What a state keeps besides its parts, which keep their own state, or need none.
_PARTS = {"population", "liquid", "exchange", "axis"}
_KEPT = {f.name for f in fields(State)} - _PARTS - {"step", "time"}


class Simulation:
    """A case that is ready to run.

    Parameters
    ----------
    case : Case
        What to simulate.
    output : path-like, optional
        Directory for the results; by default ``out/`` and the title of the case.
    overwrite : bool
        Whether results that stand there may be replaced.
    expected : mapping, optional
        What was foreseen of the run, in JSON's types; its summary repeats it as ``expected``.

    Raises
    ------
    CaseError
        If no plan can be made.

    Examples
    --------
    >>> import mpsdem as md
    >>> case = md.load_case("cases/horizontal_pipe.toml")  # doctest: +SKIP
    >>> results = md.Simulation(case, output="out/pipe").run()  # doctest: +SKIP
    """

    def __init__(
        self,
        case: Case,
        output: str | os.PathLike[str] | None = None,
        *,
        overwrite: bool = False,
        expected: Mapping[str, Any] | None = None,
    ) -> None:
        self.case = case
        self._expected = expected
        self.plan = make_plan(case)
        self.directory = Path("out", _slug(case.title)) if output is None else Path(output)
        self._overwrite = overwrite
        self._resumed = False

    @classmethod
    def resume(cls, directory: str | os.PathLike[str]) -> Simulation:
        """Go on from the last checkpoint in a directory.

        The results equal, bit by bit, those of a run that was never stopped.

        Parameters
        ----------
        directory : path-like
            Output directory of the run that was stopped.

        Raises
        ------
        CaseError
            If there is no valid case in it.
        """
        simulation = cls(load_case(Path(directory) / "case.toml"), directory)
        simulation._resumed = True
        return simulation

    def run(self, *, bar: bool = True) -> Results:
        """Run to the end of the case, and leave results, summary, report and figures.

        Parameters
        ----------
        bar : bool
            Whether to show a progress bar, on a terminal or in a notebook; else the log tells.

        Returns
        -------
        Results
            What stands in the directory now. The status in their summary is "plug" if solids
            blocked the pipe and the case says to stop then.

        Raises
        ------
        SimulationInterrupted
            On SIGINT and SIGTERM, with the step finished and a checkpoint written.
        SimulationDiverged
            If a number is no longer finite, or a solid left the bore; frames and checkpoint before
            it are kept.
        OutputError
            If the directory is in use, holds other results, or cannot be written.
        CheckpointError
            If the run to be resumed has no checkpoint, or one of another case.
        """
        with DirectoryLock(self.directory), log_file(self.directory / "run.log"):
            with signals() as received:
                time = self._simulate(received, bar=bar)
            if received:
                raise SimulationInterrupted(signal=received[0], time=time, directory=self.directory)
            results = Results(self.directory)
            if self.case.output.figures:
                from mpsdem.plot import save_report  # half a second, for those who want figures

                save_report(results)
            return results

    def _simulate(self, received: Sequence[int], *, bar: bool) -> float:
        """Run to the end or to the first signal; return the time that was reached [s]."""
        clock = self.plan.clock
        state, writer, stopwatch = self._continue() if self._resumed else self._start()
        stages = tuple(build_stages(self.case, self.plan, writer))
        due = Due(self.case.output.checkpoint_every, now=state.time)
        plugged = self.case.output.on_plug == "stop" and not math.isnan(state.plug_time)
        try:
            with writer, progress(state.time, clock.end_time, bar=bar) as show:
                if state.step == 0:
                    self._begin(stages, state, stopwatch)
                while state.step < clock.steps and not received and not plugged:
                    state.step += 1
                    state.time = clock.time(state.step)
                    for stage in stages:
                        stage(state, clock.length(state.step))
                    if state.step % clock.steps_per_frame == 0 and watch_for_plug(self.case, state):
                        plugged = self.case.output.on_plug == "stop"
                    if due(state.time):
                        self._write_checkpoint(state, stopwatch)
                    show(state.time)
                self._write_checkpoint(state, stopwatch)
        except SimulationDiverged as error:
            LOG.error("%s", error)
            self._write_summary("diverged", state, stopwatch)
            raise
        ended = "interrupted" if received else "plug" if plugged else "finished"
        self._write_summary(ended, state, stopwatch)
        return state.time

    def _start(self) -> tuple[State, ResultsWriter, Stopwatch]:
        if (self.directory / "results.h5").exists() and not self._overwrite:
            raise OutputError(
                f"{self.directory} holds results already: choose another directory, go on with "
                "`mpsdem resume`, or replace them with --overwrite (in Python, overwrite=True)"
            )
        stopwatch = Stopwatch()
        state = build_state(self.case, self.plan)
        for name in ("results.h5", "checkpoint.h5", "summary.json", _EXPECTED):
            (self.directory / name).unlink(missing_ok=True)
        if self._expected is not None:
            text = json.dumps(self._expected, indent=1, ensure_ascii=False)
            write_atomically(self.directory / _EXPECTED, text.encode())
        _log_plan(self.plan)
        return state, self._new_writer(state), stopwatch

    def _new_writer(self, state: State) -> ResultsWriter:
        solids, liquid = {}, {} if state.liquid is None else state.liquid.static_fields()
        if self.case.solids is not None:
            radius = state.solids.radius
            pipe = self.case.pipe
            sections = section_count(pipe.radius, pipe.length)
            solids = {
                "radius": radius,
                "density": np.full_like(radius, self.case.solids.density),
                "section_position": (np.arange(sections) + 0.5) * (pipe.length / sections),
            }
        return ResultsWriter(
            self.directory,
            case=self.case,
            provenance=provenance(self.plan.threads),
            solids=solids,
            liquid=liquid,
        )

    def _begin(self, stages: Sequence[Stage], state: State, stopwatch: Stopwatch) -> None:
        """Record what there is before anything has moved."""
        for stage in stages:
            if not isinstance(stage, AdvanceLiquid | AdvanceSolids | ExchangeMomentum):
                stage(state, 0.0)
        self._write_checkpoint(state, stopwatch)

    def _continue(self) -> tuple[State, ResultsWriter, Stopwatch]:
        path = self.directory / "checkpoint.h5"
        checkpoint = read_checkpoint(path, self.case)
        if not math.isclose(self.plan.clock.time(checkpoint.step), checkpoint.time):
            raise CheckpointError(
                f"{path} stands at {checkpoint.time:g} s, between the steps that end_time and "
                "output.every now lead to: give them their former values"
            )
        state = build_state(self.case, self.plan)
        try:
            stopwatch = _restore(state, checkpoint)
        except (KeyError, RuntimeError, TypeError, ValueError) as error:
            raise CheckpointError(
                f"{path} holds no state that this version can go on from ({error}): "
                "run the case anew"
            ) from None
        if state.exchange is not None:
            begin_exchange(state)
        LOG.info("resumed at %g s", state.time)
        writer = ResultsWriter.reopen(self.directory, time=state.time)
        return state, writer, stopwatch

    def _write_checkpoint(self, state: State, stopwatch: Stopwatch) -> None:
        check(state, self.case.pipe.radius)
        write_checkpoint(
            self.directory / "checkpoint.h5",
            case_toml=self.case.to_toml(),
            time=state.time,
            step=state.step,
            state={
                "solids": {} if state.population is None else state.population.state(),
                "liquid": {} if state.liquid is None else state.liquid.state(),
                "stages": {name: getattr(state, name) for name in _KEPT},
                "spent": {"wall": stopwatch.wall, "cpu": stopwatch.cpu},
            },
        )

    def _write_summary(self, status: str, state: State, stopwatch: Stopwatch) -> None:
        with Results(self.directory) as results:
            values, not_applicable = summarize(self.plan, state, results)
        values |= {"status": status, "wall_seconds": stopwatch.wall, "cpu_seconds": stopwatch.cpu}
        if (expected := self.directory / _EXPECTED).exists():
            values["expected"] = json.loads(expected.read_bytes())
        write_summary(self.directory, values, not_applicable=not_applicable)
        LOG.info("%s at %g s after %.1f s of wall clock", status, state.time, stopwatch.wall)


def _restore(state: State, checkpoint: Checkpoint) -> Stopwatch:
    """Put a state where a checkpoint stands, or raise what does not fit; return the time spent."""
    state.step, state.time = checkpoint.step, checkpoint.time
    if state.population is not None:
        state.population.restore(checkpoint.state["solids"])
    if state.liquid is not None:
        state.liquid.restore(checkpoint.state["liquid"])
    stages = checkpoint.state["stages"]
    if differing := sorted(stages.keys() ^ _KEPT):
        raise KeyError(*differing)
    for name, value in stages.items():
        _require_alike(name, value, getattr(state, name))
        setattr(state, name, value)
    spent = checkpoint.state["spent"]
    return Stopwatch(wall=float(spent["wall"]), cpu=float(spent["cpu"]))


def _require_alike(name: str, value: object, usual: object) -> None:
    """Refuse what is no number, or no array of the kind, where a state holds one of any length."""
    if isinstance(usual, np.ndarray) and isinstance(value, np.ndarray):
        fits = value.dtype == usual.dtype and value.ndim == usual.ndim
        fits = fits and value.shape[1:] == usual.shape[1:]
    else:
        fits = isinstance(value, int | float) and isinstance(usual, int | float)
    if not fits:
        raise TypeError(f"{name} is of another kind")


def _slug(title: str) -> str:
    """Name of a directory that tells of the title."""
    return re.sub(r"\W+", "_", title.lower()).strip("_") or "run"


def _log_plan(plan: Plan) -> None:
    for stage in plan.stages:
        LOG.info("%s: %s", stage.name, stage.reason)
    for name, step in (
        ("solid", plan.solid_step),
        ("coupling", plan.coupling_step),
        ("liquid", plan.liquid_step),
    ):
        if step is not None:
            LOG.info("%s step %.4g s, bound by %s", name, step.value, step.binding.name)
    for warning in plan.warnings:
        LOG.warning("%s", warning)
