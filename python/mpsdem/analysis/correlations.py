"""Engineering correlations for water and sand, gravel or nodules: orientation, not simulation."""

from __future__ import annotations

import math

LAMINAR_LIMIT = 2300.0  # [-] Reynolds number of a pipe below which its flow is laminar
NEWTON_REGIME = 1000.0  # [-] Reynolds number of a sphere above which its drag coefficient is fixed
NEWTON_DRAG = 0.44  # [-]


def friction_factor(reynolds: float, relative_roughness: float = 0.0) -> float:
    """Darcy friction factor of a full pipe.

    Parameters
    ----------
    reynolds : float
        Of the bulk velocity and the pipe's diameter [-].
    relative_roughness : float
        Sand-grain roughness over the pipe's diameter [-].

    Returns
    -------
    float
        ``64 / reynolds`` below 2300, above it by Colebrook's equation [-].

    Raises
    ------
    ValueError
        If `reynolds` is not positive, or `relative_roughness` lies outside 0 to 0.05.

    Notes
    -----
    Within 2 % of measurements in smooth pipes from a Reynolds number of 4000; between 2300 and 4000
    the flow is intermittent and no law holds.

    References
    ----------
    Colebrook (1939), doi:10.1680/ijoti.1939.13150.

    Examples
    --------
    >>> round(friction_factor(2e5), 4)
    0.0156
    """
    _require_positive("reynolds", reynolds)
    if not 0 <= relative_roughness <= 0.05:
        raise ValueError(f"relative_roughness = {relative_roughness}: must lie in [0, 0.05]")
    if reynolds < LAMINAR_LIMIT:
        return 64 / reynolds
    x = 7.0  # 1 / sqrt(f); each turn gains a digit
    for _ in range(30):
        x = -2 * math.log10(relative_roughness / 3.7 + 2.51 * x / reynolds)
    return x**-2


def sphere_drag_coefficient(reynolds: float) -> float:
    """Drag coefficient of a lone smooth sphere.

    Parameters
    ----------
    reynolds : float
        Of the slip and the sphere's diameter [-], up to 2e5.

    Returns
    -------
    float
        Force over dynamic pressure and frontal area [-].

    Notes
    -----
    Within 5 % of measurements up to a Reynolds number of 800, within 15 % up to 2e5.

    References
    ----------
    Schiller & Naumann (1933), Z. Ver. Dtsch. Ing. 77, 318-320; constant 0.44 from 1000 on.
    """
    _require_positive("reynolds", reynolds)
    if reynolds >= NEWTON_REGIME:
        return NEWTON_DRAG
    return 24 / reynolds * (1 + 0.15 * math.pow(reynolds, 0.687))


def terminal_velocity(
    *,
    diameter: float,
    density: float,
    liquid_density: float,
    kinematic_viscosity: float,
    gravity: float = 9.807,
) -> float:
    """Speed at which a lone sphere settles in a liquid at rest.

    Parameters
    ----------
    diameter : float
        [m]
    density, liquid_density : float
        Of the sphere and of the liquid [kg/m3].
    kinematic_viscosity : float
        Of the liquid [m2/s].
    gravity : float
        [m/s2]

    Returns
    -------
    float
        Terminal velocity [m/s]: positive for a sphere that sinks, negative for one that rises.

    Notes
    -----
    Balances the weight in the liquid with `sphere_drag_coefficient`: 5 % low just above a Reynolds
    number of 1000, where the true drag coefficient has its minimum.

    Examples
    --------
    A glass bead of 1 mm in water:

    >>> v = terminal_velocity(
    ...     diameter=1e-3, density=2500, liquid_density=998.2, kinematic_viscosity=1.004e-6
    ... )
    >>> round(v, 3)
    0.146
    """
    _require_positive("diameter", diameter)
    _require_positive("density", density)
    _require_positive("liquid_density", liquid_density)
    _require_positive("kinematic_viscosity", kinematic_viscosity)
    excess = density / liquid_density - 1
    best = 4 / 3 * gravity * diameter**3 * abs(excess) / kinematic_viscosity**2  # C_d Re^2
    reynolds = math.sqrt(best / NEWTON_DRAG)
    if reynolds < NEWTON_REGIME:
        # Newton's method on a convex function, from above, so it cannot overshoot.
        reynolds = best / 24
        for _ in range(60):
            drag = 24 * (reynolds + 0.15 * math.pow(reynolds, 1.687))
            slope = 24 * (1 + 0.15 * 1.687 * math.pow(reynolds, 0.687))
            reynolds -= (drag - best) / slope
        reynolds = min(reynolds, NEWTON_REGIME)  # C_d rises there by 0.4 % at once
    return math.copysign(reynolds * kinematic_viscosity / diameter, excess)


def durand_deposition_velocity(
    *,
    pipe_diameter: float,
    diameter: float,
    density: float,
    liquid_density: float,
    volume_fraction: float,
    gravity: float = 9.807,
) -> float:
    """Bulk velocity below which solids settle to a bed in a level pipe, after Durand.

    Parameters
    ----------
    pipe_diameter : float
        Of the bore [m].
    diameter : float
        Of the solids; their median [m].
    density, liquid_density : float
        Of the solids and of the liquid [kg/m3].
    volume_fraction : float
        Delivered volume fraction of solids [-].
    gravity : float
        [m/s2]

    Returns
    -------
    float
        Deposition velocity [m/s]; 0 for solids that do not sink.

    Notes
    -----
    ``F_L sqrt(2 g D (s - 1))`` with ``F_L = 1.3 C^0.125 (1 - exp(-6.9 d / mm))``. Made from sand
    and gravel in water (``s`` near 2.65), fractions of 0.02 to 0.15; ``F_L`` no longer depends on
    the size above 1 mm. Correlations of this kind disagree by 20 to 60 % for coarse solids.

    References
    ----------
    Durand (1953), Proc. Minnesota Int. Hydraulics Convention, 89-103; ``F_L`` by Schiller & Herbich
    (1991), in Handbook of Dredging Engineering.
    """
    scale = _bed_scale(pipe_diameter, density, liquid_density, gravity)
    _require_positive("diameter", diameter)
    _require_fraction(volume_fraction)
    return 1.3 * math.pow(volume_fraction, 0.125) * -math.expm1(-6.9 * diameter / 1e-3) * scale


def wasp_deposition_velocity(
    *,
    pipe_diameter: float,
    diameter: float,
    density: float,
    liquid_density: float,
    volume_fraction: float,
    gravity: float = 9.807,
) -> float:
    """Bulk velocity below which solids settle to a bed in a level pipe, after Wasp.

    Parameters
    ----------
    pipe_diameter : float
        Of the bore [m].
    diameter : float
        Of the solids; their median [m].
    density, liquid_density : float
        Of the solids and of the liquid [kg/m3].
    volume_fraction : float
        Delivered volume fraction of solids [-].
    gravity : float
        [m/s2]

    Returns
    -------
    float
        Deposition velocity [m/s]; 0 for solids that do not sink.

    Notes
    -----
    ``3.116 C^0.186 sqrt(2 g D (s - 1)) (d / D)^(1/6)``. Made for slurries of fine and medium sand,
    ``d / D`` below about 0.01; for coarser solids it is an extrapolation.

    References
    ----------
    Wasp, Kenny & Gandhi (1977), Solid-liquid flow: slurry pipeline transportation.
    """
    scale = _bed_scale(pipe_diameter, density, liquid_density, gravity)
    _require_positive("diameter", diameter)
    _require_fraction(volume_fraction)
    return (
        3.116 * math.pow(volume_fraction, 0.186) * scale * math.pow(diameter / pipe_diameter, 1 / 6)
    )


def _bed_scale(
    pipe_diameter: float, density: float, liquid_density: float, gravity: float
) -> float:
    _require_positive("pipe_diameter", pipe_diameter)
    _require_positive("density", density)
    _require_positive("liquid_density", liquid_density)
    return math.sqrt(2 * gravity * pipe_diameter * max(density / liquid_density - 1, 0.0))


def _require_positive(name: str, value: float) -> None:
    if not value > 0:
        raise ValueError(f"{name} = {value}: must be > 0")


def _require_fraction(value: float) -> None:
    if not 0 <= value < 1:
        raise ValueError(f"volume_fraction = {value}: must lie in [0, 1)")
