"""
Liquids. SI units throughout.
"""
from __future__ import annotations
import numpy
import numpy.typing
import typing
__all__: list[str] = ['PipeProfile', 'friction_factor']
class PipeProfile:
    """
    Developed velocity profile of a full straight pipe, prescribed.
    
    The pipe's axis is the x axis. Laminar (parabola) below a Reynolds number of 2300, above it
    Reichardt's turbulent profile, made to carry the bulk velocity with Colebrook's friction factor.
    
    Parameters
    ----------
    pipe_radius : float
        [m]
    bulk_velocity : float
        Along x, of either sign or zero [m/s].
    kinematic_viscosity : float
        [m2/s]
    roughness : float
        Sand-grain roughness of the wall [m], at most 0.05 of the pipe's diameter.
    
    References
    ----------
    Reichardt (1951), doi:10.1002/zamm.19510310704.
    """
    def __init__(self, *, pipe_radius: typing.SupportsFloat | typing.SupportsIndex, bulk_velocity: typing.SupportsFloat | typing.SupportsIndex, kinematic_viscosity: typing.SupportsFloat | typing.SupportsIndex, roughness: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> None:
        ...
    def velocity(self, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Liquid velocity at points.
        
        Parameters
        ----------
        position : (n, 3) float64 ndarray
            [m]
        
        Returns
        -------
        (n, 3) float64 ndarray
            Velocity [m/s]; zero outside the bore.
        """
    @property
    def friction_factor(self) -> float:
        """
        Darcy friction factor [-]; 0 where the liquid rests.
        """
    @property
    def friction_velocity(self) -> float:
        """
        Root of wall shear stress over density, >= 0 [m/s].
        """
    @property
    def laminar(self) -> bool:
        """
        Whether the profile is the parabola.
        """
    @property
    def reynolds(self) -> float:
        """
        Reynolds number of bulk velocity and diameter [-].
        """
def friction_factor(reynolds: typing.SupportsFloat | typing.SupportsIndex, relative_roughness: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> float:
    """
    Darcy friction factor of a full pipe.
    
    Parameters
    ----------
    reynolds : float
        Of the bulk velocity and the pipe's diameter [-], > 0.
    relative_roughness : float
        Sand-grain roughness over the pipe's diameter [-], at most 0.05.
    
    Returns
    -------
    float
        ``64 / reynolds`` below 2300, above it the solution of Colebrook's equation [-].
    
    Notes
    -----
    Between 2300 and 4000 the flow of nature is intermittent and no law holds.
    
    References
    ----------
    Colebrook (1939), doi:10.1680/ijoti.1939.13150.
    """
