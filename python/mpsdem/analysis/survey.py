"""All analyses of a run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from mpsdem.analysis.averages import Average, Trend, time_average, trend
from mpsdem.analysis.blockage import (
    Plug,
    accumulation,
    find_plug,
    full_fraction,
    standing_full,
    standing_time,
)
from mpsdem.analysis.partial_volumes import slab_area
from mpsdem.analysis.periods import Periods, by_period, period_of_motion
from mpsdem.analysis.regime import FlowRegime, flow_regime
from mpsdem.analysis.solids_survey import (
    Profile,
    SolidsSurvey,
    frames_looked_at,
    mean_profile,
    survey_solids,
)
from mpsdem.results import Results, ResultsError

FloatArray = NDArray[np.float64]

UNITS: Mapping[str, str] = MappingProxyType(
    {
        "pressure_gradient": "Pa/m",
        "pressure_gradient_friction": "Pa/m",
        "pressure_gradient_solids": "Pa/m",
        "bulk_velocity": "m/s",
        "power_input": "W/m",
        "dissipation": "W/m",
        "solids_mean_velocity": "m/s",
        "liquid_mean_velocity": "m/s",
        "slip_velocity": "m/s",
        "local_slip": "m/s",
        "insitu_concentration": "1",
        "delivered_concentration": "1",
        "delivered_over_insitu": "1",
        "bed_height": "m",
        "bed_share": "1",
        "bed_velocity": "m/s",
    }
)
"""What is averaged over time where a run has it, with the units."""

_RECORDED = tuple(UNITS)[:6]
_OF_SOLIDS = ("local_slip", "bed_height", "bed_share", "bed_velocity")


@dataclass(frozen=True, slots=True, kw_only=True)
class Blockage:
    """Whether solids block the pipe.

    Parameters
    ----------
    state : {"free", "filling", "plug"}
        Filling: the fullest section gains solids, by more than three errors, and at this rate would
        be full after as much time as was averaged over.
    plug : Plug or None
        Where the pipe is blocked.
    full_fraction : float
        Volume fraction from which a section counts as full [-].
    fullest_position, fullest_fraction : float
        The fullest section of the last frame [m], and its volume fraction [-].
    fullest_gain : Average
        What flows into it and not out, over the window [1/s].
    trends : mapping of str to Trend
        Over the window: ``fullest_fraction`` [1/s], ``bed_top``, the highest of the bed anywhere
        [m/s], ``pressure_gradient`` [Pa/m/s].
    """

    state: str
    plug: Plug | None
    full_fraction: float
    fullest_position: float
    fullest_fraction: float
    fullest_gain: Average
    trends: Mapping[str, Trend]


@dataclass(frozen=True, slots=True, kw_only=True)
class Survey:
    """All analyses of a run; what it lacks is None, or absent from a mapping.

    Parameters
    ----------
    window : tuple of float
        From when to when is averaged [s].
    period : float or None
        Of the motion of the pipe [s].
    averages : mapping of str to Average
        By the names in `UNITS`.
    static_gradient : float or None
        Weight of the liquid along the axis, part of no other loss of pressure [Pa/m].
    pressure_periods : Periods or None
        The loss of pressure in each period of the motion [Pa/m]; without motion, one period of the
        length of the window.
    liquid_over_height, liquid_over_radius : Profile or None
        Axial velocity of the liquid [m/s]; a prescribed one on the vertical through the axis.
    solids : SolidsSurvey or None
        What the solids do.
    regime : FlowRegime or None
        How they travel; None where nothing flows.
    blockage : Blockage or None
        Whether they block the pipe; None where nothing flows.
    """

    window: tuple[float, float]
    period: float | None
    averages: Mapping[str, Average]
    static_gradient: float | None
    pressure_periods: Periods | None
    liquid_over_height: Profile | None
    liquid_over_radius: Profile | None
    solids: SolidsSurvey | None
    regime: FlowRegime | None
    blockage: Blockage | None


def survey(results: Results, *, window: tuple[float, float] | None = None) -> Survey:
    """Analyse a run.

    Parameters
    ----------
    results : Results
        Any run with a frame: clear or with solids, finished or not.
    window : tuple of float, optional
        From when to when to average [s]; by default the second half of what there is.

    Returns
    -------
    Survey
        All that the run has fields for.

    Raises
    ------
    ResultsError
        If the run has no frames.
    """
    if not results.time.size:
        raise ResultsError(f"the run in {results.directory} has no frames yet")
    case, end = results.case, float(results.time[-1])
    window = window or (end / 2, end)
    period = period_of_motion(case.motion)
    solids = None
    if results.has_solids:
        solids = survey_solids(results, window=window, period=period)
    averages = {
        name: time_average(time, values, window=window, period=period)
        for name, (time, values) in _series(results, solids).items()
        if np.isfinite(values).any()
    }
    of_height, of_radius = _liquid(results, window, period)
    bulk = averages["bulk_velocity"].mean if "bulk_velocity" in averages else 0.0
    moves = solids is not None and bulk != 0
    return Survey(
        window=window,
        period=period,
        averages=averages,
        static_gradient=None
        if case.liquid is None
        else -case.liquid.density * case.gravity_vector[0],
        pressure_periods=_pressure_periods(results, window, period),
        liquid_over_height=of_height,
        liquid_over_radius=of_radius,
        solids=solids,
        regime=_regime(results, solids, averages, bulk) if solids and moves else None,
        blockage=_blockage(results, solids, window, bulk) if solids and moves else None,
    )


def _series(
    results: Results, solids: SolidsSurvey | None
) -> dict[str, tuple[FloatArray, FloatArray]]:
    """What can be averaged: times and values."""
    recorded = results.diagnostics
    series = {
        name: (results.time, np.asarray(recorded[name], dtype=np.float64))
        for name in _RECORDED
        if name in recorded
    }
    if solids is None:
        return series
    for name in _OF_SOLIDS:
        series[name] = (solids.time, getattr(solids, name))
    velocity, frames = solids.mean_velocity, frames_looked_at(results)
    if "solids_mean_velocity" in recorded:  # of every frame
        velocity, frames = recorded["solids_mean_velocity"], np.arange(results.time.size)
    insitu = solids.insitu_concentration
    values = {
        "solids_mean_velocity": velocity,
        "insitu_concentration": np.full_like(velocity, insitu),
    }
    if "bulk_velocity" in recorded and recorded["bulk_velocity"].all():
        ratio = velocity / recorded["bulk_velocity"][frames]
        values |= {"delivered_over_insitu": ratio, "delivered_concentration": insitu * ratio}
    if "liquid_flux" in recorded:
        liquid = recorded["liquid_flux"][frames] / (1 - insitu)
        values |= {"liquid_mean_velocity": liquid, "slip_velocity": liquid - velocity}
    return series | {name: (results.time[frames], column) for name, column in values.items()}


def _liquid(
    results: Results, window: tuple[float, float], period: float | None
) -> tuple[Profile | None, Profile | None]:
    """Velocity of the liquid over height and over radius."""
    if not results.has_liquid:
        return None, None
    liquid, radius = results.liquid, results.case.pipe.radius
    if liquid.is_prescribed:
        r, u = liquid.profile_radius, liquid.profile_velocity
        known = np.zeros_like(u)
        height = radius + np.concatenate([-r[::-1], r])
        of_height = Profile(
            place=height, mean=np.concatenate([u[::-1], u]), error=np.tile(known, 2)
        )
        return of_height, Profile(place=r, mean=u, error=known)
    slack = 1e-9 * float(results.time[-1])  # times carry round-off
    inside = (results.time >= window[0] - slack) & (results.time <= window[1] + slack)
    time = results.time[inside]
    layers = rings = None
    if "layer_velocity" in liquid:
        place, values = radius + liquid.layer_height, liquid.layer_velocity[:][inside]
        layers = mean_profile(place, time, values, period=period)
    if "velocity_profile" in liquid:
        place, values = liquid.profile_radius, liquid.velocity_profile[:][inside]
        rings = mean_profile(place, time, values, period=period)
    return layers, rings


def _pressure_periods(
    results: Results, window: tuple[float, float], period: float | None
) -> Periods | None:
    loss = results.diagnostics.get("pressure_gradient")
    if loss is None or not window[1] > window[0]:
        return None
    length = period or window[1] - window[0]
    return by_period(results.time, loss, period=length, start=window[0])


def _regime(
    results: Results, solids: SolidsSurvey, averages: Mapping[str, Average], bulk: float
) -> FlowRegime:
    case = results.case
    assert case.solids is not None
    profile = solids.fraction_over_height
    edges = np.linspace(-case.pipe.radius, case.pipe.radius, profile.mean.size + 1)
    volume = slab_area(case.pipe.radius, edges) * profile.mean
    halves = volume[: volume.size // 2].sum(), volume[volume.size // 2 :].sum()
    floats = case.liquid is not None and case.solids.density < case.liquid.density
    lower, upper = halves[::-1] if floats else halves
    bed = averages.get("bed_velocity")
    return flow_regime(
        bed_share=averages["bed_share"].mean,
        bed_velocity_ratio=math.nan if bed is None else bed.mean / bulk,
        upper_over_lower=float(upper / lower) if lower > 0 else math.inf,
    )


def _blockage(
    results: Results, solids: SolidsSurvey, window: tuple[float, float], bulk: float
) -> Blockage:
    pipe = results.case.pipe
    diameters = {
        "pipe_diameter": 2 * pipe.radius,
        "diameter": 2 * float(np.average(results.solids.radius)),
    }
    full, fullest = full_fraction(**diameters), solids.fraction.max(axis=1)
    plug = find_plug(
        solids.time,
        solids.station,
        solids.fraction,
        standing_full(solids.fraction, solids.flux, full=full, bulk_velocity=bulk),
        lasting=standing_time(2 * pipe.radius, bulk),
    )
    top = np.where(np.isnan(solids.bed_surface), 0.0, solids.bed_surface).max(axis=1)
    followed = {
        "fullest_fraction": (solids.time, fullest),
        "bed_top": (solids.time, top),
    }
    if (loss := results.diagnostics.get("pressure_gradient")) is not None:
        followed["pressure_gradient"] = (results.time, loss)
    trends = {}
    for name, (time, values) in followed.items():
        inside = time >= window[0]
        trends[name] = trend(time[inside], values[inside])
    rise = trends["fullest_fraction"]
    section = int(solids.fraction[-1].argmax())
    gain = accumulation(solids.flux, length=pipe.length)[:, section]
    after = fullest[-1] + rise.slope * (window[1] - window[0])
    state = "filling" if rise.rises and after >= full else "free"
    return Blockage(
        state=state if plug is None else "plug",
        plug=plug,
        full_fraction=full,
        fullest_position=float(solids.station[section]),
        fullest_fraction=float(fullest[-1]),
        fullest_gain=time_average(solids.time, gain, window=window),
        trends=trends,
    )
