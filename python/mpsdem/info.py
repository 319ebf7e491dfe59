"""Which program on which machine: what a result has to name, and `mpsdem info` to show."""

from __future__ import annotations

import platform
import subprocess
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

from mpsdem import _core

_LIBRARIES = ("numpy", "scipy", "h5py", "pydantic", "pint", "matplotlib", "rich", "typer")


def environment() -> dict[str, str | int]:
    """Version, compiler and machine, by name."""
    return {
        "version": _core.version,
        "commit": _commit(),
        "compiler": _core.compiler,
        "simd": _core.simd,
        "cholmod": _core.cholmod or "not found",
        "available_threads": _core.available_threads(),
        "python": platform.python_version(),
        "system": platform.platform(),
        **{name: version(name) for name in _LIBRARIES},
    }


def provenance(threads: int) -> dict[str, str | int]:
    """Where the numbers of a run come from, for its results file.

    Parameters
    ----------
    threads : int
        Threads that the run takes.
    """
    return environment() | {"threads": threads, "date": datetime.now(UTC).isoformat("T", "seconds")}


def _commit() -> str:
    """Last commit to the working tree that the package is imported from, or "unknown"."""
    folder = Path(__file__).parent
    try:
        shown = subprocess.run(
            ["git", "log", "-1", "--format=%h", "--", "."],
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=5,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return "unknown"
    return shown.stdout.strip() or "unknown"
