"""The case file: frozen models, SI inside, units and every check at the border."""

from mpsdem.case.axis import MovingAxis
from mpsdem.case.case import Case, load_case
from mpsdem.case.errors import CaseError, Problem
from mpsdem.case.fidelity import Fidelity
from mpsdem.case.liquid import Liquid
from mpsdem.case.motion import Motion, Movement, Vibration
from mpsdem.case.output import Output
from mpsdem.case.pipe import Pipe
from mpsdem.case.solids import (
    Block,
    Distribution,
    List,
    Lognormal,
    Material,
    Random,
    Sieve,
    Solids,
    Uniform,
    Wall,
)

__all__ = [
    "Block",
    "Case",
    "CaseError",
    "Distribution",
    "Fidelity",
    "Liquid",
    "List",
    "Lognormal",
    "Material",
    "Motion",
    "Movement",
    "MovingAxis",
    "Output",
    "Pipe",
    "Problem",
    "Random",
    "Sieve",
    "Solids",
    "Uniform",
    "Vibration",
    "Wall",
    "load_case",
]
