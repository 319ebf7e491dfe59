"""Files that are either whole or absent, and errors that say what to do."""

from __future__ import annotations

import errno
import hashlib
import io
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import h5py  # type: ignore[import-untyped]

from mpsdem.results.errors import OutputError

RESULTS = "results.h5"
CHECKPOINT = "checkpoint.h5"
SUMMARY = "summary.json"
REPORT = "report.json"
CASE = "case.toml"

_SLACK = 1 << 18  # [bytes] for the bookkeeping of an HDF5 file between two reservations

_REMEDY = {
    errno.ENOSPC: "the disk is full: free some space",
    errno.EDQUOT: "the disk quota is used up: free some space",
    errno.EACCES: "permission denied: choose a directory that you may write to",
    errno.EPERM: "not permitted: choose a directory that you may write to",
    errno.EROFS: "the file system is read-only: choose another directory",
    errno.ENOTDIR: "a part of the path is a file, not a directory: choose another one",
    errno.EEXIST: "a file of this name is in the way: choose another directory",
    errno.ENAMETOOLONG: "the name is too long: choose a shorter one",
}


def output_error(path: Path, error: Exception) -> OutputError:
    """The same trouble in words, with the path and, where there is one, the remedy."""
    number = getattr(error, "errno", None)
    return OutputError(f"cannot write {path}: {_REMEDY.get(number or 0, str(error))}")


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Turn the system's error about `path` into an `OutputError`."""
    try:
        yield
    except OSError as error:
        raise output_error(path, error) from error


@contextmanager
def reading(path: Path, refusal: type[Exception]) -> Iterator[None]:
    """Turn whatever a damaged file at `path` makes HDF5 say into a `refusal`."""
    try:
        yield
    except (refusal, OutputError):
        raise
    except (OSError, RuntimeError, KeyError, TypeError, ValueError) as error:
        raise refusal(f"{path} is damaged: {error}") from error


def make_directory(path: Path) -> Path:
    """Create `path` with its parents where absent, or raise `OutputError`."""
    with writing(path):
        path.mkdir(parents=True, exist_ok=True)
    return path


def write_atomically(path: Path, *content: bytes) -> None:
    """Write a file that is at every instant either the old one or the new one, whole.

    Parameters
    ----------
    path : Path
        The file; its directory exists.
    *content : bytes
        What it shall hold, in this order.

    Raises
    ------
    OutputError
        If it cannot be written; a file that stood there before is then untouched.
    """
    draft = path.with_name(path.name + ".part")
    try:
        with writing(path):
            with draft.open("wb") as file:
                file.writelines(content)
                file.flush()
                os.fsync(file.fileno())
            draft.replace(path)
            _sync_directory(path.parent)
    except OutputError:
        with suppress(OSError):
            draft.unlink()
        raise


def _sync_directory(path: Path) -> None:
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def reserve(file: h5py.File, size: int, path: Path) -> None:
    """Take disk space at the end of an open file before HDF5 needs it.

    Parameters
    ----------
    file : h5py.File
        Open for writing.
    size : int
        Of what will be written next [bytes].
    path : Path
        What the file is called in an error.

    Raises
    ------
    OutputError
        If there is not as much: HDF5 would crash on a full disk.
    """
    if hasattr(os, "posix_fallocate"):
        with writing(path):
            os.posix_fallocate(file.id.get_vfd_handle(), file.id.get_filesize(), size + _SLACK)


@contextmanager
def new_hdf5(path: Path, *, seal: bool = False) -> Iterator[h5py.File]:
    """Build a small HDF5 file in memory and write it whole, as HDF5 does not survive a full disk.

    Parameters
    ----------
    path : Path
        The file to write when the block ends without an error.
    seal : bool
        Whether its SHA-256 follows it, for `sealed_hdf5` to find any damage; programs that read
        HDF5 take no notice of that.

    Yields
    ------
    h5py.File
        An empty file to fill.
    """
    with h5py.File(path, "w", driver="core", backing_store=False, libver="latest") as file:
        yield file
        file.flush()
        image = file.id.get_file_image()
    write_atomically(path, image, *([hashlib.sha256(image).digest()] if seal else []))


@contextmanager
def sealed_hdf5(path: Path) -> Iterator[h5py.File]:
    """Open a file that was written with its seal, or raise ValueError if a bit of it differs."""
    content = path.read_bytes()
    size = len(content) - hashlib.sha256().digest_size
    image, seal = content[:size], content[size:]
    if size <= 0 or hashlib.sha256(image).digest() != seal:
        raise ValueError("its checksum does not fit its content")
    with h5py.File(io.BytesIO(image), "r") as file:
        yield file
