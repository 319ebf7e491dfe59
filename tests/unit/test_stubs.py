"""The type stubs of the compiled module say what the module offers."""

import subprocess
import sys
from difflib import unified_diff
from pathlib import Path

import pytest

import mpsdem
from mpsdem import _core

REPOSITORY = Path(__file__).parents[2]
STUBS = REPOSITORY / "python" / "mpsdem" / "_core"


def lines(stubs: Path) -> list[str]:
    return [line for stub in sorted(stubs.glob("*.pyi")) for line in stub.read_text().splitlines()]


def test_the_stubs_match_the_compiled_module(tmp_path):
    script = REPOSITORY / "scripts" / "stubs.py"
    made = subprocess.run([sys.executable, script, tmp_path], capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    fresh = lines(tmp_path / "mpsdem" / "_core")
    if changes := "\n".join(unified_diff(lines(STUBS), fresh, "committed", "fresh", lineterm="")):
        pytest.fail(
            f"Stubs are out of date; regenerate them: python scripts/stubs.py\n{changes}",
            pytrace=False,
        )


def test_the_stub_folder_does_not_shadow_the_compiled_module():
    assert Path(_core.__file__).suffix in {".so", ".pyd"}


def test_the_package_ships_its_types():
    package = Path(mpsdem.__file__).parent
    assert (package / "py.typed").is_file()
    assert (package / "_core" / "__init__.pyi").is_file()
