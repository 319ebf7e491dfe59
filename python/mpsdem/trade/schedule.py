"""How long runs may be so that all of them fit into the time there is."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from mpsdem.case import Case
from mpsdem.plan import terminal_velocity
from mpsdem.trade.settings import AS_GIVEN, LEVELS, LeftOut, Setting

_ROOM = 0.75  # share of the time that is planned with: estimates are off, and cores stand idle
_DIAMETERS = 20  # that the flow goes at least, for a mean to mean anything
_FRAMES = 60  # of a run, that its averages come from


@dataclass(frozen=True, slots=True, kw_only=True)
class Schedule:
    """What is run, and for how long.

    Parameters
    ----------
    end_time : float
        Of every run [s].
    kept : tuple of Setting
        In the order of the runs: the reference first, which all others need.
    left_out : tuple of LeftOut
        For which there is no time.
    cpu_seconds : float
        That all of it is expected to take [s].
    """

    end_time: float
    kept: tuple[Setting, ...]
    left_out: tuple[LeftOut, ...]
    cpu_seconds: float


def make_schedule(
    settings: Sequence[Setting],
    rates: Mapping[str, float],
    *,
    seconds: float,
    workers: int,
    longest: float,
    shortest: float,
) -> Schedule:
    """Choose one end time for all settings, and leave out the dearest where it would be too short.

    Parameters
    ----------
    settings : sequence of Setting
    rates : mapping of str to float
        Processor time of a simulated second [-], by the name of the setting.
    seconds : float
        Of wall clock that there are [s].
    workers : int
        Runs side by side.
    longest, shortest : float
        End time that is wanted, and below which a run tells nothing [s].

    Returns
    -------
    Schedule
        The case as given and the quick level are always kept; a level is left out where it takes
        too long by itself, else only when all knobs have been.
    """
    kept, left_out = list(settings), []

    def end_time() -> float:
        """That the settings kept so far leave [s]."""
        costs = [rates[setting.name] for setting in kept]
        return _ROOM * seconds / max(sum(costs) / workers, max(costs))

    while end_time() < min(shortest, longest):
        spare = [s for s in kept if s.knob not in (AS_GIVEN, "level")]
        levels = [s for s in kept if s.knob == "level" and s.value != LEVELS[0]]
        alone = max(kept, key=lambda setting: rates[setting.name])
        if alone in levels and rates[alone.name] > sum(rates[s.name] for s in kept) / workers:
            spare = [alone]  # a run that takes all the time by itself: no other gives it more
        spare = spare or levels
        if not spare:
            break
        dearest = max(spare, key=lambda setting: rates[setting.name])
        kept.remove(dearest)
        cost = rates[dearest.name] * min(shortest, longest)
        reason = f"no time: {cost:.0f} s of computing for the {min(shortest, longest):.3g} s needed"
        left_out.append(LeftOut(setting=str(dearest), reason=reason))
    until = min(longest, float(f"{end_time():.3g}"))
    reference = finest(kept)
    kept.sort(key=lambda setting: (_importance(setting, reference), -rates[setting.name]))
    total = until * sum(rates[setting.name] for setting in kept)
    return Schedule(
        end_time=until, kept=tuple(kept), left_out=tuple(left_out), cpu_seconds=total
    )  # fmt: skip


def finest(settings: Sequence[Setting]) -> Setting:
    """The setting that others are compared with: the highest level there is."""
    levels = [setting for setting in settings if setting.knob == "level"]
    return max(levels, key=lambda setting: setting.number) if levels else settings[0]


def _importance(setting: Setting, reference: Setting) -> int:
    if setting == reference:
        return 0
    return 1 if setting.knob == AS_GIVEN else 2 if setting.knob == "level" else 3


def least_time(case: Case) -> float:
    """Time in which the flow has gone twenty bores, or a solid has sunk through twenty [s]."""
    speed = abs(case.liquid.bulk_velocity) if case.liquid is not None else 0.0
    speed = max(speed, terminal_velocity(case))
    return _DIAMETERS * 2 * case.pipe.radius / speed if speed > 0 else math.inf


def shortened(case: Case, end_time: float) -> Case:
    """The case up to an end time [s], with frames enough for averages and no figures."""
    frames = max(_FRAMES, math.ceil(end_time / case.output.every * (1 - 1e-9)))
    output = {"every": end_time / frames, "times": None, "figures": False, "liquid_stride": 0}
    return case.with_(end_time=end_time, fidelity={"threads": 1}, output=output)
