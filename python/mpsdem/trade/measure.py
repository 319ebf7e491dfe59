"""Measure the table that the package ships.

usage: python -m mpsdem.trade.measure [--scratch DIR] [--table FILE] [SCENE]...

About twenty minutes of computing on one core. What was measured before, in DIR, is not run again;
scenes that are not named keep their place in the table.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mpsdem.info import provenance
from mpsdem.results.files import write_atomically
from mpsdem.trade.machine import Machine
from mpsdem.trade.outcome import as_json
from mpsdem.trade.scenes import SCENES
from mpsdem.trade.table import TABLE
from mpsdem.trade.trading import trade

_LONG = 6 * 3600.0  # [s] so that no scene is cut short


def measure(
    names: Sequence[str] = (), *, scratch: Path, table: Path = TABLE, cores: int = 1
) -> dict[str, Any]:
    """Measure scenes, all by default, and write them into a table.

    Parameters
    ----------
    names : sequence of str
        Of `SCENES`.
    scratch : Path
        Where runs go.
    table : Path
        Is read, where it exists, and written.
    cores : int
        To use. More than one gives the same errors; costs only if no run disturbs another.

    Returns
    -------
    dict
        The table.
    """
    machines = [Machine.measured()]
    known: dict[str, Any] = {}
    if table.exists():
        known = json.loads(table.read_text("utf-8"))["scenes"]
    for name in names or SCENES:
        scene = SCENES[name]()
        outcome = trade(
            scene.case,
            scratch / name.replace(" ", "_"),
            quantities=scene.quantities,
            exact=scene.exact,
            seconds=_LONG,
            cores=cores,
            tell=lambda text, name=name: _tell(f"{name}: {text}"),  # type: ignore[misc]
        )
        known[name] = as_json(outcome)
        machines.append(Machine.measured())
    machine = {
        "solids": float(f"{_median([m.solids for m in machines]):.3g}"),
        "liquid": float(f"{_median([m.liquid for m in machines]):.3g}"),
    }
    origin = provenance(1)
    whole = {
        "provenance": {k: origin[k] for k in ("version", "compiler", "simd", "date")},
        "machine": machine,
        "scenes": {name: known[name] for name in SCENES if name in known},
    }
    write_atomically(table, (json.dumps(whole, indent=1, ensure_ascii=False) + "\n").encode())
    return whole


def _median(values: list[float]) -> float:
    return sorted(values)[len(values) // 2]


def _tell(text: str) -> None:
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def main() -> None:
    """Entry point of ``python -m mpsdem.trade.measure``."""
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", metavar="SCENE", nargs="*", choices=[*SCENES, []])
    parser.add_argument("--scratch", type=Path, default=Path("out/trade_table"))
    parser.add_argument("--table", type=Path, default=TABLE)
    parser.add_argument("--cores", type=int, default=1)
    given = parser.parse_args()
    measure(given.scenes, scratch=given.scratch, table=given.table, cores=given.cores)
    _tell(f"written to {given.table}")


if __name__ == "__main__":
    main()
