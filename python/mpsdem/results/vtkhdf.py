"""Points that move, as a time series that ParaView opens: VTKHDF, written frame by frame."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any

import h5py  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import NDArray

from mpsdem.results.fields import FieldInfo
from mpsdem.results.files import reserve, writing

_VERSION = (2, 0)  # the first with time steps of PolyData
_ROOM = 1 << 17  # [bytes] for the names of the fields
_CELLS = ("Vertices", "Lines", "Polygons", "Strips")  # in the order of the offsets of a step


class PointSeries:
    """A VTKHDF file of PolyData, whose points, each a vertex, may change from frame to frame.

    Parameters
    ----------
    path : Path
        The file, written anew where the block ends without an error.
    case : str
        The case as TOML text, kept beside what VTK reads.

    Notes
    -----
    All frames lie one after the other in the same datasets, and each step says where its own begin.
    What has not changed since the frame before, such as a radius or a node, is not written again.

    Raises
    ------
    OutputError
        If the file cannot be written, or the disk is full.

    References
    ----------
    VTKHDF format specification, "Poly data" and "Temporal Data", docs.vtk.org.
    """

    def __init__(self, path: Path, *, case: str) -> None:
        self._path = path
        room = _ROOM + len(case)
        with writing(path):
            self._draft.write_bytes(bytes(8 * room))  # an error here is one before HDF5 crashes
            self._file = h5py.File(self._draft, "w", locking=False)
        reserve(self._file, room, path)
        self._file["case"] = case
        self._root = self._file.create_group("VTKHDF")
        self._root.attrs["Version"] = _VERSION
        self._root.attrs["Type"] = np.bytes_("PolyData")
        self._times: list[float] = []
        self._counts: list[int] = []  # points of each frame
        self._series: dict[str, _Series] = {}
        self._file.flush()

    def append(
        self,
        time: float,
        points: NDArray[np.float64],
        fields: Mapping[str, NDArray[Any]],
        about: Mapping[str, FieldInfo],
    ) -> None:
        """Write one frame.

        Parameters
        ----------
        time : float
            [s].
        points : (n, 3) float64 ndarray
            Where the points are [m]; n may differ from frame to frame.
        fields : mapping of str to ndarray
            Their fields, (n,) or (n, 3), the same ones in every frame.
        about : mapping of str to FieldInfo
            Unit and meaning of the fields.
        """
        sizes = [array.nbytes for array in (points, *fields.values())]
        reserve(self._file, 2 * sum(sizes), self._path)  # no chunk is longer than two frames
        if not self._series:
            self._series["Points"] = _Series(self._root, "Points", points)
            for name, values in fields.items():
                path = f"PointData/{name}"
                self._series[path] = _Series(self._root, path, values)
                info = about[name]
                self._root[path].attrs.update(unit=info.unit, description=info.description)
        self._series["Points"].append(points)
        for name, values in fields.items():
            self._series[f"PointData/{name}"].append(values)
        self._file.flush()
        self._times.append(time)
        self._counts.append(len(points))

    def __enter__(self) -> PointSeries:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            with writing(self._path):
                if error is None:
                    self._finish()
                self._file.close()
                if error is None:
                    self._draft.replace(self._path)
        finally:
            with suppress(OSError):
                self._draft.unlink()

    @property
    def _draft(self) -> Path:
        return self._path.with_name(self._path.name + ".part")

    def _finish(self) -> None:
        """Write where each frame begins."""
        root, frames = self._root, len(self._times)
        numbers = (20 + len(self._series)) * frames + 2 * max(self._counts, default=0)
        reserve(self._file, 8 * numbers, self._path)
        steps = root.create_group("Steps")
        steps.attrs["NSteps"] = frames
        steps["Values"] = self._times
        steps["PartOffsets"] = np.arange(frames)
        steps["NumberOfParts"] = np.ones(frames, dtype=np.int64)
        for path, series in self._series.items():
            group, _, name = path.rpartition("/")
            steps[f"{group}Offsets/{name}" if group else "PointOffsets"] = series.starts
        # Every frame finds its vertices at the start of the same list, point k at entry k.
        for name in ("CellOffsets", "ConnectivityIdOffsets"):
            steps[name] = np.zeros((frames, len(_CELLS)), dtype=np.int64)
        root["NumberOfPoints"] = self._counts
        for cells in _CELLS:
            counts = np.array(self._counts) if cells == "Vertices" else np.zeros(frames, np.int64)
            most = counts.max(initial=0)
            root[f"{cells}/NumberOfCells"] = root[f"{cells}/NumberOfConnectivityIds"] = counts
            root[f"{cells}/Connectivity"] = np.arange(most)
            root[f"{cells}/Offsets"] = np.arange(most + 1)


class _Series:
    """One array over all frames, and where each frame of it begins."""

    def __init__(self, group: h5py.Group, path: str, like: NDArray[Any]) -> None:
        row = like.shape[1:]
        self._dataset = group.create_dataset(
            path,
            shape=(0, *row),
            maxshape=(None, *row),
            chunks=(max(1, len(like)), *row),
            dtype=like.dtype,
        )
        self._last: NDArray[Any] | None = None
        self._end = 0
        self.starts: list[int] = []

    def append(self, values: NDArray[Any]) -> None:
        """Write a frame, unless it is the last one over again."""
        if self._last is not None and np.array_equal(self._last, values):
            self.starts.append(self.starts[-1])
            return
        self.starts.append(self._end)
        self._end += len(values)
        self._dataset.resize(self._end, axis=0)
        self._dataset[self.starts[-1] :] = values
        self._last = values
