"""The extremes, as data: each a small case that differs from one scene in what is extreme."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from mpsdem.case import Case

Outcome = Literal["survived", "refused", "stopped"]

PROFILE, EULERIAN, LAGRANGIAN = "profile", "eulerian", "lagrangian"
COMPUTED = (EULERIAN, LAGRANGIAN)
ALL = (PROFILE, EULERIAN, LAGRANGIAN)
DRY = "dry"

BORE = 0.1  # [m]
_LENGTH = 3 * BORE  # [m]
_DIAMETER = 0.01  # [m] of the solids

#: Sixty nodules of a tenth of the bore in water at 1 m/s, a pipe of three diameters.
BASE: Mapping[str, Any] = {
    "end_time": 1.0,
    "pipe": {"radius": BORE / 2, "length": _LENGTH},
    "liquid": {"density": 1000.0, "kinematic_viscosity": 1e-6, "bulk_velocity": 1.0},
    "solids": {
        "diameter": _DIAMETER,
        "density": 2500.0,
        "youngs_modulus": 1e7,
        "count": 60,
    },
    "fidelity": {"level": "quick", "threads": 1},
    "output": {"figures": False, "liquid_stride": 1},
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """One extreme, of one liquid.

    Attributes
    ----------
    quantity, value : str
        What is extreme, and how much.
    model : str
        Of the liquid; "dry" for none.
    changes : mapping
        In what the case differs from `BASE`; None takes a part out.
    steps : int
        Of the liquid, or coupling steps where it is prescribed.
    outcome : {"survived", "refused", "stopped"}
        What must come of it.
    speed : float
        Above which a velocity is absurd [m/s]; 0 for five times the fastest that the case names:
        bulk velocity, terminal velocity or that of the start.
    then : mapping
        In what the case differs when the run is resumed, if it is.
    """

    quantity: str
    value: str
    model: str
    changes: Mapping[str, Any]
    steps: int = 100
    outcome: Outcome = "survived"
    speed: float = 0.0
    then: Mapping[str, Any] = field(default_factory=dict)

    @property
    def id(self) -> str:
        """Its name on the command line."""
        words = (self.quantity, self.value, self.model)
        return "/".join(word.replace(" ", "-") for word in words)

    def case(self) -> Case:
        """The case, its end not yet chosen.

        Raises
        ------
        CaseError
            If the extreme is refused as soon as it is written down.
        """
        scene = dict(BASE)
        if self.model == DRY:
            del scene["liquid"]
            return Case(**scene).with_(**self.changes)
        model = {"liquid": {"model": self.model}}
        return Case(**scene).with_(**model).with_(**self.changes)


def rows() -> tuple[Row, ...]:
    """All rows, in the order of the table."""
    return tuple(
        row
        for group in (
            _solids(),
            _contacts(),
            _flow(),
            _pipe(),
            _motion(),
            _numerics(),
            _sizes(),
        )
        for row in group
    )


def _each(
    quantity: str,
    values: Mapping[str, Mapping[str, Any]],
    models: tuple[str, ...] = ALL,
    **options: Any,
) -> Iterator[Row]:
    """A row per value and liquid."""
    for value, changes in values.items():
        for model in models:
            yield Row(quantity=quantity, value=value, model=model, changes=changes, **options)


def _of_solids(key: str, *values: float) -> dict[str, dict[str, Any]]:
    return {f"{value:g}": {"solids": {key: value}} for value in values}


def _solids() -> Iterator[Row]:
    ratios = {f"{r:g}": {"solids": {"density": 1000.0 * r}} for r in (0.1, 1.0, 20.0)}
    yield from _each("density ratio", ratios)

    def packed(share: float) -> dict[str, Any]:
        return {"count": None, "volume_fraction": share}

    crowds: dict[str, Mapping[str, Any]] = {
        "0": {"solids": None},
        "0.3": {"solids": packed(0.3)},
        "0.57, random close packing": {"solids": packed(0.57)},
    }
    yield from _each("solid fraction", crowds, steps=50)
    fine: dict[str, Any] = {
        "pipe": {"length": 0.6 * BORE},
        "solids": packed(0.6) | {"diameter": _DIAMETER / 2},
    }
    packed_bed = "0.6 in twenty diameters"
    yield from _each("solid fraction", {packed_bed: fine}, (EULERIAN,), steps=20)
    # at rest in a liquid at 1 m/s, whose first steps bring 560 kPa/m
    yield from _each(
        "solid fraction", {packed_bed: fine}, (LAGRANGIAN,), steps=20, outcome="stopped"
    )
    moving = fine | {"solids": fine["solids"] | {"arrangement": {"velocity": (1.0, 0.0, 0.0)}}}
    yield from _each("solid fraction", {f"{packed_bed}, moving": moving}, (LAGRANGIAN,), steps=20)
    dense = {"solids": packed(0.6)}
    yield from _each(
        "solid fraction", {"0.6 in ten diameters": dense}, (PROFILE,), outcome="refused"
    )
    plug = {"count": None, "volume_fraction": 0.2, "arrangement": {"start": 0.3, "end": 0.65}}
    yield from _each("full plug", {"0.57 of a third": {"solids": plug}})
    alone = {"fidelity": {"coupling": "two-way"}, "solids": {"count": 1}}
    yield from _each("one solid", {"two-way": alone}, COMPUTED)
    yield from _each("one solid", {"one-way": {"solids": {"count": 1}}}, (PROFILE,))
    large = {"solids": {"diameter": 0.4 * BORE, "count": 4}}
    yield from _each("diameter over the bore", {"0.4": large})
    sizes = {"kind": "uniform", "smallest": 0.1 * _DIAMETER, "largest": _DIAMETER}
    yield from _each("ratio of sizes", {"10": {"solids": {"diameter": sizes, "count": 200}}})


def _contacts() -> Iterator[Row]:
    yield from _each("Young's modulus", _of_solids("youngs_modulus", 1e4), outcome="refused")
    yield from _each("Young's modulus", _of_solids("youngs_modulus", 1e5), (*ALL, DRY))
    yield from _each("Young's modulus", _of_solids("youngs_modulus", 1e12), (*ALL, DRY), steps=30)
    yield from _each("restitution", _of_solids("restitution", 0.01, 1.0), (*ALL, DRY))
    yield from _each("friction", _of_solids("friction", 0.0, 2.0), (*ALL, DRY))
    for law in ("linear spring", "hertz viscoelastic"):
        contact = {"contact": law.replace(" ", "_")}
        extremes = {
            f"{law}, E {modulus:g}, e {restitution:g}": {
                "solids": contact | {"youngs_modulus": modulus, "restitution": restitution}
            }
            for modulus, restitution in ((1e5, 0.01), (1e10, 1.0))
        }
        yield from _each("contact law", extremes, (PROFILE, DRY), steps=50)


def _flow() -> Iterator[Row]:
    viscosities = {
        f"{nu:g} m2/s": {"liquid": {"kinematic_viscosity": nu}} for nu in (1e-9, 1e-3, 10.0)
    }
    yield from _each("viscosity", viscosities)
    speeds = {
        f"{speed * BORE / 1e-6:g}": {
            "liquid": {"bulk_velocity": speed},
            "solids": {"youngs_modulus": modulus},
        }
        for speed, modulus in ((1e-7, 1e7), (100.0, 1e10))  # [m/s, Pa]
    }
    yield from _each("Reynolds number", speeds)
    directions = {f"{speed:g} m/s": {"liquid": {"bulk_velocity": speed}} for speed in (0.0, -1.0)}
    yield from _each("bulk velocity", directions)
    stop = {"bulk_velocity": 5.0, "pressure_gradient": 0.0}
    back = {"bulk_velocity": 5.0, "pressure_gradient": -1e4}
    start = {"bulk_velocity": 0.0, "pressure_gradient": 1e4}
    jumps = {
        "from rest at 10 kPa/m": {"liquid": start},
        "5 m/s, pump off": {"liquid": stop},
        "5 m/s, pump reversed": {"liquid": back},
    }
    yield from _each("jump of velocity", jumps, COMPUTED, speed=25.0)
    thrown = {"solids": {"arrangement": {"kind": "random", "velocity": (20.0, 5.0, -5.0)}}}
    yield from _each("jump of velocity", {"solids thrown at 21 m/s": thrown})
    yield from _each(
        "jump of velocity",
        {"resumed at 2 m/s": {}},
        outcome="refused",
        then={"liquid": {"bulk_velocity": 2.0}},
        steps=20,
    )


def _pipe() -> Iterator[Row]:
    angles = {
        f"{angle:g} deg": {"pipe": {"inclination": f"{angle} deg"}} for angle in (-90.0, 45.0, 90.0)
    }
    yield from _each("inclination", angles)
    short = {"pipe": {"length": 0.5 * BORE}}
    yield from _each("pipe length", {"0.5 D": short}, (PROFILE,))
    yield from _each("pipe length", {"0.5 D, ten spacings": short}, COMPUTED, outcome="refused")
    resolved = short | {"fidelity": {"particle_spacing": BORE / 13}}
    yield from _each("pipe length", {"0.5 D, thirteen spacings": resolved}, COMPUTED)
    long = {"pipe": {"length": 500 * BORE}, "fidelity": {"particle_spacing": BORE / 6}}
    yield from _each("pipe length", {"500 D": long}, steps=10)
    longest = (_LENGTH - BORE / 2) / 1.5
    for value, factor, outcome in (("largest", 0.999999, "survived"), ("larger", 1.01, "refused")):
        plate = {"pipe": {"ends": "push-plate", "stroke": factor * longest}}
        yield from _each("stroke of the push plate", {value: plate}, (LAGRANGIAN,), outcome=outcome)


def _motion() -> Iterator[Row]:
    def shaken(direction: str, frequency: float, amplitude: float, mode: int = 0) -> dict[str, Any]:
        part = {
            "direction": direction,
            "frequency": frequency,
            "amplitude": amplitude,
            "mode": mode,
        }
        return {"motion": {"vibration": [part]}}

    parts = {
        "50 Hz, 1 mm, across": shaken("z", 50.0, 1e-3),
        "1 Hz, one bore, across": shaken("z", 1.0, BORE),
        "1 Hz, one bore, along": shaken("x", 1.0, BORE),
        "50 Hz, 10 mm, across": shaken("z", 50.0, 0.1 * BORE),
        "50 Hz, one bore, across": shaken("z", 50.0, BORE) | {"solids": {"youngs_modulus": 1e8}},
    }
    yield from _each("vibration", parts)
    bent = {
        "50 Hz, 1 mm, mode 2": shaken("z", 50.0, 1e-3, mode=2),
        "1 Hz, a fifth of the bore, mode 2": shaken("z", 1.0, 0.2 * BORE, mode=2),
    }
    yield from _each("vibration", bent, (LAGRANGIAN,))
    steep = {"1 Hz, one bore, mode 2": shaken("z", 1.0, BORE, mode=2)}
    yield from _each("vibration", steep, (LAGRANGIAN,), outcome="refused")


def _numerics() -> Iterator[Row]:
    def courant(number: float) -> dict[str, Any]:
        return {f"{number:g}": {"fidelity": {"courant": number}}}

    yield from _each("Courant number", courant(0.05), COMPUTED, steps=200)
    yield from _each("Courant number", courant(2.0), COMPUTED)
    yield from _each("Courant number", courant(5.0), COMPUTED, outcome="refused")

    def spacing(across: int) -> dict[str, Any]:
        return {"fidelity": {"particle_spacing": BORE / across}}

    coarse = {"D/4": spacing(4)}
    yield from _each("spacing", coarse, (EULERIAN,), outcome="refused")
    yield from _each("spacing", {"D/6": spacing(6)}, (EULERIAN,))
    yield from _each("spacing", coarse, (LAGRANGIAN,))
    fine = spacing(60) | {"pipe": {"length": 0.5 * BORE}, "solids": {"count": 10}}
    yield from _each("spacing", {"D/60": fine}, COMPUTED, steps=20)
    equal = {
        "solids": {"youngs_modulus": 1e5},
        "fidelity": {"liquid_step": 1e-4, "coupling_step": 1e-4, "solid_step": 1e-4},
    }
    yield from _each("step ratio", {"1": equal}, COMPUTED)
    far = {
        "solids": {"youngs_modulus": 1e12, "count": 10},
        "fidelity": {"rayleigh_fraction": 0.04, "coupling": "two-way"},
    }
    yield from _each("step ratio", {"1e5": far}, COMPUTED, steps=10)
    tolerances = {f"{t:g}": {"fidelity": {"pressure_tolerance": t}} for t in (1e-1, 1e-6, 1e-12)}
    yield from _each("pressure tolerance", tolerances, (LAGRANGIAN,))


def _sizes() -> Iterator[Row]:
    yield from _each("liquid particles", {"none": {}}, (DRY,))
    many = {
        "solids": None,
        "pipe": {"length": 160 * BORE},
        "fidelity": {"particle_spacing": BORE / 20},
        "output": {"liquid_stride": None},
    }
    yield from _each("liquid particles", {"1e6": many}, COMPUTED, steps=2)
