"""The case: everything that decides a run, as one value that TOML can hold."""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Self

import numpy as np

from mpsdem.case.axis import MovingAxis
from mpsdem.case.errors import CaseError, Problem
from mpsdem.case.fidelity import Fidelity
from mpsdem.case.liquid import Liquid
from mpsdem.case.motion import Motion
from mpsdem.case.output import Output
from mpsdem.case.part import Part
from mpsdem.case.pipe import Pipe
from mpsdem.case.solids import Block, List, Random, Solids
from mpsdem.case.units import Quantity

# Densest random packing of equal spheres; Scott & Kilgour (1969), doi:10.1088/0022-3727/2/6/311.
_DENSEST_PACKING = 0.64
_STEEPEST = 0.5  # [-] of a bent axis; the bore across it is then a tenth narrower than said
_SHARPEST = 0.5  # [-] the inside of a bend is so much shorter; liquid is sane at 0.44, not at 0.7
_SAMPLES = np.linspace(0.0, 1.0, 101)  # of the time, where a motion along the pipe shows


class Case(Part):
    """A pipe, what is in it, and how accurately to compute it. SI units.

    Axes: x along the pipe from its inlet, y horizontal, z normal to the axis in the vertical plane
    (up when the pipe is level); y = z = 0 on the axis.

    Parameters
    ----------
    title : str
        What the figures are headed with.
    end_time : float
        Time at which the run stops [s]; it starts at 0.
    gravity : float
        Magnitude of the acceleration of gravity [m/s2]; 0 switches it off.
    pipe : Pipe
        The bore.
    liquid : Liquid, optional
        What fills it; None for dry solids.
    solids : Solids, optional
        What is carried; None for clear liquid.
    motion : Motion
        How the pipe moves; at rest by default.
    fidelity : Fidelity
        Numerics; all else is nature.
    output : Output
        What the run leaves behind.

    Raises
    ------
    CaseError
        If anything is wrong, with all of it.
    """

    title: str = ""
    end_time: Annotated[float, Quantity("s", above=0.0)]
    gravity: Annotated[float, Quantity("m/s2", at_least=0.0)] = 9.807
    pipe: Pipe
    liquid: Liquid | None = None
    solids: Solids | None = None
    motion: Motion = Motion()
    fidelity: Fidelity = Fidelity()
    output: Output = Output()

    @classmethod
    def from_toml(cls, text: str, folder: str | Path = ".") -> Self:
        """Read a case from TOML.

        Parameters
        ----------
        text : str
            The case.
        folder : path-like
            From which the paths of other files in it count.

        Raises
        ------
        CaseError
            If `text` is not TOML, or not a case.
        """
        try:
            table = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            raise CaseError([Problem(rule=f"not valid TOML: {error}")]) from None
        motion = table.get("motion")
        if isinstance(motion, dict) and isinstance(motion.get("file"), str):
            motion["file"] = str(Path(folder, motion["file"]))
        return cls(**table)

    def to_toml(self) -> str:
        """Write the case as TOML, all defaults resolved; `from_toml` gives back an equal case."""
        table = self.model_dump(exclude_none=True)
        scalars = {key: value for key, value in table.items() if not isinstance(value, dict)}
        blocks = [_toml_lines(scalars)] + [
            f"[{key}]\n{_toml_lines(value)}" for key, value in table.items() if key not in scalars
        ]
        return "\n".join(blocks)

    def with_(self, **changes: Any) -> Self:
        """Make a case that differs from this one.

        Parameters
        ----------
        **changes
            Fields with their new values. A dict is merged into the table it names, at any depth;
            None takes an optional field out.

        Returns
        -------
        Case
            The new case, checked as if it were read from a file.

        Examples
        --------
        >>> from mpsdem.case import Case
        >>> case = Case(
        ...     end_time=1.0,
        ...     pipe={"radius": 0.1, "length": 4.0},
        ...     liquid={"density": 1000.0, "kinematic_viscosity": 1e-6, "bulk_velocity": 1.0},
        ... )
        >>> case.with_(liquid={"bulk_velocity": "2 m/s"}).liquid.bulk_velocity
        2.0
        """
        return type(self)(**_merged(self.model_dump(exclude_none=True), changes))

    def with_settings(self, settings: Sequence[str]) -> Self:
        """Make a case with dotted keys set, as on the command line.

        Parameters
        ----------
        settings : sequence of str
            ``"solids.density=2500"``; a value that is not TOML, such as ``20 mm``, is a string.
        """
        changes: dict[str, Any] = {}
        for setting in settings:
            key, equals, text = setting.partition("=")
            if not equals or not key.strip():
                rule = f"{setting!r} must have the form key=value, such as solids.density=2500"
                raise CaseError([Problem(rule=rule)])
            *parents, last = key.strip().split(".")
            change: dict[str, Any] = {last: _toml_value(text.strip())}
            for parent in reversed(parents):
                change = {parent: change}
            changes = _merged(changes, change)
        return self.with_(**changes)

    def differences(self, other: Case) -> list[str]:
        """List the dotted keys in which two cases differ, with both values.

        Parameters
        ----------
        other : Case
            The case to compare with; its values are named second.
        """
        ours, theirs = _flat(self.model_dump()), _flat(other.model_dump())
        return [
            f"{key}: {_shown(ours.get(key))} != {_shown(theirs.get(key))}"
            for key in ours | theirs
            if ours.get(key) != theirs.get(key)
        ]

    @property
    def gravity_vector(self) -> tuple[float, float, float]:
        """Gravity in the axes of the pipe [m/s2]."""
        rise = self.pipe.inclination
        return -self.gravity * math.sin(rise), 0.0, -self.gravity * math.cos(rise)

    @property
    def solids_count(self) -> int:
        """Number of solids."""
        if self.solids is None:
            return 0
        match self.solids.arrangement:
            case List(positions=positions):
                return len(positions)
            case Block(count=count, counts=counts):
                return math.prod(counts) if count is None else count
        if self.solids.count is not None:
            return self.solids.count
        assert self.solids.volume_fraction is not None
        return round(self.solids.volume_fraction * self.pipe.bore_volume / self.solids.mean_volume)

    @property
    def solids_fraction(self) -> float:
        """Volume of the solids over that of the bore [-]."""
        volume = 0.0 if self.solids is None else self.solids_count * self.solids.mean_volume
        return volume / self.pipe.bore_volume

    def problems(self) -> Iterable[Problem]:
        """Yield what is wrong across parts."""
        if self.liquid is None and self.solids is None:
            yield Problem(rule="a case needs [liquid], [solids] or both")
        if self.solids is not None:
            yield from self._solids_that_do_not_fit(self.solids)
        if self.pipe.has_plate:
            yield from self._a_plate_without_its_liquid()
        if self.fidelity.coupling == "two-way":
            yield from self._a_coupling_that_cannot_be()
        yield from self._a_motion_that_cannot_be()
        if self.solids is not None and self.solids.held and self.liquid is None:
            rule, remedy = "without a liquid nothing moves", "add [liquid], or leave it out"
            yield Problem(field="solids.held", value=True, rule=rule, remedy=remedy)
        if self.liquid is not None and (
            self.liquid.computed
            or self.pipe.has_plate
            or self.motion.moves_walls
            or self.fidelity.coupling == "two-way"
        ):
            yield from self.spacing_problems()
        if self.output.every > self.end_time:
            yield Problem(
                field="output.every",
                value=self.output.every,
                unit="s",
                rule=f"must be <= {self.end_time} s, the end_time",
            )
        for i, time in enumerate(self.output.times or ()):
            if time > self.end_time:
                yield Problem(
                    field=f"output.times[{i}]",
                    value=time,
                    unit="s",
                    rule=f"must be <= {self.end_time} s, the end_time",
                )

    def _a_plate_without_its_liquid(self) -> Iterable[Problem]:
        liquid, periodic = self.liquid, "set pipe.ends = 'periodic'"
        if liquid is None:
            rule = "a push plate moves liquid, and the case has none"
            yield Problem(field="pipe.ends", value=self.pipe.ends, rule=rule, remedy=periodic)
            return
        if liquid.model not in ("auto", "lagrangian"):
            yield Problem(
                field="liquid.model",
                value=liquid.model,
                rule="has no particles that a push plate could move",
                remedy=f"set liquid.model = 'lagrangian', or {periodic}",
            )
        if liquid.bulk_velocity <= 0:
            yield Problem(
                field="liquid.bulk_velocity",
                value=liquid.bulk_velocity,
                unit="m/s",
                rule="must be > 0 m/s, the velocity of the push plate",
                remedy=periodic,
            )
        if liquid.pressure_gradient is not None:
            yield Problem(
                field="liquid.pressure_gradient",
                value=liquid.pressure_gradient,
                unit="Pa/m",
                rule="cannot be given where a push plate drives the liquid",
                remedy=f"leave it out, or {periodic}",
            )
        if self.fidelity.layout != "rings":
            yield Problem(
                field="fidelity.layout",
                value=self.fidelity.layout,
                rule="cannot have a push plate",
                remedy=f"leave it out, or {periodic}",
            )
        spacing = self.fidelity.resolved_particle_spacing(self.pipe.radius)
        if self.pipe.resolved_stroke < 2 * spacing:
            yield Problem(
                field="pipe.stroke",
                value=self.pipe.stroke,
                unit="m",
                rule=f"must be >= {2 * spacing:g} m, two particle spacings",
            )

    def _a_motion_that_cannot_be(self) -> Iterable[Problem]:
        for i, part in enumerate(self.motion.vibration):
            if part.mode % 2 and not self.pipe.has_plate:
                yield Problem(
                    field=f"motion.vibration[{i}].mode",
                    value=part.mode,
                    rule="must be even in a periodic pipe, whose outlet moves as its inlet does",
                    remedy=f"take {part.mode - 1} or {part.mode + 1}",
                )
        yield from self._a_bend_that_is_no_pipe()
        times = self.motion.times
        if times is not None and times[-1] < self.end_time:
            yield Problem(
                field="motion.times",
                value=times[-1],
                unit="s",
                rule=f"must reach to {self.end_time:g} s, the end_time",
                remedy="repeat the last place at a later time, if the pipe is to stay there",
            )
        if self.motion.moves_walls:
            yield from self._walls_that_cannot_move()

    def _a_bend_that_is_no_pipe(self) -> Iterable[Problem]:
        slope = self.motion.steepest(self.pipe.length)
        bend = self.motion.sharpest(self.pipe.length) * self.pipe.radius
        for name, value, largest in (
            ("slope", slope, _STEEPEST),
            ("curvature over that of the bore", bend, _SHARPEST),
        ):
            if value > largest:
                yield Problem(
                    field="motion.vibration",
                    rule=f"bends the axis to a {name} of {value:.2g}, and cross-sections that move "
                    f"as one body make a pipe of it up to {largest:g} only",
                    remedy="a smaller amplitude, a lower mode or a longer pipe",
                )

    def _walls_that_cannot_move(self) -> Iterable[Problem]:
        flexes, liquid = self.motion.flexes, self.liquid
        still = "take mode = 0" if flexes else "leave motion.walls out"
        why = "a pipe that flexes moves its walls" if flexes else "walls are to move"
        if liquid is not None and liquid.model not in ("auto", "lagrangian"):
            yield Problem(
                field="liquid.model",
                value=liquid.model,
                rule=f"{why} through the liquid, and this one has no particles that give way",
                remedy=f"set liquid.model = 'lagrangian', or {still}",
            )
        if self.pipe.has_plate:
            rule, remedy = f"{why}, and the plate's do not", f"set ends = 'periodic', or {still}"
            yield Problem(field="pipe.ends", value=self.pipe.ends, rule=rule, remedy=remedy)
        if self.solids is not None and self.solids.held:
            rule, remedy = f"{why}, and held solids do not go with them", f"{still}, or held out"
            yield Problem(field="solids.held", value=True, rule=rule, remedy=remedy)
        if np.any(self.motion.of_mode(0, _SAMPLES * self.end_time).displacement[:, 0]):
            yield Problem(
                field="motion.walls" if not flexes else "motion.vibration",
                rule=f"{why}, which they do across the pipe only",
                remedy=f"leave out the motion along x, or {still}",
            )

    @property
    def axis(self) -> MovingAxis:
        """The axis of the pipe as it moves."""
        return MovingAxis(motion=self.motion, length=self.pipe.length)

    def _a_coupling_that_cannot_be(self) -> Iterable[Problem]:
        def problem(rule: str, remedy: str) -> Problem:
            return Problem(field="fidelity.coupling", value="two-way", rule=rule, remedy=remedy)

        if self.liquid is None or self.solids is None:
            yield problem("needs [liquid] and [solids]", "leave it out")
        elif self.liquid.model == "profile":
            yield problem(
                "a prescribed profile feels no solids",
                "set liquid.model = 'eulerian' or 'lagrangian', or coupling = 'one-way'",
            )
        elif self.pipe.has_plate:
            yield problem(
                "a liquid that a push plate moves feels no solids",
                "set pipe.ends = 'periodic', or coupling = 'one-way'",
            )

    def spacing_problems(self) -> Iterable[Problem]:
        """Yield what keeps a computed liquid from fitting into the pipe."""
        spacing = self.fidelity.resolved_particle_spacing(self.pipe.radius)
        particles = self.liquid is not None and self.liquid.model == "lagrangian"
        across, share = (4, "a quarter") if particles else (6, "a sixth")
        widest = 2 * self.pipe.radius / across
        if spacing > widest:
            yield Problem(
                field="fidelity.particle_spacing",
                value=spacing,
                unit="m",
                rule=f"must be <= {widest:g} m, {share} of the bore",
            )
        if self.pipe.length < 5 * spacing:
            yield Problem(
                field="pipe.length",
                value=self.pipe.length,
                unit="m",
                rule=f"must be >= {5 * spacing:g} m, five particle spacings",
            )

    def _solids_that_do_not_fit(self, solids: Solids) -> Iterable[Problem]:
        largest = solids.largest_diameter
        listed = isinstance(solids.arrangement, List) and solids.arrangement.diameters is not None
        field = "solids.arrangement.diameters" if listed else "solids.diameter"
        if largest >= 2 * self.pipe.radius:
            yield Problem(
                field=field,
                value=largest,
                unit="m",
                rule=f"must be < {2 * self.pipe.radius:g} m, the bore of the pipe",
            )
            return
        if self.pipe.length < 2 * largest:
            yield Problem(
                field="pipe.length",
                value=self.pipe.length,
                unit="m",
                rule=f"must be >= {2 * largest:g} m, two of the largest diameters",
            )
            return
        if self.solids_count == 0:
            yield Problem(
                field="solids.volume_fraction",
                value=solids.volume_fraction,
                rule=f"is less than one solid of {solids.mean_volume:g} m3",
                remedy="raise it, or leave out [solids] for clear liquid",
            )
        stretch = 1.0
        if isinstance(solids.arrangement, Random):
            stretch = solids.arrangement.end - solids.arrangement.start
            if stretch * self.pipe.length < largest:
                yield Problem(
                    field="solids.arrangement.end",
                    value=solids.arrangement.end,
                    rule=f"must leave {largest:g} m after the start, the largest diameter",
                )
        if self.solids_fraction > _DENSEST_PACKING * stretch:
            room = int(_DENSEST_PACKING * stretch * self.pipe.bore_volume / solids.mean_volume)
            name = "count" if solids.volume_fraction is None else "volume_fraction"
            counted = isinstance(solids.arrangement, Random)
            yield Problem(
                field=f"solids.{name}" if counted else "solids.arrangement",
                value=getattr(solids, name) if counted else None,
                rule=f"{self.solids_count} solids do not fit: at the densest random packing, "
                f"{_DENSEST_PACKING}, their stretch of the bore holds {room}",
                remedy="take fewer or smaller solids, or a longer pipe",
            )
        if isinstance(solids.arrangement, List):
            for i, (x, _, _) in enumerate(solids.arrangement.positions):
                if not 0 <= x < self.pipe.length:
                    yield Problem(
                        field=f"solids.arrangement.positions[{i}]",
                        value=x,
                        unit="m",
                        rule=f"x must lie from 0 to less than {self.pipe.length:g} m, the length",
                    )


def load_case(path: str | Path) -> Case:
    """Read a case file.

    Parameters
    ----------
    path : str or Path
        TOML file in UTF-8.

    Raises
    ------
    CaseError
        If there is no such file, or it holds no valid case.
    """
    try:
        text = Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise CaseError([Problem(rule=f"cannot be read: {error.strerror}")], str(path)) from None
    except UnicodeDecodeError:
        raise CaseError([Problem(rule="is not a text file in UTF-8")], str(path)) from None
    try:
        return Case.from_toml(text, Path(path).parent)
    except CaseError as error:
        raise CaseError(error.problems, str(path)) from None


def _merged(table: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    merged = dict(table)
    for key, new in changes.items():
        old = merged.get(key)
        new = new.model_dump(exclude_none=True) if isinstance(new, Part) else new
        same_kind = (
            isinstance(old, Mapping)
            and isinstance(new, Mapping)
            and new.get("kind") in (None, old.get("kind"))
        )
        merged[key] = _merged(old, new) if same_kind else new  # type: ignore[arg-type]
    return merged


def _flat(table: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for key, value in table.items():
        if isinstance(value, Mapping):
            flat |= _flat(value, f"{prefix}{key}.")
        else:
            flat[f"{prefix}{key}"] = value
    return flat


def _shown(value: object) -> str:
    return "not given" if value is None else repr(value)


def _toml_value(text: str) -> Any:
    try:
        table = tomllib.loads(f"value = {text}")
    except tomllib.TOMLDecodeError:
        return text
    return table["value"] if len(table) == 1 else text


def _toml_lines(table: Mapping[str, Any]) -> str:
    return "".join(f"{key} = {_toml(value)}\n" for key, value in table.items())


def _toml(value: object) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():
            return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
        case tuple():
            return f"[{', '.join(map(_toml, value))}]"
        case dict():
            inner = ", ".join(f"{key} = {_toml(entry)}" for key, entry in value.items())
            return f"{{ {inner} }}" if inner else "{}"
        case _:
            return repr(value)
