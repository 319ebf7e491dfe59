"""Numbers from the fields of a run: pure functions of arrays, in SI units."""

from mpsdem.analysis.front import Extent, extent
from mpsdem.analysis.pipe_flow import friction_velocity, laminar_profile, turbulent_profile
from mpsdem.analysis.profiles import (
    height_edges,
    slab_area,
    slab_volume,
    velocity_over_height,
    volume_fraction_over_height,
)
from mpsdem.analysis.silhouette import Silhouette, silhouette

__all__ = [
    "Extent",
    "Silhouette",
    "extent",
    "friction_velocity",
    "height_edges",
    "laminar_profile",
    "silhouette",
    "slab_area",
    "slab_volume",
    "turbulent_profile",
    "velocity_over_height",
    "volume_fraction_over_height",
]
