"""What runs are compared by: a quantity over time, and how far two of them lie apart."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mpsdem.analysis import bed_height, insitu_concentration, time_average
from mpsdem.case import Case
from mpsdem.results import Results

FloatArray = NDArray[np.float64]

QUANTITIES = ("pressure_gradient", "solids_mean_velocity", "bed_height", "delivered_concentration")
_UPRIGHT = 0.2  # [-] cosine of the inclination below which no bed lies in a pipe


@dataclass(frozen=True, slots=True, kw_only=True)
class Series:
    """A quantity of a run over time.

    Parameters
    ----------
    time : (n,) float64 ndarray
        [s].
    values : (n,) float64 ndarray
        In the unit of ``summary.json``; one value where only the end of the run is known.
    """

    time: FloatArray
    values: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Deviation:
    """How far a run lies from what it is compared with.

    Parameters
    ----------
    value : float
        Relative, signed [-]; NaN where there is none.
    bar : float
        Its standard error [-]; NaN where the run has too few values to tell.
    sure : bool
        Whether the run was long enough to trust the bar, which is else too small.
    """

    value: float
    bar: float
    sure: bool = True

    @property
    def size(self) -> float:
        """What may be counted on [-]: no less than the error bar."""
        return max(abs(self.value), self.bar if math.isfinite(self.bar) else 0.0)

    @property
    def resolved(self) -> bool:
        """Whether it is more than chance: two error bars, or four that are too small."""
        bars = 2 if self.sure else 4
        return math.isfinite(self.value) and not abs(self.value) <= bars * self.bar


NONE = Deviation(value=math.nan, bar=math.nan)


def applicable(case: Case, names: Sequence[str] = QUANTITIES) -> list[str]:
    """Those of the quantities that mean something in a case."""
    moving = case.solids is not None and not case.solids.held
    lying = moving and case.gravity * math.cos(case.pipe.inclination) > _UPRIGHT * case.gravity
    flowing = case.liquid is not None and case.liquid.bulk_velocity != 0
    applies = {
        "pressure_gradient": case.liquid is not None,
        "solids_mean_velocity": moving and (flowing or case.pipe.inclination != 0),
        "bed_height": lying,
        "delivered_concentration": moving and flowing,
    }
    return [name for name in names if applies.get(name, True)]


def series_of(results: Results, name: str) -> Series | None:
    """Values of a quantity, by its name in ``summary.json``, over time; None where it has none."""
    time, recorded, case = results.time, results.diagnostics, results.case
    if name in recorded and recorded[name].ndim == 1:
        return Series(time=time, values=np.asarray(recorded[name], dtype=float))
    if name == "bed_height" and case.solids is not None:
        solids = results.solids
        heights = [
            bed_height(z, solids.radius, pipe_radius=case.pipe.radius)
            for z in solids.position[..., 2]
        ]
        return Series(time=time, values=np.array(heights))
    if name == "delivered_concentration" and case.solids is not None and case.liquid is not None:
        share = insitu_concentration(
            results.solids.radius, pipe_radius=case.pipe.radius, length=case.pipe.length
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            slip = recorded["solids_mean_velocity"] / recorded["bulk_velocity"]
        return Series(time=time, values=share * np.where(np.isfinite(slip), slip, np.nan))
    if name == "friction_factor" and case.liquid is not None and case.solids is None:
        velocity = recorded["bulk_velocity"]
        dynamic = case.liquid.density * velocity * np.abs(velocity) / 2
        loss = recorded["pressure_gradient_friction"]
        return Series(time=time, values=loss * 2 * case.pipe.radius / dynamic)
    value = results.summary.get(name)
    if not isinstance(value, int | float) or isinstance(value, bool):
        return None
    return Series(time=time[-1:], values=np.array([float(value)]))


def mean_of(series: Series) -> Deviation:
    """Mean of the second half, with its standard error, both in the unit of the series."""
    average = time_average(series.time, series.values)
    return Deviation(value=average.mean, bar=average.error, sure=average.long_enough)


def deviation(series: Series, reference: Series | float) -> Deviation:
    """How far the mean of a series lies from that of another, or from a known value.

    Parameters
    ----------
    series : Series
        The run's.
    reference : Series or float
        Of a run over the same time, or what is exactly known.

    Returns
    -------
    Deviation
        Over the reference. Where both runs stand at the same times, it is the mean of their
        difference, instant by instant: what they share, such as a start that both are still
        leaving, is not taken for scatter.
    """
    if isinstance(reference, float):
        known, apart = reference, mean_of(
            Series(time=series.time, values=series.values - reference)
        )  # fmt: skip
    else:
        known = mean_of(reference).value
        if series.time.size == reference.time.size and np.allclose(series.time, reference.time):
            apart = mean_of(Series(time=series.time, values=series.values - reference.values))
        else:
            one, other = mean_of(series), mean_of(reference)
            bar = math.hypot(one.bar, other.bar)
            sure = one.sure and other.sure
            apart = Deviation(value=one.value - other.value, bar=bar, sure=sure)
    if known == 0 or not math.isfinite(known):
        return NONE
    return Deviation(value=apart.value / abs(known), bar=apart.bar / abs(known), sure=apart.sure)
