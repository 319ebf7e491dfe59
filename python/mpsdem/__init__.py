"""Hydraulic transport of coarse solids in pipes: MPS liquid, DEM solids. SI units throughout.

>>> import mpsdem as md
>>> case = md.load_case("cases/horizontal_pipe.toml")  # doctest: +SKIP
>>> results = md.Simulation(case, output="out/pipe").run()  # doctest: +SKIP
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mpsdem.case import Case, CaseError, load_case
    from mpsdem.plan import Plan, make_plan
    from mpsdem.plot import save_figures
    from mpsdem.results import Results
    from mpsdem.simulation import Simulation, SimulationDiverged, SimulationInterrupted

__all__ = [
    "Case",
    "CaseError",
    "Plan",
    "Results",
    "Simulation",
    "SimulationDiverged",
    "SimulationInterrupted",
    "load_case",
    "make_plan",
    "save_figures",
]

# Imported where first asked for, so that cases and results open without the compiled core.
_HOMES = {
    "Case": "case",
    "CaseError": "case",
    "Plan": "plan",
    "Results": "results",
    "Simulation": "simulation",
    "SimulationDiverged": "simulation",
    "SimulationInterrupted": "simulation",
    "load_case": "case",
    "make_plan": "plan",
    "save_figures": "plot",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'mpsdem' has no attribute {name!r}")
    return getattr(import_module(f"mpsdem.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted(__all__)
