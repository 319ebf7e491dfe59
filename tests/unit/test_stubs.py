"""The type stubs of the compiled module say what the module offers."""

import subprocess
import sys
from pathlib import Path

import mpsdem
from mpsdem import _core

REPOSITORY = Path(__file__).parents[2]
STUBS = REPOSITORY / "python" / "mpsdem" / "_core"
REGENERATE = "python scripts/stubs.py"


def test_the_stubs_match_the_compiled_module(tmp_path):
    script = REPOSITORY / "scripts" / "stubs.py"
    made = subprocess.run([sys.executable, script, tmp_path], capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    fresh = {stub.name: stub.read_text() for stub in (tmp_path / "mpsdem" / "_core").iterdir()}
    committed = {stub.name: stub.read_text() for stub in STUBS.glob("*.pyi")}
    assert committed == fresh, f"the stubs are out of date; regenerate them with: {REGENERATE}"


def test_the_stub_folder_does_not_shadow_the_compiled_module():
    assert Path(_core.__file__).suffix in {".so", ".pyd"}


def test_the_package_ships_its_types():
    package = Path(mpsdem.__file__).parent
    assert (package / "py.typed").is_file()
    assert (package / "_core" / "__init__.pyi").is_file()
