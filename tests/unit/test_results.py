"""Results as they are read: what was written comes back, lazily, and damage is named."""

import contextlib
import json
import subprocess
import sys

import h5py
import numpy as np
import pytest
from synthetic_results import (
    CASE,
    CLEAR,
    KIND,
    PROVENANCE,
    cluster,
    frame,
    open_writer,
    particle_frame,
    write_run,
)

from mpsdem.results import Results, ResultsError, write_summary
from mpsdem.results.summary import SUMMARY_KEYS


@pytest.fixture(scope="module")
def directory(tmp_path_factory):
    return write_run(tmp_path_factory.mktemp("run"))


def test_what_was_written_is_read(directory):
    with Results(directory) as results:
        np.testing.assert_array_equal(results.time, np.arange(0.0, 8.25, 0.5))
        assert results.solids.velocity.shape == (17, 64, 3)
        np.testing.assert_array_equal(results.solids.velocity[3], cluster(1.5)[1])
        np.testing.assert_array_equal(results.solids.radius, 0.01)
        assert results.pressure_gradient[2] == 80 + 5 * np.sin(1.0)
        assert results.diagnostics["contacts"].tolist() == [3] * 17
        assert results.liquid.profile_velocity[-1] == 0
        assert results.summary["status"] == "finished"
        assert results.provenance == PROVENANCE
        assert results.case == CASE
        assert (directory / "case.toml").read_text("utf-8") == results.case_toml


def test_unwrapped_positions_know_nothing_of_the_outlet(directory):
    results = Results(directory)
    assert results.solids.laps[-1].max() == 2
    assert results.solids.position[:, :, 0].max() < CASE.pipe.length
    np.testing.assert_allclose(results.solids.unwrapped_position[-1], cluster(8.0)[0], rtol=1e-14)


@pytest.mark.parametrize(
    "key",
    [
        0,
        -1,
        np.int64(4),
        slice(None),
        slice(2, 9, 3),
        slice(None, None, -1),
        slice(9, 2, -3),
        slice(5, 5),
        ...,
        (slice(-3, None), slice(None), 0),
        (2, slice(None), 0),
        (slice(1, 4), 5),
        [0, 3],
        np.arange(17) % 2 == 0,
    ],
)
def test_a_field_is_indexed_like_an_array(directory, key):
    field = Results(directory).solids.position
    np.testing.assert_array_equal(field[key], np.asarray(field)[key])


def test_a_field_calculates_like_an_array(directory):
    velocity = Results(directory).solids.velocity
    assert np.mean(velocity[:, :, 1]) == 0
    assert (2 * velocity - velocity == velocity).all()
    assert np.linalg.norm(velocity, axis=2).shape == (17, 64)
    assert [row.shape for row in velocity] == [(64, 3)] * 17
    with pytest.raises(IndexError):
        velocity[17]


def test_every_dataset_says_its_unit_and_meaning(directory):
    with h5py.File(directory / "results.h5") as file:
        mute = []
        file.visititems(
            lambda name, item: (
                mute.append(name)
                if isinstance(item, h5py.Dataset)
                and name != "case"
                and not {"unit", "description"} <= set(item.attrs)
                else None
            )
        )
    assert mute == []
    assert Results(directory).solids.velocity.unit == "m/s"


def test_a_run_of_clear_liquid_has_no_solids(tmp_path):
    results = Results(write_run(tmp_path, CLEAR))
    assert results.has_liquid
    assert not results.has_solids
    with pytest.raises(ResultsError, match="has no solids"):
        results.solids  # noqa: B018


def test_a_liquid_of_particles_is_read_as_it_was_written(tmp_path):
    results = Results(write_run(tmp_path, CLEAR, [0.0, 0.5, 1.0], "particles"))
    liquid, (fields, numbers) = results.liquid, particle_frame(0.5, CLEAR)
    assert liquid.has_particles
    assert not liquid.is_prescribed
    assert liquid.kind.dtype == np.int8
    np.testing.assert_array_equal(liquid.kind, KIND)
    for name, values in fields.items():
        np.testing.assert_array_equal(getattr(liquid, name)[1], values)
    for name, value in numbers.items():
        assert results.diagnostics[name][1] == value
    assert results.diagnostics["clamped"].dtype == np.int64
    assert liquid.section_position.shape == liquid.section_pressure.shape[1:]
    assert liquid.profile_radius.shape == liquid.velocity_profile.shape[1:]
    assert liquid.pressure.unit == "Pa"
    with pytest.raises(ResultsError, match="profile_velocity"):
        liquid.profile_velocity  # noqa: B018


def test_the_full_pressure_adds_the_weight_above_and_the_loss_along_the_pipe(tmp_path):
    steep = CLEAR.with_(pipe={"inclination": "30 deg"}, gravity=10.0)
    results = Results(write_run(tmp_path, steep, [0.0, 0.5], "particles"))
    liquid, x = results.liquid, results.liquid.position[1]
    height = x[:, 0] * 0.5 + x[:, 2] * np.sqrt(0.75)
    added = -1000.0 * 10.0 * height - results.pressure_gradient[1] * x[:, 0]
    np.testing.assert_allclose(liquid.full_pressure(1), liquid.pressure[1] + added, rtol=1e-12)
    along = liquid.section_position
    added = -(1000.0 * 10.0 * 0.5 + results.pressure_gradient[-1]) * along
    np.testing.assert_allclose(
        liquid.full_section_pressure(-1), liquid.section_pressure[-1] + added, rtol=1e-12
    )


def test_a_liquid_may_leave_its_particles_unrecorded(tmp_path):
    liquid = Results(write_run(tmp_path, CLEAR, [0.0], "unrecorded")).liquid
    assert not liquid.has_particles
    assert liquid.velocity_profile.shape == (1, 20)
    with pytest.raises(ResultsError, match="position"):
        liquid.position  # noqa: B018


def test_a_prescribed_liquid_has_no_particles(directory):
    liquid = Results(directory).liquid
    assert liquid.is_prescribed
    assert not liquid.has_particles


def test_results_can_be_read_while_they_grow(tmp_path):
    with open_writer(tmp_path) as writer:
        writer.append(0.0, **frame(0.0))
        first = Results(tmp_path)
        writer.append(0.5, **frame(0.5))
        assert Results(tmp_path).time.tolist() == [0.0, 0.5]
        assert first.time.tolist() == [0.0]
        assert len(first.solids.position) == len(np.asarray(first.solids.position)) == 1
        assert first.summary == {}
        other_process = "import sys, mpsdem.results as r; print(*r.Results(sys.argv[1]).time)"
        printed = subprocess.run(
            [sys.executable, "-c", other_process, tmp_path], capture_output=True, check=True
        )
        assert printed.stdout.split() == [b"0.0", b"0.5"]


def test_a_path_may_hold_spaces_and_any_letters(tmp_path):
    path = write_run(tmp_path / "Förderrohr Nr. 1 – 512 Knollen" / "結果")
    assert len(Results(path).time) == 17


def test_results_open_without_the_compiled_core_and_the_simulation(directory):
    script = (
        "import sys; sys.modules['mpsdem._core'] = sys.modules['mpsdem.simulation'] = None\n"
        "import mpsdem.plot\n"
        "from mpsdem.results import Results; print(len(Results(sys.argv[1]).time))"
    )
    subprocess.run([sys.executable, "-c", script, directory], check=True)


def test_a_missing_run_is_named(tmp_path):
    with pytest.raises(ResultsError, match="has this case been run"):
        Results(tmp_path)


def test_a_file_that_is_not_hdf5_is_refused(tmp_path):
    (tmp_path / "results.h5").write_text("time,position\n0,1\n")
    with pytest.raises(ResultsError, match="not a results file"):
        Results(tmp_path)


def test_an_hdf5_file_of_another_program_is_refused(tmp_path):
    with h5py.File(tmp_path / "results.h5", "w", libver="latest") as file:
        file["time"] = [0.0]
    with pytest.raises(ResultsError, match="of another program"):
        Results(tmp_path)


def test_a_file_of_a_later_version_says_to_update(tmp_path):
    write_run(tmp_path)
    with h5py.File(tmp_path / "results.h5", "r+") as file:
        file.attrs["format_version"] = 99
    with pytest.raises(ResultsError, match="update mpsdem"):
        Results(tmp_path)


@pytest.mark.parametrize("share", [0.001, 0.01, 0.1, 0.5, 0.9])
def test_a_file_cut_short_is_refused_or_gives_right_numbers(directory, tmp_path, share):
    whole = (directory / "results.h5").read_bytes()
    (tmp_path / "results.h5").write_bytes(whole[: int(share * len(whole))])
    right = np.asarray(Results(directory).solids.velocity)
    with contextlib.suppress(ResultsError):
        results = Results(tmp_path)
        np.testing.assert_array_equal(results.solids.velocity, right[: len(results.time)])


def test_a_damaged_header_is_refused(directory, tmp_path):
    content = bytearray((directory / "results.h5").read_bytes())
    content[8:512] = bytes(504)
    (tmp_path / "results.h5").write_bytes(content)
    with pytest.raises(ResultsError, match="damaged"):
        Results(tmp_path)


def test_a_field_that_was_not_recorded_is_named(directory):
    results = Results(directory)
    assert "void_fraction" not in results.solids
    with pytest.raises(ResultsError, match="void_fraction"):
        results.solids.void_fraction  # noqa: B018


def test_a_summary_is_plain_json_and_complete(tmp_path):
    values = dict.fromkeys(SUMMARY_KEYS, 1) | {
        "wall_seconds": np.float64(2.5),
        "pressure_gradient": np.nan,
        "warnings": np.array(["Größe"]),
    }
    del values["friction_factor"]
    with pytest.raises(ValueError, match="lacks friction_factor"):
        write_summary(tmp_path, values)
    write_summary(tmp_path, values, not_applicable={"friction_factor": "no liquid"})
    summary = json.loads((tmp_path / "summary.json").read_text("utf-8"))
    assert summary["wall_seconds"] == 2.5
    assert summary["pressure_gradient"] is None
    assert summary["warnings"] == ["Größe"]
    assert summary["friction_factor"] is None
    assert summary["not_applicable"] == {"friction_factor": "no liquid"}
    assert list(summary)[: len(SUMMARY_KEYS)] == list(SUMMARY_KEYS)
