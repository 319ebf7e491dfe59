"""`summary.json`, a run in about twenty numbers, and `report.json`, all that its fields tell."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from mpsdem.results.files import REPORT, SUMMARY, write_atomically

SUMMARY_KEYS = (
    "status",
    "time",
    "steps",
    "wall_seconds",
    "cpu_seconds",
    "liquid_model",
    "liquid_count",
    "solids_count",
    "bulk_velocity",
    "pressure_gradient",
    "pressure_gradient_static",
    "friction_factor",
    "solids_mean_velocity",
    "solids_front_position",
    "insitu_concentration",
    "delivered_concentration",
    "bed_height",
    "largest_overlap",
    "mass_error",
    "momentum_error",
    "exchange_error",
    "warnings",
)
"""What every summary holds; `None` where it does not apply, with the reason."""


def write_summary(
    directory: str | os.PathLike[str],
    summary: Mapping[str, Any],
    *,
    not_applicable: Mapping[str, str] | None = None,
) -> None:
    """Write ``DIRECTORY/summary.json``, whole or not at all.

    Parameters
    ----------
    directory : path-like
        The run's output directory.
    summary : mapping
        Values by name; all of `SUMMARY_KEYS` but those in `not_applicable`, and any others.
    not_applicable : mapping of str to str, optional
        Names that mean nothing for this run, each with the reason; written as null.

    Raises
    ------
    ValueError
        If a key of `SUMMARY_KEYS` is missing.
    OutputError
        If the file cannot be written.
    """
    reasons = dict(not_applicable or {})
    values = dict(summary) | dict.fromkeys(reasons)
    if missing := [key for key in SUMMARY_KEYS if key not in values]:
        raise ValueError(f"the summary lacks {', '.join(missing)}")
    ordered = {key: values.pop(key) for key in SUMMARY_KEYS} | values | {"not_applicable": reasons}
    _write(Path(directory) / SUMMARY, ordered, indent=2)


def write_report(directory: str | os.PathLike[str], report: Mapping[str, Any]) -> Path:
    """Write ``DIRECTORY/report.json``, whole or not at all.

    Parameters
    ----------
    directory : path-like
        The run's output directory.
    report : mapping
        Nested values by name; what is not finite becomes null.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    path = Path(directory) / REPORT
    _write(path, report, indent=1)
    return path


def _write(path: Path, values: Mapping[str, Any], *, indent: int) -> None:
    text = json.dumps(_plain(values), indent=indent, ensure_ascii=False, allow_nan=False)
    text = _NUMBERS.sub(lambda row: f"[{' '.join(row[1].split())}]", text)
    write_atomically(path, (text + "\n").encode())


# An array of numbers, which reads better in a line.
_NUMBERS = re.compile(r"\[([^][{}\"]*)\]")


def _plain(value: Any) -> Any:
    """The value in JSON's own types; JSON has no infinity and no NaN, so these become null."""
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
