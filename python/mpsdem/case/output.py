"""What a run leaves behind."""

from __future__ import annotations

from typing import Annotated, Literal

from mpsdem.case.part import FromList, Part
from mpsdem.case.units import Quantity, Whole


class Output(Part):
    """Frames, figures and checkpoints.

    Parameters
    ----------
    every : float
        Time between two frames of the results [s].
    figures : bool
        Whether the run ends with its report written and its figures drawn.
    times : tuple of float, optional
        Times of the side views and cross-sections [s]; by default the program chooses.
    liquid_stride : int, optional
        One of how many particles of a computed liquid is written, 0 for none; by default as many
        as keep a frame below 10,000 of them.
    checkpoint_every : float, optional
        Simulated time between two checkpoints [s]; by default one a minute of wall clock.
    on_plug : {"warn", "stop"}
        What happens when solids fill a section of the pipe and stand still while the bulk flow goes
        five diameters: the run goes on with a warning, or ends with the status "plug".
    """

    every: Annotated[float, Quantity("s", above=0.0)] = 0.1
    figures: bool = True
    times: Annotated[tuple[Annotated[float, Quantity("s", at_least=0.0)], ...], FromList] | None = (
        None
    )
    liquid_stride: Annotated[int, Whole(at_least=0)] | None = None
    checkpoint_every: Annotated[float, Quantity("s", above=0.0)] | None = None
    on_plug: Literal["warn", "stop"] = "warn"
