"""The stages of a time step. The plan names those that a scene needs; the run calls them in turn.

A stage is a small frozen object: its parameters are fixed before the run, and all that changes
stands in the `State` that it is called with.
"""

from mpsdem.stages.build import build_stages, build_state
from mpsdem.stages.state import SimulationDiverged, Stage, State, check
from mpsdem.stages.steps import (
    AdvanceLiquid,
    AdvanceSolids,
    ExchangeMomentum,
    HoldSolids,
    begin_exchange,
)

__all__ = [
    "AdvanceLiquid",
    "AdvanceSolids",
    "ExchangeMomentum",
    "HoldSolids",
    "SimulationDiverged",
    "Stage",
    "State",
    "begin_exchange",
    "build_stages",
    "build_state",
    "check",
]
