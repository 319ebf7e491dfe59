"""One look for all figures, without a trace in anybody's matplotlib settings."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from matplotlib import colormaps, rc_context
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, ListedColormap
from matplotlib.figure import Figure

SPEED_COLOURS = "viridis"
PRESSURE_COLOURS = "RdBu_r"
FRACTION_COLOURS = "Blues"
INK = "#222222"  # text, walls
FAINT = "#b8b8b8"  # walls of the bore, grid
BORE = "#f3f6f9"  # inside of the bore
ACCENTS = ("#c1432e", "#222222", "#2a6f97")  # front, centre, tail
DOTS_PER_INCH = 200

_STYLE = {
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "figure.titlesize": 10.0,
    "figure.titleweight": "bold",
    "axes.labelcolor": INK,
    "axes.edgecolor": INK,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": FAINT,
    "grid.linewidth": 0.4,
    "grid.alpha": 0.6,
    "lines.linewidth": 1.4,
    "legend.frameon": False,
    "legend.fontsize": 8.0,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
}


@contextmanager
def style() -> Iterator[None]:
    """Draw in the look of this package inside of the block."""
    with rc_context(_STYLE):  # type: ignore[arg-type]
        yield


def time_colours(count: int) -> list[tuple[float, float, float, float]]:
    """Colours for curves at successive times, dark to light; unlike those of speed."""
    scale: Colormap | ListedColormap = colormaps["plasma"]
    return [scale(0.85 * k / max(count - 1, 1)) for k in range(count)]


def axes_at(figure: Figure, left: float, bottom: float, width: float, height: float) -> Axes:
    """Axes with their lower left corner and size given in inches."""
    across, up = figure.get_size_inches()
    return figure.add_axes((left / across, bottom / up, width / across, height / up))
