"""The documents tell the truth about the files and the names."""

import re
from pathlib import Path

import pytest

from mpsdem.results.fields import GROUPS

REPOSITORY = Path(__file__).parents[2]
CONTRIBUTING = (REPOSITORY / "CONTRIBUTING.md").read_text("utf-8")
SOURCES = [
    path
    for folder, pattern in (("cpp", "*.[ch]pp"), ("python/mpsdem", "*.py"))
    for path in (REPOSITORY / folder).rglob(pattern)
    if "validation" not in path.parts
]


@pytest.mark.parametrize(
    ("heading", "law"),
    [("contact", r"hertz_viscoelastic|HertzViscoelastic"), ("drag", r"di_felice|DiFelice")],
)
def test_a_law_is_named_in_the_listed_files_alone(heading, law):
    section = CONTRIBUTING.split(f"## Adding a {heading} law")[1].split("##")[0]
    own = law.split("|")[0]
    listed = {file.replace("my_law", own) for file in re.findall(r"(?m)^\d\. `(.+?)`", section)}
    naming = {
        str(path.relative_to(REPOSITORY))
        for path in SOURCES
        if re.search(law, path.read_text("utf-8"))
    }
    assert naming == listed


@pytest.mark.parametrize("document", ["CONTRIBUTING.md", "README.md"])
def test_every_file_that_a_document_names_exists(document):
    text = (REPOSITORY / document).read_text("utf-8")
    paths = re.findall(r"`(?:\./)?((?:cpp|python|tests|scripts|cases)/[\w/.]+)`", text)
    links = re.findall(r"\]\((\w[\w/.]*)\)", text)
    named = {name for name in paths + links if "my_law" not in name}
    assert {name for name in named if not (REPOSITORY / name).exists()} == set()


def test_the_notation_has_every_name_of_a_results_file():
    notation = (REPOSITORY / "NOTATION.md").read_text("utf-8")
    names = {name for group in GROUPS.values() for name in group}
    assert {name for name in names if not re.search(rf"[`.]{name}`", notation)} == set()
