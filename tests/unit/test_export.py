"""What is exported is what was computed: read back by VTK's own readers, frame by frame."""

import builtins
import xml.etree.ElementTree as ET

import h5py
import numpy as np
import pytest
from synthetic_results import CASE, CLEAR, KIND, TIMES, frame, open_writer, write_run
from typer.testing import CliRunner

from mpsdem.cli import app
from mpsdem.results import MissingExtraError, OutputError, Results, ResultsError, export
from mpsdem.results.export import FORMATS, OF_LIQUID, OF_SOLIDS
from mpsdem.results.fields import LIQUID, SOLIDS

FLOWS = KIND == 2


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return Results(write_run(tmp_path_factory.mktemp("run"), liquid="particles"))


class Series:
    """A VTKHDF file as VTK's reader sees it."""

    def __init__(self, path):
        hdf = pytest.importorskip("vtkmodules.vtkIOHDF")
        pipeline = pytest.importorskip("vtkmodules.vtkCommonExecutionModel")
        self.reader = hdf.vtkHDFReader()
        self.reader.SetFileName(str(path))
        self.reader.UpdateInformation()
        key = pipeline.vtkStreamingDemandDrivenPipeline.TIME_STEPS()
        self.times = np.array(self.reader.GetOutputInformation(0).Get(key))

    def at(self, time):
        """Points, and the point data by name."""
        pyvista = pytest.importorskip("pyvista")
        self.reader.UpdateTimeStep(time)
        mesh = pyvista.wrap(self.reader.GetOutput())
        assert mesh.n_verts == mesh.n_cells == mesh.n_points
        np.testing.assert_array_equal(mesh.verts.reshape(-1, 2)[:, 1], np.arange(mesh.n_points))
        return np.array(mesh.points), {name: np.array(mesh[name]) for name in mesh.point_data}


def test_paraview_finds_the_solids_where_they_are_at_every_time(results, tmp_path):
    solids = Series(export(results, tmp_path)[0])
    np.testing.assert_array_equal(solids.times, TIMES)
    for k in (0, 16, 5, 4):  # also back, as one who drags the slider
        points, fields = solids.at(TIMES[k])
        np.testing.assert_array_equal(points, results.solids.position[k])
        np.testing.assert_array_equal(fields["velocity"], results.solids.velocity[k])
        np.testing.assert_array_equal(fields["laps"], results.solids.laps[k])
        np.testing.assert_array_equal(fields["radius"], np.full(64, 0.01))
        assert set(fields) == {"radius", "density", "velocity", "spin", "laps"}


def test_the_liquid_comes_without_the_wall_and_with_its_full_pressure(results, tmp_path):
    liquid = Series(export(results, tmp_path)[1])
    for k in (16, 3):
        points, fields = liquid.at(TIMES[k])
        np.testing.assert_array_equal(points, results.liquid.position[k][FLOWS])
        np.testing.assert_array_equal(fields["velocity"], results.liquid.velocity[k][FLOWS])
        np.testing.assert_array_equal(fields["pressure"], results.liquid.pressure[k][FLOWS])
        down = np.polyfit(points[:, 2], fields["full_pressure"] - fields["pressure"], 1)[0]
        assert down == pytest.approx(-9.807e3, rel=0.05)


def test_a_place_that_holds_no_particle_in_a_frame_is_left_out_of_it(tmp_path):
    gone = np.arange(0, len(KIND), 100)
    with open_writer(tmp_path, liquid="particles") as writer:
        for time in TIMES[:4]:
            fields = frame(time, liquid="particles")
            if time == TIMES[2]:
                fields["liquid"]["position"][gone] = np.nan
            writer.append(time, **fields)
    liquid = Series(export(Results(tmp_path), tmp_path / "export")[1])
    counts = [len(liquid.at(time)[0]) for time in TIMES[:4]]
    assert counts == [FLOWS.sum()] * 2 + [FLOWS.sum() - FLOWS[gone].sum()] + [FLOWS.sum()]
    assert np.isfinite(liquid.at(TIMES[2])[0]).all()
    position = Results(tmp_path).liquid.position[3][FLOWS]
    np.testing.assert_array_equal(liquid.at(TIMES[3])[0], position)


def test_what_stands_still_is_written_once(results, tmp_path):
    with h5py.File(export(results, tmp_path)[0]) as file:
        fields = file["VTKHDF/PointData"]
        assert len(fields["radius"]) == 64
        assert len(fields["velocity"]) == 64  # the made-up cluster does not accelerate
        assert len(file["VTKHDF/Points"]) == 64 * TIMES.size
        assert fields["velocity"].attrs["unit"] == "m/s"
        assert file["case"].asstr()[()] == results.case_toml


def test_a_collection_lists_each_frame_with_its_time(results, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    solids, liquid = export(results, tmp_path, to="vtp", frames=[0, 7])
    assert (solids.name, liquid.name) == ("solids.pvd", "liquid.pvd")
    entries = list(ET.parse(solids).getroot().iter("DataSet"))
    assert [float(entry.get("timestep")) for entry in entries] == [0.0, TIMES[7]]
    for entry, k in zip(entries, (0, 7), strict=True):
        mesh = pyvista.read(tmp_path / entry.get("file"))
        np.testing.assert_allclose(mesh.points, results.solids.position[k], rtol=1e-6)
        np.testing.assert_array_equal(mesh["velocity"], results.solids.velocity[k])


@pytest.mark.parametrize("to", ["vtu", "vtk"])
def test_a_snapshot_is_that_of_the_last_frame(results, tmp_path, to):
    meshio = pytest.importorskip("meshio")
    solids, liquid = export(results, tmp_path, to=to)
    mesh = meshio.read(solids)
    np.testing.assert_allclose(mesh.points, results.solids.position[-1], rtol=1e-12)
    np.testing.assert_allclose(mesh.point_data["velocity"], results.solids.velocity[-1])
    assert len(meshio.read(liquid).points) == FLOWS.sum()


def test_clear_liquid_has_no_solids_and_a_prescribed_one_no_points(tmp_path):
    clear = Results(write_run(tmp_path / "clear", CLEAR, liquid="particles"))
    assert [path.name for path in export(clear, tmp_path / "1")] == ["liquid.vtkhdf"]
    prescribed = Results(write_run(tmp_path / "prescribed", CASE))
    assert [path.name for path in export(prescribed, tmp_path / "2")] == ["solids.vtkhdf"]


def test_every_field_of_a_solid_and_of_the_liquid_is_exported():
    means = {name for name in SOLIDS | LIQUID if "section" in name}
    means |= {"profile_radius", "profile_velocity", "velocity_profile"}
    means |= {"layer_height", "layer_velocity", "kind"}
    assert set(OF_SOLIDS) == set(SOLIDS) - means - {"position"}
    assert set(OF_LIQUID) == set(LIQUID) - means - {"position"}


@pytest.mark.parametrize(("to", "package"), [("vtp", "pyvista"), ("vtu", "meshio")])
def test_a_missing_package_is_told_with_the_command_that_installs_it(
    results, tmp_path, monkeypatch, to, package
):
    real = builtins.__import__

    def without(name, *rest):
        if name == package:
            raise ImportError(name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(MissingExtraError, match=f"pip install {package}"):
        export(results, tmp_path, to=to)


def test_the_command_says_what_to_open(results, tmp_path):
    def type_in(*options):
        command = ["export", str(results.directory), "-o", str(tmp_path), *options]
        return CliRunner().invoke(app, command)

    said = type_in("--times", "7.9,0,0.1")
    assert said.stdout.split() == [
        str(tmp_path / f"{name}.vtkhdf") for name in ("solids", "liquid")
    ]
    with h5py.File(tmp_path / "solids.vtkhdf") as file:
        assert list(file["VTKHDF/Steps/Values"]) == [0.0, 8.0]
    assert type_in("--every", "8").exit_code == 0
    with h5py.File(tmp_path / "solids.vtkhdf") as file:
        assert list(file["VTKHDF/Steps/Values"]) == [0.0, 4.0, 8.0]
    for options in (["--times", "1;2"], ["--times", "1", "--every", "2"], ["--every", "0"]):
        said = type_in(*options)
        assert said.exit_code == 2
        assert "--" in said.stderr


def test_what_cannot_be_exported_is_an_error_in_words(results, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match="not a directory"):
        export(results, tmp_path / "file" / "export")
    with pytest.raises(ValueError, match=", ".join(FORMATS)):
        export(results, tmp_path, to="ply")
    with pytest.raises(ResultsError, match="no frames"):
        export(results, tmp_path, frames=[])


def test_an_export_that_fails_leaves_the_one_before_untouched(results, tmp_path):
    before = export(results, tmp_path)[0].read_bytes()
    with pytest.raises(IndexError):
        export(results, tmp_path, frames=[0, 99])
    assert (tmp_path / "solids.vtkhdf").read_bytes() == before
    assert list(tmp_path.glob("*.part")) == []
