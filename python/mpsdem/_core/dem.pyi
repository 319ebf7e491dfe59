"""
Discrete element method: contact laws and the solids. SI units throughout.
"""
from __future__ import annotations
import collections.abc
import mpsdem._core.geometry
import numpy
import numpy.typing
import typing
__all__: list[str] = ['AdvanceReport', 'HertzMindlin', 'HertzViscoelastic', 'LinearSpring', 'Lubrication', 'Solids', 'damping_factor']
class LinearSpring:
    """
    Linear spring-dashpot with friction.
    """
    @staticmethod
    def with_restitution(*, normal_stiffness: typing.SupportsFloat | typing.SupportsIndex, tangential_stiffness: typing.SupportsFloat | typing.SupportsIndex, restitution: typing.SupportsFloat | typing.SupportsIndex, friction: typing.SupportsFloat | typing.SupportsIndex) -> LinearSpring:
        """
        Damping chosen for each pair so that an impact returns `restitution`.
        """
    def __init__(self, *, normal_stiffness: typing.SupportsFloat | typing.SupportsIndex, tangential_stiffness: typing.SupportsFloat | typing.SupportsIndex, normal_damping: typing.SupportsFloat | typing.SupportsIndex, tangential_damping: typing.SupportsFloat | typing.SupportsIndex, friction: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    def contact_force(self, *, normal: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], relative_velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], overlap: typing.SupportsFloat | typing.SupportsIndex, reduced_radius: typing.SupportsFloat | typing.SupportsIndex, reduced_mass: typing.SupportsFloat | typing.SupportsIndex, spring: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], dt: typing.SupportsFloat | typing.SupportsIndex) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Force of one contact on body i.
        
        Parameters
        ----------
        normal : (3,) float64 ndarray
            Unit vector from body j to body i.
        relative_velocity : (3,) float64 ndarray
            v_i - v_j at the contact point, spin included [m/s].
        overlap, reduced_radius : float
            [m].
        reduced_mass : float
            [kg].
        spring : (3,) float64 ndarray
            Tangential displacement before the step [m].
        dt : float
            Step [s].
        
        Returns
        -------
        normal, tangential : (3,) float64 ndarray
            Force on body i [N].
        spring : (3,) float64 ndarray
            Tangential displacement after the step [m].
        """
class HertzMindlin:
    """
    Hertz normal and Mindlin tangential force.
    """
    def __init__(self, *, youngs_modulus: typing.SupportsFloat | typing.SupportsIndex, poisson_ratio: typing.SupportsFloat | typing.SupportsIndex, restitution: typing.SupportsFloat | typing.SupportsIndex, friction: typing.SupportsFloat | typing.SupportsIndex, other_youngs_modulus: typing.SupportsFloat | typing.SupportsIndex | None = None, other_poisson_ratio: typing.SupportsFloat | typing.SupportsIndex | None = None) -> None:
        """
        Contact of bodies of one material, or of two.
        
        Parameters
        ----------
        youngs_modulus, other_youngs_modulus : float
            [Pa]; infinite for a rigid body. The other body's is the first's unless given.
        poisson_ratio, other_poisson_ratio : float
            [-].
        restitution : float
            Returned by a head-on impact at any speed [-].
        friction : float
            Sliding friction [-].
        """
    def contact_force(self, *, normal: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], relative_velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], overlap: typing.SupportsFloat | typing.SupportsIndex, reduced_radius: typing.SupportsFloat | typing.SupportsIndex, reduced_mass: typing.SupportsFloat | typing.SupportsIndex, spring: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], dt: typing.SupportsFloat | typing.SupportsIndex) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Force of one contact on body i.
        
        Parameters
        ----------
        normal : (3,) float64 ndarray
            Unit vector from body j to body i.
        relative_velocity : (3,) float64 ndarray
            v_i - v_j at the contact point, spin included [m/s].
        overlap, reduced_radius : float
            [m].
        reduced_mass : float
            [kg].
        spring : (3,) float64 ndarray
            Tangential displacement before the step [m].
        dt : float
            Step [s].
        
        Returns
        -------
        normal, tangential : (3,) float64 ndarray
            Force on body i [N].
        spring : (3,) float64 ndarray
            Tangential displacement after the step [m].
        """
class HertzViscoelastic:
    """
    Hertz contact of viscoelastic bodies, for comparing codes.
    """
    def __init__(self, *, normal_stiffness: typing.SupportsFloat | typing.SupportsIndex, tangential_stiffness: typing.SupportsFloat | typing.SupportsIndex, normal_damping: typing.SupportsFloat | typing.SupportsIndex, tangential_damping: typing.SupportsFloat | typing.SupportsIndex, friction: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    def contact_force(self, *, normal: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], relative_velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], overlap: typing.SupportsFloat | typing.SupportsIndex, reduced_radius: typing.SupportsFloat | typing.SupportsIndex, reduced_mass: typing.SupportsFloat | typing.SupportsIndex, spring: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], dt: typing.SupportsFloat | typing.SupportsIndex) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Force of one contact on body i.
        
        Parameters
        ----------
        normal : (3,) float64 ndarray
            Unit vector from body j to body i.
        relative_velocity : (3,) float64 ndarray
            v_i - v_j at the contact point, spin included [m/s].
        overlap, reduced_radius : float
            [m].
        reduced_mass : float
            [kg].
        spring : (3,) float64 ndarray
            Tangential displacement before the step [m].
        dt : float
            Step [s].
        
        Returns
        -------
        normal, tangential : (3,) float64 ndarray
            Force on body i [N].
        spring : (3,) float64 ndarray
            Tangential displacement after the step [m].
        """
class Lubrication:
    """
    Viscous force in narrow gaps between solids and at walls, along the normal.
    
    F = -6 pi viscosity R^2 u_n (1 / max(h, h_min) - 1 / h_c) for gaps 0 < h < h_c; R is the reduced
    radius. Source: Biegert, Vowinckel & Meiburg (2017) doi:10.1016/j.jcp.2017.03.035.
    
    Parameters
    ----------
    viscosity : float
        Of the liquid, dynamic [Pa s], > 0.
    least_gap : float
        h_min / R [-], > 0: the roughness of the surfaces.
    cutoff : float
        h_c / R [-], > least_gap and <= 2.
    
    Raises
    ------
    ValueError
        A number out of its range.
    """
    def __init__(self, *, viscosity: typing.SupportsFloat | typing.SupportsIndex, least_gap: typing.SupportsFloat | typing.SupportsIndex = 0.003, cutoff: typing.SupportsFloat | typing.SupportsIndex = 1.0) -> None:
        ...
    def force(self, *, gap: typing.SupportsFloat | typing.SupportsIndex, normal_velocity: typing.SupportsFloat | typing.SupportsIndex, reduced_radius: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        On the first body, positive apart [N]. `gap` and `reduced_radius` in m; `normal_velocity` [m/s], positive while the bodies part.
        """
class AdvanceReport:
    """
    What a call of Solids.advance met.
    """
    @property
    def finite(self) -> bool:
        """
        False when positions or velocities overflowed: the state is lost.
        """
    @property
    def largest_overlap(self) -> float:
        """
        Largest overlap over the smaller radius [-].
        """
    @property
    def prunes(self) -> int:
        ...
    @property
    def sorts(self) -> int:
        ...
class Solids:
    """
    Spheres that touch each other and walls.
    
    Parameters
    ----------
    position, velocity, spin : (n, 3) float64 ndarray
        [m], [m/s], [rad/s].
    radius, density : (n,) float64 ndarray
        [m], [kg/m3].
    pair_law, wall_law : LinearSpring, HertzMindlin or HertzViscoelastic
        Contact law between solids and at walls.
    pair_rolling_friction, wall_rolling_friction : float
        [-].
    walls : list of Plane, Cylinder or BentCylinder
    period : float
        Length of the periodic x axis [m]; 0 for none.
    threads : int
        The results do not depend on it.
    lubrication : Lubrication, optional
        None: gaps hold nothing. Its force bounds the step of `advance`.
    """
    def __init__(self, *, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], spin: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], radius: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], density: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pair_law: LinearSpring | HertzMindlin | HertzViscoelastic, wall_law: LinearSpring | HertzMindlin | HertzViscoelastic, pair_rolling_friction: typing.SupportsFloat | typing.SupportsIndex = 0.0, wall_rolling_friction: typing.SupportsFloat | typing.SupportsIndex = 0.0, walls: collections.abc.Sequence[mpsdem._core.geometry.Plane | mpsdem._core.geometry.Cylinder | mpsdem._core.geometry.BentCylinder] = [], period: typing.SupportsFloat | typing.SupportsIndex = 0.0, threads: typing.SupportsInt | typing.SupportsIndex = 1, lubrication: Lubrication | None = None) -> None:
        ...
    def __len__(self) -> int:
        ...
    def advance(self, dt: typing.SupportsFloat | typing.SupportsIndex, steps: typing.SupportsInt | typing.SupportsIndex) -> AdvanceReport:
        """
        Take `steps` steps of velocity Verlet of `dt` [s]. ValueError: dt is not > 0, or too long for lubrication.
        """
    def bend(self, bending: mpsdem._core.geometry.Bending) -> None:
        """
        Bent walls move so in the next `advance`, and stay as at its end.
        """
    def contacts(self) -> dict[str, typing.Any]:
        """
        What touches now: first, second (-1 - w for wall w), overlap [m], normal, force [N].
        """
    def restore(self, state: dict[str, typing.Any]) -> None:
        """
        Continue bit-equal from a `state` of the same population.
        """
    def set_forcing(self, *, acceleration: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], liquid_velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None = None, drag_rate: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None = None, liquid_acceleration: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None = None, relaxation: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None = None, added_mass: typing.SupportsFloat | typing.SupportsIndex | typing.Annotated[numpy.typing.ArrayLike, numpy.float64] = 0.0) -> None:
        """
        From now on dv/dt = F/m + acceleration + drag_rate (u - v), u = liquid_velocity.
        
        With the last two the liquid responds: du/dt = liquid_acceleration - relaxation (u - v), from
        `liquid_velocity` on. Both are implicit in the slip u - v, together: stable for any step. The
        liquid's inertia of each solid, drag_rate * mass / relaxation [kg], times u and the solid's mass
        times v then keep their sum in the exchange.
        
        Added mass adds added_mass (du/dt - dv/dt) to the solid's acceleration, implicitly: stable for any
        ratio of densities. A liquid that responds gets the opposite with the inertia above; one that does
        not has du/dt = 0. Contacts see the solid's own mass. Starts `drag_impulse` and `mean_velocity` anew.
        
        Parameters
        ----------
        acceleration : (n, 3) float64 ndarray
            [m/s2].
        liquid_velocity : (n, 3) float64 ndarray, optional
            [m/s]; together with `drag_rate`.
        drag_rate : (n,) float64 ndarray, optional
            [1/s], >= 0.
        liquid_acceleration : (n, 3) float64 ndarray, optional
            What else moves the liquid at each solid [m/s2]; together with `relaxation`.
        relaxation : (n,) float64 ndarray, optional
            Rate at which the liquid at each solid nears the solid's velocity [1/s], >= 0.
        added_mass : float or (n,) float64 ndarray
            Over the solid's own mass [-], >= 0: C_m rho_liquid / rho_solid, C_m = 1/2 for a sphere. Force:
            Auton, Hunt & Prud'homme (1988) doi:10.1017/S0022112088003246. Other than 0 only with `drag_rate`.
        
        Raises
        ------
        ValueError
            A shape, a negative number, or one of those that come together is missing.
        """
    def state(self) -> dict[str, typing.Any]:
        """
        The exact state as arrays of private layout, for `restore`; forcing is not part of it.
        """
    @property
    def drag_impulse(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) impulse of drag and added mass on each solid since set_forcing [N s].
        """
    @property
    def elastic_energy(self) -> float:
        """
        [J]
        """
    @property
    def kinetic_energy(self) -> float:
        """
        [J]
        """
    @property
    def laps(self) -> numpy.typing.NDArray[numpy.int64]:
        """
        (n,) times around the periodic axis.
        """
    @property
    def liquid_velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) of the liquid at each solid now [m/s]; in a liquid only.
        """
    @property
    def longest_step(self) -> float:
        """
        That lubrication allows [s]; infinite without.
        """
    @property
    def mass(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) [kg].
        """
    @property
    def mean_velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) mean over the time since set_forcing, as drag saw it [m/s]; in a liquid only.
        """
    @property
    def position(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) [m], x within the period.
        """
    @property
    def radius(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) [m].
        """
    @property
    def spin(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) [rad/s].
        """
    @property
    def velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) [m/s].
        """
    @property
    def wall_impulse(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) impulse of the walls on the solids, lubrication included, since the start [N s].
        """
def damping_factor(restitution: typing.SupportsFloat | typing.SupportsIndex, p: typing.SupportsFloat | typing.SupportsIndex, q: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    Factor a of x'' + a x^q x' + x^p = 0 that returns `restitution` without pulling.
    """
