"""The axis of a pipe that moves: from the pipe to the laboratory and back."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mpsdem.case.motion import Motion

FloatArray = NDArray[np.float64]

_STATIONS = 2000  # over which the pressure along a bent axis is summed up


@dataclass(frozen=True, slots=True, kw_only=True)
class MovingAxis:
    """The axis of a pipe along x, w(x, t), whose cross-sections move as bodies.

    Seen from the pipe, a place counts from the axis in its own section, and a velocity is the rate
    at which that place changes: what goes with the pipe is at rest.

    Parameters
    ----------
    motion : Motion
        How it moves.
    length : float
        From inlet to outlet [m].
    """

    motion: Motion
    length: float

    def displacement(self, x: ArrayLike, time: float) -> FloatArray:
        """w, (n, 3) [m]; x (n,) [m]."""
        return self.motion.at(time, along=np.asarray(x) / self.length).displacement

    def velocity(self, x: ArrayLike, time: float) -> FloatArray:
        """dw/dt, (n, 3) [m/s]; x (n,) [m]."""
        return self.motion.at(time, along=np.asarray(x) / self.length).velocity

    def slope(self, x: ArrayLike, time: float) -> FloatArray:
        """dw/dx, (n, 3) [-]; x (n,) [m]."""
        return self._along(x, time, 1, "displacement")

    def _along(self, x: ArrayLike, time: float, order: int, name: str) -> FloatArray:
        """Derivative along the pipe of displacement or velocity."""
        x = np.asarray(x, dtype=np.float64)
        sum_ = np.zeros((*x.shape, 3))
        for mode in self.motion.modes:
            k = mode * math.pi / self.length
            # cos' = cos(. + pi / 2), and so on
            shape = k**order * np.cos(k * x + order * math.pi / 2)
            sum_ += np.multiply.outer(shape, getattr(self.motion.of_mode(mode, time), name))
        return sum_

    def place(self, position: FloatArray, time: float) -> FloatArray:
        """Places in the laboratory, (n, 3) [m], of positions in the pipe."""
        return position + self.displacement(position[:, 0], time)

    def position(self, place: FloatArray, time: float) -> FloatArray:
        """Positions in the pipe, (n, 3) [m], of places in the laboratory; x is the same."""
        return place - self.displacement(place[:, 0], time)

    def to_laboratory(self, velocity: FloatArray, x: FloatArray, time: float) -> FloatArray:
        """Velocities in the laboratory, (n, 3) [m/s], of those seen from the pipe at x (n,) [m]."""
        return velocity + self._of_section(velocity, x, time)

    def from_pipe(self, velocity: FloatArray, x: FloatArray, time: float) -> FloatArray:
        """Velocities seen from the pipe at x (n,) [m], (n, 3) [m/s], of those in the laboratory."""
        return velocity - self._of_section(velocity, x, time)

    def _of_section(self, velocity: FloatArray, x: FloatArray, time: float) -> FloatArray:
        # what goes along a slope goes across, too; along the pipe both see the same slope
        return self.velocity(x, time) + velocity[:, :1] * self.slope(x, time)

    def plug_gain(self, position: FloatArray, start: float, end: float, speed: float) -> FloatArray:
        """Velocity that a plug which follows the axis gains, (n, 3) [m/s].

        The known pressure that turns it also acts along the pipe, outside the axis.

        Parameters
        ----------
        position : (n, 3) float64 ndarray
            In the pipe, at the start [m].
        start, end : float
            [s].
        speed : float
            Of the plug along the pipe [m/s].
        """
        x = position[:, 0]
        later = x + speed * (end - start)

        def across(x: FloatArray, time: float, order: int) -> FloatArray:
            turn = self._along(x, time, order + 1, "displacement")
            return self._along(x, time, order, "velocity") + speed * turn

        gain = across(later, end, 0) - across(x, start, 0)
        turn = across(later, end, 1) - across(x, start, 1)
        gain[:, 0] = (turn[:, 1:] * position[:, 1:]).sum(axis=1)
        return gain

    def plug_pressure(self, position: FloatArray, time: float, speed: float) -> FloatArray:
        """Pressure over density that turns such a plug, (n,) [m2/s2]; 0 on the axis at the inlet.

        Parameters
        ----------
        position : (n, 3) float64 ndarray
            In the pipe [m].
        time : float
            [s].
        speed : float
            Of the plug along the pipe [m/s].
        """
        stations = np.linspace(0.0, self.length, _STATIONS + 1)
        known = (self._acceleration(stations, time, speed) * self.slope(stations, time)).sum(axis=1)
        along = np.concatenate([[0.0], np.cumsum(known[1:] + known[:-1]) / 2]) * stations[1]
        of_section = self._acceleration(position[:, 0], time, speed)
        on_axis: FloatArray = np.interp(position[:, 0], stations, along)
        pressure: FloatArray = -(of_section * position).sum(axis=1) - on_axis
        return pressure

    def _acceleration(self, x: FloatArray, time: float, speed: float) -> FloatArray:
        pipe = self.motion.at(time, along=x / self.length).acceleration
        turn = 2 * self._along(x, time, 1, "velocity")
        return pipe + speed * (turn + speed * self._along(x, time, 2, "displacement"))
