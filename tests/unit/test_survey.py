"""The report of a run says what its made-up fields say, and lacks only what the run lacks."""

import json

import h5py
import numpy as np
import pytest
from matplotlib.figure import Figure
from synthetic_results import CASE, CLEAR, TIMES, blank, cluster, frame, open_writer, write_run

from mpsdem.analysis import period_of_motion, report, slab_area, survey
from mpsdem.case import Case, Motion
from mpsdem.plot import save_report
from mpsdem.results import Results, ResultsError

IN_SITU = 64 * 4 / 3 * 0.01**3 / (0.1**2 * 4.0)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    directory = tmp_path_factory.mktemp("run")
    with open_writer(directory, liquid="particles") as writer:
        for time in TIMES:
            fields = frame(time, liquid="particles")
            fields["solids"]["liquid_velocity"] = fields["solids"]["velocity"] + [0.2, 0.0, 0.0]
            fields["diagnostics"]["liquid_flux"] = 1.0 - IN_SITU * 0.58
            writer.append(time, **fields)
    return Results(directory)


@pytest.fixture(scope="module")
def found(results):
    return survey(results)


def mean_speed():
    return cluster(0.0)[1][:, 0].mean()


def test_concentration_velocity_and_slip_are_those_of_the_fields(found):
    means = {name: average.mean for name, average in found.averages.items()}
    assert means["insitu_concentration"] == pytest.approx(IN_SITU)
    assert means["solids_mean_velocity"] == pytest.approx(mean_speed())
    assert means["delivered_concentration"] == pytest.approx(IN_SITU * mean_speed())
    assert means["delivered_over_insitu"] == pytest.approx(mean_speed())
    assert means["local_slip"] == pytest.approx(0.2)
    liquid = (1 - IN_SITU * 0.58) / (1 - IN_SITU)
    assert means["liquid_mean_velocity"] == pytest.approx(liquid)
    assert means["slip_velocity"] == pytest.approx(liquid - mean_speed())


def test_profiles_and_stations_hold_all_solids(found):
    solids, edges = found.solids, np.linspace(-0.1, 0.1, 41)
    area = slab_area(0.1, edges)
    over_height = solids.fraction_over_height.mean @ area / area.sum()
    assert over_height == pytest.approx(IN_SITU, rel=1e-9)
    np.testing.assert_allclose(solids.fraction.mean(axis=1), IN_SITU, rtol=1e-9)
    np.testing.assert_allclose(solids.flux.mean(axis=1), IN_SITU * mean_speed(), rtol=1e-9)


def test_a_cluster_that_floats_in_the_middle_is_no_bed(found):
    assert found.averages["bed_share"].mean == 0
    assert found.regime.regime == "heterogeneous"
    assert "bed_velocity" not in found.averages
    assert found.blockage.state == "free"


def fallen(tmp_path, case=CASE, sign=-1.0):
    """A run whose cluster slides on one side of the wall, two layers deep."""
    with open_writer(tmp_path, case) as writer:
        for time in TIMES:
            fields = frame(time, case)
            row, layer = np.divmod(np.arange(64), 2)
            position = fields["solids"]["position"]
            position[:, 0] = (0.0205 * row + 0.3 * time) % 4.0
            position[:, 1], position[:, 2] = 0.0, sign * (0.09 - 0.02 * layer)
            fields["solids"]["velocity"][:, 0] = 0.3
            fields["diagnostics"]["bulk_velocity"] = 1.0
            writer.append(time, **fields)
    return survey(Results(tmp_path))


def test_a_cluster_on_the_floor_is_a_sliding_bed_of_its_height_and_speed(tmp_path):
    found = fallen(tmp_path)
    assert found.regime.regime == "sliding bed"
    assert found.averages["bed_velocity"].mean == pytest.approx(0.3)
    assert found.averages["bed_height"].mean == pytest.approx(0.04)
    assert np.nanmax(found.solids.bed_surface) == pytest.approx(0.04, abs=1e-3)


def test_solids_that_float_make_their_bed_under_the_roof(tmp_path):
    light = Case(**CASE.model_dump() | {"solids": CASE.solids.model_dump() | {"density": 900.0}})
    assert fallen(tmp_path / "roof", light, sign=1.0).regime.regime == "sliding bed"
    assert fallen(tmp_path / "floor", light).regime.regime == "heterogeneous"


@pytest.mark.parametrize(
    ("gathering", "stands", "state"),
    [(0.0, False, "free"), (0.07, False, "filling"), (0.1, True, "plug")],
)
def test_solids_that_gather_fill_the_pipe_and_block_it_once_they_stand(
    tmp_path, gathering, stands, state
):
    narrow = Case(**CASE.model_dump() | {"pipe": CASE.pipe.model_dump() | {"radius": 0.03}})
    with open_writer(tmp_path, narrow) as writer:
        for time in TIMES:
            fields = frame(time, narrow)
            spread = np.linspace(-0.3, 0.3, 64) * (1 - gathering * time)
            fields["solids"]["position"][:] = np.outer(2.0 + spread, [1.0, 0.0, 0.0])
            fields["solids"]["velocity"][:, 0] = 0.0 if stands else 0.3
            fields["diagnostics"]["bulk_velocity"] = 1.0
            writer.append(time, **fields)
    blockage = survey(Results(tmp_path)).blockage
    assert blockage.state == state
    assert blockage.trends["fullest_fraction"].rises == (gathering > 0)
    assert (blockage.plug is not None) == stands
    if stands:
        assert blockage.plug.position == pytest.approx(2.0, abs=0.1)
        assert 6.0 < blockage.plug.time < 8.0


def test_a_vertical_pipe_has_no_bed(tmp_path):
    pipe = CASE.pipe.model_dump() | {"inclination": "90 deg"}
    found = fallen(tmp_path, Case(**CASE.model_dump() | {"pipe": pipe}))
    assert found.averages["bed_share"].mean == 0
    assert found.static_gradient == pytest.approx(1000.0 * 9.807)


def test_pressure_loss_has_mean_peak_and_trough_of_the_window(tmp_path):
    found = survey(Results(write_run(tmp_path, CLEAR)))
    loss = 80 + 5 * np.sin(TIMES[TIMES > 4.0])  # each a mean since the time before
    (peak,), (trough,) = found.pressure_periods.peak, found.pressure_periods.trough
    assert (peak, trough) == pytest.approx((loss.max(), loss.min()))
    average = found.averages["pressure_gradient"]
    assert average.window == (4.0, 8.0)
    assert average.mean == pytest.approx((80 + 5 * np.sin(TIMES[TIMES >= 4.0])).mean())
    assert not average.long_enough


@pytest.mark.parametrize("liquid", ["prescribed", "particles", "unrecorded"])
@pytest.mark.parametrize("case", [CASE, CLEAR], ids=["solids", "clear"])
def test_any_run_has_a_report_even_of_one_frame(tmp_path, monkeypatch, case, liquid):
    monkeypatch.setattr(Figure, "savefig", blank)
    results = Results(write_run(tmp_path, case, TIMES[:1], liquid))
    path, *figures = save_report(results)
    numbers = json.loads(path.read_bytes())
    assert ("solids" in numbers) == (case is CASE)
    loss = numbers["pressure_loss"]["whole"]
    assert loss["mean"] == results.pressure_gradient[0]
    assert loss["error"] is None
    assert numbers["averages"]["pressure_gradient"]["long_enough"] is False
    assert {figure.parent.name for figure in figures} == {"figures"}


def test_a_run_that_was_killed_or_of_an_older_version_has_a_report(tmp_path):
    write_run(tmp_path, liquid="particles")
    (tmp_path / "summary.json").unlink()
    with h5py.File(tmp_path / "results.h5", "r+") as file:
        for name in ("layer_velocity", "layer_height", "velocity_profile"):
            del file["liquid"][name]
        del file["diagnostics"]["bulk_velocity"]
    numbers = report(results := Results(tmp_path), survey(results))
    assert numbers["status"] == "unfinished"
    assert "delivered_concentration" not in numbers["averages"]
    assert numbers["solids"]["insitu_concentration"] == pytest.approx(IN_SITU)


def test_every_average_has_its_unit_and_every_array_fits_its_places(results, found):
    numbers = json.loads(json.dumps(report(results, found), default=lambda array: array.tolist()))
    assert all(average["unit"] for average in numbers["averages"].values())
    of_solids = numbers["solids"]
    for name in ("volume_fraction_over_height", "velocity_over_height"):
        profile = of_solids[name]
        assert len(profile["height"]) == len(profile["mean"]) == len(profile["error"]) == 40
    for density in of_solids["velocity_density"].values():
        assert len(density["velocity_edges"]) == len(density["density"]) + 1


def test_a_run_without_frames_has_no_report(tmp_path):
    write_run(tmp_path)
    with h5py.File(tmp_path / "results.h5", "r+") as file:
        file["time"].resize(0, axis=0)
    with pytest.raises(ResultsError, match="no frames"):
        survey(Results(tmp_path))


@pytest.mark.parametrize(
    ("periods", "expected"), [((), None), ((2.0,), 2.0), ((2.0, 0.5), 2.0), ((2.0, 0.7), None)]
)
def test_a_pipe_repeats_itself_after_its_longest_period_if_all_fit_in(periods, expected):
    shakes = tuple({"direction": "y", "amplitude": 0.01, "period": period} for period in periods)
    assert period_of_motion(Motion(vibration=shakes)) == expected
