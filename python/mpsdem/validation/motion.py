"""A pipe that moves: solids in a shaken liquid, and moving walls beside the frame of the pipe."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np

from mpsdem.validation.program import results_of
from mpsdem.validation.registry import Check, Source

STOKES = Source(
    cite="Stokes drag",
    reference="(1 + c) dv/dt = -k v - (1 - rho/rho_s) a, seen from the pipe; c = rho / (2 rho_s)",
)
FRAME = Source(cite="frame of the pipe", reference="this program's, the same case")
STRAIGHT = Source(cite="straight pipe", reference="this program's, at the same spacing")

_FREQUENCY, _AMPLITUDE = 100.0, 1e-6  # [Hz], [m]
_LIGHTNESS = 1 - 1000 / 2500  # [-]
_STOKES_RATE = 18 * 0.1 / (2500 * 1e-3**2)  # [1/s] 18 mu / (rho_s d2)

_SPHERE = """
end_time = 0.08
gravity = 0.0
[pipe]
radius = 0.01
length = 0.05
[liquid]
model = "profile"
density = 1000.0
kinematic_viscosity = 1e-4
bulk_velocity = 0.0
[solids]
diameter = 1e-3
density = 2500.0
youngs_modulus = 1e4
drag = "schiller_naumann"
arrangement = {{ kind = "list", positions = [[0.02, 0.0, 0.0]] }}
[motion]
vibration = {{ direction = "y", amplitude = 1e-6, frequency = 100.0 }}
[fidelity]
level = "quick"
added_mass = "{added_mass}"
[output]
every = 0.0005
figures = false
"""

_PIPE = """
end_time = {end_time}
[pipe]
radius = 0.1
length = {length}
[liquid]
model = "lagrangian"
density = 1000.0
kinematic_viscosity = 1e-6
bulk_velocity = 1.0
[motion]
walls = "{walls}"
vibration = {{ direction = "y", amplitude = {amplitude}, period = {period}, mode = {mode} }}
[fidelity]
level = "quick"
[output]
every = 0.02
figures = false
liquid_stride = 0
"""


def checks() -> Iterator[Check]:
    """All checks of this module."""
    for added_mass in ("off", "on"):
        carried = 0.5 * (1 - _LIGHTNESS) if added_mass == "on" else 0.0
        rate = 2 * math.pi * _FREQUENCY
        drive = _LIGHTNESS * _AMPLITUDE * rate**2
        exact = drive / complex(_STOKES_RATE, (1 + carried) * rate)
        sphere = Sphere(added_mass=added_mass)
        yield Check(
            id=f"motion/sphere/added-mass-{added_mass}/amplitude",
            claim="a lone sphere in a shaken liquid swings as far as linear theory has it",
            expected=abs(exact) * 1e6,
            measure=sphere.amplitude,
            relative=0.02,
            unit="um/s",
            source=STOKES,
        )
        yield Check(
            id=f"motion/sphere/added-mass-{added_mass}/phase",
            claim="it lags by as much as linear theory has it",
            expected=math.degrees(cmath.phase(exact)),
            measure=sphere.phase,
            absolute=1.0,
            unit="deg",
            source=STOKES,
        )
    strong = 20 / (2 * math.pi * 5) ** 2
    shaken = Pipe(walls="moving", amplitude=strong, period=0.2, mode=0, length=0.8, end_time=1.0)
    seen = Pipe(walls="fixed", amplitude=strong, period=0.2, mode=0, length=0.8, end_time=1.0)
    yield Check(
        id="motion/moving-walls/friction",
        claim="walls shaken at 20 m/s2 and 5 Hz leave the friction of a force in their frame",
        expected=1.0,
        measure=lambda: shaken.friction() / seen.friction(),
        relative=0.01,
        unit="frame",
        source=FRAME,
    )
    flexing = Pipe(walls="auto", amplitude=0.03, period=6.0, mode=2, length=2.0, end_time=3.0)
    straight = Pipe(walls="auto", amplitude=0.0, period=6.0, mode=2, length=2.0, end_time=3.0)
    yield Check(
        id="motion/flexing/friction",
        claim="a pipe that flexes slowly has the friction of the straight one",
        expected=1.0,
        measure=lambda: flexing.friction() / straight.friction(),
        relative=0.02,
        unit="straight",
        source=STRAIGHT,
        slow=True,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Sphere:
    """A sphere of 1 mm in a liquid at rest of a hundred times water's viscosity, shaken."""

    added_mass: str

    def amplitude(self) -> float:
        """Of the velocity seen from the pipe [um/s]."""
        return abs(_response(self.added_mass)) * 1e6

    def phase(self) -> float:
        """Of that velocity after the pipe's displacement [deg]."""
        return math.degrees(cmath.phase(_response(self.added_mass)))


@cache
def _response(added_mass: str) -> complex:
    with results_of(_SPHERE.format(added_mass=added_mass)) as results:
        late = results.time > 0.04
        angle = 2 * math.pi * _FREQUENCY * results.time[late]
        waves = np.column_stack([np.sin(angle), np.cos(angle)])
        in_phase, ahead = np.linalg.lstsq(waves, results.solids.velocity[late, 0, 1], rcond=None)[0]
    return complex(in_phase, ahead)


@dataclass(frozen=True, slots=True, kw_only=True)
class Pipe:
    """Clear particle liquid at a Reynolds number of 2e5, of which the second half counts."""

    walls: str
    amplitude: float
    period: float
    mode: int
    length: float
    end_time: float

    def friction(self) -> float:
        """Loss of pressure to the walls [Pa/m]."""
        return _friction(self)


@cache
def _friction(pipe: Pipe) -> float:
    values = {name: getattr(pipe, name) for name in Pipe.__slots__}
    with results_of(_PIPE.format(**values)) as results:
        later = results.time > pipe.end_time / 2
        return float(results.diagnostics["pressure_gradient_friction"][later].mean())
