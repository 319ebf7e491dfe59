"""One run at a time in a directory."""

from __future__ import annotations

import fcntl
import os
from pathlib import Path
from types import TracebackType

from mpsdem.results.errors import LockError
from mpsdem.results.files import make_directory, writing

NAME = ".lock"


class DirectoryLock:
    """Hold an output directory for this process, created where absent.

    The system drops the lock with the process however it ends, so a killed run needs no cleaning
    up. The file stays: removing it would let two processes lock two files of one name.

    Parameters
    ----------
    directory : path-like
        The output directory.

    Raises
    ------
    LockError
        On entering, if another process or another lock of this one holds the directory.
    OutputError
        On entering, if the directory cannot be created or written.

    Examples
    --------
    >>> import tempfile
    >>> from mpsdem.results import DirectoryLock
    >>> with tempfile.TemporaryDirectory() as directory, DirectoryLock(directory):
    ...     pass  # nobody else writes here
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.directory = Path(directory)
        self._handle: int | None = None

    def __enter__(self) -> DirectoryLock:
        make_directory(self.directory)
        path = self.directory / NAME
        with writing(path):
            handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
        try:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                owner = os.pread(handle, 32, 0).decode(errors="replace").strip()
                raise LockError(
                    f"{self.directory} is in use by a run with process id {owner or 'unknown'}: "
                    "wait for it, stop it, or choose another directory"
                ) from None
            with writing(path):
                os.ftruncate(handle, 0)
                os.pwrite(handle, f"{os.getpid()}\n".encode(), 0)
        except BaseException:
            os.close(handle)
            raise
        self._handle = handle
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._handle is not None:
            os.close(self._handle)
            self._handle = None
