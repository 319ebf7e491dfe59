"""The layers, held by a test: an #include and an import may only point down."""

import ast
import re
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[2]
CPP = REPOSITORY / "cpp"
PYTHON = REPOSITORY / "python" / "mpsdem"

BASE = {"core", "geometry", "neighbors", "linear"}
MAY_INCLUDE = {
    "core": set(),
    "geometry": {"core"},
    "neighbors": {"core"},
    "linear": {"core"},
    "mps": BASE,
    "dem": BASE,
    "coupling": BASE | {"mps", "dem"},
    "bindings": BASE | {"mps", "dem", "coupling"},
}
MAY_IMPORT = {
    "case": set(),
    "geometry": {"case"},
    "results": {"case"},
    "analysis": {"case", "results"},
    "plot": {"case", "results", "analysis"},
    "contacts": set(),
    "info": {"_core"},
    "plan": {"_core", "analysis", "case", "contacts", "geometry"},
    "liquids": {"_core", "case", "geometry", "plan"},
    "stages": {"_core", "case", "contacts", "geometry", "liquids", "plan", "results"},
    "simulation": {
        "_core",
        "analysis",
        "case",
        "geometry",
        "info",
        "liquids",
        "plan",
        "plot",
        "results",
        "stages",
    },
}
MAY_IMPORT["trade"] = (
    {"validation"} | MAY_IMPORT["simulation"] - {"liquids", "stages"} | {"simulation"}
)
ABOVE_ALL = {"validation", "cli", "__init__", "__main__"}  # these may import every layer

SOURCES = sorted(CPP.rglob("*.[ch]pp"))
MODULES = sorted(PYTHON.rglob("*.py"))


def layer(file: Path, root: Path) -> str:
    """Name the layer of a file: the first folder under the root, or its own name there."""
    return file.relative_to(root).parts[0].removesuffix(".py")


def includes(source: Path) -> list[str]:
    return re.findall(
        r'^\s*#\s*include\s*["<]([^">]+)[">]', source.read_text("utf-8"), re.MULTILINE
    )


def imports(module: Path) -> set[str]:
    """Layers of mpsdem that a module imports anywhere in it, in functions and for typing too."""
    package = ["mpsdem", *module.relative_to(PYTHON).parts[:-1]]
    names = []
    for node in ast.walk(ast.parse(module.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            parts = package[: len(package) - node.level + 1] if node.level else []
            origin = ".".join([*parts, *filter(None, [node.module])])
            names += [f"{origin}.{alias.name}" for alias in node.names]
    return {name.split(".")[1] for name in names if name.startswith("mpsdem.")}


def test_the_sources_are_found():
    assert {layer(source, CPP) for source in SOURCES} >= {"core", "dem", "bindings"}
    assert {layer(module, PYTHON) for module in MODULES} >= {
        "case",
        "plan",
        "simulation",
        "results",
    }


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: str(path.relative_to(CPP)))
def test_an_include_points_down(source):
    own = layer(source, CPP)
    assert own in MAY_INCLUDE, f"say in MAY_INCLUDE what {own} may include"
    ours = {name.split("/")[0] for name in includes(source) if (CPP / name).exists()}
    assert ours <= MAY_INCLUDE[own] | {own}


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: str(path.relative_to(CPP)))
def test_a_quoted_include_is_written_from_the_include_root(source):
    quoted = re.findall(r'#\s*include\s*"([^"]+)"', source.read_text("utf-8"))
    assert [name for name in quoted if not (CPP / name).exists()] == []


def test_only_the_bindings_name_pybind11():
    naming = {layer(source, CPP) for source in SOURCES if "pybind11" in source.read_text("utf-8")}
    assert naming == {"bindings"}


def test_only_one_file_names_openmp():
    openmp = re.compile(r"\bomp\b|\bomp_|<omp\.h>|OpenMP")
    naming = [source for source in SOURCES if openmp.search(source.read_text("utf-8"))]
    assert naming == [CPP / "core" / "parallel.hpp"]


@pytest.mark.parametrize("module", MODULES, ids=lambda path: str(path.relative_to(PYTHON)))
def test_an_import_points_down(module):
    own = layer(module, PYTHON)
    if own not in ABOVE_ALL:
        assert own in MAY_IMPORT, f"say in MAY_IMPORT what {own} may import"
        assert imports(module) <= MAY_IMPORT[own] | {own}


def test_the_rule_sees_every_way_to_import(tmp_path, monkeypatch):
    monkeypatch.setitem(globals(), "PYTHON", tmp_path)
    module = tmp_path / "case" / "pipe.py"
    module.parent.mkdir()
    for line in (
        "import mpsdem.simulation",
        "from mpsdem import simulation",
        "from mpsdem.simulation import Simulation",
        "from .. import simulation",
        "from ..simulation import Simulation",
        "def f():\n    import mpsdem.simulation as s",
        "if TYPE_CHECKING:\n    from mpsdem.simulation import Simulation",
    ):
        module.write_text(line)
        assert imports(module) == {"simulation"}, line
