"""What a run kept and lost, added up from its diagnostics."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from synthetic_results import CASE, CLEAR, TIMES, write_run

from mpsdem import plot
from mpsdem.analysis import ledgers
from mpsdem.results import Results, ResultsError

TIME = np.array([0.0, 1.0, 1.5, 3.0, 4.0])  # [s] intervals differ


def recorded(**numbers):
    values = {"pressure_gradient_friction": 40.0, "power_input": 2.0, "dissipation": 2.0} | numbers
    diagnostics = {
        name: np.broadcast_to(value, TIME.shape) if np.ndim(value) < 2 else value
        for name, value in values.items()
    }
    return SimpleNamespace(time=TIME, diagnostics=diagnostics, case=CASE, directory=Path("run"))


def test_impulse_and_energy_are_the_integrals_from_the_second_frame_on():
    kept = ledgers(recorded(liquid_unexplained=[9.0, 9.0, 1.0, 2.0, -4.0], dissipation=1.5))
    assert kept.time.tolist() == [1.0, 1.5, 3.0, 4.0]
    assert kept.friction.tolist() == [0.0, 20.0, 80.0, 120.0]
    assert kept.unexplained.tolist() == [0.0, 0.5, 3.5, -0.5]
    assert kept.put_in.tolist() == [0.0, 1.0, 4.0, 6.0]
    assert kept.stored.tolist() == pytest.approx([0.0, 0.25, 1.0, 1.5])


def test_errors_are_the_largest_so_far():
    kept = ledgers(
        recorded(
            liquid_unexplained=0.0,
            liquid_volume_error=[0.0, 1e-15, -3e-15, 1e-16, 2e-15],
            exchange_error=[0.0, 2e-15, 0.0, 5e-15, 0.0],
            drag_force=np.zeros((5, 3)),
        )
    )
    assert kept.volume_error.tolist() == [1e-15, 3e-15, 3e-15, 3e-15]
    assert kept.exchange_error.tolist() == [2e-15, 2e-15, 5e-15, 5e-15]


def test_a_liquid_of_particles_is_held_to_its_flow_rate():
    """It gains what gradient less solids less friction give: here 10 Pa/m of 1000 kg/m3."""
    flux = 1.0 + 0.01 * TIME
    kept = ledgers(
        recorded(
            pressure_iterations=12.0,
            pressure_gradient=80.0,
            pressure_gradient_solids=30.0,
            liquid_flux=flux,
        )
    )
    assert kept.unexplained == pytest.approx(0.0, abs=1e-10)


def test_a_liquid_that_is_not_computed_has_no_ledger(tmp_path):
    with pytest.raises(ResultsError, match="no liquid that is computed"):
        ledgers(Results(write_run(tmp_path, CLEAR, TIMES)))


def test_a_run_without_the_frame_has_no_ledger():
    short = recorded(liquid_unexplained=0.0)
    short.time = TIME[:1]
    with pytest.raises(ResultsError, match="has no frame 1"):
        ledgers(short)


def test_what_solids_give_counts_whatever_its_direction():
    force = np.outer([9.0, 9.0, 2.0, -2.0, 2.0], [0.6, 0.0, 0.8])
    kept = ledgers(recorded(liquid_unexplained=0.0, exchange_error=0.0, drag_force=force))
    volume = CASE.pipe.bore_volume
    assert kept.exchanged * volume == pytest.approx([0.0, 1.0, 4.0, 6.0])


def test_the_figure_shows_what_was_given_back_only_where_something_was():
    axes = plot.ledger_history(recorded(liquid_unexplained=0.4)).axes
    (line,) = axes[1].lines
    assert line.get_ydata() == pytest.approx(1.0)  # percent of 40 Pa/m
    axes = plot.ledger_history(recorded(liquid_unexplained=0.4, convection_error=-0.8)).axes
    assert axes[1].lines[1].get_ydata() == pytest.approx(-2.0)
