"""Every number of the registry: what the program gives beside what it must."""

import pytest

from mpsdem.validation import CHECKS


@pytest.mark.parametrize(
    "check",
    [
        pytest.param(check, id=id_, marks=[pytest.mark.slow] if check.slow else [])
        for id_, check in CHECKS.items()
    ],
)
def test_the_program_gives_the_published_number(check):
    outcome = check.run()
    said = f"{check.claim}: expected {check.expected:g}, got {outcome.got:g} {check.unit}"
    # A difference that is known must not heal unseen: then its reason is to be taken out.
    assert outcome.agrees != bool(check.differs), said
