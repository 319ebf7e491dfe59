"""Numerics: how accurately the case is computed, apart from what it is."""

from __future__ import annotations

from typing import Annotated, Literal

from mpsdem.case.part import Part
from mpsdem.case.units import Quantity, Whole

# A restitution of 0.9 is met to 0.001 at 0.1, 0.006 at 0.3, 0.014 at 0.5; bulk flow does not move
# up to there (docs/trade.md).
_RAYLEIGH_FRACTION = {"quick": 0.3, "balanced": 0.1, "fine": 0.05}
# Twice 0.1 moves settling by less than 0.01 % and a sliding bed by less than chance
# (docs/trade.md); a pipe full of a packed bed swings at it, at 0.1 it does not (docs/extremes.md).
_COUPLING_FRACTION = {"quick": 0.2, "balanced": 0.1, "fine": 0.1}
_CROWDED = 0.1  # [-] mean solid fraction from which all levels exchange as balanced does
_SPACINGS_ACROSS = {"quick": 10, "balanced": 16, "fine": 24}


class Fidelity(Part):
    """A level, and whatever is to differ from it.

    Parameters
    ----------
    level : {"quick", "balanced", "fine"}
        Sets all that is not given below.
    rayleigh_fraction : float, optional
        Time step of the solids over the Rayleigh time of the smallest of them [-]; at most 0.5.
    solid_step : float, optional
        Time step of the solids [s]; refused by the plan if it exceeds a limit.
    liquid_step : float, optional
        Longest time step of a computed liquid [s]; Courant number and viscosity may shorten it.
    coupling_step : float, optional
        Time between two exchanges with the liquid [s]; by default 0.1 of the times over which
        the forces on a solid change, at quick 0.2 if solids fill less than a tenth of the bore.
    stiffness_factor : float
        Multiplies every modulus and stiffness [-]; less than 1 buys larger steps with overlap.
    smoothing_radius : float, optional
        Radius over which void fraction and exchange with the liquid are averaged [m]; by default
        2.5 largest diameters, and at least 3 spacings of a computed liquid.
    coupling : {"auto", "one-way", "two-way"}
        Whether the liquid feels the solids. ``"auto"``: where it is computed, in a periodic pipe,
        and the solids fill more than 0.001 of the bore; a prescribed profile never does.
    added_mass : {"auto", "on", "off"}
        Whether a solid carries half its volume of liquid along. ``"auto"``: where it is less than
        twice as dense as the liquid.
    lubrication : {"auto", "on", "off"}
        Whether the liquid in the gap between two solids, or at the wall, damps their impact.
        ``"auto"``: where the Stokes number of impacts is below 100.
    particle_spacing : float, optional
        Distance between the particles of a computed liquid [m]; by default 1/10, 1/16 or 1/24 of
        the bore. The layout takes the nearest that divides the radius.
    courant : float
        Largest speed of a computed liquid times its step over the spacing [-]; nodes with solids
        between them part a step where it exceeds 0.45.
    convection : {"upwind", "muscl"}
        How a liquid on fixed nodes is carried: least-squares upwind, or MUSCL-Rusanov, slower, more
        damped and more robust.
    time_scheme : {"rk2", "rk3"}
        Runge-Kutta steps of a liquid on fixed nodes: two stages bear a ``courant`` of 0.8, three
        one of 1.2.
    pressure_tolerance : float
        Residual at which the pressure equation of a particle liquid is solved, relative [-].
    pressure_solver : {"two_level", "jacobi", "cholmod"}
        Of a particle liquid: conjugate gradients whose iterations do not grow with the pipe's
        length; the same without a coarse space, for comparison; or a sparse factor each step, the
        reference, where the build has found CHOLMOD.
    layout : {"rings", "lattice"}
        How the particles of a liquid start: on rings that follow the wall, or on a cubic lattice
        that the wall cuts in stairs (ten times the error in laminar flow).
    turbulence : {"auto", "mixing_length", "smagorinsky"}
        Eddy viscosity of a particle liquid. ``"auto"``: none below a Reynolds number of 2300, else
        the mixing length of pipe flow. Smagorinsky's is a model of what large eddies leave over;
        the particles carry hardly any, and its friction comes out too low.
    threads : int
        Threads of the kernels; 0 leaves the choice to the program. Results do not depend on it.
    """

    level: Literal["quick", "balanced", "fine"] = "balanced"
    rayleigh_fraction: Annotated[float, Quantity(above=0.0, at_most=0.5)] | None = None
    solid_step: Annotated[float, Quantity("s", above=0.0)] | None = None
    liquid_step: Annotated[float, Quantity("s", above=0.0)] | None = None
    coupling_step: Annotated[float, Quantity("s", above=0.0)] | None = None
    stiffness_factor: Annotated[float, Quantity(above=0.0, at_most=1.0)] = 1.0
    smoothing_radius: Annotated[float, Quantity("m", above=0.0)] | None = None
    coupling: Literal["auto", "one-way", "two-way"] = "auto"
    added_mass: Literal["auto", "on", "off"] = "auto"
    lubrication: Literal["auto", "on", "off"] = "auto"
    particle_spacing: Annotated[float, Quantity("m", above=0.0)] | None = None
    courant: Annotated[float, Quantity(above=0.0, at_most=2.0)] = 0.8
    convection: Literal["upwind", "muscl"] = "upwind"
    time_scheme: Literal["rk2", "rk3"] = "rk2"
    pressure_tolerance: Annotated[float, Quantity(above=0.0, below=1.0)] = 1e-3
    pressure_solver: Literal["two_level", "jacobi", "cholmod"] = "two_level"
    layout: Literal["rings", "lattice"] = "rings"
    turbulence: Literal["auto", "mixing_length", "smagorinsky"] = "auto"
    threads: Annotated[int, Whole(at_least=0)] = 0

    @property
    def resolved_rayleigh_fraction(self) -> float:
        """Share of the Rayleigh time that a step of the solids may take [-]."""
        if self.rayleigh_fraction is not None:
            return self.rayleigh_fraction
        return _RAYLEIGH_FRACTION[self.level]

    def coupling_fraction(self, solids_fraction: float) -> float:
        """Share of the times over which the forces on a solid change, between two exchanges [-].

        ``solids_fraction`` is the mean in the bore [-].
        """
        return _COUPLING_FRACTION[self.level if solids_fraction < _CROWDED else "balanced"]

    def resolved_particle_spacing(self, pipe_radius: float) -> float:
        """Distance between the particles of a computed liquid in a bore of that radius [m]."""
        if self.particle_spacing is not None:
            return self.particle_spacing
        return 2 * pipe_radius / _SPACINGS_ACROSS[self.level]
