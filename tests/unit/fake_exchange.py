"""A plain exchange, solids and nodes that know of it: the time loop, alone with its bookkeeping.

The liquid gets back what the solids got as a uniform force; what it is around a solid is a mean
over the smoothing radius.
"""

import numpy as np

from mpsdem._core import coupling, dem, mps


class Exchange:
    def __init__(self, *, smoothing_radius, pipe_radius, threads=1):
        self.smoothing_radius, self.pipe_radius, self.threads = (
            smoothing_radius,
            pipe_radius,
            threads,
        )
        self.begun = 0
        self.given = None
        self.clipped, self.mismatch, self.liquid_volume_error = 0, 0.0, 0.0

    def begin(self, liquid, *, position, radius):
        self.begun += 1
        self.given = None
        self.position, self.radius = np.array(position), np.array(radius)
        self.liquid_velocity = liquid.velocity_at(points=position, radius=self.smoothing_radius)
        self.liquid_acceleration = np.zeros_like(self.liquid_velocity)
        self.clipped = 3

    def relaxation(self, *, drag_rate, mass):
        assert len(drag_rate) == len(mass) == len(self.position)
        return np.zeros_like(drag_rate)

    def give(self, *, position, mean_velocity, drag, impulse, held=False):
        assert self.given is None, "given twice in one step"
        np.testing.assert_array_equal(position, self.position)
        self.given = mean_velocity, drag, impulse, held

    def act(self, liquid, dt):
        """Force on the liquid over its mass, (n, stations, 3) [m/s2]."""
        _, drag, impulse, held = self.given
        self.impulse = drag[:, None] * self.liquid_velocity * dt if held else impulse
        self.mismatch = 1e-15
        self.liquid_volume_error = -1e-4
        mass = 1000.0 * np.pi * self.pipe_radius**2 * 0.4
        return np.broadcast_to(-self.impulse.sum(axis=0) / mass / dt, liquid.velocity.shape).copy()


class Nodes(mps.EulerianLiquid):
    def advance(self, dt, *, exchange=None):
        if exchange is not None:
            self.momentum_source(exchange.act(self, dt))
        report = super().advance(dt)
        self.momentum_source(None)
        return report


class Solids(dem.Solids):
    def set_forcing(self, *, acceleration, liquid_velocity, drag_rate, **_more):
        self.liquid_velocity = liquid_velocity
        super().set_forcing(
            acceleration=acceleration, liquid_velocity=liquid_velocity, drag_rate=drag_rate
        )

    def advance(self, dt, steps):
        before = self.velocity
        report = super().advance(dt, steps)
        self.mean_velocity = (before + self.velocity) / 2
        return report


def install(patch):
    """Put the fakes in the place of what they stand for."""
    patch.setattr(coupling, "Exchange", Exchange, raising=False)
    patch.setattr(mps, "EulerianLiquid", Nodes)
    patch.setattr(dem, "Solids", Solids)
