"""The page on a long run."""

from types import SimpleNamespace

import numpy as np

from mpsdem.validation.long_run import page

TIME = np.arange(0.0, 80.25, 0.5)  # [s]


def test_each_window_has_its_means_and_its_own_share_of_the_ledger():
    """Of 40 Pa/m of friction 0.4 go unexplained, and from 40 s on 0.8."""
    late = TIME > 40
    diagnostics = {
        "pressure_gradient_friction": np.full_like(TIME, 40.0),
        "liquid_unexplained": np.where(late, 0.8, 0.4),
        "convection_error": np.full_like(TIME, -0.2),
        "power_input": np.full_like(TIME, 2.0),
        "dissipation": np.full_like(TIME, 1.5),
        "liquid_volume_error": np.where(late, 1e-3, 0.0),
        "solids_mean_velocity": np.where(late, 0.6, 0.5),
    }
    run = SimpleNamespace(
        time=TIME,
        diagnostics=diagnostics,
        pressure_gradient=np.where(late, 70.0, 90.0),
        summary={"steps": 10, "solid_steps": 1000, "cpu_seconds": 3.0},
    )
    first, second = [line for line in page(run).splitlines() if line.startswith(("| 0", "| 40"))]
    assert first.startswith("| 0 to 40 | 90.0 ± 0.0 | 0.500 ± 0.000 | +1.000 | -0.500 | 0.0e+00 |")
    assert second.startswith("| 40 to 80 | 70.")
    assert "| +2.0" in second
    assert second.endswith("| 1.0e-03 | 0.0e+00 | +25.00 |")
