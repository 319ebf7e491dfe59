"""What a run left in its directory, read lazily, while it goes on or after."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpsdem.case import Case, CaseError
from mpsdem.results.errors import ResultsError
from mpsdem.results.files import RESULTS, SUMMARY
from mpsdem.results.stored import Field, StoredRun

FloatArray = NDArray[np.float64]

LIQUID_KIND = 2  # of a particle of liquid, among those of the wall


class Results:
    """What a run left in its directory; a snapshot if the run still goes on.

    Parameters
    ----------
    directory : path-like
        The run's output directory.

    Attributes
    ----------
    directory : Path
        The run's output directory.
    time : (frames,) float64 ndarray
        Time of each frame [s].

    Raises
    ------
    ResultsError
        If there are no readable results.

    Notes
    -----
    All is seen from the pipe: where that moves (`Case.motion`), positions count from its axis and
    velocities from its own; `SolidsResults.laboratory_position` and `laboratory_velocity` give
    those of the laboratory.

    Fields are read from the file where they are indexed, so results larger than the memory can be
    looked through frame by frame. Frames written after the opening are seen by opening again.

    Examples
    --------
    >>> import mpsdem as md
    >>> results = md.Results("out/horizontal_pipe")  # doctest: +SKIP
    >>> results.solids.velocity[-1].mean(axis=0)  # doctest: +SKIP
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.directory = Path(directory)
        self._run = StoredRun(self.directory / RESULTS)
        self.time: FloatArray = self._run.read_frames("time")

    def frames_at(self, times: Sequence[float]) -> list[int]:
        """Frames nearest to some times.

        Parameters
        ----------
        times : sequence of float
            [s].

        Returns
        -------
        list of int
            Their numbers, each once, in order.

        Raises
        ------
        ResultsError
            If the run has no frames.
        """
        if not self.time.size:
            raise ResultsError(f"the run in {self.directory} has no frames yet")
        return sorted({int(np.abs(self.time - time).argmin()) for time in times})

    @property
    def has_solids(self) -> bool:
        """Whether the run has solids."""
        return "solids" in self._run

    @property
    def has_liquid(self) -> bool:
        """Whether the run has a liquid."""
        return "liquid" in self._run

    @property
    def solids(self) -> SolidsResults:
        """The solids; a `ResultsError` where the run has none."""
        if not self.has_solids:
            raise ResultsError(f"the run in {self.directory} has no solids")
        return SolidsResults(self)

    @property
    def liquid(self) -> LiquidResults:
        """The liquid; a `ResultsError` where the run is dry."""
        if not self.has_liquid:
            raise ResultsError(f"the run in {self.directory} has no liquid")
        return LiquidResults(self)

    @property
    def diagnostics(self) -> Diagnostics:
        """Numbers about the whole run, one per frame, by name."""
        return Diagnostics(self)

    @property
    def pressure_gradient(self) -> FloatArray:
        """Loss of pressure along the axis, static head apart, (frames,) [Pa/m]."""
        return self._run.read_frames("diagnostics/pressure_gradient")

    @cached_property
    def case(self) -> Case:
        """The case that was run."""
        try:
            return Case.from_toml(self.case_toml)
        except CaseError as error:
            raise ResultsError(f"{self._run.path} holds no valid case: {error}") from error

    @property
    def case_toml(self) -> str:
        """The case as TOML text, every default written out."""
        return self._run.text("case")

    @property
    def provenance(self) -> dict[str, Any]:
        """Where the numbers come from: version, compiler, threads and the like."""
        return self._run.attributes("provenance")

    @property
    def summary(self) -> dict[str, Any]:
        """The run's `summary.json`; empty while the run goes on."""
        path = self.directory / SUMMARY
        try:
            summary: dict[str, Any] = json.loads(path.read_bytes())
        except FileNotFoundError:
            return {}
        except ValueError as error:
            raise ResultsError(f"{path} is damaged: {error}") from error
        return summary

    def close(self) -> None:
        """Close the file; arrays that were read stay."""
        self._run.file.close()

    def __enter__(self) -> Results:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        end = f" to {self.time[-1]:g} s" if self.time.size else ""
        return f"<Results of {str(self.directory)!r}: {self.time.size} frames{end}>"


class SolidsResults:
    """The solids of a run, in the order in which they were placed.

    Parameters
    ----------
    results : Results
        The run's results.
    """

    def __init__(self, results: Results) -> None:
        self._results = results
        self._run = results._run

    def __contains__(self, name: str) -> bool:
        return f"solids/{name}" in self._run

    def __len__(self) -> int:
        return len(self._run.dataset("solids/radius"))

    @property
    def radius(self) -> FloatArray:
        """Radius of each solid, (n,) [m]."""
        return self._run.read("solids/radius")

    @property
    def density(self) -> FloatArray:
        """Density of each solid, (n,) [kg/m3]."""
        return self._run.read("solids/density")

    @property
    def position(self) -> Field:
        """Centres, (frames, n, 3) [m]; x wrapped into [0, pipe length)."""
        return Field(self._run, "solids/position")

    @property
    def unwrapped_position(self) -> FloatArray:
        """Centres with the laps of the periodic pipe added to x, (frames, n, 3) [m]."""
        position = self.position[:]
        position[:, :, 0] += self._results.case.pipe.length * self.laps[:]
        return position

    @property
    def velocity(self) -> Field:
        """Velocities of the centres, (frames, n, 3) [m/s]."""
        return Field(self._run, "solids/velocity")

    def laboratory_position(self, frame: int) -> FloatArray:
        """Centres as seen by someone who does not move with the pipe.

        Parameters
        ----------
        frame : int
            Which; -1 is the last.

        Returns
        -------
        (n, 3) float64 ndarray
            [m]; x wrapped before the pipe's displacement is added.
        """
        return self._results.case.axis.place(self.position[frame], self._results.time[frame])

    def laboratory_velocity(self, frame: int) -> FloatArray:
        """Velocities of the centres as seen by someone who does not move with the pipe.

        Parameters
        ----------
        frame : int
            Which; -1 is the last.

        Returns
        -------
        (n, 3) float64 ndarray
            [m/s].
        """
        x, time = self.position[frame][:, 0], self._results.time[frame]
        return self._results.case.axis.to_laboratory(self.velocity[frame], x, time)

    @property
    def spin(self) -> Field:
        """Angular velocities, (frames, n, 3) [rad/s]."""
        return Field(self._run, "solids/spin")

    @property
    def laps(self) -> Field:
        """Times each solid left the outlet and came back at the inlet, (frames, n)."""
        return Field(self._run, "solids/laps")

    @property
    def void_fraction(self) -> Field:
        """Share of liquid in the surroundings of each solid, (frames, n)."""
        return Field(self._run, "solids/void_fraction")

    @property
    def liquid_velocity(self) -> Field:
        """Undisturbed liquid velocity at each solid, (frames, n, 3) [m/s]."""
        return Field(self._run, "solids/liquid_velocity")

    @property
    def drag_force(self) -> Field:
        """Drag of the liquid on each solid, (frames, n, 3) [N]."""
        return Field(self._run, "solids/drag_force")

    @property
    def section_position(self) -> FloatArray:
        """Middles of equal bins along the pipe, (s,) [m]."""
        return self._run.read("solids/section_position")

    @property
    def section_fraction(self) -> Field:
        """Share of the solids in those bins, by where their centres are, (frames, s)."""
        return Field(self._run, "solids/section_solids_fraction")

    @property
    def section_velocity(self) -> Field:
        """Mean axial velocity of the solids in those bins, (frames, s) [m/s]; NaN without any."""
        return Field(self._run, "solids/section_solids_velocity")


class LiquidResults:
    """The liquid of a run, prescribed or made of particles.

    Parameters
    ----------
    results : Results
        The run's results.

    Notes
    -----
    A prescribed liquid is its profile. One of particles has a profile per frame, the pressure along
    the axis, and those particles that the run recorded, which may be none.

    Their pressure p' leaves out what is known without computing: the mean gradient and the static
    part. In a full rigid pipe a uniform acceleration such as gravity or shaking moves no liquid,
    whatever its size; left in, it would ask the solver for a pressure many times that of the flow,
    and its error would stir the liquid. `full_pressure` adds both again.
    """

    def __init__(self, results: Results) -> None:
        self._results = results
        self._run = results._run

    def __contains__(self, name: str) -> bool:
        return f"liquid/{name}" in self._run

    @property
    def is_prescribed(self) -> bool:
        """Whether the liquid's velocity was given rather than computed."""
        return "profile_velocity" in self

    @property
    def has_particles(self) -> bool:
        """Whether particles of the liquid were recorded, apart from those of the wall."""
        return "position" in self and bool((self.kind == LIQUID_KIND).any())

    @property
    def profile_radius(self) -> FloatArray:
        """Distances from the axis at which the profile is given, (b,) [m]."""
        return self._run.read("liquid/profile_radius")

    @property
    def profile_velocity(self) -> FloatArray:
        """Prescribed axial liquid velocity at those distances, (b,) [m/s]."""
        return self._run.read("liquid/profile_velocity")

    @property
    def velocity_profile(self) -> Field:
        """Mean axial velocity of all liquid particles in rings at those distances, (frames, b)."""
        return Field(self._run, "liquid/velocity_profile")

    @property
    def layer_height(self) -> FloatArray:
        """Middles of equal layers from the bottom of the bore to its top, z, (h,) [m]."""
        return self._run.read("liquid/layer_height")

    @property
    def layer_velocity(self) -> Field:
        """Mean axial velocity of the liquid in those layers, (frames, h) [m/s]."""
        return Field(self._run, "liquid/layer_velocity")

    @property
    def section_position(self) -> FloatArray:
        """Middles of equal bins along the pipe, (s,) [m]."""
        return self._run.read("liquid/section_position")

    @property
    def section_pressure(self) -> Field:
        """Mean pressure in those bins, (frames, s) [Pa]; mean gradient and static head apart."""
        return Field(self._run, "liquid/section_pressure")

    @property
    def kind(self) -> NDArray[np.int8]:
        """Each recorded particle, (m,): 2 liquid, -2 wall, -1 ghost."""
        return self._run.read("liquid/kind")

    @property
    def position(self) -> Field:
        """Places of the recorded particles, (frames, m, 3) [m]; x wrapped into [0, length)."""
        return Field(self._run, "liquid/position")

    @property
    def velocity(self) -> Field:
        """Velocities of the recorded particles, (frames, m, 3) [m/s]."""
        return Field(self._run, "liquid/velocity")

    @property
    def pressure(self) -> Field:
        """Pressures of the recorded particles, (frames, m) [Pa]; mean gradient and head apart."""
        return Field(self._run, "liquid/pressure")

    def full_pressure(self, frame: int) -> FloatArray:
        """Pressure of the recorded particles with mean gradient and static part.

        Parameters
        ----------
        frame : int
            Which; -1 is the last.

        Returns
        -------
        (m,) float64 ndarray
            p' + rho (g - a).x - G x [Pa], G the mean loss since the frame before, a the
            acceleration of the pipe; where it flexes, that of a plug that follows it. Zero is the
            mean of p' on the axis at the inlet. It is not periodic: from the outlet to the inlet
            it jumps by what a pump gives.
        """
        pressure: FloatArray = self.pressure[frame]
        return pressure + self._split_off(frame, self.position[frame])

    def full_section_pressure(self, frame: int) -> FloatArray:
        """Pressure in the bins along the pipe, on its axis, with mean gradient and static part.

        Parameters
        ----------
        frame : int
            Which; -1 is the last.

        Returns
        -------
        (s,) float64 ndarray
            [Pa], as `full_pressure`.
        """
        pressure: FloatArray = self.section_pressure[frame]
        return pressure + self._split_off(frame, np.outer(self.section_position, [1.0, 0.0, 0.0]))

    def _split_off(self, frame: int, position: FloatArray) -> FloatArray:
        """What the pressure at some positions, (n, 3) [m], was stored without [Pa]."""
        case, time = self._results.case, self._results.time[frame]
        assert case.liquid is not None
        liquid = case.liquid
        per_metre = liquid.density * np.array(case.gravity_vector)
        per_metre[0] -= self._results.pressure_gradient[frame]
        turning = case.axis.plug_pressure(position, time, liquid.bulk_velocity)
        split_off: FloatArray = position @ per_metre + liquid.density * turning
        return split_off


class Diagnostics(Mapping[str, FloatArray]):
    """Numbers about the whole run, one per frame, by name.

    Parameters
    ----------
    results : Results
        The run's results.
    """

    def __init__(self, results: Results) -> None:
        self._run = results._run

    def __getitem__(self, name: str) -> FloatArray:
        if f"diagnostics/{name}" not in self._run:
            raise KeyError(name)
        return self._run.read_frames(f"diagnostics/{name}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._run.file.get("diagnostics", ()))

    def __len__(self) -> int:
        return len(self._run.file.get("diagnostics", ()))
