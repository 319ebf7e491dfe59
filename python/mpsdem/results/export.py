"""A run for ParaView and other programs that read VTK's formats."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from mpsdem.results.errors import MissingExtraError, ResultsError
from mpsdem.results.fields import LIQUID, SOLIDS, FieldInfo
from mpsdem.results.files import make_directory, write_atomically, writing
from mpsdem.results.reader import LIQUID_KIND, Results
from mpsdem.results.vtkhdf import PointSeries

FORMATS = ("vtkhdf", "vtp", "vtu", "vtk")
SNAPSHOTS = ("vtu", "vtk")  # of which the last frame alone is written by default

OF_SOLIDS = (
    "radius",
    "density",
    "velocity",
    "spin",
    "laps",
    "void_fraction",
    "liquid_velocity",
    "drag_force",
)
OF_LIQUID = ("velocity", "pressure")
_FULL_PRESSURE = FieldInfo(unit="Pa", description="Pressure with mean gradient and static head")
ABOUT: Mapping[str, Mapping[str, FieldInfo]] = MappingProxyType(
    {"solids": SOLIDS, "liquid": {**LIQUID, "full_pressure": _FULL_PRESSURE}}
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Cloud:
    """The solids or the liquid in one frame, as points with fields.

    Parameters
    ----------
    points : (n, 3) float64 ndarray
        Where they are [m], in the axes of the pipe.
    fields : dict of str to ndarray
        What is known of each, (n,) or (n, 3), by the names in `mpsdem.results.fields`.
    """

    points: NDArray[np.float64]
    fields: dict[str, NDArray[Any]]


CloudAt: TypeAlias = Callable[[int], Cloud]


def export(
    results: Results,
    directory: str | os.PathLike[str],
    *,
    to: str = "vtkhdf",
    frames: Sequence[int] | None = None,
) -> list[Path]:
    """Write the solids, and the liquid where it was recorded, as points with all their fields.

    Parameters
    ----------
    results : Results
        The run; it may still go on.
    directory : path-like
        Where the files go, created where absent.
    to : {"vtkhdf", "vtp", "vtu", "vtk"}
        ``"vtkhdf"``: one file of all frames; ``"vtp"``: a file a frame, and a ``.pvd`` that lists
        them with their times, through pyvista; ``"vtu"``, ``"vtk"``: snapshots, through meshio.
    frames : sequence of int, optional
        Which; by default all, of snapshots the last.

    Returns
    -------
    list of Path
        What to open, of the solids and of the liquid.

    Raises
    ------
    ResultsError
        If the run has no such frames.
    MissingExtraError
        If `to` needs a package that is not installed.
    OutputError
        If the files cannot be written.

    Notes
    -----
    One frame at a time is in the memory. Only particles of liquid are written, neither those of the
    wall nor places that hold none in a frame.
    """
    if to not in FORMATS:
        raise ValueError(f"to = {to!r} must be one of {', '.join(FORMATS)}")
    if frames is None:
        every = range(results.time.size)
        frames = every[-1:] if to in SNAPSHOTS else every
    if not frames:
        raise ResultsError(f"the run in {results.directory} has no frames yet")
    write = {"vtkhdf": _write_series, "vtp": _write_collection}.get(to, _write_snapshots)
    folder = make_directory(Path(directory))
    return [
        path
        for name, cloud_at in _recorded(results)
        for path in write(results, folder / f"{name}.{to}", frames, cloud_at)
    ]


def solids_cloud(results: Results, frame: int) -> Cloud:
    """The solids in one frame."""
    solids = results.solids
    constant = {"radius": solids.radius, "density": solids.density}
    moving = {
        name: getattr(solids, name)[frame]
        for name in OF_SOLIDS
        if name not in constant and name in solids
    }
    return Cloud(points=solids.position[frame], fields=constant | moving)


def liquid_cloud(results: Results, frame: int) -> Cloud:
    """The recorded particles or nodes of liquid in one frame."""
    liquid = results.liquid
    position = liquid.position[frame]
    fields = {name: getattr(liquid, name)[frame] for name in OF_LIQUID}
    fields["full_pressure"] = liquid.full_pressure(frame)
    flows = (liquid.kind == LIQUID_KIND) & np.isfinite(position[:, 0])
    return Cloud(points=position[flows], fields={k: v[flows] for k, v in fields.items()})


def _recorded(results: Results) -> Iterator[tuple[str, CloudAt]]:
    if results.has_solids:
        yield "solids", lambda frame: solids_cloud(results, frame)
    if results.has_liquid and results.liquid.has_particles:
        yield "liquid", lambda frame: liquid_cloud(results, frame)


def _write_series(
    results: Results, path: Path, frames: Sequence[int], cloud_at: CloudAt
) -> list[Path]:
    with PointSeries(path, case=results.case_toml) as series:
        for frame in frames:
            cloud = cloud_at(frame)
            series.append(results.time[frame], cloud.points, cloud.fields, ABOUT[path.stem])
    return [path]


def _write_collection(
    results: Results, path: Path, frames: Sequence[int], cloud_at: CloudAt
) -> list[Path]:
    try:
        import pyvista
        from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
    except ImportError:
        raise MissingExtraError("export to vtp", "pyvista") from None
    entries = []
    for frame in frames:
        cloud, piece = cloud_at(frame), _numbered(path, frame)
        points = pyvista.PolyData(cloud.points)
        points.point_data.update(cloud.fields)
        # VTK does not survive a full disk: it writes a text, and the text goes to the disk.
        writer = vtkXMLPolyDataWriter()
        writer.SetInputData(points)
        writer.SetDataModeToBinary()
        writer.WriteToOutputStringOn()
        writer.Write()
        write_atomically(piece, writer.GetOutputString().encode())
        time = float(results.time[frame])
        entries.append(f'    <DataSet timestep="{time!r}" file="{piece.name}"/>\n')
    list_of_all = path.with_suffix(".pvd")
    write_atomically(list_of_all, _PVD.format("".join(entries)).encode())
    return [list_of_all]


_PVD = """<?xml version="1.0"?>
<VTKFile type="Collection" version="0.1">
  <Collection>
{}  </Collection>
</VTKFile>
"""


def _write_snapshots(
    results: Results,  # noqa: ARG001  as of the series
    path: Path,
    frames: Sequence[int],
    cloud_at: CloudAt,
) -> list[Path]:
    try:
        import meshio  # type: ignore[import-untyped, unused-ignore]
    except ImportError:
        raise MissingExtraError(f"export to {path.suffix[1:]}", "meshio") from None
    paths = []
    for frame in frames:
        cloud, snapshot = cloud_at(frame), _numbered(path, frame)
        vertices = ("vertex", np.arange(len(cloud.points))[:, None])
        mesh = meshio.Mesh(cloud.points, [vertices], point_data=cloud.fields)
        with writing(snapshot):
            mesh.write(snapshot)
        paths.append(snapshot)
    return paths


def _numbered(path: Path, frame: int) -> Path:
    return path.with_stem(f"{path.stem}_{frame:05d}")
