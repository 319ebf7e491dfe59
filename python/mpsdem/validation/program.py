"""The whole program on a small case: from its text to its results."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from tempfile import TemporaryDirectory

from mpsdem.case import Case
from mpsdem.results import Results
from mpsdem.simulation import Simulation


@contextmanager
def results_of(case: str) -> Iterator[Results]:
    """Run a case; its results last as long as the context.

    Parameters
    ----------
    case : str
        In TOML.
    """
    with (
        TemporaryDirectory() as directory,
        Simulation(Case.from_toml(case), f"{directory}/run").run(bar=False) as results,
    ):
        yield results
