"""Around the time loop: signals, progress, the log, and when a checkpoint is due."""

from __future__ import annotations

import logging
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

from mpsdem.results import OutputError

LOG = logging.getLogger("mpsdem")

_CHECKPOINT_INTERVAL = 60.0  # [s] of wall clock, where the case gives no simulated time
_REFRESH_INTERVAL = 0.1  # [s] of wall clock between two looks at the progress
_LOG_LINES = 10  # lines on the progress of a run


class SimulationInterrupted(KeyboardInterrupt):
    """A signal stopped the run after a whole step; its checkpoint is written.

    Attributes
    ----------
    signal : int
        Number of the signal.
    time : float
        Simulated time that was reached [s].
    directory : Path
        What to resume.
    """

    def __init__(self, *, signal: int, time: float, directory: Path) -> None:
        self.signal, self.time, self.directory = signal, time, directory
        super().__init__(f"interrupted at t = {time:.6g} s; go on with `mpsdem resume {directory}`")


@contextmanager
def signals() -> Iterator[list[int]]:
    """Note SIGINT and SIGTERM in a list instead of dying of them; the second one has its usual way.

    Outside the main thread Python hears no signals, and the list stays empty.
    """
    received: list[int] = []
    if threading.current_thread() is not threading.main_thread():
        yield received
        return
    usual = {
        number: signal.getsignal(number) or signal.SIG_DFL
        for number in (signal.SIGINT, signal.SIGTERM)
    }

    def restore() -> None:
        for number, handler in usual.items():
            signal.signal(number, handler)

    def note(number: int, _frame: object) -> None:
        received.append(number)
        restore()

    for number in usual:
        signal.signal(number, note)
    try:
        yield received
    finally:
        restore()


@contextmanager
def log_file(path: Path) -> Iterator[None]:
    """Append what is logged meanwhile to a file, each line with its time."""
    try:
        handler = logging.FileHandler(path, encoding="utf-8")
    except OSError as error:
        raise OutputError(f"cannot write {path}: {error.strerror}") from error
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    level = LOG.level
    LOG.setLevel(min(level or logging.INFO, logging.INFO))
    LOG.addHandler(handler)
    try:
        yield
    finally:
        LOG.removeHandler(handler)
        LOG.setLevel(level)
        handler.close()


class Stopwatch:
    """Wall and processor time of this process [s], on top of what a resumed run had spent."""

    def __init__(self, wall: float = 0.0, cpu: float = 0.0) -> None:
        self._wall = wall - time.perf_counter()
        self._cpu = cpu - time.process_time()

    @property
    def wall(self) -> float:
        """Wall-clock time [s]."""
        return self._wall + time.perf_counter()

    @property
    def cpu(self) -> float:
        """Processor time of all threads [s]."""
        return self._cpu + time.process_time()


class Due:
    """Whether the next checkpoint is due: by simulated time [s] if given, else by wall clock."""

    def __init__(self, every: float | None, now: float) -> None:
        self._every = every
        self._last = now if every else time.monotonic()

    def __call__(self, now: float) -> bool:
        """Ask at a simulated time [s]; a yes counts as done."""
        clock = now if self._every else time.monotonic()
        # Simulated times carry round-off.
        due = clock - self._last >= (self._every or _CHECKPOINT_INTERVAL) * (1 - 1e-9)
        if due:
            self._last = clock
        return due


@contextmanager
def progress(start: float, end: float, *, bar: bool) -> Iterator[Callable[[float], None]]:
    """Give a function that is told the simulated time [s], and shows or logs how far the run is."""
    console = Console(stderr=True)
    # In a notebook rich draws with ipywidgets, and complains where they are not installed.
    if bar and (console.is_terminal or (console.is_jupyter and find_spec("ipywidgets"))):
        with _bar(console, start, end) as show:
            yield show
    else:
        yield _log_lines(start, end)


@contextmanager
def _bar(console: Console, start: float, end: float) -> Iterator[Callable[[float], None]]:
    columns = (
        TextColumn("{task.completed:.2f} of {task.total:g} s"),
        BarColumn(),
        TaskProgressColumn(),
        TimeRemainingColumn(),
        TextColumn("{task.fields[speed]}"),
    )
    begin = time.perf_counter()
    shown = 0.0

    with Progress(*columns, console=console) as bar:
        task = bar.add_task("", total=end, speed="")
        bar.update(task, completed=start)

        def show(now: float) -> None:
            nonlocal shown
            elapsed = time.perf_counter() - begin
            if elapsed - shown > _REFRESH_INTERVAL or now == end:
                shown = elapsed
                bar.update(task, completed=now, speed=f"{(now - start) / elapsed:.3g} s/s")

        yield show


def _log_lines(start: float, end: float) -> Callable[[float], None]:
    begin = time.perf_counter()
    told = int(_LOG_LINES * start / end)

    def show(now: float) -> None:
        nonlocal told
        if (done := int(_LOG_LINES * now / end)) > told:
            told = done
            speed = (now - start) / (time.perf_counter() - begin)
            LOG.info(
                "%.4g of %g s, %.3g simulated s per s, %.0f s left",
                now,
                end,
                speed,
                (end - now) / speed,
            )

    return show
