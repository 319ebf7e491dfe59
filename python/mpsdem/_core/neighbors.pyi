"""
Which points are near to which. SI units throughout.
"""
from __future__ import annotations
import numpy
import numpy.typing
import typing
__all__: list[str] = ['NeighborList', 'cell_order']
class NeighborList:
    """
    For each point all others nearer than a radius, in compressed rows.
    
    The neighbors of point i are ``column[row[i]:row[i + 1]]``, ascending; a pair stands in both its
    rows. The list keeps the positions that it was made for. It is made fastest where the points are
    in `cell_order`; it does not depend on the number of threads.
    
    Parameters
    ----------
    position : (n, 3) float64 ndarray
        [m]; x is wrapped into the period.
    radius : float
        Reach, itself left out [m].
    period : float
        Along x [m], more than two radii; 0 for none.
    threads : int
        Used to make the list.
    """
    def __init__(self, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, radius: typing.SupportsFloat | typing.SupportsIndex, period: typing.SupportsFloat | typing.SupportsIndex = 0.0, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> None:
        ...
    def __len__(self) -> int:
        ...
    def find(self, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> None:
        """
        Make the list anew for other positions, in the same memory.
        
        Parameters
        ----------
        position : (n, 3) float64 ndarray
            [m]
        threads : int
            Used to make the list.
        """
    @property
    def column(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        (row[n],) uint32 ndarray: the neighbors, row after row.
        """
    @property
    def period(self) -> float:
        """
        Along x [m]; 0 for none.
        """
    @property
    def radius(self) -> float:
        """
        Reach [m].
        """
    @property
    def row(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        (n + 1,) uint32 ndarray: where the neighbors of each point begin in `column`.
        """
def cell_order(position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, cell_size: typing.SupportsFloat | typing.SupportsIndex, period: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> numpy.typing.NDArray[numpy.uint32]:
    """
    Order of points by cubic cells, x slowest: points near in space come near in memory.
    
    Parameters
    ----------
    position : (n, 3) float64 ndarray
        [m]
    cell_size : float
        Least width of a cell [m]; the radius of the neighbor list is a good choice.
    period : float
        Of the points along x [m]; 0 for none.
    
    Returns
    -------
    (n,) uint32 ndarray
        ``position[order]`` are the points, sorted.
    """
