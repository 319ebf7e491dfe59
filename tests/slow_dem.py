"""Solids the slow way, and scenes to compare: the oracle of `mpsdem._core.dem.Solids`.

Every image of every pair is looked at in every step, one contact at a time, in the caller's
order: there is no list, no sorting, no lane, no block. Only the force of a single contact is the
law's own; what laws must obey is tested elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import product
from typing import Any

import numpy as np

from mpsdem._core import dem, geometry

HERTZ = dem.HertzMindlin(youngs_modulus=1e6, poisson_ratio=0.2, restitution=0.7, friction=0.4)
LINEAR = dem.LinearSpring(
    normal_stiffness=1e3,
    tangential_stiffness=7e2,
    normal_damping=0.3,
    tangential_damping=0.2,
    friction=0.3,
)
LINEAR_RESTITUTION = dem.LinearSpring.with_restitution(
    normal_stiffness=1e3, tangential_stiffness=8e2, restitution=0.8, friction=0.5
)
VISCOELASTIC = dem.HertzViscoelastic(
    normal_stiffness=7e5,
    tangential_stiffness=6e5,
    normal_damping=1e4,
    tangential_damping=5e3,
    friction=0.4,
)
LAWS = {
    "hertz": HERTZ,
    "linear": LINEAR,
    "linear_restitution": LINEAR_RESTITUTION,
    "viscoelastic": VISCOELASTIC,
}
STEP = 1e-4  # [s] about a fiftieth of an impact of the solids below under any of these laws


@dataclass(frozen=True, kw_only=True)
class Bore:
    """Pipe along x, seen from inside."""

    radius: float
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def curvature(self):
        return -0.5 / self.radius

    def at(self, point):
        distance = np.hypot(point[1], point[2])
        inward = np.array([0.0, -point[1], -point[2]])
        return self.radius - distance, inward / distance if distance > 0 else 0 * inward

    def core(self):
        return geometry.Cylinder(radius=self.radius, velocity=np.array(self.velocity))


@dataclass(frozen=True, kw_only=True)
class Flat:
    """Plane through a point, seen from the side of its normal."""

    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    normal: tuple[float, float, float] = (0.0, 0.0, 1.0)
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    curvature = 0.0

    def at(self, point):
        normal = np.array(self.normal) / np.linalg.norm(self.normal)
        return normal @ (point - self.point), normal

    def core(self):
        return geometry.Plane(
            point=np.array(self.point),
            normal=np.array(self.normal),
            velocity=np.array(self.velocity),
        )


@dataclass(frozen=True, kw_only=True)
class Scene:
    """All that the motion of some solids depends on; rows are solids."""

    position: np.ndarray  # (n, 3) [m]
    velocity: np.ndarray  # (n, 3) [m/s]
    spin: np.ndarray  # (n, 3) [rad/s]
    radius: np.ndarray  # (n,) [m]
    density: np.ndarray  # (n,) [kg/m3]
    pair_law: Any = HERTZ
    wall_law: Any = HERTZ
    pair_rolling_friction: float = 0.0
    wall_rolling_friction: float = 0.0
    walls: list = field(default_factory=list)
    period: float = 0.0
    acceleration: np.ndarray | None = None  # (n, 3) [m/s2]
    liquid_velocity: np.ndarray | None = None  # (n, 3) [m/s]
    drag_rate: np.ndarray | None = None  # (n,) [1/s]

    def with_(self, **changes):
        return replace(self, **changes)

    def solids(self, threads=1):
        """The engine's solids, forcing set."""
        parts = {name: getattr(self, name) for name in Scene.__dataclass_fields__}
        forcing = {n: parts.pop(n) for n in ("acceleration", "liquid_velocity", "drag_rate")}
        parts["walls"] = [wall.core() for wall in self.walls]
        solids = dem.Solids(**parts, threads=threads)
        if any(value is not None for value in forcing.values()):
            if forcing["acceleration"] is None:
                forcing["acceleration"] = np.zeros_like(self.position)
            solids.set_forcing(**forcing)
        return solids

    @property
    def mass(self):
        return self.density * 4 / 3 * np.pi * self.radius**3


def scene(position, velocity=0.0, spin=0.0, radius=0.01, density=2500.0, **parts):
    """Scene from whatever broadcasts to rows of solids."""
    position = np.array(position, dtype=float).reshape(-1, 3)
    n = len(position)

    def rows(values, *shape):
        return np.broadcast_to(np.asarray(values, dtype=float), (n, *shape)).copy()

    for name in ("acceleration", "liquid_velocity"):
        if name in parts:
            parts[name] = rows(parts[name], 3)
    if "drag_rate" in parts:
        parts["drag_rate"] = rows(parts["drag_rate"])
    return Scene(
        position=position,
        velocity=rows(velocity, 3),
        spin=rows(spin, 3),
        radius=rows(radius),
        density=rows(density),
        **parts,
    )


def block(counts, pitch, rng, jitter=0.0):
    """Cubic lattice that starts at the origin, each point moved by up to `jitter` [m]."""
    points = np.array(list(product(*map(range, counts))), dtype=float) * pitch
    return points + rng.uniform(-jitter, jitter, points.shape)


def sheared_packing(rng, counts=(4, 3, 3), radius=0.01, overlap=0.02, speed=0.2, **parts):
    """Touching solids in a lattice, the upper ones pushed along x over the lower ones."""
    position = block(counts, 2 * radius * (1 - overlap), rng, jitter=radius * overlap / 2)
    height = position[:, 2] - position[:, 2].mean()
    velocity = rng.uniform(-speed / 10, speed / 10, position.shape)
    velocity[:, 0] += speed * height / abs(height).max()
    spin = rng.uniform(-5, 5, position.shape)
    return scene(position, velocity, spin, radius, **parts)


class SlowSolids:
    """Velocity Verlet over every pair, image and wall; positions never wrap."""

    def __init__(self, scene):
        self.scene = scene
        self.x, self.v, self.w = scene.position.copy(), scene.velocity.copy(), scene.spin.copy()
        self.history = {}  # (i, j, periods between them) or (i, -1 - wall): spring [m], roll [rad]
        self.wall_impulse = np.zeros(3)
        self.find_forces(0.0)

    def advance(self, dt, steps):
        for k in range(steps):
            self.kick(dt / 2 if k == 0 else dt)
            self.x += dt * self.v
            self.find_forces(dt)
        self.kick(dt / 2)

    def kick(self, dt):
        s = self.scene
        self.v += dt * self.force / s.mass[:, None]
        if s.acceleration is not None:
            self.v += dt * s.acceleration
        if s.drag_rate is not None:  # implicit: v_new = v + dt rate (liquid - v_new)
            k = dt * s.drag_rate[:, None]
            self.v = (self.v + k * s.liquid_velocity) / (1 + k)
        self.w += dt * self.torque / (0.4 * s.mass * s.radius**2)[:, None]
        self.wall_impulse += dt * self.wall_force

    def find_forces(self, dt):
        s = self.scene
        self.force, self.torque = np.zeros_like(self.x), np.zeros_like(self.x)
        self.wall_force = np.zeros(3)
        old, self.history = self.history, {}

        i, j = np.triu_indices(len(self.x), 1)
        apart = self.x[i] - self.x[j]
        nearest = np.round(apart[:, 0] / s.period) if s.period else np.zeros(len(i))
        for image in (-1, 0, 1) if s.period else (0,):
            d = apart.copy()
            d[:, 0] -= (nearest + image) * s.period
            distance = np.linalg.norm(d, axis=1)
            for k in np.flatnonzero(distance < s.radius[i] + s.radius[j]):
                a, b = i[k], j[k]
                r_a, r_b, m_a, m_b = s.radius[a], s.radius[b], s.mass[a], s.mass[b]
                n = d[k] / distance[k]
                force, torque = self.contact(
                    s.pair_law,
                    s.pair_rolling_friction,
                    old.get(key := (a, b, nearest[k] + image)),
                    key,
                    dt,
                    normal=n,
                    overlap=r_a + r_b - distance[k],
                    relative_velocity=self.v[a]
                    - self.v[b]
                    - cross(r_a * self.w[a] + r_b * self.w[b], n),
                    reduced_radius=r_a * r_b / (r_a + r_b),
                    reduced_mass=m_a * m_b / (m_a + m_b),
                    relative_spin=self.w[a] - self.w[b],
                )
                self.force[a] += force
                self.force[b] -= force
                self.torque[a] += torque - r_a * cross(n, force)
                self.torque[b] -= torque + r_b * cross(n, force)

        for w, wall in enumerate(s.walls):
            for a, r in enumerate(s.radius):
                distance, n = wall.at(self.x[a])
                if distance >= r:
                    continue
                force, torque = self.contact(
                    s.wall_law,
                    s.wall_rolling_friction,
                    old.get(key := (a, -1 - w)),
                    key,
                    dt,
                    normal=n,
                    overlap=r - distance,
                    relative_velocity=self.v[a] - wall.velocity - cross(r * self.w[a], n),
                    reduced_radius=1 / (1 / r + wall.curvature),
                    reduced_mass=s.mass[a],
                    relative_spin=self.w[a],
                )
                self.force[a] += force
                self.torque[a] += torque - r * cross(n, force)
                self.wall_force += force

    def contact(self, law, rolling_friction, history, key, dt, *, relative_spin, **contact):
        """Force and rolling torque on the first body."""
        spring, roll = history or (np.zeros(3), np.zeros(3))
        f_n, f_t, spring = law.contact_force(**contact, spring=spring, dt=dt)
        torque = np.zeros(3)
        if rolling_friction > 0:
            torque, roll = rolling_torque(
                law, rolling_friction, np.linalg.norm(f_n), relative_spin, roll, dt, contact
            )
        self.history[key] = (spring, roll)
        return f_n + f_t, torque


def rolling_torque(law, rolling_friction, normal_force, relative_spin, roll, dt, contact):
    """Elastic-plastic spring-dashpot, model C of Ai et al. (2011) doi:10.1016/j.powtec.2010.09.030.

    Returns torque on the first body [N m] and roll [rad].
    """
    n, radius = contact["normal"], contact["reduced_radius"]
    # the law's tangential stiffness, read off a displacement so small that it surely sticks
    probe = cross(n, np.array([n[1] + 0.3, n[2] - 0.5, n[0] + 0.7])) * 1e-6 * contact["overlap"]
    at_rest = contact | {"relative_velocity": np.zeros(3)}
    held = law.contact_force(**at_rest, spring=probe, dt=0.0)[1]
    stiffness = np.linalg.norm(held) / np.linalg.norm(probe) * radius**2
    inertia = 7 / 5 * contact["reduced_mass"] * radius**2
    limit = rolling_friction * radius * normal_force

    rate = relative_spin - (relative_spin @ n) * n
    roll = roll - (roll @ n) * n + dt * rate
    if stiffness * np.linalg.norm(roll) > limit:
        roll = roll * limit / (stiffness * np.linalg.norm(roll))
        torque = -stiffness * roll
    else:
        torque = -stiffness * roll - 2 * 0.3 * np.sqrt(stiffness * inertia) * rate
    size = np.linalg.norm(torque)
    return (torque * limit / size if size > limit else torque), roll


def cross(a, b):
    """Vector product; NumPy's takes ten times as long for one pair."""
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def unwrapped(solids, period):
    """Positions that do not jump where x starts anew [m]."""
    position = solids.position
    position[:, 0] += solids.laps * period
    return position


def rotation(rng, axis=None):
    """Random proper rotation, about an axis if one is given."""
    if axis is None:
        q, r = np.linalg.qr(rng.normal(size=(3, 3)))
        q = q * np.sign(np.diag(r))
        return q if np.linalg.det(q) > 0 else -q
    angle = rng.uniform(0, 2 * np.pi)
    k = np.cross(np.eye(3), np.asarray(axis, dtype=float) / np.linalg.norm(axis))
    return np.eye(3) - np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
