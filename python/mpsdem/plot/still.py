"""A run in three dimensions: the pipe where most of its solids are, and the liquid behind them."""

from __future__ import annotations

import logging
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.spatial import cKDTree  # type: ignore[import-untyped, unused-ignore]

from mpsdem.plot import render
from mpsdem.plot.drawing import colour_bar
from mpsdem.plot.frames import heading, when
from mpsdem.plot.style import DOTS_PER_INCH, SPEED_COLOURS, axes_at, style
from mpsdem.results import MissingExtraError, Results
from mpsdem.results.export import liquid_cloud
from mpsdem.results.files import make_directory, writing

FloatArray = NDArray[np.float64]

log = logging.getLogger(__name__)

_MOST_SHOWN = 0.8  # share of the solids that the piece shall show, if it can
_PIECES = np.arange(3.0, 6.5, 0.5)  # diameters of the bore that a piece may be long
_STARTS = 200  # places of it that are tried
_VIEW = (-0.75, -1.0, 0.45)  # to the eye: upstream, to the right of the flow, above
_NEIGHBORS = 8  # of the liquid that a point of the disc is a mean of
_DISC = (20, 96)  # points of it, outwards and around
_PATIENCE = 120.0  # [s]
_WIDEST, _TALLEST = 8.4, 7.0  # [in] of the picture


class RenderError(RuntimeError):
    """Nothing here can draw in three dimensions."""


def save_still(
    results: Results,
    directory: str | os.PathLike[str],
    *,
    times: Sequence[float] | None = None,
) -> list[Path]:
    """Draw ``still.png`` if this machine can, else say in the log why not.

    Parameters
    ----------
    results : Results
        The run; without solids nothing is drawn.
    directory : path-like
        Where the file goes, created where absent.
    times : sequence of float, optional
        Times of side views [s], of which the last is drawn; by default the last frame.

    Returns
    -------
    list of Path
        The file, if there is one.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    if not results.has_solids or not results.time.size:
        return []
    try:
        figure = still_picture(results, max(times) if times else None)
    except (MissingExtraError, RenderError) as reason:
        log.warning("no still.png: %s", reason)
        return []
    path = make_directory(Path(directory)) / "still.png"
    with writing(path):
        figure.savefig(path, dpi=DOTS_PER_INCH, bbox_inches="tight")
    return [path]


def still_picture(results: Results, time: float | None = None) -> Figure:
    """The pipe with its solids in three dimensions, where most of them are.

    Parameters
    ----------
    results : Results
        A run with solids.
    time : float, optional
        When [s]; by default the last frame.

    Returns
    -------
    Figure
        The shortest piece of pipe that holds four of five solids, from three to six diameters of
        it, inclined as it is, seen from upstream. Solids by their speed; at the downstream end, if
        the liquid is known there, a disc with its axial velocity.

    Raises
    ------
    MissingExtraError
        If pyvista is not installed.
    RenderError
        If it cannot draw on this machine.
    """
    if find_spec("pyvista") is None:
        raise MissingExtraError("a picture in three dimensions", "pyvista")
    frame = results.frames_at([results.time[-1] if time is None else time])[0]
    pipe, solids = results.case.pipe, results.solids
    position = solids.position[frame]
    piece = _piece(position[:, 0], 2 * pipe.radius, pipe.length, periodic=not pipe.has_plate)
    along = piece.from_its_middle(position[:, 0])
    shown = np.abs(along) <= piece.length / 2
    speed = np.linalg.norm(solids.velocity[frame], axis=1)[shown]
    disc, velocity = _disc(results, frame, piece)
    norm = _norm(results, speed, velocity)
    picture = _drawn(
        centre=np.column_stack([along, position[:, 1:]])[shown],
        diameter=2 * solids.radius[shown],
        speed=speed,
        disc=disc,
        disc_velocity=velocity,
        pipe=(pipe.radius, piece.length),
        inclination=pipe.inclination,
        colours=SPEED_COLOURS,
        limits=(norm.vmin, norm.vmax),
        view=_VIEW,
    )
    height, width = picture.shape[:2]
    across = min(_WIDEST, _TALLEST * width / height)
    with style():
        figure = Figure(figsize=(across + 1.4, across * height / width + 0.9))
        axes = axes_at(figure, 0.2, 0.4, across, across * height / width)
        axes.imshow(picture, interpolation="antialiased")
        axes.set_axis_off()
        subject = f"{piece} at {when(results.time[frame])}"
        axes.set_title(heading(results, subject), pad=10)
        note = f"bore {2 * pipe.radius:.3g} m"
        if velocity.size:
            note += "; disc at the downstream end: axial velocity of the liquid"
        axes.text(0, -0.02, note, transform=axes.transAxes, va="top", size=8)
        everything = np.concatenate([speed, velocity.ravel(), [0.0]])
        colour_bar(
            figure, [axes], norm, SPEED_COLOURS, label="speed (m/s)",
            values=(float(everything.min()), float(everything.max())),
        )  # fmt: skip
    return figure


@dataclass(frozen=True, slots=True, kw_only=True)
class _Piece:
    """A piece of pipe, which may go over a periodic end."""

    start: float  # [m]
    length: float  # [m]
    period: float  # [m] of the pipe

    def from_its_middle(self, x: FloatArray) -> FloatArray:
        """Distances along the axis [m]."""
        half = self.period / 2
        away: FloatArray = np.remainder(x - self.start - self.length / 2 + half, self.period) - half
        return away

    def __str__(self) -> str:
        if self.length == self.period:
            return "all of the pipe"
        return f"{self.length:.3g} m of the pipe from x = {self.start:.3g} m"


def _piece(x: FloatArray, diameter: float, length: float, *, periodic: bool) -> _Piece:
    """The shortest piece of pipe with most of the solids, whose places are `x` [m]."""
    sizes = [min(length, size * diameter) for size in _PIECES]
    for size in sizes:
        last = length if periodic and size < length else length - size
        starts = np.linspace(0.0, last, _STARTS, endpoint=not periodic)
        inside = np.remainder(x - starts[:, None], length) < size
        counts = np.count_nonzero(inside, axis=1)
        if counts.max() >= _MOST_SHOWN * x.size:
            break
    best = starts[counts == counts.max()]
    return _Piece(start=float(best[best.size // 2]), length=size, period=length)


def _disc(results: Results, frame: int, piece: _Piece) -> tuple[FloatArray, FloatArray]:
    """Points of the downstream end of a piece, (r, t, 3) [m], and the axial velocity there."""
    nothing = np.empty((0, 0, 3)), np.empty((0, 0))
    if not results.has_liquid:
        return nothing
    liquid = results.liquid
    r = np.linspace(0.0, results.case.pipe.radius, _DISC[0])
    angle = np.linspace(0.0, 2 * np.pi, _DISC[1])
    disc = np.stack(
        [
            np.full(_DISC, piece.length / 2),
            np.outer(r, np.cos(angle)),
            np.outer(r, np.sin(angle)),
        ],
        axis=-1,
    )
    if liquid.is_prescribed:
        along = np.interp(r, liquid.profile_radius, liquid.profile_velocity)
        return disc, np.repeat(along[:, None], angle.size, axis=1)
    if not liquid.has_particles:
        return nothing
    cloud = liquid_cloud(results, frame)
    x = cloud.points[:, 0]
    bore = (x >= 0) & (x < piece.period)  # a push plate moves liquid beyond either end
    place = np.column_stack([piece.from_its_middle(x), cloud.points[:, 1:]])[bore]
    away, nearest = cKDTree(place).query(disc, k=min(_NEIGHBORS, len(place)))
    weight = 1 / (away**2 + (r[1] - r[0]) ** 2)
    velocity = cloud.fields["velocity"][bore, 0][nearest]
    return disc, (weight * velocity).sum(axis=-1) / weight.sum(axis=-1)


def _norm(results: Results, speed: FloatArray, velocity: FloatArray) -> Normalize:
    """Colours from rest to the fastest of solids and liquid."""
    liquid = results.case.liquid
    bulk = abs(liquid.bulk_velocity or 0.0) if liquid is not None else 0.0
    top = max(bulk, float(velocity.max(initial=0.0))) or float(speed.max(initial=0.0)) or 1.0
    return Normalize(0.0, top)


def _drawn(**scene: Any) -> NDArray[np.uint8]:
    """What `render` makes of a scene, in a process that may crash."""
    with TemporaryDirectory() as folder:
        given, made = Path(folder, "scene.npz"), Path(folder, "picture.npy")
        np.savez(given, **scene)
        command = [sys.executable, "-P", render.__file__, str(given), str(made)]
        try:
            done = subprocess.run(command, capture_output=True, timeout=_PATIENCE, check=False)
        except subprocess.TimeoutExpired:
            raise RenderError(f"pyvista drew for longer than {_PATIENCE:g} s") from None
        if done.returncode or not made.exists():
            raise RenderError(
                "pyvista cannot draw here: it needs OpenGL, on a machine without a display from "
                "EGL (Debian: libegl1 libgl1-mesa-dri) or OSMesa (libosmesa6)"
            )
        picture: NDArray[np.uint8] = np.load(made)
        return picture
