"""How the walls of a pipe move over a step, for the kernels."""

from __future__ import annotations

import math

import numpy as np

from mpsdem._core import geometry
from mpsdem.case import MovingAxis


def bending(axis: MovingAxis, start: float, end: float) -> geometry.Bending:
    """The pipe's modes from `start` to `end` [s]."""
    modes = axis.motion.modes
    before, after = ([axis.motion.of_mode(mode, time) for mode in modes] for time in (start, end))
    return geometry.Bending(
        duration=end - start,
        wave_number=np.array(modes) * (math.pi / axis.length),
        displacement_before=np.array([mode.displacement for mode in before]),
        velocity_before=np.array([mode.velocity for mode in before]),
        displacement_after=np.array([mode.displacement for mode in after]),
        velocity_after=np.array([mode.velocity for mode in after]),
    )
