"""The C++ linter is really on: a family that enables nothing would pass for ever."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).parents[2]


def test_every_listed_family_enables_a_check():
    clang_tidy = shutil.which("clang-tidy", path=Path(sys.executable).parent)
    assert clang_tidy, "install the extra `check`: pip install .[check]"
    listed = re.findall(r"(?m)^  ([a-z-]+-)\*,?$", (REPOSITORY / ".clang-tidy").read_text())
    enabled = subprocess.run(
        [clang_tidy, "--list-checks"], cwd=REPOSITORY, capture_output=True, text=True, check=True
    ).stdout.split()
    assert listed
    assert [family for family in listed if not any(c.startswith(family) for c in enabled)] == []
