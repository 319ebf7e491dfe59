"""Read a run's directory: `Results`, lazily, while it runs or after."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from types import TracebackType
from typing import Any

import h5py  # type: ignore[import-untyped]
import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin
from numpy.typing import DTypeLike, NDArray

from mpsdem.case import Case
from mpsdem.results.errors import ResultsError
from mpsdem.results.files import RESULTS, SUMMARY

FORMAT = "mpsdem results"
FORMAT_VERSION = 1

FloatArray = NDArray[np.float64]


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
    if not h5py.is_hdf5(path):
        raise ResultsError(f"{path} is not a results file, or its beginning is damaged")
    try:
        file = h5py.File(path, "r", libver="latest", swmr=True, locking=False)
    except OSError as error:
        raise ResultsError(f"{path} is damaged or not a results file: {error}") from error
    try:
        if file.attrs.get("format") != FORMAT:
            raise ResultsError(f"{path} is an HDF5 file of another program, not mpsdem results")
        if (version := file.attrs["format_version"]) > FORMAT_VERSION:
            raise ResultsError(
                f"{path} has format version {version}; this mpsdem reads up to {FORMAT_VERSION}: "
                "update mpsdem"
            )
        if "time" not in file or "case" not in file:
            raise ResultsError(f"{path} is damaged: it has no time or no case")
    except (OSError, RuntimeError, KeyError) as error:
        file.close()
        if isinstance(error, ResultsError):
            raise
        raise ResultsError(f"{path} is damaged: {error}") from error
    return file


class Field(NDArrayOperatorsMixin):
    """One field over all frames, read from the file only where it is indexed.

    ``field[-1]`` reads the last frame, ``field[::10, 0]`` one solid in every tenth; arithmetic,
    NumPy functions and ``np.asarray(field)`` read everything.

    Parameters
    ----------
    dataset : h5py.Dataset
        Where it is stored, frames along the first axis.
    frames : int
        Number of whole frames.
    """

    def __init__(self, dataset: h5py.Dataset, frames: int) -> None:
        self._dataset = dataset
        self.shape: tuple[int, ...] = (frames, *dataset.shape[1:])

    @property
    def dtype(self) -> np.dtype[Any]:
        """NumPy type of the entries."""
        return self._dataset.dtype  # type: ignore[no-any-return]

    @property
    def ndim(self) -> int:
        """Number of axes, that of the frames included."""
        return len(self.shape)

    @property
    def unit(self) -> str:
        """SI unit, "1" for a pure number."""
        return str(self._dataset.attrs["unit"])

    @property
    def description(self) -> str:
        """What the numbers mean."""
        return str(self._dataset.attrs["description"])

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, key: Any) -> NDArray[Any]:
        first, *rest = key if isinstance(key, tuple) else (key,)
        if isinstance(first, slice):
            frames = range(len(self))[first]
            start, stop = (min(frames), max(frames) + 1) if frames else (0, 0)
            block = self._read(slice(start, stop))[:: frames.step or 1]
            return np.asarray(block[(slice(None), *rest)])
        if isinstance(first, int | np.integer):
            return np.asarray(self._read(range(len(self))[first])[tuple(rest)])
        return np.asarray(self._read(slice(0, len(self)))[key])

    def __iter__(self) -> Iterator[NDArray[Any]]:
        return (self[frame] for frame in range(len(self)))

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        if copy is False:
            raise ValueError("a Field is on disk: an array of it is always a copy")
        return np.asarray(self[:], dtype=dtype)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        arrays = (np.asarray(item) if isinstance(item, Field) else item for item in inputs)
        return getattr(ufunc, method)(*arrays, **options)

    def __repr__(self) -> str:
        return f"<Field {self.description!r} [{self.unit}], shape {self.shape}>"

    def _read(self, frames: int | slice) -> NDArray[Any]:
        return np.asarray(_read(self._dataset, frames))


class Solids:
    """The solids of a run, in the order in which they were placed.

    Parameters
    ----------
    results : Results
        The run's results.
    """

    def __init__(self, results: Results) -> None:
        self._results = results

    def __contains__(self, name: str) -> bool:
        return f"solids/{name}" in self._results.file

    def __len__(self) -> int:
        return int(self._dataset("radius").shape[0])

    @property
    def radius(self) -> FloatArray:
        """Radius of each solid, (n,) [m]."""
        return np.asarray(_read(self._dataset("radius")))

    @property
    def density(self) -> FloatArray:
        """Density of each solid, (n,) [kg/m3]."""
        return np.asarray(_read(self._dataset("density")))

    @property
    def position(self) -> Field:
        """Centres, (frames, n, 3) [m]; x wrapped into [0, pipe length)."""
        return self._field("position")

    @property
    def velocity(self) -> Field:
        """Velocities of the centres, (frames, n, 3) [m/s]."""
        return self._field("velocity")

    @property
    def spin(self) -> Field:
        """Angular velocities, (frames, n, 3) [rad/s]."""
        return self._field("spin")

    @property
    def laps(self) -> Field:
        """Times each solid left the outlet and came back at the inlet, (frames, n)."""
        return self._field("laps")

    @property
    def void_fraction(self) -> Field:
        """Share of liquid in the surroundings of each solid, (frames, n)."""
        return self._field("void_fraction")

    @property
    def liquid_velocity(self) -> Field:
        """Undisturbed liquid velocity at each solid, (frames, n, 3) [m/s]."""
        return self._field("liquid_velocity")

    @property
    def drag_force(self) -> Field:
        """Force of the liquid on each solid, buoyancy apart, (frames, n, 3) [N]."""
        return self._field("drag_force")

    @property
    def unwrapped_position(self) -> FloatArray:
        """Centres with the laps of the periodic pipe added to x, (frames, n, 3) [m]."""
        position = self.position[:]
        position[:, :, 0] += self._results.case.pipe.length * self.laps[:]
        return position

    def _field(self, name: str) -> Field:
        return Field(self._dataset(name), len(self._results.time))

    def _dataset(self, name: str) -> h5py.Dataset:
        return _dataset(self._results.file, f"solids/{name}")


class Liquid:
    """The prescribed liquid of a run.

    Parameters
    ----------
    file : h5py.File
        The open results.
    """

    def __init__(self, file: h5py.File) -> None:
        self._file = file

    @property
    def profile_radius(self) -> FloatArray:
        """Distances from the axis at which the profile is given, (k,) [m]."""
        return np.asarray(_read(_dataset(self._file, "liquid/profile_radius")))

    @property
    def profile_velocity(self) -> FloatArray:
        """Axial liquid velocity at those distances, (k,) [m/s]."""
        return np.asarray(_read(_dataset(self._file, "liquid/profile_velocity")))


class Diagnostics(Mapping[str, FloatArray]):
    """Numbers about the whole run, one per frame, by name.

    Parameters
    ----------
    file : h5py.File
        The open results.
    frames : int
        Number of whole frames.
    """

    def __init__(self, file: h5py.File, frames: int) -> None:
        self._group: Mapping[str, h5py.Dataset] = file.get("diagnostics", {})
        self._frames = frames

    def __getitem__(self, name: str) -> FloatArray:
        return np.asarray(_read(self._group[name], slice(0, self._frames)))

    def __iter__(self) -> Iterator[str]:
        return iter(self._group)

    def __len__(self) -> int:
        return len(self._group)


class Results:
    """What a run left in its directory; a snapshot if the run still goes on.

    Parameters
    ----------
    directory : path-like
        The run's output directory.

    Raises
    ------
    ResultsError
        If there are no readable results.

    Notes
    -----
    Fields are read from the file where they are indexed, so results larger than the memory can be
    looked through frame by frame. Frames written after the opening are seen by opening again.

    Examples
    --------
    >>> import mpsdem as md
    >>> results = md.Results("out/horizontal_pipe")  # doctest: +SKIP
    >>> results.solids.velocity[-1].mean(axis=0)  # doctest: +SKIP
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.directory = Path(directory)
        self.file = open_results(self.directory / RESULTS)
        self.time: FloatArray = np.asarray(_read(self.file["time"]))
        """Time of each frame, (frames,) [s]."""

    @property
    def has_solids(self) -> bool:
        """Whether the run has solids."""
        return "solids" in self.file

    @property
    def has_liquid(self) -> bool:
        """Whether the run has a liquid."""
        return "liquid" in self.file

    @property
    def solids(self) -> Solids:
        """The solids; a `ResultsError` where the run has none."""
        if not self.has_solids:
            raise ResultsError(f"the run in {self.directory} has no solids")
        return Solids(self)

    @property
    def liquid(self) -> Liquid:
        """The liquid; a `ResultsError` where the run is dry."""
        if not self.has_liquid:
            raise ResultsError(f"the run in {self.directory} has no liquid")
        return Liquid(self.file)

    @property
    def diagnostics(self) -> Diagnostics:
        """Numbers about the whole run, one per frame, by name."""
        return Diagnostics(self.file, len(self.time))

    @property
    def pressure_gradient(self) -> FloatArray:
        """Loss of pressure along the axis, static head apart, (frames,) [Pa/m]."""
        if "pressure_gradient" not in self.diagnostics:
            raise ResultsError(f"the run in {self.directory} recorded no pressure gradient")
        return self.diagnostics["pressure_gradient"]

    @cached_property
    def case(self) -> Case:
        """The case that was run."""
        return Case.from_toml(self.case_toml)

    @property
    def case_toml(self) -> str:
        """The case as TOML text, every default written out."""
        return str(self.file["case"].asstr()[()])

    @property
    def provenance(self) -> dict[str, Any]:
        """Where the numbers come from: version, compiler, threads and the like."""
        return {
            name: value.item() if isinstance(value, np.generic) else value
            for name, value in self.file["provenance"].attrs.items()
        }

    @property
    def summary(self) -> dict[str, Any]:
        """The run's `summary.json`; empty while the run goes on."""
        path = self.directory / SUMMARY
        try:
            summary: dict[str, Any] = json.loads(path.read_bytes())
        except FileNotFoundError:
            return {}
        except ValueError as error:
            raise ResultsError(f"{path} is damaged: {error}") from error
        return summary

    def close(self) -> None:
        """Close the file; what was read stays."""
        self.file.close()

    def __enter__(self) -> Results:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        end = f" to {self.time[-1]:g} s" if self.time.size else ""
        return f"<Results of {str(self.directory)!r}: {self.time.size} frames{end}>"


def _dataset(file: h5py.File, path: str) -> h5py.Dataset:
    try:
        return file[path]
    except KeyError:
        raise ResultsError(f"{file.filename} holds no {path}") from None


def _read(dataset: h5py.Dataset, frames: int | slice | tuple[()] = ()) -> Any:
    try:
        return dataset[frames]
    except (OSError, RuntimeError) as error:
        raise ResultsError(f"{dataset.file.filename} is damaged: {error}") from error
