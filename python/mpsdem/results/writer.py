"""Frames into `results.h5`, so that a killed run leaves every frame it finished readable."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Protocol

import h5py  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import ArrayLike

from mpsdem.results.errors import OutputError, ResultsError
from mpsdem.results.fields import GROUPS, TIME, FieldInfo
from mpsdem.results.files import (
    CASE,
    CHECKPOINT,
    RESULTS,
    SUMMARY,
    make_directory,
    new_hdf5,
    output_error,
    reading,
    reserve,
    write_atomically,
    writing,
)
from mpsdem.results.stored import FORMAT, FORMAT_VERSION, open_results

_CHUNK = 1 << 16  # [bytes] far below HDF5's chunk cache, so that a chunk is filled in memory


class WritesToml(Protocol):
    """What a results file needs of a case."""

    def to_toml(self) -> str:
        """Return the case with every default written out."""


class ResultsWriter:
    """Write a run's frames to ``DIRECTORY/results.h5`` and its case to ``DIRECTORY/case.toml``.

    Results, checkpoint and summary of an earlier run in the directory are removed.

    Parameters
    ----------
    directory : path-like
        Output directory, created where absent.
    case : Case
        The case that is run.
    provenance : mapping of str to str, int or float
        Where the numbers come from: version, compiler, threads and the like.
    solids, liquid : mapping of str to array_like, optional
        What does not change with time, by the names in `mpsdem.results.fields`.

    Raises
    ------
    OutputError
        If the directory cannot be written or the disk is full.

    Notes
    -----
    The file is written in HDF5's single-writer-multiple-reader mode: what is flushed never refers
    to something unwritten, and `/time` is flushed after all else, so a frame counts only once it
    is whole. `Results` reads the file at any moment, and also after a kill; other programs open a
    file that was not closed with ``h5py.File(path, swmr=True, locking=False)``. The space of a
    frame is reserved before HDF5 hears of it, as HDF5 does not survive a full disk. Nothing is
    compressed: the digits of coordinates are noise to a compressor.
    """

    def __init__(
        self,
        directory: str | os.PathLike[str],
        *,
        case: WritesToml,
        provenance: Mapping[str, str | int | float],
        solids: Mapping[str, ArrayLike] | None = None,
        liquid: Mapping[str, ArrayLike] | None = None,
    ) -> None:
        self._path = make_directory(Path(directory)) / RESULTS
        self._toml = case.to_toml()
        self._provenance = dict(provenance)
        self._constants = _by_path(solids=solids, liquid=liquid)
        self._file: h5py.File | None = None
        self._frames = 0
        self._last_time = -np.inf
        for stale in (RESULTS, CHECKPOINT, SUMMARY):
            with writing(self._path):
                self._path.with_name(stale).unlink(missing_ok=True)
        write_atomically(self._path.with_name(CASE), self._toml.encode())

    @classmethod
    def reopen(
        cls, directory: str | os.PathLike[str], *, time: float, case: WritesToml | None = None
    ) -> ResultsWriter:
        """Continue the results of a stopped or killed run after its frame at `time`.

        Parameters
        ----------
        directory : path-like
            Output directory of that run.
        time : float
            Time of the checkpoint [s]; later frames are dropped, as the run will make them again.
        case : Case, optional
            The case as it is continued, for instance to a later end; by default the one recorded.

        Returns
        -------
        ResultsWriter
            Appending after the last frame that was kept.

        Raises
        ------
        ResultsError
            If there are no readable results.
        OutputError
            If the directory cannot be written or the disk is full; the old file is then untouched.

        Notes
        -----
        A killed writer leaves its file marked as open, and HDF5 refuses to write to it again. So
        the frames to keep are copied to a new file, which takes the old one's place when whole.
        """
        writer = cls.__new__(cls)
        writer._path = Path(directory) / RESULTS
        writer._file = None
        try:
            with open_results(writer._path) as old, reading(writer._path, ResultsError):
                writer._continue(old, time, case)
        except BaseException:
            writer.close()
            with suppress(OSError):
                writer._draft.unlink()
            raise
        if case is not None:
            write_atomically(writer._path.with_name(CASE), case.to_toml().encode())
        return writer

    @property
    def frames(self) -> int:
        """Number of frames written."""
        return self._frames

    def append(
        self,
        time: float,
        *,
        solids: Mapping[str, ArrayLike] | None = None,
        liquid: Mapping[str, ArrayLike] | None = None,
        diagnostics: Mapping[str, ArrayLike] | None = None,
    ) -> None:
        """Write one frame and flush it.

        Parameters
        ----------
        time : float
            Simulated time [s], later than that of the last frame.
        solids : mapping of str to array_like, optional
            Fields of the solids, (n,) or (n, 3), by the names in `mpsdem.results.fields`.
        liquid : mapping of str to array_like, optional
            Fields of the recorded liquid particles, (m,) or (m, 3), and profiles, by those names.
        diagnostics : mapping of str to array_like, optional
            Numbers about the whole run, by the names in `mpsdem.results.fields`.

        Raises
        ------
        OutputError
            If the disk is full or the file cannot be written; the frames before are kept.
        """
        frame = _by_path(solids=solids, liquid=liquid, diagnostics=diagnostics)
        if not time > self._last_time:
            raise ValueError(f"a frame at {time!r} s cannot follow one at {self._last_time!r} s")
        try:
            if self._file is None:
                self._create(frame)
            elif changed := (frame.keys() | {"time"}) ^ self._series.keys():
                raise ValueError(f"all frames hold the same fields; not so {sorted(changed)}")
            self._reserve(sum(map(_chunk_bytes, self._series.values())))
            for path, value in frame.items():
                self._write(path, value)
            self._flush()
            self._write("time", time)
            self._flush()
        except OutputError:
            raise
        except (OSError, RuntimeError) as error:
            raise output_error(self._path, error) from error
        self._frames += 1
        self._last_time = float(time)

    def close(self) -> None:
        """Close the file; frames written are already safe. A second call does nothing."""
        if self._file:
            try:
                self._file.close()
            except (OSError, RuntimeError) as error:
                raise output_error(self._path, error) from error

    def __enter__(self) -> ResultsWriter:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    @property
    def _draft(self) -> Path:
        return self._path.with_name(RESULTS + ".new")

    def _create(self, frame: Mapping[str, np.ndarray | np.generic]) -> None:
        with new_hdf5(self._draft) as file:
            file.attrs["format"] = FORMAT
            file.attrs["format_version"] = FORMAT_VERSION
            file.attrs["frame_of_reference"] = "pipe"  # where it moves, all moves with it
            file["case"] = self._toml
            file["case"].attrs["description"] = "The case in TOML, every default written out"
            file.create_group("provenance").attrs.update(self._provenance)
            for path, value in self._constants.items():
                file[path] = value
                _describe(file[path])
            for path, value in frame.items():
                _create_series(file, path, value.shape, value.dtype)
            _create_series(file, "time", (), np.dtype(TIME.dtype))
        self._open()
        self._publish()

    def _continue(self, old: h5py.File, time: float, case: WritesToml | None) -> None:
        self._frames = int(np.searchsorted(old["time"], time * (1 + 1e-12), side="right"))
        self._last_time = float(old["time"][self._frames - 1]) if self._frames else -np.inf
        with new_hdf5(self._draft) as new:
            _copy_all_but_frames(old, new)
            if case is not None:
                new["case"][()] = case.to_toml()
        self._open()
        self._reserve(sum(old[path].id.get_storage_size() for path in self._series))
        for path, dataset in self._series.items():
            _copy_frames(old[path], dataset, self._frames)
        self._publish()

    def _open(self) -> None:
        self._file = h5py.File(self._draft, "r+", libver="latest", locking=False)
        self._series: dict[str, h5py.Dataset] = {p: self._file[p] for p in _series_of(self._file)}

    def _publish(self) -> None:
        assert self._file is not None
        self._file.swmr_mode = True
        self._flush()
        os.fsync(self._file.id.get_vfd_handle())
        self._draft.replace(self._path)

    def _write(self, path: str, value: ArrayLike) -> None:
        dataset = self._series[path]
        dataset.resize(self._frames + 1, axis=0)
        dataset[self._frames] = value

    def _flush(self) -> None:
        assert self._file is not None
        self._file.flush()

    def _reserve(self, size: int) -> None:
        assert self._file is not None
        reserve(self._file, size, self._path)


def _by_path(**groups: Mapping[str, ArrayLike] | None) -> dict[str, np.ndarray | np.generic]:
    """Arrays by their path in the file, in the type that the table of fields gives."""
    return {
        f"{group}/{name}": np.asarray(value, dtype=_info(f"{group}/{name}").dtype)
        for group, fields in groups.items()
        for name, value in (fields or {}).items()
    }


def _info(path: str) -> FieldInfo:
    if path == "time":
        return TIME
    group, name = path.split("/")
    try:
        return GROUPS[group][name]
    except KeyError:
        raise ValueError(f"no field {name!r} of the {group}: add it to results/fields.py") from None


def _describe(dataset: h5py.Dataset) -> None:
    info = _info(dataset.name.lstrip("/"))
    dataset.attrs["unit"] = info.unit
    dataset.attrs["description"] = info.description


def _create_series(
    file: h5py.File, path: str, shape: tuple[int, ...], dtype: np.dtype[np.generic]
) -> None:
    frame_bytes = max(1, int(np.prod(shape)) * dtype.itemsize)
    dataset = file.create_dataset(
        path,
        shape=(0, *shape),
        maxshape=(None, *shape),
        chunks=(max(1, _CHUNK // frame_bytes), *shape),
        dtype=dtype,
    )
    _describe(dataset)


def _chunk_bytes(dataset: h5py.Dataset) -> int:
    return int(np.prod(dataset.chunks) * dataset.dtype.itemsize)


def _series_of(file: h5py.File) -> list[str]:
    """Paths of what grows by one entry a frame, time last."""
    paths: list[str] = []

    def visit(path: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset) and item.maxshape[:1] == (None,):
            paths.append(path)

    file.visititems(visit)
    return sorted(paths, key=lambda path: path == "time")


def _copy_all_but_frames(old: h5py.File, new: h5py.File) -> None:
    new.attrs.update(old.attrs)
    series = _series_of(old)

    def visit(path: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Group):
            new.create_group(path).attrs.update(item.attrs)
        elif path in series:
            _create_series(new, path, item.shape[1:], item.dtype)
        else:
            new[path] = item[()]
            new[path].attrs.update(item.attrs)

    old.visititems(visit)


def _copy_frames(old: h5py.Dataset, new: h5py.Dataset, frames: int) -> None:
    new.resize(frames, axis=0)
    step = old.chunks[0]
    for start in range(0, frames, step):
        stop = min(start + step, frames)
        new[start:stop] = old[start:stop]
