"""Who runs what a trade needs: one after another, or side by side."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any, Protocol

from mpsdem.results import MissingExtraError
from mpsdem.trade.runs import Outcome, carry_out


class Workers(Protocol):
    """Who runs cases."""

    count: int
    said: str  # how, in words

    @property
    def busy(self) -> int:
        """How many runs are under way."""

    def start(self, name: str, case: str, directory: str) -> None:
        """Begin with a run, of a case in TOML, in a directory."""

    def wait(self) -> tuple[str, Outcome]:
        """Name and outcome of the next run that ends."""


class InTurn:
    """Runs in this process, one after another."""

    count = 1

    def __init__(self, said: str = "one after another") -> None:
        self.said = said
        self._waiting: list[tuple[str, str, str]] = []

    @property
    def busy(self) -> int:
        return len(self._waiting)

    def start(self, name: str, case: str, directory: str) -> None:
        self._waiting.append((name, case, directory))

    def wait(self) -> tuple[str, Outcome]:
        name, case, directory = self._waiting.pop(0)
        return name, carry_out(case, directory)


class SideBySide:
    """Runs on the workers of a Dask client, which must see the same file system."""

    def __init__(self, client: Any, said: str) -> None:
        self._client, self.said = client, said
        self.count = max(1, sum(client.nthreads().values()))
        self._under_way: dict[str, str] = {}
        self._ended = _distributed().as_completed()

    @property
    def busy(self) -> int:
        return len(self._under_way)

    def start(self, name: str, case: str, directory: str) -> None:
        future = self._client.submit(carry_out, case, os.path.abspath(directory), pure=False)  # noqa: PTH100
        self._under_way[future.key] = name
        self._ended.add(future)

    def wait(self) -> tuple[str, Outcome]:
        future = next(self._ended)
        return self._under_way.pop(future.key), future.result()


@contextmanager
def workers(scheduler: str | None = None, *, cores: int | None = None) -> Iterator[Workers]:
    """Find workers.

    Parameters
    ----------
    scheduler : str, optional
        Address of a Dask scheduler; else one is started here, with a process a core. Threads would
        not do: the processor time of a run is that of its process.
    cores : int, optional
        Of this machine to use; all that this process may by default.

    Raises
    ------
    MissingExtraError
        If a scheduler is named and ``distributed`` is not installed.
    """
    cores = cores or len(os.sched_getaffinity(0))
    try:
        distributed = _distributed()
    except ImportError:
        if scheduler is not None:
            raise MissingExtraError("--scheduler", "distributed") from None
        yield InTurn(
            "one after another: with Dask (pip install distributed) they would run side by side"
        )
        return
    if scheduler is not None:
        with distributed.Client(scheduler) as client:
            yield SideBySide(client, f"on the workers of {scheduler}")
    elif cores == 1:
        yield InTurn("one after another, on one core")
    else:
        with (
            distributed.LocalCluster(
                n_workers=cores, threads_per_worker=1, dashboard_address=None
            ) as cluster,
            distributed.Client(cluster) as client,
        ):
            yield SideBySide(client, f"side by side on {cores} cores")


def _distributed() -> Any:
    """Dask's package, which is optional, and has no types."""
    return import_module("distributed")
