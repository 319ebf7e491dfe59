"""How the pipe moves: harmonic vibrations, uniform or with a mode along the pipe, and tables."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import BeforeValidator, ModelWrapValidatorHandler, model_validator

from mpsdem.case.errors import Problem, refusal, validation_error
from mpsdem.case.part import FromList, Part
from mpsdem.case.units import Quantity, Whole

FloatArray = NDArray[np.float64]
Triple = tuple[float, float, float]

_AXES: Mapping[str, Triple] = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
_COLUMNS = ["t", "x", "y", "z"]

_Length = Annotated[float, Quantity("m")]
_Time = Annotated[float, Quantity("s")]
_Place = Annotated[tuple[_Length, _Length, _Length], FromList]


@dataclass(frozen=True, slots=True, kw_only=True)
class Movement:
    """Where a pipe is, and how it moves.

    Attributes
    ----------
    displacement : (..., 3) float64 ndarray
        From its place without motion [m].
    velocity : (..., 3) float64 ndarray
        Derivative of the displacement in time [m/s].
    acceleration : (..., 3) float64 ndarray
        Derivative of the velocity [m/s2].
    """

    displacement: FloatArray
    velocity: FloatArray
    acceleration: FloatArray

    def __add__(self, other: Movement) -> Movement:
        return Movement(
            displacement=self.displacement + other.displacement,
            velocity=self.velocity + other.velocity,
            acceleration=self.acceleration + other.acceleration,
        )

    def scaled(self, factor: FloatArray) -> Movement:
        """Each of them times a factor (...)."""
        factor = factor[..., None]
        return Movement(
            displacement=factor * self.displacement,
            velocity=factor * self.velocity,
            acceleration=factor * self.acceleration,
        )


def _as_direction(value: object) -> object:
    """Take the name of an axis, or three numbers that are not all zero."""
    if isinstance(value, str) and value in _AXES:
        return value
    rule = "must be 'x', 'y', 'z' or a vector of three numbers, not all zero"
    try:
        numbers = tuple(float(v) for v in value)  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        raise refusal(Problem(rule=rule)) from None
    if len(numbers) != 3 or not math.isfinite(sum(numbers)) or not any(numbers):
        raise refusal(Problem(rule=rule))
    return numbers


class Vibration(Part):
    """Harmonic vibration: displacement A cos(n pi x / L) sin(2 pi t / T + phase).

    Parameters
    ----------
    direction : {"x", "y", "z"} or tuple of float
        Axis, or a vector of any length.
    amplitude : float
        A [m].
    period : float, optional
        T [s].
    frequency : float, optional
        1 / T in place of it [Hz].
    phase : float
        Of the sine at t = 0 [rad].
    mode : int
        n, half waves along the pipe; 0 moves it as one body.
    ramp : float, optional
        Time in which the amplitude grows from zero [s]; by default a period. With 0 the pipe has
        always been vibrating: at t = 0 it goes with its full velocity, and so does all that is in
        it, as every velocity of a case counts from the pipe's.

    Notes
    -----
    The amplitude grows as the smoothest step of fifth degree, 10 s^3 - 15 s^4 + 6 s^5, s = t/ramp:
    displacement, velocity and acceleration start from zero and are continuous.
    """

    direction: Annotated[Literal["x", "y", "z"] | Triple, BeforeValidator(_as_direction)]
    amplitude: Annotated[float, Quantity("m", at_least=0.0)]
    period: Annotated[float, Quantity("s", above=0.0)] | None = None
    frequency: Annotated[float, Quantity("Hz", above=0.0)] | None = None
    phase: Annotated[float, Quantity("rad")] = 0.0
    mode: Annotated[int, Whole(at_least=0)] = 0
    ramp: Annotated[float, Quantity("s", at_least=0.0)] | None = None

    def problems(self) -> Iterable[Problem]:
        given = [name for name in ("period", "frequency") if getattr(self, name) is not None]
        if len(given) != 1:
            yield Problem(
                field="period",
                value=self.period,
                rule="a vibration takes either period or frequency",
                remedy="leave out one" if given else "give one of them",
            )
        if self.mode > 0 and self.axis[0] != 0:
            yield Problem(
                field="direction",
                value=self.direction,
                rule=f"must be normal to the pipe in mode {self.mode}: a pipe does not stretch",
                remedy="take 'y', 'z' or a vector between them, or mode = 0",
            )

    @property
    def axis(self) -> FloatArray:
        """Unit vector of the direction, (3,)."""
        given = self.direction
        vector = np.array(_AXES[given] if isinstance(given, str) else given)
        vector /= np.abs(vector).max()  # whose squares are numbers, whatever its length
        unit: FloatArray = vector / np.linalg.norm(vector)
        return unit

    @property
    def resolved_period(self) -> float:
        """Time of one vibration [s]."""
        if self.period is not None:
            return self.period
        assert self.frequency is not None
        return 1 / self.frequency

    @property
    def resolved_ramp(self) -> float:
        """Time in which the amplitude grows [s]."""
        return self.resolved_period if self.ramp is None else self.ramp

    @property
    def looks(self) -> FloatArray:
        """Times that show the extremes of its growth and of a period after it [s]."""
        ramp, period = self.resolved_ramp, self.resolved_period
        grown = ramp + np.linspace(0.0, period, 65)
        return np.concatenate([np.linspace(0.0, ramp, 65), grown])

    def at(self, time: FloatArray) -> Movement:
        """The pipe where the mode is largest, at times (...) [s]."""
        rate = 2 * math.pi / self.resolved_period  # [rad/s]
        angle = rate * time + self.phase
        sine, cosine = np.sin(angle), np.cos(angle)
        grown, growth, curve = _smooth_step(time, self.resolved_ramp)
        laws = (
            grown * sine,
            growth * sine + rate * grown * cosine,
            curve * sine + 2 * rate * growth * cosine - rate**2 * grown * sine,
        )
        way = self.amplitude * self.axis
        place, velocity, acceleration = (np.multiply.outer(law, way) for law in laws)
        return Movement(displacement=place, velocity=velocity, acceleration=acceleration)


def _smooth_step(time: FloatArray, ramp: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Growth from 0 to 1 [-], and its derivatives in time [1/s, 1/s2]."""
    if ramp == 0:
        return np.ones_like(time), np.zeros_like(time), np.zeros_like(time)
    s = np.clip(time / ramp, 0.0, 1.0)
    return (
        s**3 * (10 + s * (6 * s - 15)),
        30 * (s * (1 - s)) ** 2 / ramp,
        60 * s * (1 - s) * (1 - 2 * s) / ramp**2,
    )


class Motion(Part):
    """How the pipe moves; all parts add up.

    Parameters
    ----------
    vibration : Vibration or tuple of Vibration
        Harmonic parts.
    times : tuple of float, optional
        Times (n,) of a table [s], in order.
    displacements : tuple of tuple of float, optional
        Where the pipe is at those times, (n, 3) [m].
    file : str, optional
        CSV file with columns t, x, y, z [s, m] and a line that names them, in place of `times` and
        `displacements`, which it fills; its path counts from the case file.
    walls : {"auto", "fixed", "moving"}
        Frame of the computation. Fixed: that of the pipe, in which its acceleration is a force on
        the solids. Moving: walls go through the liquid. ``"auto"``: moving where the pipe flexes.

    Notes
    -----
    Between its entries a table is a cubic spline, whose acceleration is continuous. At its first
    time, and before, the pipe is at rest. A table lasts as long as the run: a record may be cut at
    any moment, without a stop there; to let the pipe come to rest, repeat its last place.
    """

    vibration: Annotated[
        tuple[Vibration, ...],
        BeforeValidator(
            lambda value: (value,) if isinstance(value, Mapping | Vibration) else value
        ),
        FromList,
    ] = ()
    times: Annotated[tuple[_Time, ...], FromList] | None = None
    displacements: Annotated[tuple[_Place, ...], FromList] | None = None
    file: str | None = None
    walls: Literal["auto", "fixed", "moving"] = "auto"

    @model_validator(mode="wrap")
    @classmethod
    def _read_file(cls, data: Any, handler: ModelWrapValidatorHandler[Motion]) -> Motion:
        if not isinstance(data, Mapping) or not isinstance(data.get("file"), str):
            return handler(data)
        rest = {key: value for key, value in data.items() if key != "file"}
        for name in ("times", "displacements"):
            if rest.get(name) is not None:
                rule, remedy = f"a file gives {name} too", "leave out one of them"
                problem = Problem(field="file", value=data["file"], rule=rule, remedy=remedy)
                raise validation_error(cls.__name__, [problem])
        try:
            table = _read_table(Path(data["file"]))
        except ValueError as error:
            problem = Problem(field="file", value=data["file"], rule=str(error))
            raise validation_error(cls.__name__, [problem]) from None
        times, displacements = table[:, 0].tolist(), table[:, 1:].tolist()
        return handler({**rest, "times": times, "displacements": displacements})

    def problems(self) -> Iterable[Problem]:
        yield from self._wrong_table()
        if self.flexes and self.walls == "fixed":
            yield Problem(
                field="walls",
                value="fixed",
                rule="a pipe that flexes has no frame in which it is at rest",
                remedy="leave it out, or take mode = 0",
            )

    def _wrong_table(self) -> Iterable[Problem]:
        times, places = self.times, self.displacements
        if (times is None) != (places is None):
            missing = "displacements" if places is None else "times"
            yield Problem(field=missing, rule="a table needs both times and displacements")
        if times is None or places is None:
            return
        if len(times) < 2 or any(b <= a for a, b in pairwise(times)):
            rule = "must be two times or more, each after the one before"
            yield Problem(field="times", value=times, unit="s", rule=rule)
        if len(places) != len(times):
            yield Problem(
                field="displacements",
                value=places,
                rule=f"must have {len(times)} entries, one per time",
            )

    @property
    def modes(self) -> tuple[int, ...]:
        """Modes in which the pipe moves, in order; none for a pipe at rest."""
        modes = {part.mode for part in self.vibration if part.amplitude > 0}
        if self.displacements is not None and len(set(self.displacements)) > 1:
            modes.add(0)
        return tuple(sorted(modes))

    @property
    def at_rest(self) -> bool:
        """Whether the pipe does not move."""
        return not self.modes

    @property
    def flexes(self) -> bool:
        """Whether the pipe moves otherwise than as one body."""
        return any(self.modes)

    @property
    def moves_walls(self) -> bool:
        """Whether walls go through the liquid, instead of a force in the frame of the pipe."""
        return self.flexes or (self.walls == "moving" and not self.at_rest)

    def of_mode(self, mode: int, time: ArrayLike) -> Movement:
        """What moves in one mode, where that is largest.

        Parameters
        ----------
        mode : int
            Which.
        time : array_like
            (...) [s].
        """
        time = np.asarray(time, dtype=np.float64)
        nothing = np.zeros((*time.shape, 3))
        sum_ = Movement(displacement=nothing, velocity=nothing, acceleration=nothing)
        for part in self.vibration:
            if part.mode == mode:
                sum_ += part.at(time)
        if mode == 0 and self.displacements is not None:
            sum_ += self._of_table(time)
        return sum_

    def at(self, time: ArrayLike, *, along: ArrayLike = 0.0) -> Movement:
        """Where the pipe is, and how it moves.

        Parameters
        ----------
        time : array_like
            [s].
        along : array_like
            Distance from the inlet over the length of the pipe [-], of a shape that goes with that
            of `time`.
        """
        along = np.asarray(along, dtype=np.float64)
        shape = np.broadcast_shapes(np.shape(time), along.shape)
        sum_ = self.of_mode(0, np.broadcast_to(time, shape))
        for mode in self.modes:
            if mode > 0:
                sum_ += self.of_mode(mode, time).scaled(np.cos(mode * math.pi * along))
        return sum_

    def _of_table(self, time: FloatArray) -> Movement:
        assert self.times is not None
        within = (time >= self.times[0]) & (time <= self.times[-1])
        inside = np.clip(time, self.times[0], self.times[-1])
        place, velocity, acceleration = (self._spline(inside, order) for order in (0, 1, 2))
        return Movement(
            displacement=place,
            velocity=np.where(within[..., None], velocity, 0.0),
            acceleration=np.where(within[..., None], acceleration, 0.0),
        )

    @cached_property
    def _spline(self) -> Any:
        from scipy.interpolate import CubicSpline  # slow to load, for the few that have a table

        assert self.times is not None
        assert self.displacements is not None
        if len(self.times) == 2:
            return CubicSpline(self.times, self.displacements, bc_type="clamped")
        ends: Any = (1, np.zeros(3)), "not-a-knot"
        return CubicSpline(self.times, self.displacements, bc_type=ends)

    @property
    def peak_speed(self) -> float:
        """Speed that the pipe does not exceed [m/s]."""
        return sum(speed for speed, _ in self._peaks)

    @property
    def peak_acceleration(self) -> float:
        """Acceleration that the pipe does not exceed [m/s2]."""
        return sum(acceleration for _, acceleration in self._peaks)

    def steepest(self, length: float) -> float:
        """Slope of the axis that the modes of a pipe of that length [m] do not exceed [-]."""
        return sum(part.amplitude * part.mode for part in self.vibration) * math.pi / length

    def sharpest(self, length: float) -> float:
        """Curvature of the axis that they do not exceed [1/m]."""
        waves = [part.mode * math.pi / length for part in self.vibration]
        bends = zip(self.vibration, waves, strict=True)
        return sum(part.amplitude * wave**2 for part, wave in bends)

    @property
    def shortest_period(self) -> float:
        """Of all vibrations, and for a table of a sine as fast and as steep [s]; else infinite."""
        periods = [part.resolved_period for part in self.vibration if part.amplitude > 0]
        if self.displacements is not None:
            speed, acceleration = self._peaks[-1]
            periods += [2 * math.pi * speed / acceleration] if acceleration > 0 else []
        return min(periods, default=math.inf)

    @property
    def _peaks(self) -> list[tuple[float, float]]:
        """Largest speed and acceleration of each part, the table last, to a few percent."""
        peaks = [part.at(part.looks) for part in self.vibration]
        if self.times is not None:
            knots = np.arange(len(self.times))
            peaks.append(
                self._of_table(np.interp(np.arange(8 * knots[-1] + 1) / 8, knots, self.times))
            )
        return [
            (
                float(np.linalg.norm(peak.velocity, axis=1).max()),
                float(np.linalg.norm(peak.acceleration, axis=1).max()),
            )
            for peak in peaks
        ]


def _read_table(path: Path) -> FloatArray:
    """Times and displacements (n, 4) [s, m] of a CSV file; ValueError in words if it has none."""
    try:
        with path.open(encoding="utf-8", newline="") as file:
            header, *rows = [row for row in csv.reader(file) if row]
    except OSError as error:
        raise ValueError(f"cannot be read: {error.strerror}") from None
    except (UnicodeDecodeError, csv.Error):
        raise ValueError("is not a table of comma-separated values in UTF-8") from None
    except ValueError:
        raise ValueError("is empty") from None
    if [name.strip() for name in header] != _COLUMNS:
        raise ValueError("must begin with the line 't,x,y,z', times in s and displacements in m")
    for number, row in enumerate(rows, start=2):
        try:
            values = [float(entry) for entry in row]
        except ValueError:
            values = []
        if len(values) != len(_COLUMNS) or not math.isfinite(sum(values)):
            raise ValueError(f"must have four numbers in each row, unlike row {number}")
    return np.array(rows, dtype=np.float64).reshape(-1, len(_COLUMNS))
