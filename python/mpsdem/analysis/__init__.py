"""Numbers from the fields of a run: pure functions of arrays, in SI units."""

from mpsdem.analysis.averages import Average, time_average
from mpsdem.analysis.concentration import (
    height_edges,
    insitu_concentration,
    radius_edges,
    solids_flux_along_pipe,
    volume_fraction_along_pipe,
    volume_fraction_over_height,
    volume_fraction_over_radius,
    volume_fraction_over_section,
)
from mpsdem.analysis.front import Extent, extent
from mpsdem.analysis.partial_volumes import (
    cell_area,
    cell_volume,
    ring_volume,
    slab_area,
    slab_volume,
)
from mpsdem.analysis.pipe_flow import friction_velocity, laminar_profile, turbulent_profile
from mpsdem.analysis.profiles import velocity_over_height, velocity_over_radius
from mpsdem.analysis.silhouette import Silhouette, silhouette

__all__ = [
    "Average",
    "Extent",
    "Silhouette",
    "cell_area",
    "cell_volume",
    "extent",
    "friction_velocity",
    "height_edges",
    "insitu_concentration",
    "laminar_profile",
    "radius_edges",
    "ring_volume",
    "silhouette",
    "slab_area",
    "slab_volume",
    "solids_flux_along_pipe",
    "time_average",
    "turbulent_profile",
    "velocity_over_height",
    "velocity_over_radius",
    "volume_fraction_along_pipe",
    "volume_fraction_over_height",
    "volume_fraction_over_radius",
    "volume_fraction_over_section",
]
