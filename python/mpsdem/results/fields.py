"""The names that a results file may hold, each with its unit and meaning: NOTATION as data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True, slots=True, kw_only=True)
class FieldInfo:
    """Unit, meaning and NumPy type of one dataset; "1" is the unit of a pure number."""

    unit: str
    description: str
    dtype: str = "float64"


def _table(
    *rows: tuple[str, str, str] | tuple[str, str, str, str],
) -> Mapping[str, FieldInfo]:
    return MappingProxyType(
        {
            name: FieldInfo(unit=unit, description=text, dtype=dtype[0] if dtype else "float64")
            for name, unit, text, *dtype in rows
        }
    )


TIME = FieldInfo(unit="s", description="Simulated time of each frame")

SOLIDS = _table(
    ("radius", "m", "Radius of each solid"),
    ("density", "kg/m3", "Density of each solid"),
    ("position", "m", "Centre of each solid; x wrapped into [0, pipe length)"),
    ("velocity", "m/s", "Velocity of each solid's centre"),
    ("spin", "rad/s", "Angular velocity of each solid"),
    ("laps", "1", "Times each solid left the outlet and came back at the inlet", "int32"),
    ("void_fraction", "1", "Share of liquid in the surroundings of each solid"),
    ("liquid_velocity", "m/s", "Undisturbed liquid velocity at each solid"),
    ("drag_force", "N", "Drag of the liquid on each solid now, added mass apart"),
    ("section_position", "m", "Middles of equal bins along the pipe"),
    ("section_solids_fraction", "1", "Share of the solids in each bin, by where their centres are"),
    ("section_solids_velocity", "m/s", "Their mean axial velocity there; NaN where there are none"),
)

LIQUID = _table(
    ("profile_radius", "m", "Distances from the pipe axis at which the profile is given"),
    ("profile_velocity", "m/s", "Prescribed axial liquid velocity at those distances"),
    ("velocity_profile", "m/s", "Mean axial velocity of the liquid in rings at those distances"),
    ("layer_height", "m", "Middles of equal layers from the bottom of the bore to its top, z"),
    ("layer_velocity", "m/s", "Mean axial velocity of the liquid in those layers"),
    ("section_position", "m", "Middles of equal bins along the pipe"),
    ("section_pressure", "Pa", "Mean pressure in those bins, mean gradient and static head apart"),
    ("kind", "1", "Each recorded particle: 2 liquid, -2 wall, -1 ghost", "int8"),
    (
        "position",
        "m",
        "Place of each recorded particle, x wrapped into [0, pipe length) in a periodic pipe; with "
        "a push plate, NaN where no particle holds the place in this frame",
    ),
    ("velocity", "m/s", "Velocity of each recorded particle"),
    ("pressure", "Pa", "Pressure of each recorded particle, mean gradient and static head apart"),
)

DIAGNOSTICS = _table(
    ("pressure_gradient", "Pa/m", "Loss of pressure along the axis, static head apart"),
    ("pressure_gradient_friction", "Pa/m", "Part of it that the walls take from the liquid"),
    ("pressure_gradient_solids", "Pa/m", "Part of it that the solids take from the liquid"),
    (
        "bulk_velocity",
        "m/s",
        "Flow rate over the cross-section of the bore: of liquid and solids where it feels them, "
        "else of the liquid",
    ),
    ("liquid_flux", "m/s", "Flow rate of the liquid alone over the cross-section of the bore"),
    ("power_input", "W/m", "Flow rate times loss of pressure, since the last frame"),
    ("dissipation", "W/m", "Power put in that is neither motion, contact nor height of the solids"),
    ("shaking_power", "W/m", "Work of the pipe's motion on the solids, since the last frame"),
    ("pipe_displacement", "m", "Where the pipe is, from its place without motion"),
    ("pipe_velocity", "m/s", "Velocity of the pipe"),
    ("pipe_acceleration", "m/s2", "Acceleration of the pipe"),
    ("solids_mean_velocity", "m/s", "Axial velocity of the solids, weighted with their mass"),
    ("largest_overlap", "1", "Largest contact overlap over the radius, since the last frame"),
    ("kinetic_energy", "J", "Kinetic energy of the solids, spin included"),
    ("elastic_energy", "J", "Energy stored in the contacts"),
    ("contacts", "1", "Number of touching pairs, walls included", "int64"),
    ("wall_force", "N", "Mean force of the walls on the solids since the last frame"),
    ("drag_force", "N", "Mean force of the liquid on all solids, added mass in, buoyancy apart"),
    ("pressure_iterations", "1", "Iterations for the pressure, mean per step since the last frame"),
    ("pressure_residual", "1", "Largest residual of the pressure equation since the last frame"),
    ("density_scatter", "1", "Scatter of the liquid's particle number density about its mean"),
    ("pressure_noise", "Pa", "Scatter of the liquid's pressure, mean gradient and head apart"),
    ("divergence", "1", "Largest rms divergence of the liquid, times spacing over speed"),
    ("liquid_kinetic_energy", "J/kg", "Kinetic energy of the liquid over its mass"),
    ("clamped", "1", "Pressures cut to their bounds since the last frame", "int64"),
    (
        "liquid_unexplained",
        "Pa/m",
        "What convection and pressure did to the liquid's momentum",
    ),
    (
        "convection_error",
        "Pa/m",
        "Axial momentum of the liquid that its convection between solids lost, and was given back",
    ),
    (
        "exchange_error",
        "1",
        "Largest relative difference of what both gave each other",
    ),
    ("liquid_volume_error", "1", "Largest error of the liquid's volume since the last frame"),
    (
        "void_fraction_clipped",
        "1",
        "Void fractions at solids raised to their floor",
        "int64",
    ),
    ("liquid_void_fraction_clipped", "1", "Void fractions in the liquid raised to it", "int64"),
    ("drags", "1", "Drags found since the last frame", "int64"),
    ("drags_outside", "1", "Those of them outside the range of their law", "int64"),
    ("viscosity_capped", "1", "Eddy viscosities cut to what the step can bear", "int64"),
    ("shifts_cut", "1", "Shifts of particles cut to their longest since the last frame", "int64"),
    ("deficient", "1", "Particles without a viscous term since the last frame", "int64"),
    ("held_back", "1", "Particles held back from a wall since the last frame", "int64"),
    ("plate_returns", "1", "Returns of the push plate since the last frame", "int64"),
    ("entered", "1", "Particles that filled the gap behind it since the last frame", "int64"),
    ("replaced", "1", "Particles before it that went for them since the last frame", "int64"),
    ("crowded", "1", "Particles left out of the gap, too near to others", "int64"),
    ("left", "1", "Particles that left through the outlet since the last frame", "int64"),
    ("pushed", "1", "Particles held back from the push plate since the last frame", "int64"),
)

GROUPS: Mapping[str, Mapping[str, FieldInfo]] = MappingProxyType(
    {"solids": SOLIDS, "liquid": LIQUID, "diagnostics": DIAGNOSTICS}
)
