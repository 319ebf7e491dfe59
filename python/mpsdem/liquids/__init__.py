"""The liquids behind one interface: what carries the solids never asks which one it is."""

from mpsdem.liquids.bending import bending
from mpsdem.liquids.bins import section_count
from mpsdem.liquids.build import build_liquid, node_layout_of, particle_layout
from mpsdem.liquids.nodes import NodeLiquid
from mpsdem.liquids.particles import CLIPS, PLATE_COUNTS, ParticleLiquid
from mpsdem.liquids.profile import ProfileLiquid
from mpsdem.liquids.protocol import ComputedLiquid, Liquid

__all__ = [
    "CLIPS",
    "PLATE_COUNTS",
    "ComputedLiquid",
    "Liquid",
    "NodeLiquid",
    "ParticleLiquid",
    "ProfileLiquid",
    "bending",
    "build_liquid",
    "node_layout_of",
    "particle_layout",
    "section_count",
]
