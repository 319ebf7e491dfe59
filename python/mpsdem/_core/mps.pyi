"""
Liquids. SI units throughout.
"""
from __future__ import annotations
import mpsdem._core.geometry
import mpsdem._core.neighbors
import numpy
import numpy.typing
import typing
__all__: list[str] = ['EulerianLiquid', 'LagrangianLiquid', 'LiquidReport', 'MixingLength', 'NodeLiquidReport', 'PipeProfile', 'PushPlate', 'ReferenceDensity', 'Smagorinsky', 'WallFunction', 'background_gradient', 'conserving_gradient', 'corrected_divergence', 'corrected_gradient', 'difference_gradient', 'divergence', 'eddy_viscosity', 'friction_factor', 'laplacian', 'least_squares_laplacian', 'number_density', 'relative_convection', 'section_operators', 'shear_rate', 'shifting', 'slip_divergence', 'stored_weights', 'sum_gradient', 'viscous_acceleration']
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
class ReferenceDensity:
    """
    Sums over the undisturbed lattice, by which operators are scaled.
    
    Parameters
    ----------
    spacing : float
        Of the particles [m].
    effective_radius : float
        Reach of the weight ``r_e / (0.85 r + 0.15 r_e) - 1`` [m], in (1, 10] spacings.
    
    References
    ----------
    Zhang, Wan & Hino (2014), doi:10.1016/S1001-6058(14)60065-8.
    """
    def __init__(self, *, spacing: typing.SupportsFloat | typing.SupportsIndex, effective_radius: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def effective_radius(self) -> float:
        """
        [m]
        """
    @property
    def lambda_(self) -> float:
        """
        Mean of the distances squared, by weight [m2].
        """
    @property
    def number_density(self) -> float:
        """
        Sum of the weights [-].
        """
    @property
    def spacing(self) -> float:
        """
        [m]
        """
class MixingLength:
    """
    Nikuradse's mixing length of developed flow in a round pipe.
    
    ``l / R = 0.14 - 0.08 s^2 - 0.06 s^4`` with ``s = r / R``; the axis is the x axis.
    
    Parameters
    ----------
    pipe_radius : float
        [m]
    
    References
    ----------
    Nikuradse (1932), VDI-Forschungsheft 356.
    """
    def __init__(self, *, pipe_radius: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    def length(self, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Length l of the eddy viscosity l^2 |S|.
        
        Parameters
        ----------
        position : (n, 3) float64 ndarray
            [m]
        
        Returns
        -------
        (n,) float64 ndarray
            [m]
        """
class Smagorinsky:
    """
    Length of the eddies that the spacing does not resolve.
    
    A coarse pipe flow with it alone has too little friction: its particles carry no eddies.
    
    Parameters
    ----------
    spacing : float
        Of the particles [m].
    coefficient : float
        Length over spacing [-], 0.1 to 0.2.
    
    References
    ----------
    Smagorinsky (1963), doi:10.1175/1520-0493(1963)091<0099:GCEWTP>2.3.CO;2.
    """
    def __init__(self, *, spacing: typing.SupportsFloat | typing.SupportsIndex, coefficient: typing.SupportsFloat | typing.SupportsIndex = 0.1) -> None:
        ...
    def length(self, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Length l of the eddy viscosity l^2 |S|.
        
        Parameters
        ----------
        position : (n, 3) float64 ndarray
            [m]
        
        Returns
        -------
        (n,) float64 ndarray
            [m]
        """
class WallFunction:
    """
    Wall shear from the speed at a distance from the wall.
    
    The greater of a laminar layer's and that of the logarithmic law with 0.41 and 5.2, shifted by the
    roughness as in Colebrook's formula.
    
    Parameters
    ----------
    kinematic_viscosity : float
        [m2/s]
    roughness : float
        Sand grains of the wall [m].
    
    References
    ----------
    Pope (2000), Turbulent Flows, ch. 7. Colebrook (1939), doi:10.1680/ijoti.1939.13150.
    """
    def __init__(self, *, kinematic_viscosity: typing.SupportsFloat | typing.SupportsIndex, roughness: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> None:
        ...
    def shear(self, *, speed: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], distance: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Wall shear stress over density.
        
        Parameters
        ----------
        speed : (n,) float64 ndarray
            Along the wall, relative to it, >= 0 [m/s].
        distance : (n,) float64 ndarray
            From the wall, > 0 [m].
        
        Returns
        -------
        (n,) float64 ndarray
            [m2/s2]
        """
class PushPlate:
    """
    A plate that pushes the liquid into the pipe, and an outlet that lets it go.
    
    The plate works upstream of the pipe, so that the bore is always full: its face moves from
    -(stroke + settling) to -settling and jumps back by the stroke. The gap is filled with a slab of the
    bore's own liquid, shifted and turned. Behind the pipe, over the length of the outlet, the pressure
    is zero and the liquid keeps its velocity.
    
    Parameters
    ----------
    velocity : float
        Of the plate, so of the bulk [m/s], > 0.
    stroke : float
        [m].
    settling : float
        Length left between plate and bore, renewed with the gap at each return [m].
    outlet : float
        Length of the outlet behind the pipe [m].
    draws : (n, 2) float64 ndarray
        Which slab fills a gap, and how far it is turned: shares in [0, 1), a row for each return, from
        the first row again when all are used.
    """
    def __init__(self, *, velocity: typing.SupportsFloat | typing.SupportsIndex, stroke: typing.SupportsFloat | typing.SupportsIndex, settling: typing.SupportsFloat | typing.SupportsIndex, outlet: typing.SupportsFloat | typing.SupportsIndex, draws: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None:
        ...
class LiquidReport:
    """
    What a call of LagrangianLiquid.advance met.
    """
    @property
    def bending(self) -> float:
        """
        Part of mean_gradient: the loss along an axis that slopes and moves [Pa/m].
        """
    @property
    def clamped(self) -> int:
        """
        Pressures cut to the limit.
        """
    @property
    def convection_error(self) -> float:
        """
        Axial momentum that particles failed to carry along between solids, and were given back, mean over the call [Pa/m].
        """
    @property
    def crowded(self) -> int:
        """
        Particles left out there, nearer than half a spacing to others.
        """
    @property
    def deficient(self) -> int:
        """
        Particles whose neighbors fix no Laplacian: no viscosity acted there.
        """
    @property
    def entered(self) -> int:
        """
        Particles that came to be behind the plate.
        """
    @property
    def friction(self) -> float:
        """
        What walls and viscosity take up, mean over the call [Pa/m].
        """
    @property
    def halvings(self) -> int:
        """
        Steps that were halved after a failed solve.
        """
    @property
    def held_back(self) -> int:
        """
        Particles kept from going nearer to the wall than 0.3 spacings.
        """
    @property
    def iterations(self) -> int:
        """
        Iterations of the pressure equation, all substeps.
        """
    @property
    def left(self) -> int:
        """
        Particles that went through the outlet.
        """
    @property
    def mean_gradient(self) -> float:
        """
        Loss of pressure along the pipe, mean over the call [Pa/m].
        """
    @property
    def plate_returns(self) -> int:
        """
        Returns of the plate.
        """
    @property
    def pushed(self) -> int:
        """
        Particles kept from going nearer to the plate than 0.3 spacings.
        """
    @property
    def replaced(self) -> int:
        """
        Particles between plate and bore that went for them.
        """
    @property
    def residual(self) -> float:
        """
        Largest residual of the pressure equation, relative [-].
        """
    @property
    def retries(self) -> int:
        """
        Pressure solves that had to start anew.
        """
    @property
    def shifts_cut(self) -> int:
        """
        Shifts cut to their longest.
        """
    @property
    def solve_seconds(self) -> float:
        """
        Time spent in the pressure equation, set-up included [s].
        """
    @property
    def sound(self) -> bool:
        """
        False when the pressure could not be solved or speeds overflowed.
        """
    @property
    def substeps(self) -> int:
        ...
    @property
    def unexplained(self) -> float:
        """
        What p' does to the axial momentum, and must not, mean [Pa/m].
        """
    @property
    def viscosity_capped(self) -> int:
        """
        Eddy viscosities cut to what the step can bear.
        """
class LagrangianLiquid:
    """
    The particle liquid of a full, straight pipe, periodic or with a push plate.
    
    Moving particles, walls of wall and ghost particles, pressure from a Poisson equation. A liquid of
    the mean flow: its stable form damps fluctuations.
    
    Parameters
    ----------
    position, velocity : (n, 3) float64 ndarray
        Of a layout [m], [m/s].
    kind : (n,) int8 ndarray
        2 liquid, -2 wall, -1 ghost.
    particle_spacing : float
        Of that layout [m].
    pipe_radius, pipe_length : float
        [m].
    plate : PushPlate, optional
        Without it, the pipe is periodic. With it, the layout is that of `push_plate_layout`, and what
        lies inside the pipe's radius but is no liquid is the plate.
    density, kinematic_viscosity : float
        [kg/m3], [m2/s].
    roughness : float
        Of the wall [m].
    turbulence : MixingLength or Smagorinsky or None
        Length of the eddy viscosity, with the log law at the wall; None for laminar flow between walls
        that hold the liquid.
    bulk_velocity : float
        Held each step unless a gradient is given; scales the pressure limits in any case [m/s].
    pressure_gradient : float, optional
        Given loss of pressure along the pipe [Pa/m].
    courant, tolerance, background, shift, pressure_limit : float
        Numbers of the method [-].
    speed : float
        Of the stirring by solids, where the liquid itself hardly flows: scales the pressure limits as
        the bulk velocity does [m/s].
    solver : {"two_level", "jacobi", "cholmod"}
        Of the pressure equation: conjugate gradients, or a factor each step where the build has it.
    pairing : {"conserving", "difference"}
        What the gradient takes of a pair: the sum of its pressures, equal and opposite; or their
        difference, blind to a constant.
    threads : int
        The results do not depend on it.
    
    References
    ----------
    Koshizuka & Oka (1996) doi:10.13182/NSE96-A24205.
    """
    def __init__(self, *, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], kind: typing.Annotated[numpy.typing.ArrayLike, numpy.int8], particle_spacing: typing.SupportsFloat | typing.SupportsIndex, pipe_radius: typing.SupportsFloat | typing.SupportsIndex, pipe_length: typing.SupportsFloat | typing.SupportsIndex, plate: PushPlate | None = None, density: typing.SupportsFloat | typing.SupportsIndex, kinematic_viscosity: typing.SupportsFloat | typing.SupportsIndex, roughness: typing.SupportsFloat | typing.SupportsIndex, turbulence: None | MixingLength | Smagorinsky, bulk_velocity: typing.SupportsFloat | typing.SupportsIndex, pressure_gradient: typing.SupportsFloat | typing.SupportsIndex | None = None, courant: typing.SupportsFloat | typing.SupportsIndex = 0.8, tolerance: typing.SupportsFloat | typing.SupportsIndex = 0.001, solver: str = 'two_level', pairing: str = 'conserving', background: typing.SupportsFloat | typing.SupportsIndex = 0.02, shift: typing.SupportsFloat | typing.SupportsIndex = 0.25, pressure_limit: typing.SupportsFloat | typing.SupportsIndex = 0.25, speed: typing.SupportsFloat | typing.SupportsIndex = 0.0, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> None:
        ...
    def __len__(self) -> int:
        ...
    def advance(self, dt: typing.SupportsFloat | typing.SupportsIndex) -> LiquidReport:
        """
        Advance by dt [s], in as many substeps as Courant number and viscosity ask for.
        """
    def bend(self, bending: mpsdem._core.geometry.Bending) -> None:
        """
        The pipe moves so in the next `advance`, of the same duration; from now on it is as at the start of it.
        """
    def drive(self, *, bulk_velocity: typing.SupportsFloat | typing.SupportsIndex, pressure_gradient: typing.SupportsFloat | typing.SupportsIndex | None = None) -> None:
        """
        Drive the liquid otherwise from now on.
        
        Parameters
        ----------
        bulk_velocity : float
            Held each step unless a gradient is given; scales the pressure limits in any case [m/s].
        pressure_gradient : float, optional
            Given loss of pressure along the pipe [Pa/m].
        """
    def restore(self, state: dict[str, typing.Any]) -> None:
        """
        Continue bit-equal from a `state` of the same liquid.
        """
    def state(self) -> dict[str, typing.Any]:
        """
        The exact state as arrays, for `restore`.
        """
    def velocity_at(self, *, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], radius: typing.SupportsFloat | typing.SupportsIndex) -> numpy.typing.NDArray[numpy.float64]:
        """
        Liquid velocity at points, averaged with the kernel W_s over a radius.
        
        Parameters
        ----------
        points : (n, 3) float64 ndarray
            Positions, x within the pipe [m].
        radius : float
            Of the average [m].
        
        Returns
        -------
        (n, 3) float64 ndarray
            [m/s]; zero where no liquid is within the radius.
        """
    @property
    def bulk_velocity(self) -> float:
        """
        Flow rate of liquid and solids over the bore [m/s].
        """
    @property
    def count_in_bore(self) -> int:
        """
        Liquid particles from x = 0 to the pipe's length.
        """
    @property
    def density_ratio(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) number density over its mean in the liquid [-].
        """
    @property
    def density_scatter(self) -> float:
        """
        Standard deviation of the number density over its mean [-].
        """
    @property
    def kinetic_energy(self) -> float:
        """
        Per mass [J/kg].
        """
    @property
    def liquid_count(self) -> int:
        ...
    @property
    def plate_face(self) -> float:
        """
        Where the plate meets the liquid [m]; 0 without a plate.
        """
    @property
    def position(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) [m], in the order given; NaN in a place that no particle holds.
        """
    @property
    def pressure(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) p', less the mean gradient and static parts [Pa].
        """
    @property
    def pressure_gradient(self) -> float:
        """
        Loss along the pipe in the last substep [Pa/m].
        """
    @property
    def pressure_noise(self) -> float:
        """
        Root mean square change of p' in the last substep [Pa].
        """
    @property
    def velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) [m/s].
        """
    @property
    def void_fraction(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) share of the liquid, of the last substep [-].
        """
    @property
    def wall_shear(self) -> float:
        """
        Mean shear of the wall function [Pa]; 0 in laminar flow.
        """
class NodeLiquidReport:
    """
    What a call of EulerianLiquid.advance met.
    """
    @property
    def convection_error(self) -> float:
        """
        Axial momentum that convection failed to keep between solids, and that was given back [Pa/m].
        """
    @property
    def divergence(self) -> float:
        """
        Root mean square divergence at the end, times spacing over speed [-].
        """
    @property
    def friction(self) -> float:
        """
        What the walls take up, mean over the call [Pa/m].
        """
    @property
    def limit(self) -> str:
        """
        What bound the shortest step: courant, viscosity, or none where one step was enough.
        """
    @property
    def mean_gradient(self) -> float:
        """
        Loss of pressure along the pipe, mean over the call [Pa/m].
        """
    @property
    def shortest(self) -> float:
        """
        Shortest step that the limits allowed in the call [s].
        """
    @property
    def solve_seconds(self) -> float:
        """
        Time spent in the pressure equation [s].
        """
    @property
    def sound(self) -> bool:
        """
        False when speeds overflowed or the step became too short.
        """
    @property
    def substeps(self) -> int:
        ...
    @property
    def unexplained(self) -> float:
        """
        Of the axial momentum: what convection and pressure add, and must not [Pa/m].
        """
class EulerianLiquid:
    """
    The liquid of a full, straight, rigid, periodic round pipe on fixed nodes.
    
    Least-squares MPS on rings of nodes that repeat along the pipe; the pressure is solved directly.
    Laminar flow sticks to the wall, turbulent flow has a mixing length and a wall function: a liquid of
    the mean flow.
    
    Parameters
    ----------
    place : (n, 2) float64 ndarray
        Nodes of a cross-section (y, z), those on the wall last [m].
    area : (n,) float64 ndarray
        Of each node; sums to that of the bore [m2].
    wall_count : int
        Nodes on the wall.
    stations : int
        Cross-sections along the pipe, a multiple of 4; station k lies at ``(k + 1/2) / stations`` of
        the length.
    spacing : float
        Between the nodes of a cross-section [m].
    velocity : (n, stations, 3) float64 ndarray
        To start with; on the wall it is set by the flow [m/s].
    pipe_radius, pipe_length : float
        [m].
    density, kinematic_viscosity : float
        [kg/m3], [m2/s].
    roughness : float
        Of the wall [m].
    turbulent : bool
        Mixing length and log-law wall function; else laminar with no-slip walls.
    bulk_velocity : float
        Held at every stage unless a gradient is given [m/s].
    pressure_gradient : float, optional
        Given loss of pressure along the pipe [Pa/m].
    convection : {"upwind", "muscl"}
        Least-squares upwind, or MUSCL-Rusanov: more damped, and stable where no viscosity helps.
    scheme : {"rk2", "rk3"}
        Runge-Kutta of two or three stages.
    courant : float, optional
        Largest step over the time to cross a spacing [-]; by default 0.8 with rk2, 1.2 with rk3.
    threads : int
        The results do not depend on it.
    
    References
    ----------
    Tamai & Koshizuka (2014) doi:10.1007/s40571-014-0027-2.
    """
    def __init__(self, *, place: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], area: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], wall_count: typing.SupportsInt | typing.SupportsIndex, stations: typing.SupportsInt | typing.SupportsIndex, spacing: typing.SupportsFloat | typing.SupportsIndex, velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pipe_radius: typing.SupportsFloat | typing.SupportsIndex, pipe_length: typing.SupportsFloat | typing.SupportsIndex, density: typing.SupportsFloat | typing.SupportsIndex, kinematic_viscosity: typing.SupportsFloat | typing.SupportsIndex, roughness: typing.SupportsFloat | typing.SupportsIndex, turbulent: bool, bulk_velocity: typing.SupportsFloat | typing.SupportsIndex, pressure_gradient: typing.SupportsFloat | typing.SupportsIndex | None = None, convection: str = 'upwind', scheme: str = 'rk2', courant: typing.SupportsFloat | typing.SupportsIndex | None = None, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> None:
        ...
    def __len__(self) -> int:
        ...
    def advance(self, dt: typing.SupportsFloat | typing.SupportsIndex) -> NodeLiquidReport:
        """
        Advance by dt [s], in as few substeps as Courant number and viscosity allow.
        """
    def body_force(self, acceleration: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None:
        """
        Acceleration of every mass from now on, (3,) [m/s2].
        """
    def drive(self, *, bulk_velocity: typing.SupportsFloat | typing.SupportsIndex, pressure_gradient: typing.SupportsFloat | typing.SupportsIndex | None = None) -> None:
        """
        Drive the liquid otherwise from now on.
        
        Parameters
        ----------
        bulk_velocity : float
            Held at every stage unless a gradient is given [m/s].
        pressure_gradient : float, optional
            Given loss of pressure along the pipe [Pa/m].
        """
    def momentum_source(self, acceleration: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None) -> None:
        """
        Force on the liquid over its mass from now on, (n, stations, 3) [m/s2]; None ends it.
        """
    def restore(self, state: dict[str, typing.Any]) -> None:
        """
        Continue bit-equal from a `state` of the same liquid.
        """
    def state(self) -> dict[str, typing.Any]:
        """
        The exact state as arrays, for `restore`.
        """
    def velocity_at(self, *, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], radius: typing.SupportsFloat | typing.SupportsIndex) -> numpy.typing.NDArray[numpy.float64]:
        """
        Liquid velocity at points, averaged with the kernel W_s over a radius.
        
        Parameters
        ----------
        points : (n, 3) float64 ndarray
            Positions, x within the pipe [m].
        radius : float
            Of the average [m].
        
        Returns
        -------
        (n, 3) float64 ndarray
            [m/s]; zero where no node is within the radius.
        """
    @property
    def bulk_velocity(self) -> float:
        """
        Flow rate of liquid and solids over the bore [m/s].
        """
    @property
    def kinetic_energy(self) -> float:
        """
        Per mass [J/kg].
        """
    @property
    def largest_viscosity(self) -> float:
        """
        Molecular and eddy viscosity, the largest of the last stage [m2/s].
        """
    @property
    def pressure(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, stations) less the mean gradient and static parts [Pa].
        """
    @property
    def pressure_gradient(self) -> float:
        """
        Loss along the pipe in the last substep [Pa/m].
        """
    @property
    def pressure_noise(self) -> float:
        """
        Scatter of the pressure about its mean [Pa].
        """
    @property
    def stations(self) -> int:
        ...
    @property
    def velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, stations, 3) [m/s].
        """
    @property
    def viscosity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, stations) molecular and eddy viscosity of the last stage [m2/s].
        """
    @property
    def void_fraction(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, stations) share of the liquid, of the last substep [-].
        """
    @property
    def wall_shear(self) -> float:
        """
        Mean shear of the wall function [Pa]; 0 in laminar flow.
        """
def background_gradient(neighbors: mpsdem._core.neighbors.NeighborList, reference: ReferenceDensity, pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, background: typing.SupportsFloat | typing.SupportsIndex, kind: typing.Annotated[numpy.typing.ArrayLike, numpy.int8], wall: mpsdem._core.geometry.Plane | mpsdem._core.geometry.Cylinder, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    Pressure gradient from p_j - p_i, and 2 p_b that spreads the particles evenly.
    
    Between liquid and wall the background pushes along the wall's normal alone.
    
    Parameters
    ----------
    neighbors : NeighborList
    reference : ReferenceDensity
    pressure : (n,) float64 ndarray
        [Pa]
    background : float
        p_b [Pa]; 0.02 of density x bulk velocity^2 is a good choice.
    kind : (n,) int8 ndarray
        2 liquid, -2 wall, -1 ghost.
    wall : Plane or Cylinder
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n, 3) float64 ndarray
        [Pa/m]
    """
def conserving_gradient(neighbors: mpsdem._core.neighbors.NeighborList, reference: ReferenceDensity, pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, background: typing.SupportsFloat | typing.SupportsIndex, kind: typing.Annotated[numpy.typing.ArrayLike, numpy.int8], wall: mpsdem._core.geometry.Plane | mpsdem._core.geometry.Cylinder, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    Pressure gradient from p_j + p_i among liquid, and 2 p_b that spreads the particles evenly.
    
    Momentum among liquid is kept to round-off. Between liquid and wall the difference counts along the
    wall, the sum along its normal.
    
    Parameters
    ----------
    neighbors : NeighborList
    reference : ReferenceDensity
    pressure : (n,) float64 ndarray
        [Pa]
    background : float
        p_b [Pa]; 0.02 of density x bulk velocity^2 is a good choice.
    kind : (n,) int8 ndarray
        2 liquid, -2 wall, -1 ghost.
    wall : Plane or Cylinder
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n, 3) float64 ndarray
        [Pa/m]
    """
def corrected_divergence(neighbors: mpsdem._core.neighbors.NeighborList, reference: ReferenceDensity, velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, kind: typing.Annotated[numpy.typing.ArrayLike, numpy.int8], wall: mpsdem._core.geometry.Plane | mpsdem._core.geometry.Cylinder, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    Divergence of the velocity beside a no-slip wall, exact for linear velocities.
    
    The whole velocity is mirrored in the wall.
    
    Parameters
    ----------
    neighbors : NeighborList
    reference : ReferenceDensity
    velocity : (n, 3) float64 ndarray
        Of liquid, wall and ghosts [m/s].
    kind : (n,) int8 ndarray
        2 liquid, -2 wall, -1 ghost.
    wall : Plane or Cylinder
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n,) float64 ndarray
        [1/s]; 0 at walls and ghosts.
    """
def corrected_gradient(neighbors: mpsdem._core.neighbors.NeighborList, reference: ReferenceDensity, pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    Pressure gradient from p_j - p_i and the inverse moment of the neighborhood.
    
    Exact for linear pressures wherever the neighbors are. Where they lie in a plane, the uncorrected
    difference.
    
    Parameters
    ----------
    neighbors : NeighborList
    reference : ReferenceDensity
    pressure : (n,) float64 ndarray
        [Pa]
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n, 3) float64 ndarray
        [Pa/m]
    
    References
    ----------
    Khayyer & Gotoh (2011), doi:10.1016/j.jcp.2011.01.009.
    """
def difference_gradient(neighbors: mpsdem._core.neighbors.NeighborList, reference: ReferenceDensity, pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    Pressure gradient from p_j - p_i.
    
    A constant pressure has none. Exact for linear pressures on the lattice; among scattered particles
    the error does not fall with the spacing.
    
    Parameters
    ----------
    neighbors : NeighborList
    reference : ReferenceDensity
    pressure : (n,) float64 ndarray
        [Pa]
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n, 3) float64 ndarray
        [Pa/m]
    
    References
    ----------
    Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
    """
def divergence(neighbors: mpsdem._core.neighbors.NeighborList, reference: ReferenceDensity, velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    Divergence of the velocity; walls count with the velocities they are given.
    
    Parameters
    ----------
    neighbors : NeighborList
    reference : ReferenceDensity
    velocity : (n, 3) float64 ndarray
        [m/s]; 0 at the wall makes it a no-slip wall.
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n,) float64 ndarray
        [1/s]
    
    References
    ----------
    Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
    """
def eddy_viscosity(model: MixingLength | Smagorinsky, *, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], shear_rate: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], largest: typing.SupportsFloat | typing.SupportsIndex, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    Eddy viscosity, the smaller of length^2 x rate of strain and `largest`.
    
    Parameters
    ----------
    model : MixingLength or Smagorinsky
    position : (n, 3) float64 ndarray
        [m]
    shear_rate : (n,) float64 ndarray
        [1/s]
    largest : float
        What the time step allows [m2/s]; 0.1 of spacing^2 / step holds.
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n,) float64 ndarray
        [m2/s]
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
def laplacian(neighbors: mpsdem._core.neighbors.NeighborList, reference: ReferenceDensity, field: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    Laplacian from weighted differences.
    
    Second order on the lattice; among scattered particles its error grows as the spacing falls.
    
    Parameters
    ----------
    neighbors : NeighborList
    reference : ReferenceDensity
    field : (n,) or (n, 3) float64 ndarray
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n,) or (n, 3) float64 ndarray
        Unit of the field / m2.
    
    References
    ----------
    Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
    """
def least_squares_laplacian(neighbors: mpsdem._core.neighbors.NeighborList, field: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, kind: typing.Annotated[numpy.typing.ArrayLike, numpy.int8], wall: mpsdem._core.geometry.Plane | mpsdem._core.geometry.Cylinder, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> tuple[numpy.typing.NDArray[numpy.float64], int]:
    """
    Laplacian of the quadratic polynomial that fits the neighbors best.
    
    Exact for quadratic fields wherever the neighbors are. A wall particle's value is taken to hold on
    the wall, at the point nearest to the particle; ghosts are left out.
    
    Parameters
    ----------
    neighbors : NeighborList
    field : (n,) or (n, 3) float64 ndarray
    kind : (n,) int8 ndarray
        2 liquid, -2 wall, -1 ghost.
    wall : Plane or Cylinder
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    result : (n,) or (n, 3) float64 ndarray
        Unit of the field / m2; 0 but for the liquid.
    deficient : int
        How many liquid particles have neighbors that fix no quadratic; their result is 0.
    
    References
    ----------
    Tamai & Koshizuka (2014), doi:10.1007/s40571-014-0027-2.
    """
def number_density(neighbors: mpsdem._core.neighbors.NeighborList, reference: ReferenceDensity, *, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    Sum of the neighbors' weights.
    
    Parameters
    ----------
    neighbors : NeighborList
    reference : ReferenceDensity
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n,) float64 ndarray
        [-]; ``reference.number_density`` on the lattice.
    
    References
    ----------
    Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
    """
def relative_convection(neighbors: mpsdem._core.neighbors.NeighborList, reference: ReferenceDensity, *, relative_flux: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], void_fraction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], kind: typing.Annotated[numpy.typing.ArrayLike, numpy.int8], threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    What a liquid brings along that moves past its own particles, upwind.
    
    Parameters
    ----------
    neighbors : NeighborList
    reference : ReferenceDensity
    relative_flux : (n, 3) float64 ndarray
        q = eps (u - w), w the particles' own velocity [m/s].
    void_fraction : (n,) float64 ndarray
        eps, share of the liquid [-].
    velocity : (n, 3) float64 ndarray
        u of the liquid [m/s].
    kind : (n,) int8 ndarray
        2 liquid, -2 wall, -1 ghost; only liquid brings something.
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n, 3) float64 ndarray
        -(q . grad) u / eps [m/s2]; 0 where q is.
    """
def section_operators(*, place: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], area: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], wall_count: typing.SupportsInt | typing.SupportsIndex, pipe_radius: typing.SupportsFloat | typing.SupportsIndex, spacing: typing.SupportsFloat | typing.SupportsIndex) -> dict[str, typing.Any]:
    """
    Least-squares operators across a pipe, as matrices.
    
    Parameters
    ----------
    place, area, wall_count, pipe_radius, spacing
        As of `EulerianLiquid`.
    
    Returns
    -------
    dict of (n, n) float64 ndarray
        ``gradient_y``, ``gradient_z`` [1/m]; ``laplacian`` [1/m2]; ``damping_y``, ``damping_z`` of
        upwind differences [1/m].
    
    References
    ----------
    Tamai & Koshizuka (2014) doi:10.1007/s40571-014-0027-2.
    """
def shear_rate(neighbors: mpsdem._core.neighbors.NeighborList, reference: ReferenceDensity, velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, kind: typing.Annotated[numpy.typing.ArrayLike, numpy.int8], threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    Rate of strain sqrt(2 S:S) among liquid particles.
    
    Exact for linear velocities wherever the neighbors are; rotation has none.
    
    Parameters
    ----------
    neighbors : NeighborList
    reference : ReferenceDensity
    velocity : (n, 3) float64 ndarray
        [m/s]
    kind : (n,) int8 ndarray
        2 liquid, -2 wall, -1 ghost.
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n,) float64 ndarray
        [1/s]; 0 but for the liquid, and where its neighbors are too few.
    """
def shifting(neighbors: mpsdem._core.neighbors.NeighborList, reference: ReferenceDensity, *, coefficient: typing.SupportsFloat | typing.SupportsIndex, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    Where particles should go for their neighborhoods to be even.
    
    Parameters
    ----------
    neighbors : NeighborList
    reference : ReferenceDensity
    coefficient : float
        Of the spacing squared times the gradient of concentration [-]; 0.1 each step holds.
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n, 3) float64 ndarray
        [m]
    
    References
    ----------
    Xu, Stansby & Laurence (2009), doi:10.1016/j.jcp.2009.05.032.
    """
def slip_divergence(neighbors: mpsdem._core.neighbors.NeighborList, reference: ReferenceDensity, velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, kind: typing.Annotated[numpy.typing.ArrayLike, numpy.int8], wall: mpsdem._core.geometry.Plane | mpsdem._core.geometry.Cylinder, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    Divergence of the velocity beside a wall that lets the liquid slip.
    
    Only the velocity through the wall counts, mirrored in it: plug flow has no divergence.
    
    Parameters
    ----------
    neighbors : NeighborList
    reference : ReferenceDensity
    velocity : (n, 3) float64 ndarray
        Of liquid, wall and ghosts [m/s].
    kind : (n,) int8 ndarray
        2 liquid, -2 wall, -1 ghost.
    wall : Plane or Cylinder
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n,) float64 ndarray
        [1/s]
    """
def stored_weights(position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], reference: ReferenceDensity, *, period: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    The weights as the particle liquid keeps them, rounded to float32.
    
    Parameters
    ----------
    position : (n, 3) float64 ndarray
        [m]
    reference : ReferenceDensity
    period : float
        Along x [m]; 0 for none.
    
    Returns
    -------
    (m,) float64 ndarray, (m,) float64 ndarray
        W [-] and W / r^2 [1/m2] of the neighbors, in the order of a `NeighborList`.
    """
def sum_gradient(neighbors: mpsdem._core.neighbors.NeighborList, reference: ReferenceDensity, pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    Pressure gradient from p_j + p_i.
    
    Momentum is kept to round-off. A constant pressure pushes apart where particles lie unevenly, and
    more so where the sums are cut off.
    
    Parameters
    ----------
    neighbors : NeighborList
    reference : ReferenceDensity
    pressure : (n,) float64 ndarray
        [Pa]
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n, 3) float64 ndarray
        [Pa/m]
    
    References
    ----------
    Khayyer & Gotoh (2008), doi:10.1142/S0578563408001788.
    """
def viscous_acceleration(neighbors: mpsdem._core.neighbors.NeighborList, reference: ReferenceDensity, velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, viscosity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], kind: typing.Annotated[numpy.typing.ArrayLike, numpy.int8], threads: typing.SupportsInt | typing.SupportsIndex = 1) -> numpy.typing.NDArray[numpy.float64]:
    """
    Acceleration by viscosity between liquid particles, a pair's being the mean of two.
    
    Momentum is kept to round-off and kinetic energy falls. The wall's shear is not in it.
    
    Parameters
    ----------
    neighbors : NeighborList
    reference : ReferenceDensity
    velocity : (n, 3) float64 ndarray
        [m/s]
    viscosity : (n,) float64 ndarray
        Kinematic, eddies included [m2/s].
    kind : (n,) int8 ndarray
        2 liquid, -2 wall, -1 ghost.
    threads : int
        The result does not depend on it.
    
    Returns
    -------
    (n, 3) float64 ndarray
        [m/s2]; 0 but for the liquid.
    
    References
    ----------
    Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205.
    """
