"""A run's directory: written safely, read lazily. Works without the compiled core."""

from mpsdem.results.checkpoint import Checkpoint, read_checkpoint, write_checkpoint
from mpsdem.results.errors import (
    CheckpointError,
    LockError,
    MissingExtraError,
    OutputError,
    ResultsError,
)
from mpsdem.results.export import export
from mpsdem.results.lock import DirectoryLock
from mpsdem.results.reader import Results
from mpsdem.results.stored import Field
from mpsdem.results.summary import SUMMARY_KEYS, write_report, write_summary
from mpsdem.results.writer import ResultsWriter

__all__ = [
    "SUMMARY_KEYS",
    "Checkpoint",
    "CheckpointError",
    "DirectoryLock",
    "Field",
    "LockError",
    "MissingExtraError",
    "OutputError",
    "Results",
    "ResultsError",
    "ResultsWriter",
    "export",
    "read_checkpoint",
    "write_checkpoint",
    "write_report",
    "write_summary",
]
