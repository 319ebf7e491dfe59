"""What the solids of a run do: all analyses of them in one pass over its frames."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpsdem.analysis.averages import time_average
from mpsdem.analysis.bed import bed_height, in_bed
from mpsdem.analysis.concentration import (
    height_edges,
    insitu_concentration,
    radius_edges,
    solids_flux_along_pipe,
    station_count,
    volume_fraction_along_pipe,
    volume_fraction_over_height,
    volume_fraction_over_radius,
    volume_fraction_over_section,
)
from mpsdem.analysis.profiles import velocity_over_height, velocity_over_radius
from mpsdem.analysis.silhouette import silhouette
from mpsdem.analysis.velocity_density import Density, radial_velocity, velocity_density
from mpsdem.case import Case
from mpsdem.results import Results

FloatArray = NDArray[np.float64]

HEIGHTS, RADII, CELLS = 40, 20, 24  # bins of the profiles, and across a section
_FEWEST, _MOST, _MOST_PLACES = 60, 200, 2_000_000  # frames to look at, and solids in all of them
_MOST_MEANED = 100  # frames of which profiles are averaged
_LEVEL = 1e-6  # cosine of the inclination below which a pipe has no lower side


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """A mean over time, place by place.

    Parameters
    ----------
    place : (bins,) float64 ndarray
        Height above the bottom of the bore, or distance from the axis [m].
    mean, error : (bins,) float64 ndarray
        Mean over the window and its standard error; NaN where nothing is known.
    """

    place: FloatArray
    mean: FloatArray
    error: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class SolidsSurvey:
    """What the solids do.

    Parameters
    ----------
    time : (f,) float64 ndarray
        Times of the frames that were looked at [s]; see `frames_looked_at`.
    insitu_concentration : float
        Share of the solids in the volume of the bore [-].
    section_edges : (cells + 1,) float64 ndarray
        Places across the pipe between which the cells of `section` lie [m].
    section : (cells, cells) float64 ndarray
        Mean volume fraction over the section [-]; rows go along y, columns along z.
    fraction_over_height, fraction_over_radius : Profile
        Volume fraction [-].
    velocity_over_height, velocity_over_radius : Profile
        Axial velocity [m/s].
    velocity_densities : mapping of str to Density
        Of the axial, radial, vertical and horizontal velocity.
    station : (s,) float64 ndarray
        Middles of equal sections along the pipe [m].
    fraction, flux : (f, s) float64 ndarray
        Volume fraction of the solids [-] and their flow rate over the area of the bore [m/s].
    bed_surface : (f, s) float64 ndarray
        Height of the bed above the lowest line of the bore [m]; NaN where there is none.
    bed_height : (f,) float64 ndarray
        Height below which 95 % of the solids lie [m].
    bed_share : (f,) float64 ndarray
        Share of the solids' volume that is in the bed [-].
    bed_velocity : (f,) float64 ndarray
        Mean axial velocity of the bed [m/s]; NaN where there is none.
    mean_velocity : (f,) float64 ndarray
        Mean axial velocity of all solids [m/s].
    local_slip : (f,) float64 ndarray
        Mean of the axial liquid velocity at the solids less their own [m/s]; NaN without a liquid.
    """

    time: FloatArray
    insitu_concentration: float
    section_edges: FloatArray
    section: FloatArray
    fraction_over_height: Profile
    fraction_over_radius: Profile
    velocity_over_height: Profile
    velocity_over_radius: Profile
    velocity_densities: Mapping[str, Density]
    station: FloatArray
    fraction: FloatArray
    flux: FloatArray
    bed_surface: FloatArray
    bed_height: FloatArray
    bed_share: FloatArray
    bed_velocity: FloatArray
    mean_velocity: FloatArray
    local_slip: FloatArray


def frames_looked_at(results: Results) -> NDArray[np.intp]:
    """Frames whose solids are analysed: evenly taken, 200 at most, fewer of many solids."""
    most = int(np.clip(_MOST_PLACES // max(len(results.solids), 1), _FEWEST, _MOST))
    return np.arange(0, results.time.size, -(-results.time.size // most))


def survey_solids(
    results: Results, *, window: tuple[float, float], period: float | None = None
) -> SolidsSurvey:
    """Analyse the solids of a run.

    Parameters
    ----------
    results : Results
        A run with solids, and a frame at least.
    window : tuple of float
        From when to when to average [s].
    period : float, optional
        Of the motion of the pipe [s].

    Returns
    -------
    SolidsSurvey
        All of it.
    """
    solids, pipe = results.solids, results.case.pipe
    bore = _Bore(case=results.case, radius=solids.radius)
    frames = frames_looked_at(results)
    time = results.time[frames]
    slack = 1e-9 * float(time[-1])  # times carry round-off
    inside = np.flatnonzero((time >= window[0] - slack) & (time <= window[1] + slack))
    averaged = inside[:: -(-inside.size // _MOST_MEANED) or 1] if inside.size else [len(time) - 1]
    along, across, velocities = [], [], []
    positions, of_solids = solids.position, solids.velocity
    of_liquid = solids.liquid_velocity if "liquid_velocity" in solids else None
    for number, frame in enumerate(frames.tolist()):
        position, velocity = positions[frame], of_solids[frame]
        liquid = None if of_liquid is None else of_liquid[frame]
        along.append(bore.along(position, velocity, liquid))
        if number in averaged:
            across.append(bore.across(position, velocity))
            velocities.append(np.column_stack([velocity, radial_velocity(position, velocity)]))
    names = ("axial", "horizontal", "vertical", "radial")
    places: dict[str, FloatArray] = {
        name: np.array([now[name] for now in across]) for name in _MEANS
    }
    profiles: dict[str, Any] = {
        name: mean_profile(bore.places(name), time[averaged], places[name], period=period)
        for name in _MEANS[1:]
    }
    histories: dict[str, Any] = {name: np.array([now[name] for now in along]) for name in along[0]}
    return SolidsSurvey(
        time=time,
        insitu_concentration=insitu_concentration(
            solids.radius, pipe_radius=pipe.radius, length=pipe.length
        ),
        section_edges=height_edges(pipe.radius, CELLS),
        section=places["section"].mean(axis=0),
        velocity_densities={
            name: velocity_density(values)
            for name, values in zip(names, np.concatenate(velocities).T, strict=True)
        },
        station=(np.arange(bore.stations) + 0.5) * pipe.length / bore.stations,
        **profiles,
        **histories,
    )


_MEANS = (
    "section",
    "fraction_over_height",
    "fraction_over_radius",
    "velocity_over_height",
    "velocity_over_radius",
)


def mean_profile(
    place: FloatArray, time: FloatArray, values: FloatArray, *, period: float | None = None
) -> Profile:
    """Average a profile over time.

    Parameters
    ----------
    place : (bins,) float64 ndarray
        Height above the bottom of the bore, or distance from the axis [m].
    time : (f,) float64 ndarray
        Times of the frames [s].
    values : (f, bins) float64 ndarray
        The profile of each; NaN is left out.
    period : float, optional
        Of what drives it [s].
    """
    always = (-math.inf, math.inf)
    found = [time_average(time, column, window=always, period=period) for column in values.T]
    return Profile(
        place=place,
        mean=np.array([average.mean for average in found]),
        error=np.array([average.error for average in found]),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Bore:
    """The bore with its bins, and the solids that do not change: analyses of one frame."""

    case: Case
    radius: FloatArray  # (n,) [m]

    @property
    def stations(self) -> int:
        """Sections along the pipe: as long as its radius, and as a solid at least."""
        pipe = self.case.pipe
        return station_count(pipe.radius, pipe.length, 2 * float(self.radius.max()))

    @property
    def heights(self) -> FloatArray:
        return height_edges(self.case.pipe.radius, HEIGHTS)

    @property
    def radii(self) -> FloatArray:
        return radius_edges(self.case.pipe.radius, RADII)

    def places(self, name: str) -> FloatArray:
        """Middles of the bins of a profile: above the bottom, or from the axis [m]."""
        edges = self.radii if name.endswith("radius") else self.heights + self.case.pipe.radius
        return np.asarray(edges[1:] + edges[:-1]) / 2

    @property
    def size(self) -> dict[str, float]:
        return {"pipe_radius": self.case.pipe.radius, "length": self.case.pipe.length}

    def along(
        self, position: FloatArray, velocity: FloatArray, liquid: FloatArray | None
    ) -> dict[str, FloatArray | float]:
        """What is followed over time, of the whole pipe and along it."""
        pipe, radius = self.case.pipe, self.radius
        x, u = position[:, 0], velocity[:, 0]
        volume = radius**3 / (radius**3).sum()
        settled = position * [1.0, 1.0, self._down]
        bed = np.zeros(len(x), dtype=bool)
        if self.case.gravity and math.cos(pipe.inclination) > _LEVEL:
            bed = in_bed(settled, radius, **self.size)
        share = float(volume[bed].sum())
        surface = silhouette(settled[bed], radius[bed], length=pipe.length, bins=self.stations)
        sections: dict[str, Any] = {**self.size, "bins": self.stations}
        return {
            "fraction": volume_fraction_along_pipe(x, radius, **sections),
            "flux": solids_flux_along_pipe(x, u, radius, **sections),
            "bed_surface": surface.upper + pipe.radius,
            "bed_height": bed_height(settled[:, 2], radius, pipe_radius=pipe.radius),
            "bed_share": share,
            "bed_velocity": float(u[bed] @ volume[bed]) / share if share else math.nan,
            "mean_velocity": float(volume @ u),
            "local_slip": math.nan if liquid is None else float(volume @ (liquid[:, 0] - u)),
        }

    @property
    def _down(self) -> float:
        """Sign of z of where solids rise to if they sink: 1, and -1 for those that float."""
        solids, liquid = self.case.solids, self.case.liquid
        assert solids is not None
        return -1.0 if liquid is not None and solids.density < liquid.density else 1.0

    def across(self, position: FloatArray, velocity: FloatArray) -> dict[str, FloatArray]:
        """What is averaged over time, over height, radius and section."""
        x, u, r = position, velocity, self.radius
        heights, radii, size = self.heights, self.radii, self.size
        return {
            "fraction_over_height": volume_fraction_over_height(x, r, **size, edges=heights),
            "fraction_over_radius": volume_fraction_over_radius(x, r, **size, edges=radii),
            "velocity_over_height": velocity_over_height(x, u, r, edges=heights),
            "velocity_over_radius": velocity_over_radius(x, u, r, edges=radii),
            "section": volume_fraction_over_section(x, r, **size, bins=CELLS),
        }
