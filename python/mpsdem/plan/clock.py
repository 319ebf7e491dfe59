"""Time in whole numbers of steps."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Clock:
    """Time as a function of the number of coupling steps, so that no sum of steps can drift.

    Frames stand at whole multiples of `every`, the last one at `end_time`; each is reached by
    `steps_per_frame` coupling steps of `substeps` solid steps. The last ones may be shorter.
    """

    end_time: float
    every: float
    steps_per_frame: int
    substeps: int

    @property
    def frames(self) -> int:
        """Frames after the first one, which stands at time 0."""
        return math.ceil(self.end_time / self.every * (1 - 1e-12))

    @property
    def steps(self) -> int:
        """Coupling steps in all."""
        return self.frames * self.steps_per_frame

    def time(self, step: int) -> float:
        """Time after `step` coupling steps [s]."""
        frame, part = divmod(step, self.steps_per_frame)
        if frame == self.frames:
            return self.end_time
        return frame * self.every + part * self.length(step + 1)

    def length(self, step: int) -> float:
        """Length of the coupling step that is counted as `step`, from 1 on [s]."""
        frame = (step - 1) // self.steps_per_frame
        interval = min(self.every, self.end_time - frame * self.every)
        if math.isclose(interval, self.every, rel_tol=1e-9):
            interval = self.every  # not the round-off of a difference, so that the end may be moved
        return interval / self.steps_per_frame
