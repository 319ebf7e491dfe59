"""
Solvers for the pressure equation on a cloud of particles.
"""
from __future__ import annotations
import numpy
import numpy.typing
import typing
__all__: list[str] = ['CholmodReference', 'CoarseSpace', 'CrossSectionSolver', 'Jacobi', 'LaplacianMatrix', 'Solution', 'TwoLevelAdditive', 'TwoLevelDeflation', 'conjugate_gradients']
class LaplacianMatrix:
    """
    Symmetric matrix of a weighted graph of neighbors.
    
    ``(A x)_i = sum_j w_ij (x_i - x_j) + d_i x_i`` with ``w_ij = w_ji >= 0``. Written with differences, a
    constant gives exactly zero where ``d = 0``; float32 weights then cost 1e-9 in the solution.
    
    Parameters
    ----------
    row : (n + 1,) uint32 ndarray
        The neighbors of unknown i stand in ``row[i]`` to ``row[i + 1]``, each pair in both rows.
    column : (m,) uint32 ndarray
        Neighbors, without the unknown itself.
    weight : (m,) float32 ndarray
        Of each neighbor, >= 0.
    dirichlet : (n,) float64 ndarray, optional
        d, >= 0: the weights of neighbors whose value is known.
    threads : int
        The result does not depend on it.
    
    Notes
    -----
    The arrays are looked at, not copied: they must not change while the matrix is in use. Unknowns that
    are near in space should be near in number, else a product takes twice the time.
    """
    def __init__(self, *, row: typing.Annotated[numpy.typing.ArrayLike, numpy.uint32], column: typing.Annotated[numpy.typing.ArrayLike, numpy.uint32], weight: typing.Annotated[numpy.typing.ArrayLike, numpy.float32], dirichlet: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None = None, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> None:
        ...
    def __len__(self) -> int:
        ...
    def apply(self, x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
        """
        The product A x.
        
        Parameters
        ----------
        x : (n,) float64 ndarray
        threads : int
            The result does not depend on it.
        
        Returns
        -------
        (n,) float64 ndarray
        """
    @property
    def cluster_count(self) -> int:
        """
        Number of connected clusters; an unknown without neighbors is one.
        """
    @property
    def diagonal(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) float64 ndarray: sum_j w_ij + d_i.
        """
    @property
    def floating_clusters(self) -> list[numpy.typing.NDArray[numpy.uint32]]:
        """
        Unknowns of each cluster without a Dirichlet part, where A x = b fixes x up to a
        constant and b must sum to zero: list of uint32 ndarrays, ascending.
        """
class CoarseSpace:
    """
    Cells of three particle spacings over a cloud of unknowns.
    
    A cell filled below 30 % joins the fullest of its neighbors in its slab; cells without unknowns do
    not count. Numbers run slab by slab along x, from both ends to the middle where x is periodic.
    
    Parameters
    ----------
    position : (n, 3) float64 ndarray
        [m]
    particle_spacing : float
        [m]
    period : float
        Along x [m]; 0 for none.
    """
    def __init__(self, *, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], particle_spacing: typing.SupportsFloat | typing.SupportsIndex, period: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> None:
        ...
    def __len__(self) -> int:
        ...
    @property
    def cell(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        (n,) uint32 ndarray: cell of each unknown; the number of cells where the position is
        not finite.
        """
class Jacobi:
    """
    Preconditioner z = r / diagonal.
    
    Iterations grow with the length of a pipe in particle spacings.
    
    Parameters
    ----------
    matrix : LaplacianMatrix
    """
    def __init__(self, matrix: LaplacianMatrix) -> None:
        ...
    def __len__(self) -> int:
        ...
    def apply(self, residual: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
        """
        What the preconditioner makes of a residual.
        
        Parameters
        ----------
        residual : (n,) float64 ndarray
        threads : int
            The result does not depend on it.
        
        Returns
        -------
        (n,) float64 ndarray
        """
class TwoLevelAdditive:
    """
    Jacobi plus a coarse solve on the cells of CoarseSpace.
    
    Iterations do not grow with the length of a pipe. The coarse factor may be kept while the matrix
    changes a little: see `follow`.
    
    Parameters
    ----------
    matrix : LaplacianMatrix
    position : (n, 3) float64 ndarray
        Of the unknowns [m].
    particle_spacing : float
        [m]
    period : float
        Along x [m]; 0 for none.
    threads : int
        The result does not depend on it.
    """
    def __init__(self, matrix: LaplacianMatrix, *, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], particle_spacing: typing.SupportsFloat | typing.SupportsIndex, period: typing.SupportsFloat | typing.SupportsIndex = 0.0, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> None:
        ...
    def __len__(self) -> int:
        ...
    def apply(self, residual: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
        """
        What the preconditioner makes of a residual.
        
        Parameters
        ----------
        residual : (n,) float64 ndarray
        threads : int
            The result does not depend on it.
        
        Returns
        -------
        (n,) float64 ndarray
        """
    def follow(self, matrix: LaplacianMatrix, *, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], threads: typing.SupportsInt | typing.SupportsIndex = 1) -> None:
        """
        Take a later matrix, keeping the cells and their factor.
        
        A factor of 10 steps ago costs an iteration or two.
        
        Parameters
        ----------
        matrix : LaplacianMatrix
            Its unknowns may differ in number and order from those before.
        position : (n, 3) float64 ndarray
            Of its unknowns [m].
        threads : int
            The result does not depend on it.
        """
    @property
    def coarse_size(self) -> int:
        """
        Number of coarse cells.
        """
class TwoLevelDeflation:
    """
    Deflation of the cells of CoarseSpace (A-DEF2).
    
    Fewer iterations than `TwoLevelAdditive`, for a longer set-up; good for one matrix and a small
    tolerance.
    
    Parameters
    ----------
    matrix : LaplacianMatrix
        The solver must be given this same matrix.
    position : (n, 3) float64 ndarray
        Of the unknowns [m].
    particle_spacing : float
        [m]
    period : float
        Along x [m]; 0 for none.
    threads : int
        The result does not depend on it.
    
    References
    ----------
    Tang, Nabben, Vuik & Erlangga (2009), doi:10.1007/s10915-009-9272-6.
    """
    def __init__(self, matrix: LaplacianMatrix, *, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], particle_spacing: typing.SupportsFloat | typing.SupportsIndex, period: typing.SupportsFloat | typing.SupportsIndex = 0.0, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> None:
        ...
    def __len__(self) -> int:
        ...
    def apply(self, residual: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
        """
        What the preconditioner makes of a residual.
        
        Parameters
        ----------
        residual : (n,) float64 ndarray
        threads : int
            The result does not depend on it.
        
        Returns
        -------
        (n,) float64 ndarray
        """
    @property
    def coarse_size(self) -> int:
        """
        Number of coarse cells.
        """
class Solution:
    """
    What a solve returned, and how it ended.
    """
    def __repr__(self) -> str:
        ...
    @property
    def broken(self) -> bool:
        """
        Whether a value was not finite, or the matrix not definite: more iterations do not
        help.
        """
    @property
    def converged(self) -> bool:
        """
        Whether the residual came down to the tolerance.
        """
    @property
    def iterations(self) -> int:
        """
        Products with the matrix after the first residual.
        """
    @property
    def residual(self) -> float:
        """
        |b - A x| / |b| [-], as the recursion has it; nan in a broken solve may be its cause.
        """
    @property
    def x(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) float64 ndarray.
        """
class CholmodReference:
    """
    Sparse Cholesky factor of CHOLMOD, to check the others by.
    
    About 20 s and 3 GB for 3e5 unknowns of a pipe.
    
    Parameters
    ----------
    matrix : LaplacianMatrix
    
    Raises
    ------
    RuntimeError
        If the build found no CHOLMOD (`_core.cholmod` is empty), or the factor does not exist.
    """
    def __init__(self, matrix: LaplacianMatrix) -> None:
        ...
    def solve(self, right_hand_side: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Solve A x = b.
        
        Parameters
        ----------
        right_hand_side : (n,) float64 ndarray
            b. Its mean over each floating cluster is taken off.
        
        Returns
        -------
        (n,) float64 ndarray
            x, of mean zero over each floating cluster.
        """
class CrossSectionSolver:
    """
    Direct solver of a Poisson equation on a cross-section, extruded along an axis.
    
    ``A p + d2p/dx2 = b`` at interior nodes, ``B p = b`` at the wall's: a Fourier transform along the
    axis and the eigenbasis of what is left of A when the wall's values are eliminated.
    
    Parameters
    ----------
    interior : (n, n + w) float64 ndarray
        A, the interior nodes' columns first [1/m2].
    wall : (w, n + w) float64 ndarray
        B.
    axial : (stations // 2 + 1,) float64 ndarray
        What d2/dx2 makes of each wave, over the wave, <= 0 [1/m2].
    stations : int
        Along the axis, a multiple of 4.
    mirrors : (2, n + w) uint32 ndarray, optional
        Each node's image in either of two mirrors; where A and B share them, the even and the odd parts
        are solved apart.
    
    Raises
    ------
    RuntimeError
        If A has a growing mode.
    
    References
    ----------
    Lynch, Rice & Thomas (1964) doi:10.1007/BF01386067.
    """
    def __init__(self, *, interior: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], wall: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], axial: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], stations: typing.SupportsInt | typing.SupportsIndex, mirrors: typing.Annotated[numpy.typing.ArrayLike, numpy.uint32] | None = None) -> None:
        ...
    def solve(self, right_hand_side: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
        """
        Solve for one right-hand side.
        
        Parameters
        ----------
        right_hand_side : (n + w, stations) float64 ndarray
        threads : int
            The result does not depend on it.
        
        Returns
        -------
        (n + w, stations) float64 ndarray
            p; where a constant is free, without it, and without the part of b that no p reaches.
        """
def conjugate_gradients(matrix: LaplacianMatrix, right_hand_side: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, preconditioner: Jacobi | TwoLevelAdditive | TwoLevelDeflation, tolerance: typing.SupportsFloat | typing.SupportsIndex = 1e-06, max_iterations: typing.SupportsInt | typing.SupportsIndex = 1000, start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None = None, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> Solution:
    """
    Solve A x = b by preconditioned conjugate gradients.
    
    Parameters
    ----------
    matrix : LaplacianMatrix
    right_hand_side : (n,) float64 ndarray
        b. Its mean over each floating cluster is taken off.
    preconditioner : Jacobi, TwoLevelAdditive or TwoLevelDeflation
    tolerance : float
        Largest residual over the size of b [-], >= 1e-13.
    max_iterations : int
    start : (n,) float64 ndarray, optional
        First guess; zero if not given.
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    Solution
        x has mean zero over each floating cluster.
    """
