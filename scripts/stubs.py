"""Write the type stubs of the compiled module.

usage: python scripts/stubs.py [FOLDER]      FOLDER holds the package mpsdem; default: python
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

DEFAULT = Path(__file__).resolve().parents[1] / "python"


def write_stubs(folder: Path) -> None:
    """Generate `folder`/mpsdem/_core/*.pyi from the installed module."""
    generate = [sys.executable, "-m", "pybind11_stubgen", "mpsdem._core", "--exit-code"]
    subprocess.run([*generate, "-o", str(folder)], check=True)
    for stub in (folder / "mpsdem" / "_core").glob("*.pyi"):
        text = stub.read_text("utf-8")
        # A string constant tells of the machine that built the module (compiler, SIMD level).
        text = re.sub(r"(?m)^(\w+: str) = .*$", r"\1", text)
        text = re.sub(r"(-> |: )dict(?=[:,)])", r"\1dict[str, typing.Any]", text)
        stub.write_text(text, "utf-8")


if __name__ == "__main__":
    write_stubs(Path(sys.argv[1]) if sys.argv[1:] else DEFAULT)
