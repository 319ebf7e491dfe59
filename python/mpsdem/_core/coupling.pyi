"""
What liquid and solids do to each other. SI units throughout.
"""
from __future__ import annotations
import mpsdem._core.mps
import numpy
import numpy.typing
import typing
__all__: list[str] = ['Beetstra', 'DiFelice', 'ErgunWenYu', 'Exchange', 'KochHill', 'SchillerNaumann', 'VoidFraction', 'WenYu', 'count_outside', 'drag_rate']
class SchillerNaumann:
    """
    Drag of an isolated sphere.
    
    The force depends on the slip alone; neighbors change nothing. Reynolds numbers up to 2e5.
    
    References
    ----------
    Schiller & Naumann (1933), Z. Ver. Dtsch. Ing. 77, 318-320.
    """
    def __init__(self) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def covers(self, reynolds: typing.SupportsFloat | typing.SupportsIndex, void_fraction: typing.SupportsFloat | typing.SupportsIndex) -> bool:
        """
        Whether the law's sources stand behind it there.
        """
    def force_ratio(self, reynolds: typing.SupportsFloat | typing.SupportsIndex, void_fraction: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        Drag over Stokes's drag on the superficial slip, in Model A.
        
        Parameters
        ----------
        reynolds : float
            Void fraction x slip x diameter / kinematic viscosity [-], >= 0.
        void_fraction : float
            Share of liquid around the sphere [-], in (0, 1].
        
        Returns
        -------
        float
            Force / (3 pi x dynamic viscosity x diameter x void fraction x slip) [-].
        """
class WenYu:
    """
    Drag of a sphere in a fluidised suspension.
    
    Void fractions from 0.45 to 1, Reynolds numbers up to 2e5.
    
    References
    ----------
    Wen & Yu (1966), Chem. Eng. Prog. Symp. Ser. 62, 100-111.
    """
    def __init__(self) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def covers(self, reynolds: typing.SupportsFloat | typing.SupportsIndex, void_fraction: typing.SupportsFloat | typing.SupportsIndex) -> bool:
        """
        Whether the law's sources stand behind it there.
        """
    def force_ratio(self, reynolds: typing.SupportsFloat | typing.SupportsIndex, void_fraction: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        Drag over Stokes's drag on the superficial slip, in Model A.
        
        Parameters
        ----------
        reynolds : float
            Void fraction x slip x diameter / kinematic viscosity [-], >= 0.
        void_fraction : float
            Share of liquid around the sphere [-], in (0, 1].
        
        Returns
        -------
        float
            Force / (3 pi x dynamic viscosity x diameter x void fraction x slip) [-].
        """
class ErgunWenYu:
    """
    Ergun's packed bed up to a void fraction of 0.8, Wen & Yu above: Gidaspow's law.
    
    Void fractions from 0.36 to 1; Reynolds numbers up to 2500 times the solid fraction in the bed,
    up to 2e5 above. The drag jumps at the switch, by a factor of 3.7 at a Reynolds number of 1000.
    
    References
    ----------
    Ergun (1952), Chem. Eng. Prog. 48, 89-94; Ding & Gidaspow (1990), doi:10.1002/aic.690360404.
    """
    def __init__(self) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def covers(self, reynolds: typing.SupportsFloat | typing.SupportsIndex, void_fraction: typing.SupportsFloat | typing.SupportsIndex) -> bool:
        """
        Whether the law's sources stand behind it there.
        """
    def force_ratio(self, reynolds: typing.SupportsFloat | typing.SupportsIndex, void_fraction: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        Drag over Stokes's drag on the superficial slip, in Model A.
        
        Parameters
        ----------
        reynolds : float
            Void fraction x slip x diameter / kinematic viscosity [-], >= 0.
        void_fraction : float
            Share of liquid around the sphere [-], in (0, 1].
        
        Returns
        -------
        float
            Force / (3 pi x dynamic viscosity x diameter x void fraction x slip) [-].
        """
class DiFelice:
    """
    One smooth law from a packed bed to a lone sphere.
    
    Void fractions from 0.4 to 1, Reynolds numbers 0.01 to 1e4.
    
    References
    ----------
    Di Felice (1994), doi:10.1016/0301-9322(94)90011-6.
    """
    def __init__(self) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def covers(self, reynolds: typing.SupportsFloat | typing.SupportsIndex, void_fraction: typing.SupportsFloat | typing.SupportsIndex) -> bool:
        """
        Whether the law's sources stand behind it there.
        """
    def force_ratio(self, reynolds: typing.SupportsFloat | typing.SupportsIndex, void_fraction: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        Drag over Stokes's drag on the superficial slip, in Model A.
        
        Parameters
        ----------
        reynolds : float
            Void fraction x slip x diameter / kinematic viscosity [-], >= 0.
        void_fraction : float
            Share of liquid around the sphere [-], in (0, 1].
        
        Returns
        -------
        float
            Force / (3 pi x dynamic viscosity x diameter x void fraction x slip) [-].
        """
class KochHill:
    """
    Drag in random arrays of spheres, computed.
    
    Void fractions from 0.36 to 0.9, Reynolds numbers up to 200.
    
    References
    ----------
    Koch & Hill (2001), doi:10.1146/annurev.fluid.33.1.619.
    """
    def __init__(self) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def covers(self, reynolds: typing.SupportsFloat | typing.SupportsIndex, void_fraction: typing.SupportsFloat | typing.SupportsIndex) -> bool:
        """
        Whether the law's sources stand behind it there.
        """
    def force_ratio(self, reynolds: typing.SupportsFloat | typing.SupportsIndex, void_fraction: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        Drag over Stokes's drag on the superficial slip, in Model A.
        
        Parameters
        ----------
        reynolds : float
            Void fraction x slip x diameter / kinematic viscosity [-], >= 0.
        void_fraction : float
            Share of liquid around the sphere [-], in (0, 1].
        
        Returns
        -------
        float
            Force / (3 pi x dynamic viscosity x diameter x void fraction x slip) [-].
        """
class Beetstra:
    """
    Drag in random arrays of spheres, computed.
    
    Void fractions from 0.4 to 0.9, Reynolds numbers up to 1000.
    
    References
    ----------
    Beetstra, van der Hoef & Kuipers (2007), doi:10.1002/aic.11065.
    """
    def __init__(self) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def covers(self, reynolds: typing.SupportsFloat | typing.SupportsIndex, void_fraction: typing.SupportsFloat | typing.SupportsIndex) -> bool:
        """
        Whether the law's sources stand behind it there.
        """
    def force_ratio(self, reynolds: typing.SupportsFloat | typing.SupportsIndex, void_fraction: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        Drag over Stokes's drag on the superficial slip, in Model A.
        
        Parameters
        ----------
        reynolds : float
            Void fraction x slip x diameter / kinematic viscosity [-], >= 0.
        void_fraction : float
            Share of liquid around the sphere [-], in (0, 1].
        
        Returns
        -------
        float
            Force / (3 pi x dynamic viscosity x diameter x void fraction x slip) [-].
        """
class VoidFraction:
    """
    Void fraction that each solid sees in a straight pipe.
    
    Neighbors count by the kernel ``4 q^5 - 5 q^4 + 1``, ``q = r / smoothing_radius``, normalised by the
    part of it inside the bore. A lone sphere sees 1, a dense bed its full solid fraction.
    
    Parameters
    ----------
    pipe_radius : float
        Of the bore about the x axis [m].
    period : float
        Of the pipe along x [m].
    smoothing_radius : float
        [m]; 2.5 diameters is a good choice, 1.5 the least.
    """
    def __init__(self, *, pipe_radius: typing.SupportsFloat | typing.SupportsIndex, period: typing.SupportsFloat | typing.SupportsIndex, smoothing_radius: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    def at_solids(self, *, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], radius: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], threads: typing.SupportsInt | typing.SupportsIndex = 1) -> tuple[numpy.typing.NDArray[numpy.float64], int]:
        """
        Void fraction at each solid.
        
        Parameters
        ----------
        position : (n, 3) float64 ndarray
            [m]
        radius : (n,) float64 ndarray
            [m]
        threads : int
            The result does not depend on it.
        
        Returns
        -------
        void_fraction : (n,) float64 ndarray
            [-], in [0.3, 1].
        clipped : int
            How many were below 0.3 and raised to it.
        """
class Exchange:
    """
    Two-way exchange between solids and a liquid, in Model B.
    
    A step: `begin` looks at the liquid around the solids; these go on, in substeps in which the liquid
    at each of them responds as `response` says; `give` takes what they did, and `advance` moves the
    liquid with it. The impulse on the solids is the liquid's loss to round-off.
    
    Parameters
    ----------
    smoothing_radius : float
        Over which a solid acts on the liquid, and samples it [m].
    liquid_density : float
        [kg/m3].
    threads : int
        The result does not depend on it.
    
    References
    ----------
    Zhou, Kuang, Chu & Yu (2010) doi:10.1017/S002211201000306X, set II.
    """
    def __init__(self, *, smoothing_radius: typing.SupportsFloat | typing.SupportsIndex, liquid_density: typing.SupportsFloat | typing.SupportsIndex, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> None:
        ...
    @typing.overload
    def advance(self, liquid: mpsdem._core.mps.LagrangianLiquid, dt: typing.SupportsFloat | typing.SupportsIndex) -> mpsdem._core.mps.LiquidReport:
        """
        Advance the liquid by dt [s] with the solids in it; returns its report.
        """
    @typing.overload
    def advance(self, liquid: mpsdem._core.mps.EulerianLiquid, dt: typing.SupportsFloat | typing.SupportsIndex) -> mpsdem._core.mps.NodeLiquidReport:
        """
        The same for a liquid on nodes.
        """
    @typing.overload
    def begin(self, liquid: mpsdem._core.mps.LagrangianLiquid, *, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], radius: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None:
        """
        Look at the liquid around the solids at the start of a step.
        
        Parameters
        ----------
        liquid : LagrangianLiquid
        position : (n, 3) float64 ndarray
            Of the solids, x within the pipe [m].
        radius : (n,) float64 ndarray
            [m].
        
        Raises
        ------
        ValueError
            If a solid has no liquid within the smoothing radius.
        """
    @typing.overload
    def begin(self, liquid: mpsdem._core.mps.EulerianLiquid, *, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], radius: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None:
        """
        The same for a liquid on nodes.
        """
    def give(self, *, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], mean_velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], drag: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], impulse: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None, duration: typing.SupportsFloat | typing.SupportsIndex) -> None:
        """
        Take what the solids did over a step of the liquid.
        
        Parameters
        ----------
        position : (n, 3) float64 ndarray
            At its start, x within the pipe [m].
        mean_velocity : (n, 3) float64 ndarray
            [m/s].
        drag : (n,) float64 ndarray
            Drag over slip, mean [kg/s].
        impulse : (n, 3) float64 ndarray or None
            That the drag gave them [N s]; None for solids that are held, which take any.
        duration : float
            [s].
        """
    def response(self, *, drag: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        How the liquid at each solid is going to change: du/dt = a - L (u - v).
        
        Parameters
        ----------
        drag : (n,) float64 ndarray
            Drag over slip now [kg/s].
        velocity : (n, 3) float64 ndarray
            Of the solids now [m/s].
        
        Returns
        -------
        acceleration : (n, 3) float64 ndarray
            a [m/s2].
        relaxation : (n,) float64 ndarray
            L [1/s].
        """
    @property
    def clipped(self) -> int:
        """
        Void fractions of the liquid raised to the floor in the last advance.
        """
    @property
    def impulse(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) on the solids, over the last advance [N s].
        """
    @property
    def liquid_velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) of the liquid at the solids, when the step began [m/s].
        """
    @property
    def liquid_volume_error(self) -> float:
        """
        Liquid volume over bore less solids, less 1 [-].
        """
    @property
    def mismatch(self) -> float:
        """
        Impulse on liquid and solids together, over the sum of the sizes of those on the solids [-].
        """
def count_outside(law: SchillerNaumann | WenYu | ErgunWenYu | DiFelice | KochHill | Beetstra, *, liquid_velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], void_fraction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], diameter: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], kinematic_viscosity: typing.SupportsFloat | typing.SupportsIndex) -> int:
    """
    How many solids lie outside what the drag law's sources stand for.
    
    Parameters
    ----------
    law : SchillerNaumann, WenYu, ErgunWenYu, DiFelice, KochHill or Beetstra
    liquid_velocity, velocity : (n, 3) float64 ndarray
        At each solid, and its own [m/s].
    void_fraction : (n,) float64 ndarray
        At each solid [-], in (0, 1].
    diameter : (n,) float64 ndarray
        [m]
    kinematic_viscosity : float
        Of the liquid [m2/s].
    
    Returns
    -------
    int
        Number of solids for which ``law.covers`` is false.
    """
def drag_rate(law: SchillerNaumann | WenYu | ErgunWenYu | DiFelice | KochHill | Beetstra, *, liquid_velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], void_fraction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], diameter: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], density: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], liquid_density: typing.SupportsFloat | typing.SupportsIndex, kinematic_viscosity: typing.SupportsFloat | typing.SupportsIndex) -> numpy.typing.NDArray[numpy.float64]:
    """
    Drag of each solid over its mass and slip, in Model B.
    
    The drag's acceleration is ``rate * (liquid_velocity - velocity)``. In Model B the liquid carries
    the whole pressure gradient, the drag is that of Model A over the void fraction, and the buoyancy
    is that of the liquid's density.
    
    Parameters
    ----------
    law : SchillerNaumann, WenYu, ErgunWenYu, DiFelice, KochHill or Beetstra
    liquid_velocity, velocity : (n, 3) float64 ndarray
        At each solid, and its own [m/s].
    void_fraction : (n,) float64 ndarray
        At each solid [-], in (0, 1].
    diameter, density : (n,) float64 ndarray
        Of each solid [m], [kg/m3].
    liquid_density : float
        [kg/m3]
    kinematic_viscosity : float
        Of the liquid [m2/s].
    
    Returns
    -------
    (n,) float64 ndarray
        Rate [1/s].
    
    References
    ----------
    Zhou, Kuang, Chu & Yu (2010), doi:10.1017/S002211201000306X.
    """
