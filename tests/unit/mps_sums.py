"""Every sum of the particle method, written once more over all pairs."""

from dataclasses import dataclass

import numpy as np
from mps_scenes import BACKGROUND, GHOST, LIQUID, WALL


@dataclass(frozen=True)
class AllPairs:
    apart: np.ndarray  # (n, n, 3) x_j - x_i
    weight: np.ndarray  # (n, n)
    factor: np.ndarray  # (n, n) weight over square distance
    number_density: float
    lambda_: float


def kernel(r, effective_radius):
    return np.where(
        r < effective_radius, effective_radius / (0.85 * r + 0.15 * effective_radius) - 1, 0
    )


def all_pairs(s):
    reach = s.reach * s.spacing
    apart = s.position[None, :] - s.position[:, None]
    apart[..., 0] -= s.period * np.round(apart[..., 0] / s.period)
    r = np.linalg.norm(apart, axis=2)
    np.fill_diagonal(r, np.inf)
    weight = kernel(r, reach)
    axis = np.arange(-4, 5) * s.spacing
    lattice = np.linalg.norm(np.stack(np.meshgrid(axis, axis, axis)), axis=0).ravel()
    lattice = lattice[lattice > 0]
    n0 = kernel(lattice, reach).sum()
    return AllPairs(
        apart=apart,
        weight=weight,
        factor=weight / r**2,
        number_density=n0,
        lambda_=(kernel(lattice, reach) * lattice**2).sum() / n0,
    )


def by_number_density(_, a):
    return a.weight.sum(axis=1)


def by_sum_gradient(s, a):
    both = s.pressure[None, :] + s.pressure[:, None]
    return 3 / a.number_density * np.einsum("ij,ijk->ik", a.factor * both, a.apart)


def by_difference_gradient(s, a):
    difference = s.pressure[None, :] - s.pressure[:, None]
    return 3 / a.number_density * np.einsum("ij,ijk->ik", a.factor * difference, a.apart)


def weighted_fit(columns, weight, right):
    root = np.sqrt(weight)[:, None]
    return np.linalg.lstsq(root * columns, root * right, rcond=None)[0]


def by_corrected_gradient(s, a):
    rows = range(len(s.position))
    return np.stack(
        [
            weighted_fit(a.apart[i], a.factor[i], (s.pressure - s.pressure[i])[:, None])[:, 0]
            for i in rows
        ]
    )


def outward(s):
    """Unit vectors from the axis, and the distance from the wall, in a pipe of radius 0.1."""
    r = np.hypot(s.position[:, 1], s.position[:, 2])
    return s.position * [0, 1, 1] / r[:, None], 0.1 - r


def by_background_gradient(s, a):
    normal = -outward(s)[0]
    along = np.einsum("ijk,ik->ij", a.apart, normal)[..., None] * normal[:, None]
    liquid = s.kind == LIQUID
    alike = (liquid[None, :] == liquid[:, None])[..., None]
    push = np.where(alike, a.apart, along)
    return by_difference_gradient(s, a) + 6 * BACKGROUND / a.number_density * np.einsum(
        "ij,ijk->ik", a.factor, push
    )


def by_conserving_gradient(s, a):
    normal = -outward(s)[0]
    liquid = s.kind == LIQUID
    mixed = liquid[None, :] != liquid[:, None]
    sums = s.pressure[None, :] + s.pressure[:, None]
    differences = s.pressure[None, :] - s.pressure[:, None]
    along_normal = np.einsum("ijk,ik->ij", a.apart, normal)[..., None] * normal[:, None]
    whole = (sums + 2 * BACKGROUND)[..., None]
    beside_wall = whole * along_normal + differences[..., None] * (a.apart - along_normal)
    pairs = np.where(mixed[..., None], beside_wall, whole * a.apart)
    return 3 / a.number_density * np.einsum("ij,ijk->ik", a.factor, pairs)


def by_divergence(s, a):
    du = s.velocity[None, :] - s.velocity[:, None]
    return 3 / a.number_density * np.einsum("ij,ijk,ijk->i", a.factor, du, a.apart)


def by_slip_divergence(s, a):
    normal, distance = outward(s)
    total = np.zeros(len(s.position))
    for i, j in zip(*np.nonzero(a.weight), strict=True):
        du = s.velocity[j] - s.velocity[i]
        liquid = s.kind[[i, j]] == LIQUID
        if not liquid.any():
            continue
        if not liquid.all():
            inner, outer = (i, j) if liquid[0] else (j, i)
            times = 1 - distance[outer] / max(distance[inner], 0.3 * s.spacing)
            du = min(times, 3) * (du @ normal[inner]) * normal[inner]
        total[i] += a.factor[i, j] * (du @ a.apart[i, j])
    return 3 / a.number_density * total


def by_corrected_divergence(s, a):
    """As the trace of the gradient fitted to the neighbors, those of the wall mirrored."""
    distance = outward(s)[1]
    result = np.zeros(len(s.position))
    for i in np.flatnonzero(s.kind == LIQUID):
        du = s.velocity - s.velocity[i]
        times = 1 - distance / max(distance[i], 0.3 * s.spacing)
        du[s.kind != LIQUID] *= np.minimum(times, 3)[s.kind != LIQUID, None]
        result[i] = np.trace(weighted_fit(a.apart[i], a.factor[i], du))
    return result


def by_laplacian(s, a):
    du = s.velocity[None, :] - s.velocity[:, None]
    return 6 / (a.number_density * a.lambda_) * np.einsum("ij,ijk->ik", a.weight, du)


def by_least_squares_laplacian(s, a):
    outwards, distance = outward(s)
    to_wall = np.where(s.kind == WALL, distance, 0)[:, None] * outwards
    result = np.zeros_like(s.velocity)
    for i in np.flatnonzero(s.kind == LIQUID):
        near = (a.weight[i] > 0) & (s.kind != GHOST)
        q = (a.apart[i] + to_wall)[near] / s.spacing
        x, y, z = q.T
        columns = np.column_stack([q, x**2, y**2, z**2, x * y, x * z, y * z])
        weight = (1 - np.linalg.norm(q, axis=1) / s.reach) ** 2
        fit = weighted_fit(columns, weight, (s.velocity - s.velocity[i])[near])
        result[i] = 2 * fit[3:6].sum(axis=0) / s.spacing**2
    return result


def among_liquid(s, values):
    liquid = s.kind == LIQUID
    return values * liquid[None, :] * liquid[:, None]


def by_viscous_acceleration(s, a):
    nu = (s.viscosity[None, :] + s.viscosity[:, None]) / 2
    du = s.velocity[None, :] - s.velocity[:, None]
    weight = among_liquid(s, a.weight * nu)
    return 6 / (a.number_density * a.lambda_) * np.einsum("ij,ijk->ik", weight, du)


def by_relative_convection(s, a):
    q = s.viscosity[:, None] * s.velocity
    inflow = -np.einsum("ijk,ijk->ij", (q[None, :] + q[:, None]) / 2, a.apart)
    weight = among_liquid(s, a.factor * np.maximum(inflow, 0))
    du = s.velocity[None, :] - s.velocity[:, None]
    return 6 / a.number_density * np.einsum("ij,ijk->ik", weight, du) / s.viscosity[:, None]


def by_shear_rate(s, a):
    factor = among_liquid(s, a.factor)
    result = np.zeros(len(s.position))
    for i in np.flatnonzero(s.kind == LIQUID):
        gradient = weighted_fit(a.apart[i], factor[i], s.velocity - s.velocity[i])
        strain = (gradient + gradient.T) / 2
        result[i] = np.sqrt(2 * np.sum(strain**2))
    return result


def by_shifting(s, a):
    return -3 * 0.1 * s.spacing**2 / a.number_density * np.einsum("ij,ijk->ik", a.factor, a.apart)


SUMS = {
    name.removeprefix("by_"): function
    for name, function in list(globals().items())
    if name.startswith("by_")
}
