"""Where things are when a run starts."""

from mpsdem.geometry.layout import Kind, Layout, lattice_layout, push_plate_layout, ring_layout
from mpsdem.geometry.nodes import NodeLayout, node_layout
from mpsdem.geometry.placing import Placement, place_solids
from mpsdem.geometry.size import sample_diameters

__all__ = [
    "Kind",
    "Layout",
    "NodeLayout",
    "Placement",
    "lattice_layout",
    "node_layout",
    "place_solids",
    "push_plate_layout",
    "ring_layout",
    "sample_diameters",
]
