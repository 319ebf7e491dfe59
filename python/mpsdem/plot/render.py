"""Draw a scene in three dimensions: a program of its own, as OpenGL may take down what runs it.

Usage: ``render.py SCENE.npz PICTURE.npy``. Without a display VTK's own choice first complains about
X; and where neither EGL nor OSMesa is installed it ends in a segmentation fault.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

_LONGEST = 1700  # [pixels] of the picture
_DISTANCE = 2.5  # of the eye, over the size of the piece
_MARGIN = 1.02  # of the window over the pipe in it
_SIDES = 128  # of what is round
_FACETS = ((1000, 24), (20_000, 14))  # of a sphere, for up to so many spheres
_COARSEST = 8
_WALL, _EDGE = "#8fb0c4", "#222222"


def render(scene: Mapping[str, NDArray[Any]]) -> NDArray[np.uint8]:
    """Draw a piece of pipe with the solids in it.

    Parameters
    ----------
    scene : mapping of str to ndarray
        ``centre`` (n, 3) [m], x from the middle of the piece along the axis; ``diameter`` and
        ``speed`` (n,); ``disc`` (r, t, 3) [m] and ``disc_velocity`` (r, t), empty for none;
        ``pipe``, its radius and the length of the piece [m]; ``inclination`` [rad]; ``colours``,
        name of the scale; ``limits`` (2,) of it [m/s]; ``view`` (3,), from the piece to the eye.

    Returns
    -------
    (height, width, 3) uint8 ndarray
        The picture, without its white margins.
    """
    import pyvista

    radius, length = (float(value) for value in scene["pipe"])
    incline = -float(np.degrees(scene["inclination"]))
    wall = pyvista.Cylinder(
        radius=radius, height=length, direction=(1, 0, 0), resolution=_SIDES, capping=False
    ).rotate_y(incline)
    away = scene["view"] / np.linalg.norm(scene["view"])
    eye = _DISTANCE * np.hypot(length, 2 * radius) * away
    width, height = _MARGIN * _seen(np.asarray(wall.points), eye)
    size = [round(_LONGEST * side / max(width, height)) for side in (width, height)]
    plotter: Any = pyvista.Plotter(off_screen=True, window_size=size)
    plotter.set_background("white")

    limits = scene["limits"].tolist()
    colours: dict[str, Any] = {
        "cmap": str(scene["colours"]), "clim": limits, "show_scalar_bar": False
    }  # fmt: skip
    if len(scene["centre"]):
        solids = pyvista.PolyData(scene["centre"])
        solids["speed"], solids["diameter"] = scene["speed"], scene["diameter"]
        facets = next((f for most, f in _FACETS if solids.n_points <= most), _COARSEST)
        ball = pyvista.Sphere(radius=0.5, theta_resolution=facets, phi_resolution=facets)
        balls = solids.glyph(geom=ball, scale="diameter", orient=False).rotate_y(incline)
        actor = plotter.add_mesh(
            balls, scalars="speed", specular=0.3, specular_power=20, ambient=0.15, **colours
        )
        actor.prop.interpolation = "gouraud"
    if scene["disc"].size:
        disc = pyvista.StructuredGrid(*np.moveaxis(scene["disc"][:, :, None], -1, 0))
        disc["velocity"] = scene["disc_velocity"].ravel(order="F")
        plotter.add_mesh(disc.rotate_y(incline), scalars="velocity", lighting=False, **colours)
    plotter.add_mesh(
        wall, color=_WALL, opacity=0.16, smooth_shading=True, specular=0.6, specular_power=30
    )
    angle = np.linspace(0, 2 * np.pi, _SIDES + 1)
    for end in (-length / 2, length / 2):
        ring = np.column_stack(
            [np.full_like(angle, end), radius * np.cos(angle), radius * np.sin(angle)]
        )
        edge = pyvista.MultipleLines(ring).rotate_y(incline)
        plotter.add_mesh(edge, color=_EDGE, line_width=3)

    camera = plotter.camera
    camera.position, camera.focal_point, camera.up = tuple(eye), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
    camera.view_angle = 2 * float(np.degrees(np.arctan(height)))
    plotter.reset_camera_clipping_range()
    return _without_margins(np.asarray(plotter.screenshot(return_img=True)))


def _seen(points: NDArray[np.float64], eye: NDArray[np.float64]) -> NDArray[np.float64]:
    """Largest distances of points from the middle of the view, across and up, over their depth."""
    across = np.cross([0.0, 0.0, 1.0], eye)
    axes = [axis / np.linalg.norm(axis) for axis in (across, np.cross(eye, across), eye)]
    right, up, near = (points @ axis for axis in axes)
    depth = np.linalg.norm(eye) - near
    return np.array([np.abs(right / depth).max(), np.abs(up / depth).max()])


def _without_margins(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    inked = np.any(picture < 250, axis=2)
    rows, columns = (np.flatnonzero(np.any(inked, axis=axis)) for axis in (1, 0))
    return picture[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]


if __name__ == "__main__":
    if sys.platform == "linux" and not os.environ.get("DISPLAY"):
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    np.save(sys.argv[2], render(np.load(sys.argv[1])))
