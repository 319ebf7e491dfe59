"""The scenes of the table: small, and of each kind that the program is used for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from mpsdem.case import Case
from mpsdem.plan import terminal_velocity
from mpsdem.validation.two_way import UPRIGHT, ergun_loss, packed_bed

_WATER = {"density": 1000.0, "kinematic_viscosity": 1e-6}


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """What a part of the table is measured on.

    Parameters
    ----------
    case : Case
    quantities : tuple of str
        That errors are of.
    exact : mapping of str to float
        Those of them that are known otherwise than by the program.
    """

    case: Case
    quantities: tuple[str, ...]
    exact: Mapping[str, float] = field(default_factory=dict)


def poiseuille() -> Scene:
    """Laminar flow at a Reynolds number of 50, by particles: on nodes it is exact."""
    case = _case(
        "Poiseuille flow, particles",
        end_time=0.3,
        pipe={"radius": 0.01, "length": 0.02},
        liquid={
            "model": "lagrangian",
            "density": 1000.0,
            "kinematic_viscosity": 1e-4,
            "bulk_velocity": 0.25,
        },
    )
    return Scene(case=case, quantities=("pressure_gradient",))


def friction() -> Scene:
    """Turbulent water at a Reynolds number of 2e5 in a smooth pipe; Colebrook's loss is known."""
    case = _case(
        "Turbulent friction, nodes",
        end_time=4.0,
        pipe={"radius": 0.1, "length": 0.4},
        liquid=_WATER | {"model": "eulerian", "bulk_velocity": 1.0},
    )
    return Scene(case=case, quantities=("pressure_gradient",))


def settling() -> Scene:
    """A bead of 5 mm that sinks in water at rest, as fast as its drag law says."""
    diameter, length = 5e-3, 0.3
    parts: dict[str, Any] = {
        "end_time": 0.4,
        "pipe": {"radius": 6 * diameter, "length": length, "inclination": UPRIGHT},
        "liquid": _WATER | {"model": "eulerian", "bulk_velocity": 0.0},
        "solids": {
            "diameter": diameter,
            "density": 2500.0,
            "youngs_modulus": 1e6,
            "drag": "schiller_naumann",
            "arrangement": {"kind": "list", "positions": [[0.99 * length, 0.0, 0.0]]},
        },
        "fidelity": {"coupling": "two-way"},
    }
    speed = terminal_velocity(_case("", **parts))
    parts["solids"]["arrangement"]["velocities"] = [[-speed, 0.0, 0.0]]
    return Scene(
        case=_case("Settling of a bead", **parts),
        quantities=("solids_mean_velocity",),
        exact={"solids_mean_velocity": -speed},
    )


def bed() -> Scene:
    """Held beads of 2 mm at a void fraction of 0.5, through which water rises; Ergun's loss."""
    velocity = 0.02
    case, void_fraction = packed_bed("eulerian", velocity, held=True, end_time=1.0, planes=13)
    case = case.with_(
        title="Packed bed", fidelity={"particle_spacing": None}, output={"every": 0.05}
    )  # fmt: skip
    exact = {"pressure_gradient": ergun_loss(velocity, void_fraction, 2e-3)}
    return Scene(case=case, quantities=("pressure_gradient",), exact=exact)


def case_a() -> Scene:
    """The nodules of ``cases/horizontal_pipe.toml``, in a metre of its pipe, spread out."""
    case = _case(
        "Case A, a metre of it",
        end_time=8.0,
        pipe={"radius": 0.1, "length": 1.0},
        liquid=_WATER | {"bulk_velocity": 1.0},
        solids=_nodules(diameter=0.02, density=2700.0, volume_fraction=0.017),
    )
    quantities = (
        "pressure_gradient", "solids_mean_velocity", "bed_height", "delivered_concentration",
    )  # fmt: skip
    return Scene(case=case, quantities=quantities)


def case_b() -> Scene:
    """Half a metre of ``cases/paper001_case2.toml``: the inclined pipe that is shaken sideways."""
    case = _case(
        "Case B2, half a metre of it",
        end_time=12.0,
        pipe={"radius": 0.1, "length": 0.5, "inclination": "50 deg"},
        liquid=_WATER | {"density": 1025.0, "bulk_velocity": 1.0},
        solids=_nodules(diameter=0.015, density=2500.0, volume_fraction=0.02),
        motion={"vibration": {"direction": "y", "amplitude": 0.08, "period": 1.0}},
        fidelity={"level": "quick"},
        output={"every": 0.05},
    )
    return Scene(case=case, quantities=("pressure_gradient", "solids_mean_velocity", "bed_height"))


#: By the names in the table.
SCENES: Mapping[str, Callable[[], Scene]] = {
    "poiseuille": poiseuille,
    "friction": friction,
    "settling": settling,
    "packed bed": bed,
    "case A": case_a,
    "case B": case_b,
}


def _nodules(*, diameter: float, density: float, volume_fraction: float) -> dict[str, Any]:
    return {
        "diameter": diameter,
        "density": density,
        "youngs_modulus": 1e8,
        "poisson_ratio": 0.2,
        "friction": 0.2,
        "restitution": 0.9,
        "volume_fraction": volume_fraction,
    }


def _case(title: str, **parts: Any) -> Case:
    return Case(title=title, **parts)
