"""
Walls as analytic surfaces. SI units throughout.
"""
from __future__ import annotations
import numpy
import numpy.typing
import typing
__all__: list[str] = ['Bending', 'BentCylinder', 'Cylinder', 'Plane']
class Plane:
    """
    A flat wall through `point` [m], wetted on the side of `normal`, moving with `velocity` [m/s].
    """
    def __init__(self, *, point: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], normal: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None:
        ...
    def distance(self, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Distance of points from the wall, positive on the wetted side.
        
        Parameters
        ----------
        points : (n, 3) float64 ndarray
            Positions [m].
        
        Returns
        -------
        (n,) float64 ndarray
            Signed distance [m].
        """
class Cylinder:
    """
    The bore of a straight pipe along x, of `radius` [m], wetted inside, moving with `velocity` [m/s].
    """
    def __init__(self, *, radius: typing.SupportsFloat | typing.SupportsIndex, velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None:
        ...
    def distance(self, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Distance of points from the wall, positive on the wetted side.
        
        Parameters
        ----------
        points : (n, 3) float64 ndarray
            Positions [m].
        
        Returns
        -------
        (n,) float64 ndarray
            Signed distance [m].
        """
class Bending:
    """
    How a pipe along x bends over a step: w(x, t) = sum_n a_n(t) cos(k_n x), across itself.
    
    The amplitudes are cubics in time through their ends, displacement and velocity, so that the
    velocity is the derivative of the displacement throughout.
    
    Parameters
    ----------
    duration : float
        Of the step [s].
    wave_number : (m,) float64 ndarray
        k_n [1/m]; 0 moves the pipe as one body.
    displacement_before, displacement_after : (m, 3) float64 ndarray
        a_n at the ends of the step [m]; x is 0.
    velocity_before, velocity_after : (m, 3) float64 ndarray
        Their derivatives in time [m/s].
    """
    def __init__(self, *, duration: typing.SupportsFloat | typing.SupportsIndex, wave_number: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], displacement_before: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity_before: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], displacement_after: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity_after: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None:
        ...
    def axis(self, elapsed: typing.SupportsFloat | typing.SupportsIndex, x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Displacement, slope and velocity of the axis.
        
        Parameters
        ----------
        elapsed : float
            Time since the start of the step [s]; as at its ends before and after it.
        x : (n,) float64 ndarray
            Places along the pipe [m].
        
        Returns
        -------
        displacement, slope, velocity : (n, 3) float64 ndarray
            [m], [-], [m/s].
        """
class BentCylinder:
    """
    The bore of a pipe along x, of `radius` [m], wetted inside, whose axis is bent and moves: straight until a `Bending` tells.
    """
    def __init__(self, *, radius: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    def bend(self, bending: Bending, elapsed: typing.SupportsFloat | typing.SupportsIndex) -> None:
        """
        Let it be as so long after the start of a step [s].
        """
    def distance(self, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Distance of points from the wall, positive on the wetted side.
        
        Parameters
        ----------
        points : (n, 3) float64 ndarray
            Positions [m].
        
        Returns
        -------
        (n,) float64 ndarray
            Signed distance [m].
        """
