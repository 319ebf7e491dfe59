"""A results file as it lies on the disk: opened at any moment, read where it is indexed."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path
from types import EllipsisType
from typing import Any, TypeAlias

import h5py  # type: ignore[import-untyped]
import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin
from numpy.typing import DTypeLike, NDArray

from mpsdem.results.errors import ResultsError
from mpsdem.results.files import reading

FORMAT = "mpsdem results"
FORMAT_VERSION = 1

Index: TypeAlias = int | slice | EllipsisType


def open_results(path: Path) -> h5py.File:
    """Open a results file for reading, also one that is being written or whose writer was killed.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    h5py.File
        The open file.

    Raises
    ------
    ResultsError
        If the file is absent, damaged, or of another program or a later version.
    """
    if not path.is_file():
        raise ResultsError(f"no results at {path}: has this case been run?")
    try:
        file = h5py.File(_Bytes(path), "r")
    except OSError as error:
        raise ResultsError(f"{path} is damaged or not a results file: {error}") from error
    try:
        with reading(path, ResultsError):
            _refuse_what_is_not_ours(path, file)
    except ResultsError:
        file.close()
        raise
    return file


def _refuse_what_is_not_ours(path: Path, file: h5py.File) -> None:
    kind, version = file.attrs.get("format"), file.attrs.get("format_version", 0)
    missing = [name for name in ("time", "case", "provenance") if name not in file]
    if kind != FORMAT:
        raise ResultsError(f"{path} is an HDF5 file of another program, not mpsdem results")
    if version > FORMAT_VERSION:
        raise ResultsError(
            f"{path} has format version {version}, this mpsdem reads up to {FORMAT_VERSION}: "
            "update mpsdem"
        )
    if missing:
        raise ResultsError(f"{path} is damaged: it holds no {' and no '.join(missing)}")


class _Bytes(io.FileIO):
    """A file that HDF5 reads through Python, and that closes itself with the last reference.

    HDF5's own access refuses a file whose writer was killed or, in its single-writer mode, waits
    for damaged bytes to become right.
    """

    def __del__(self) -> None:
        self.close()


class StoredRun:
    """An open results file and the number of frames that were whole when it was opened.

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    ResultsError
        If there is no readable results file.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        # Opened again after the frames are counted: only then does it surely hold all of them.
        with open_results(path) as file, reading(path, ResultsError):
            self.frames = len(file["time"])
        self.file = open_results(path)

    def __contains__(self, name: str) -> bool:
        return name in self.file

    def dataset(self, name: str) -> h5py.Dataset:
        """Find a dataset, or raise `ResultsError`."""
        with reading(self.path, ResultsError):
            if name not in self.file:
                raise ResultsError(f"{self.path} holds no {name}")
            return self.file[name]

    def read(self, name: str, index: Index = ...) -> NDArray[Any]:
        """Read a dataset, or a part of it, or raise `ResultsError`."""
        with reading(self.path, ResultsError):
            return np.asarray(self.dataset(name)[index])

    def read_frames(self, name: str) -> NDArray[Any]:
        """Read all whole frames of a dataset."""
        return self.read(name, slice(0, self.frames))

    def text(self, name: str) -> str:
        """Read a text."""
        with reading(self.path, ResultsError):
            return str(self.dataset(name).asstr()[()])

    def attributes(self, name: str) -> dict[str, Any]:
        """Read the attributes of a group or dataset as plain Python values."""
        with reading(self.path, ResultsError):
            return {
                key: value.item() if isinstance(value, np.generic) else value
                for key, value in self.dataset(name).attrs.items()
            }


class Field(NDArrayOperatorsMixin):
    """One field over all frames, read from the file only where it is indexed.

    ``field[-1]`` reads the last frame, ``field[::10, 0]`` one solid in every tenth; arithmetic,
    NumPy functions and ``np.asarray(field)`` read everything.

    Parameters
    ----------
    run : StoredRun
        Where it is stored.
    name : str
        Its path in the file; the frames are its first axis.
    """

    def __init__(self, run: StoredRun, name: str) -> None:
        self._run = run
        self._name = name
        dataset, about = run.dataset(name), run.attributes(name)
        self.shape: tuple[int, ...] = (run.frames, *dataset.shape[1:])
        self.dtype: np.dtype[Any] = dataset.dtype
        self.unit = str(about["unit"])
        self.description = str(about["description"])

    @property
    def ndim(self) -> int:
        """Number of axes, that of the frames included."""
        return len(self.shape)

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, key: Any) -> NDArray[Any]:
        first, *rest = key if isinstance(key, tuple) else (key,)
        if isinstance(first, int | np.integer):
            return np.asarray(self._run.read(self._name, range(len(self))[first])[tuple(rest)])
        if isinstance(first, slice):
            frames = range(len(self))[first]
            start, stop = (min(frames), max(frames) + 1) if frames else (0, 0)
            block = self._run.read(self._name, slice(start, stop))[:: frames.step]
            return np.asarray(block[(slice(None), *rest)])
        return np.asarray(self._run.read_frames(self._name)[key])

    def __iter__(self) -> Iterator[NDArray[Any]]:
        return (self[frame] for frame in range(len(self)))

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        if copy is False:
            raise ValueError("a Field lies on the disk: an array of it is always a copy")
        return np.asarray(self[:], dtype=dtype)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        arrays = (np.asarray(item) if isinstance(item, Field) else item for item in inputs)
        return getattr(ufunc, method)(*arrays, **options)

    def __repr__(self) -> str:
        return f"<Field {self._name} [{self.unit}] {self.shape}: {self.description}>"
