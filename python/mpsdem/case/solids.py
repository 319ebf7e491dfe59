"""The solids: what they are made of, how large they are, and where they start."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Annotated, Literal

from pydantic import Discriminator, Tag

from mpsdem.case.errors import BRANCH, Problem
from mpsdem.case.part import FromList, Part, Velocity, branch
from mpsdem.case.units import Quantity, Whole

Length = Annotated[float, Quantity("m")]
PositiveLength = Annotated[float, Quantity("m", above=0.0)]
Share = Annotated[float, Quantity(at_least=0.0, at_most=1.0)]
Position = Annotated[tuple[Length, Length, Length], FromList]
Rate = Annotated[float, Quantity("rad/s")]
Spin = Annotated[tuple[Rate, Rate, Rate], FromList]

_NONE = "leave out [solids] for clear liquid"


class Uniform(Part):
    """Diameters with the same number of solids in equal steps between two bounds [m]."""

    kind: Literal["uniform"] = "uniform"
    smallest: PositiveLength
    largest: PositiveLength

    def problems(self) -> Iterable[Problem]:
        yield from _wrong_order(self.smallest, self.largest)

    @property
    def mean_cube(self) -> float:
        """Mean of the cubed diameter [m3]."""
        a, b = self.smallest, self.largest
        return (a + b) * (a * a + b * b) / 4


class Lognormal(Part):
    """Diameters whose logarithm is normally distributed, cut at two bounds.

    Parameters
    ----------
    median : float
        Diameter with as many solids below as above it, before the cut [m].
    deviation : float
        Standard deviation of the natural logarithm of the diameter [-].
    smallest, largest : float
        Bounds of the diameter [m].
    """

    kind: Literal["lognormal"] = "lognormal"
    median: PositiveLength
    deviation: Annotated[float, Quantity(above=0.0, at_most=10.0)]
    smallest: PositiveLength
    largest: PositiveLength

    def problems(self) -> Iterable[Problem]:
        yield from _wrong_order(self.smallest, self.largest)
        if not self.smallest <= self.median <= self.largest:
            yield Problem(
                field="median",
                value=self.median,
                unit="m",
                rule=f"must lie between smallest and largest, {self.smallest} and {self.largest} m",
            )

    @property
    def mean_cube(self) -> float:
        """Mean of the cubed diameter [m3]."""
        s = self.deviation
        a, b = (math.log(d / self.median) / s for d in (self.smallest, self.largest))
        if a == b:
            return self.smallest**3
        share = _normal(b) - _normal(a)
        moment = _normal(b - 3 * s) - _normal(a - 3 * s)
        return self.median**3 * math.exp(4.5 * s * s) * moment / share


class Sieve(Part):
    """Classes of one diameter each.

    Parameters
    ----------
    diameters : tuple of float
        Diameter of each class [m].
    fractions : tuple of float
        Share of each class in the number of solids [-]; they add up to 1.
    """

    kind: Literal["sieve"] = "sieve"
    diameters: Annotated[tuple[PositiveLength, ...], FromList]
    fractions: Annotated[tuple[Share, ...], FromList]

    def problems(self) -> Iterable[Problem]:
        if len(self.diameters) != len(self.fractions) or not self.diameters:
            yield Problem(
                field="fractions",
                value=self.fractions,
                rule=f"must have one entry per diameter, of which there are {len(self.diameters)}",
            )
        elif not math.isclose(sum(self.fractions), 1.0, abs_tol=1e-6):
            yield Problem(
                field="fractions",
                value=self.fractions,
                rule=f"must add up to 1, not {sum(self.fractions):g}",
            )

    @property
    def smallest(self) -> float:
        """Smallest diameter that occurs [m]."""
        return min(d for d, share in zip(self.diameters, self.fractions, strict=True) if share > 0)

    @property
    def largest(self) -> float:
        """Largest diameter that occurs [m]."""
        return max(d for d, share in zip(self.diameters, self.fractions, strict=True) if share > 0)

    @property
    def mean_cube(self) -> float:
        """Mean of the cubed diameter [m3]."""
        pairs = zip(self.diameters, self.fractions, strict=True)
        return sum(share * d**3 for d, share in pairs) / sum(self.fractions)


Distribution = Uniform | Lognormal | Sieve
Diameter = Annotated[
    Annotated[PositiveLength, Tag(f"{BRANCH}number")]
    | Annotated[Uniform, Tag(f"{BRANCH}uniform")]
    | Annotated[Lognormal, Tag(f"{BRANCH}lognormal")]
    | Annotated[Sieve, Tag(f"{BRANCH}sieve")],
    Discriminator(branch),
]

_Count = Annotated[int, Whole(at_least=1, remedy=_NONE)]


class Block(Part):
    """Solids on a cubic lattice, filled layer by layer along the pipe.

    Parameters
    ----------
    counts : tuple of int
        Lattice points along x, y and z; x is the slowest to be filled.
    count : int, optional
        Stop after that many solids.
    at : float
        Centre of the full lattice, as share of the length of the pipe [-].
    gap : float
        Free distance between neighbors over the largest diameter [-]; 0 lets them touch.
    velocity : tuple of float
        Velocity at the start [m/s].
    """

    kind: Literal["block"] = "block"
    counts: Annotated[tuple[_Count, _Count, _Count], FromList]
    count: _Count | None = None
    at: Share = 0.5
    gap: Annotated[float, Quantity(at_least=0.0)] = 0.005
    velocity: Velocity = (0.0, 0.0, 0.0)

    def problems(self) -> Iterable[Problem]:
        if self.count is not None and self.count > math.prod(self.counts):
            yield Problem(
                field="count",
                value=self.count,
                rule=f"must be <= {math.prod(self.counts)}, the product of counts",
            )


class Random(Part):
    """Solids anywhere in a stretch of the pipe, without overlap.

    Parameters
    ----------
    start, end : float
        The stretch, as shares of the length of the pipe [-].
    velocity : tuple of float
        Velocity at the start [m/s].
    """

    kind: Literal["random"] = "random"
    start: Share = 0.0
    end: Share = 1.0
    velocity: Velocity = (0.0, 0.0, 0.0)

    def problems(self) -> Iterable[Problem]:
        if self.end <= self.start:
            yield Problem(field="end", value=self.end, rule=f"must be > {self.start:g}, the start")


class List(Part):
    """Solids one by one.

    Parameters
    ----------
    positions : tuple of tuple of float
        Centres (n, 3) [m]; x from 0 to less than the length of the pipe.
    velocities, spins : tuple of tuple of float, optional
        Velocities [m/s] and angular velocities [rad/s], (n, 3); at rest by default.
    diameters : tuple of float, optional
        Diameters (n,) in place of ``solids.diameter`` [m].
    """

    kind: Literal["list"] = "list"
    positions: Annotated[tuple[Position, ...], FromList]
    velocities: Annotated[tuple[Velocity, ...], FromList] | None = None
    spins: Annotated[tuple[Spin, ...], FromList] | None = None
    diameters: Annotated[tuple[PositiveLength, ...], FromList] | None = None

    def problems(self) -> Iterable[Problem]:
        if not self.positions:
            yield Problem(field="positions", rule="must name at least one solid", remedy=_NONE)
        for name in ("velocities", "spins", "diameters"):
            entries = getattr(self, name)
            if entries is not None and len(entries) != len(self.positions):
                yield Problem(
                    field=name,
                    value=entries,
                    rule=f"must have {len(self.positions)} entries, one per position",
                )


Arrangement = Annotated[
    Annotated[Block, Tag(f"{BRANCH}block")]
    | Annotated[Random, Tag(f"{BRANCH}random")]
    | Annotated[List, Tag(f"{BRANCH}list")],
    Discriminator(branch),
]

YoungsModulus = Annotated[float, Quantity("Pa", above=0.0)]
PoissonRatio = Annotated[float, Quantity(above=-1.0, at_most=0.5)]
Restitution = Annotated[float, Quantity(above=0.0, at_most=1.0)]
Friction = Annotated[float, Quantity(at_least=0.0)]


class Material(Part):
    """What a contact law needs to know of a body.

    Parameters
    ----------
    youngs_modulus : float
        Young's modulus [Pa].
    poisson_ratio : float
        Poisson's ratio [-].
    restitution : float
        Rebound speed over impact speed [-].
    friction : float
        Coefficient of sliding friction [-].
    rolling_friction : float
        Rolling resistance torque over normal force and radius [-].
    """

    youngs_modulus: YoungsModulus
    poisson_ratio: PoissonRatio = 0.2
    restitution: Restitution = 0.9
    friction: Friction = 0.2
    rolling_friction: Friction = 0.0


class Wall(Part):
    """What differs in a contact with the wall; None where nothing does.

    Parameters
    ----------
    youngs_modulus : float, optional
        Young's modulus [Pa].
    poisson_ratio, restitution, friction, rolling_friction : float, optional
        As in `Material` [-].
    """

    youngs_modulus: YoungsModulus | None = None
    poisson_ratio: PoissonRatio | None = None
    restitution: Restitution | None = None
    friction: Friction | None = None
    rolling_friction: Friction | None = None


class Solids(Material):
    """Spheres of one material, whose parameters come first.

    Parameters
    ----------
    diameter : float, Uniform, Lognormal or Sieve
        Diameter of all [m], or how diameters are distributed over their number.
    density : float
        Density [kg/m3].
    count : int, optional
        Number of randomly placed solids; a block or a list has its own.
    volume_fraction : float, optional
        In place of `count`: their volume over that of the whole bore [-].
    arrangement : Block, Random or List
        Where they start.
    seed : int
        Of everything random at the start.
    relax : bool
        Push overlapping solids apart at the start, instead of refusing them.
    held : bool
        Whether they stay where they start, as a packed bed or a screen does.
    contact : {"hertz_mindlin", "linear_spring", "hertz_viscoelastic"}
        Contact law.
    wall : Wall
        What differs in a contact with the wall.
    normal_stiffness, tangential_stiffness : float, optional
        Of the linear spring [N/m]; derived from Young's modulus if not given.
    normal_damping, tangential_damping : float, optional
        Of the linear spring [kg/s]; derived from the restitution if not given.
    impact_speed : float, optional
        Speed at which the derived linear spring is as stiff as the Hertz contact [m/s].
    drag : str
        Drag law: "ergun_wen_yu", also named "gidaspow", "schiller_naumann", "wen_yu", "di_felice",
        "koch_hill" or "beetstra".
    """

    diameter: Diameter
    density: Annotated[float, Quantity("kg/m3", above=0.0)]
    count: _Count | None = None
    volume_fraction: Annotated[float, Quantity(above=0.0, below=1.0, remedy=_NONE)] | None = None
    arrangement: Arrangement = Random()
    seed: Annotated[int, Whole(at_least=0)] = 0
    relax: bool = False
    held: bool = False
    contact: Literal["hertz_mindlin", "linear_spring", "hertz_viscoelastic"] = "hertz_mindlin"
    wall: Wall = Wall()
    normal_stiffness: Annotated[float, Quantity("N/m", above=0.0)] | None = None
    tangential_stiffness: Annotated[float, Quantity("N/m", at_least=0.0)] | None = None
    normal_damping: Annotated[float, Quantity("kg/s", at_least=0.0)] | None = None
    tangential_damping: Annotated[float, Quantity("kg/s", at_least=0.0)] | None = None
    impact_speed: Annotated[float, Quantity("m/s", above=0.0)] | None = None
    drag: Literal[
        "ergun_wen_yu",
        "gidaspow",
        "schiller_naumann",
        "wen_yu",
        "di_felice",
        "koch_hill",
        "beetstra",
    ] = "ergun_wen_yu"

    def problems(self) -> Iterable[Problem]:
        yield from self._wrong_number()
        if self.held and self.starts_moving:
            yield Problem(
                field="held",
                value=True,
                rule="solids that are held start at rest",
                remedy="leave the velocities and spins of the arrangement out, or held",
            )
        if self.contact != "linear_spring":
            for name in (
                "normal_stiffness",
                "tangential_stiffness",
                "normal_damping",
                "tangential_damping",
                "impact_speed",
            ):
                if (value := getattr(self, name)) is not None:
                    yield Problem(
                        field=name,
                        value=value,
                        rule=f"has no meaning for contact = {self.contact!r}",
                        remedy="leave it out, or write contact = 'linear_spring'",
                    )

    def _wrong_number(self) -> Iterable[Problem]:
        given = [name for name in ("count", "volume_fraction") if getattr(self, name) is not None]
        if not isinstance(self.arrangement, Random):
            for name in given:
                yield Problem(
                    field=name,
                    value=getattr(self, name),
                    rule=f"has no meaning for a {self.arrangement.kind}",
                    remedy="leave it out; the arrangement says how many solids there are",
                )
        elif len(given) != 1:
            yield Problem(
                field="count",
                value=self.count,
                rule="a random arrangement takes either count or volume_fraction",
                remedy="leave out one" if given else "give one, or another arrangement",
            )

    @property
    def starts_moving(self) -> bool:
        """Whether the arrangement gives any solid a velocity or a spin."""
        start = self.arrangement
        if isinstance(start, List):
            vectors = (*(start.velocities or ()), *(start.spins or ()))
        else:
            vectors = (start.velocity,)
        return any(any(vector) for vector in vectors)

    @property
    def smallest_diameter(self) -> float:
        """Smallest diameter that can occur [m]."""
        return self._bounds[0]

    @property
    def largest_diameter(self) -> float:
        """Largest diameter that can occur [m]."""
        return self._bounds[1]

    @property
    def mean_volume(self) -> float:
        """Mean volume of a solid [m3]."""
        if isinstance(self.arrangement, List) and self.arrangement.diameters is not None:
            diameters = self.arrangement.diameters
            cube = sum(d**3 for d in diameters) / len(diameters)
        elif isinstance(self.diameter, float):
            cube = self.diameter**3
        else:
            cube = self.diameter.mean_cube
        return math.pi / 6 * cube

    @property
    def at_wall(self) -> Material:
        """Material of a contact with the wall: that of the solids where `wall` does not differ."""
        of_solids = {name: getattr(self, name) for name in Wall.model_fields}
        return Material(**of_solids | self.wall.model_dump(exclude_none=True))

    @property
    def _bounds(self) -> tuple[float, float]:
        if isinstance(self.arrangement, List) and self.arrangement.diameters is not None:
            return min(self.arrangement.diameters), max(self.arrangement.diameters)
        if isinstance(self.diameter, float):
            return self.diameter, self.diameter
        return self.diameter.smallest, self.diameter.largest


def _wrong_order(smallest: float, largest: float) -> Iterable[Problem]:
    if largest < smallest:
        yield Problem(
            field="largest", value=largest, unit="m", rule=f"must be >= {smallest}, the smallest"
        )


def _normal(x: float) -> float:
    """Cumulative normal distribution."""
    return math.erfc(-x / math.sqrt(2)) / 2
