"""The budgets of the dry kernels beside LAMMPS; `lmp` must be on the path."""

import pytest
from compare_with_lammps import compare

pytestmark = pytest.mark.benchmark_peer


@pytest.mark.parametrize(("workload", "budget"), [("D1", 4.0), ("D2", 3.0)])
def test_every_stage_is_as_many_times_faster_as_promised_with_the_same_energy(workload, budget):
    for row in compare(workload):
        assert row.energy_difference < 0.01, row
        assert row.ratio >= budget, row
