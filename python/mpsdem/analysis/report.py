"""The survey of a run as plain numbers with names and units: `report.json`."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpsdem.analysis.averages import Average
from mpsdem.analysis.regime import CRITERION
from mpsdem.analysis.solids_survey import Profile, SolidsSurvey
from mpsdem.analysis.survey import UNITS, Blockage, Survey
from mpsdem.results import Results

FloatArray = NDArray[np.float64]

_MOST_TOLD = 100  # frames of a history; the results hold all
_DIGITS = 6


def report(results: Results, found: Survey) -> dict[str, Any]:
    """All numbers of a survey, nested by what they are about.

    Parameters
    ----------
    results : Results
        The run.
    found : Survey
        Its survey.

    Returns
    -------
    dict
        For `mpsdem.results.write_report`. Numbers that share a unit say it beside them, of all
        others ``units`` tells; arrays are rounded to six digits.
    """
    numbers: dict[str, Any] = {
        "title": results.case.title,
        "status": results.summary.get("status", "unfinished"),
        "time": results.time[-1],
        "window": found.window,
        "period": found.period,
        "averages": {
            name: {"unit": UNITS[name], **asdict(average)}
            for name, average in found.averages.items()
        },
        "pressure_loss": _pressure_loss(found),
    }
    if found.liquid_over_height is not None or found.liquid_over_radius is not None:
        numbers["liquid"] = {
            "velocity_over_height": _profile(found.liquid_over_height, "height", "m/s"),
            "velocity_over_radius": _profile(found.liquid_over_radius, "distance_from_axis", "m/s"),
        }
    if found.solids is not None:
        numbers["solids"] = _solids(found.solids, found.window)
    if found.regime is not None:
        numbers["regime"] = {**asdict(found.regime), "criterion": CRITERION}
    if found.blockage is not None:
        numbers["blockage"] = _blockage(found.blockage)
    return numbers | {"units": _UNITS}


_UNITS = {
    **dict.fromkeys(("time", "start", "window", "period", "correlation_time"), "s"),
    **dict.fromkeys(("height", "distance_from_axis", "position", "fullest_position"), "m"),
    **dict.fromkeys(("y_edges", "z_edges", "bed_height", "bed_surface"), "m"),
    **dict.fromkeys(("flux", "mean_velocity", "bed_velocity"), "m/s"),
    **dict.fromkeys(("velocity_edges", "velocity_mean", "velocity_deviation"), "m/s"),
    "density": "s/m",
    **dict.fromkeys(("volume_fraction", "insitu_concentration", "fraction"), "1"),
    **dict.fromkeys(("full_fraction", "fullest_fraction", "bed_share"), "1"),
    **dict.fromkeys(("bed_velocity_ratio", "upper_over_lower", "samples"), "1"),
}


def _pressure_loss(found: Survey) -> dict[str, Any]:
    averages, periods = found.averages, found.pressure_periods
    parts = {
        "whole": averages.get("pressure_gradient"),
        "walls": averages.get("pressure_gradient_friction"),
        "solids": averages.get("pressure_gradient_solids"),
    }
    told: dict[str, Any] = {"unit": "Pa/m"}
    told |= {name: _average(part) for name, part in parts.items() if part}
    if found.static_gradient is not None:
        told["static"] = found.static_gradient
    if periods is not None and periods.start.size:
        told["periods"] = asdict(periods)
        told["mean_of_peaks"] = periods.peak.mean()
    return told


def _average(average: Average) -> dict[str, float]:
    return {"mean": average.mean, "error": average.error}


def _profile(profile: Profile | None, place: str, unit: str) -> dict[str, Any] | None:
    if profile is None:
        return None
    return {
        "unit": unit,
        place: _rounded(profile.place),
        "mean": _rounded(profile.mean),
        "error": _rounded(profile.error),
    }


def _solids(solids: SolidsSurvey, window: tuple[float, float]) -> dict[str, Any]:
    told = slice(None, None, -(-solids.time.size // _MOST_TOLD))
    inside = solids.time >= window[0] * (1 - 1e-9)
    height, away = "height", "distance_from_axis"
    with np.errstate(invalid="ignore"):
        surface = np.ma.masked_invalid(solids.bed_surface[inside]).mean(axis=0).filled(np.nan)
    return {
        "insitu_concentration": solids.insitu_concentration,
        "volume_fraction_over_height": _profile(solids.fraction_over_height, height, "1"),
        "volume_fraction_over_radius": _profile(solids.fraction_over_radius, away, "1"),
        "velocity_over_height": _profile(solids.velocity_over_height, height, "m/s"),
        "velocity_over_radius": _profile(solids.velocity_over_radius, away, "m/s"),
        "section": {
            "y_edges": _rounded(solids.section_edges),
            "z_edges": _rounded(solids.section_edges),
            "volume_fraction": _rounded(solids.section),
        },
        "velocity_density": {
            name: {
                "velocity_edges": _rounded(density.edges),
                "density": _rounded(density.density),
                "velocity_mean": density.mean,
                "velocity_deviation": density.deviation,
            }
            for name, density in solids.velocity_densities.items()
        },
        "along_pipe": {
            "position": _rounded(solids.station),
            "volume_fraction": _rounded(solids.fraction[inside].mean(axis=0)),
            "flux": _rounded(solids.flux[inside].mean(axis=0)),
            "bed_surface": _rounded(surface),
        },
        "history": {
            name: _rounded(getattr(solids, name)[told])
            for name in ("time", "mean_velocity", "bed_height", "bed_share", "bed_velocity")
        },
    }


def _blockage(blockage: Blockage) -> dict[str, Any]:
    told: dict[str, Any] = {
        "state": blockage.state,
        "plug": blockage.plug and asdict(blockage.plug),
        "full_fraction": blockage.full_fraction,
        "fullest_position": blockage.fullest_position,
        "fullest_fraction": blockage.fullest_fraction,
        "fullest_gain": {"unit": "1/s", **_average(blockage.fullest_gain)},
    }
    units = {"fullest_fraction": "1/s", "bed_top": "m/s", "pressure_gradient": "Pa/m/s"}
    trends = {
        name: {"unit": units[name], **asdict(trend), "rises": trend.rises}
        for name, trend in blockage.trends.items()
    }
    return told | {"trends": trends}


def _rounded(values: FloatArray) -> FloatArray:
    """As many digits as a figure could show."""
    largest = np.max(np.abs(values), initial=0.0, where=np.isfinite(values))
    if not largest:
        return values
    return np.round(values, _DIGITS - 1 - int(np.floor(np.log10(largest)))) + 0.0  # no -0
