"""The measured table that the package ships."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from mpsdem.trade.machine import Machine
from mpsdem.trade.outcome import Outcome, from_json

TABLE = Path(__file__).with_name("table.json")


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Cost and error of each knob in scenes of several kinds.

    Parameters
    ----------
    machine : Machine
        That it was measured on.
    scenes : mapping of str to Outcome
        By their names in `mpsdem.trade.scenes`.
    """

    machine: Machine
    scenes: Mapping[str, Outcome]


def read_table(path: Path) -> Table:
    """Read what ``python -m mpsdem.trade.measure`` wrote."""
    table = json.loads(path.read_text("utf-8"))
    return Table(
        machine=Machine(**table["machine"]),
        scenes={name: from_json(scene) for name, scene in table["scenes"].items()},
    )


@cache
def shipped_table() -> Table:
    """The table of this version; empty where none has been measured."""
    if not TABLE.exists():
        return Table(machine=Machine(solids=1.0, liquid=1.0), scenes={})
    return read_table(TABLE)
