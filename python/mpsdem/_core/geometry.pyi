"""
Walls as analytic surfaces. SI units throughout.
"""
from __future__ import annotations
import numpy
import numpy.typing
import typing
__all__: list[str] = ['Cylinder', 'Plane']
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
