"""What the papers of two reference cases state, beside what the cases give.

A paper that prints no numbers can still be wrong or right: each of its statements becomes a number
with an error bar, and bounds within which the statement holds.
"""

from mpsdem.validation.reproduction.horizontal import HORIZONTAL
from mpsdem.validation.reproduction.inclined import INCLINED
from mpsdem.validation.reproduction.measured import Measured
from mpsdem.validation.reproduction.reasons import REASONS
from mpsdem.validation.reproduction.scene import Instant, Scene
from mpsdem.validation.reproduction.statement import Statement

__all__ = ["HORIZONTAL", "INCLINED", "REASONS", "Instant", "Measured", "Scene", "Statement"]
