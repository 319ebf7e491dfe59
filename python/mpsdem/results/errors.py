"""What can go wrong between a run and its directory."""

from __future__ import annotations


class OutputError(RuntimeError):
    """The output directory cannot be written: the message names the path and the remedy."""


class LockError(OutputError):
    """Another run is writing to the same directory."""


class ResultsError(RuntimeError):
    """There are no readable results where they were looked for."""


class CheckpointError(RuntimeError):
    """A checkpoint cannot be continued from: absent, damaged, or of another case."""


class MissingExtraError(RuntimeError):
    """An optional package is not installed: the message names the command that installs it.

    Parameters
    ----------
    what : str
        What needs it.
    package : str
        Its name.
    """

    def __init__(self, what: str, package: str) -> None:
        super().__init__(f"{what} needs {package}, which is not installed: pip install {package}")
