"""Where things are when a run starts."""

from mpsdem.geometry.placing import Placement, place_solids
from mpsdem.geometry.size import sample_diameters

__all__ = ["Placement", "place_solids", "sample_diameters"]
