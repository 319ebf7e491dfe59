"""Numbers from the fields of a run: pure functions of arrays, in SI units."""

from mpsdem.analysis.averages import (
    Average,
    Trend,
    time_average,
    trend,
)
from mpsdem.analysis.bed import (
    bed_height,
    in_bed,
)
from mpsdem.analysis.blockage import (
    Plug,
    accumulation,
    find_plug,
    full_fraction,
    longest,
    standing_full,
    standing_time,
    stands_since,
)
from mpsdem.analysis.concentration import (
    height_edges,
    insitu_concentration,
    radius_edges,
    solids_flux_along_pipe,
    station_count,
    volume_fraction_along_pipe,
    volume_fraction_over_height,
    volume_fraction_over_radius,
    volume_fraction_over_section,
)
from mpsdem.analysis.front import (
    Extent,
    extent,
)
from mpsdem.analysis.ledgers import (
    Ledgers,
    ledgers,
)
from mpsdem.analysis.partial_volumes import (
    cell_area,
    cell_volume,
    ring_volume,
    slab_area,
    slab_volume,
)
from mpsdem.analysis.periods import (
    Periods,
    by_period,
    period_of_motion,
)
from mpsdem.analysis.pipe_flow import (
    friction_velocity,
    laminar_profile,
    turbulent_profile,
)
from mpsdem.analysis.profiles import (
    velocity_over_height,
    velocity_over_radius,
)
from mpsdem.analysis.regime import (
    CRITERION,
    FlowRegime,
    Regime,
    flow_regime,
)
from mpsdem.analysis.report import report
from mpsdem.analysis.silhouette import (
    Silhouette,
    silhouette,
)
from mpsdem.analysis.solids_survey import (
    Profile,
    SolidsSurvey,
    survey_solids,
)
from mpsdem.analysis.survey import (
    Blockage,
    Survey,
    survey,
)
from mpsdem.analysis.velocity_density import (
    Density,
    radial_velocity,
    velocity_density,
)

__all__ = [
    "CRITERION",
    "Average",
    "Blockage",
    "Density",
    "Extent",
    "FlowRegime",
    "Ledgers",
    "Periods",
    "Plug",
    "Profile",
    "Regime",
    "Silhouette",
    "SolidsSurvey",
    "Survey",
    "Trend",
    "accumulation",
    "bed_height",
    "by_period",
    "cell_area",
    "cell_volume",
    "extent",
    "find_plug",
    "flow_regime",
    "friction_velocity",
    "full_fraction",
    "height_edges",
    "in_bed",
    "insitu_concentration",
    "laminar_profile",
    "ledgers",
    "longest",
    "period_of_motion",
    "radial_velocity",
    "radius_edges",
    "report",
    "ring_volume",
    "silhouette",
    "slab_area",
    "slab_volume",
    "solids_flux_along_pipe",
    "standing_full",
    "standing_time",
    "stands_since",
    "station_count",
    "survey",
    "survey_solids",
    "time_average",
    "trend",
    "turbulent_profile",
    "velocity_density",
    "velocity_over_height",
    "velocity_over_radius",
    "volume_fraction_along_pipe",
    "volume_fraction_over_height",
    "volume_fraction_over_radius",
    "volume_fraction_over_section",
]
