"""The notebooks run from the first cell to the last, on scenes so small that it takes seconds."""

import os
import shutil
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

import mpsdem

REPOSITORY = Path(__file__).parents[2]
PACKAGE = Path(mpsdem.__file__).parents[1]  # the one that these tests run, wherever it is installed
NOTEBOOKS = sorted((REPOSITORY / "notebooks").glob("*.ipynb"))
SMALL = {
    "01_first_pipe": {"end_time": 0.04},
    "02_shaken_pipe": {"end_time": 0.04, "length": 0.25, "every": 0.01},
    "03_head_loss": {"velocities": [2.0, 4.0], "end_time": 0.02, "length": 0.1},
}


def test_the_notebooks_are_found():
    assert {path.stem for path in NOTEBOOKS} == set(SMALL)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_stored_without_what_a_run_leaves_in_it(path):
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in code] == [None] * len(code)
    assert [cell.outputs for cell in code] == [[]] * len(code)


def shortened(path):
    """The cells of a notebook, with its parameters set to those of a tiny scene."""
    notebook = nbformat.read(path, as_version=4)
    (cell,) = (c for c in notebook.cells if "parameters" in c.metadata.get("tags", ()))
    known = {line.split(" = ")[0] for line in cell.source.splitlines()}
    assert SMALL[path.stem].keys() <= known
    cell.source += "".join(f"\n{name} = {value!r}" for name, value in SMALL[path.stem].items())
    return notebook.cells


def test_the_notebooks_run(tmp_path, monkeypatch):
    """All in one kernel, as starting it takes longer than most cells; none sees another's names."""
    path = os.pathsep.join([str(PACKAGE), os.environ.get("PYTHONPATH", "")])
    monkeypatch.setenv("PYTHONPATH", path)
    shutil.copytree(REPOSITORY / "cases", tmp_path / "cases")
    (tmp_path / "notebooks").mkdir()
    together = nbformat.v4.new_notebook()
    for notebook in NOTEBOOKS:
        together.cells += [nbformat.v4.new_code_cell("%reset -f"), *shortened(notebook)]
    folder = {"metadata": {"path": tmp_path / "notebooks"}}
    NotebookClient(together, kernel_name="python3", timeout=300, resources=folder).execute()
    outputs = [output for cell in together.cells for output in cell.get("outputs", ())]
    assert sum("image/png" in output.get("data", {}) for output in outputs) == 5
    assert [output.text for output in outputs if output.get("name") == "stderr"] == []
