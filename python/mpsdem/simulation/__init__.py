"""The run: a case and its plan in, a directory of results out."""

from mpsdem.simulation.run import Simulation
from mpsdem.simulation.watch import SimulationInterrupted
from mpsdem.stages import SimulationDiverged

__all__ = ["Simulation", "SimulationDiverged", "SimulationInterrupted"]
