"""What a check is, and how some of them are chosen by their ids."""

from __future__ import annotations

import difflib
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Source:
    """Where an expected number comes from.

    Attributes
    ----------
    cite : str
        As a table shows it: author and year, or "analytic".
    reference : str
        DOI or journal, and how the number was read where that matters.
    """

    cite: str
    reference: str = ""


ANALYTIC = Source(cite="analytic")


@dataclass(frozen=True, slots=True, kw_only=True)
class Check:
    """One number that the program must reproduce, known from outside it.

    Attributes
    ----------
    id : str
        Path such as ``oblique/oxide/20deg/restitution``; its first part is the group.
    claim : str
        A sentence that can be false.
    expected : float
        [`unit`].
    measure : callable
        Returns what the program gives [`unit`]. Checks of one experiment share its run.
    relative, absolute : float
        Tolerance, one of the two: relative to `expected` [-], or absolute [`unit`].
    unit : str
    source : Source
    differs : str
        Not empty where the program is known to miss the number: the reason. Such a check is
        reported, never counted as passed.
    slow : bool
        Whether its run takes longer than a quick look at the tests should: those leave it to
        ``pytest -m slow``. `mpsdem validate` runs it.
    """

    id: str
    claim: str
    expected: float
    measure: Callable[[], float]
    relative: float = 0.0
    absolute: float = 0.0
    unit: str = "-"
    source: Source = ANALYTIC
    differs: str = ""
    slow: bool = False

    def __post_init__(self) -> None:
        if (self.relative > 0) == (self.absolute > 0):
            raise ValueError(f"{self.id}: give either a relative or an absolute tolerance > 0")
        if self.relative > 0 and self.expected == 0:
            raise ValueError(f"{self.id}: what is expected to be 0 needs an absolute tolerance")

    def run(self) -> Outcome:
        """Measure, and compare."""
        return Outcome(check=self, got=float(self.measure()))


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What a check gave."""

    check: Check
    got: float

    @property
    def error(self) -> float:
        """Got less expected; over the expected where the tolerance is relative."""
        difference = self.got - self.check.expected
        return difference if self.check.absolute else difference / abs(self.check.expected)

    @property
    def agrees(self) -> bool:
        """Whether the number lies within the tolerance."""
        return math.isfinite(self.got) and abs(self.error) <= (
            self.check.absolute or self.check.relative
        )

    @property
    def failed(self) -> bool:
        """Whether the number is off, and not known to be."""
        return not self.agrees and not self.check.differs


def collect(*groups: Iterable[Check]) -> dict[str, Check]:
    """Checks by their ids, which must be unique."""
    checks: dict[str, Check] = {}
    for check in (check for group in groups for check in group):
        if check.id in checks:
            raise ValueError(f"two checks have the id {check.id}")
        checks[check.id] = check
    return checks


def select(checks: Mapping[str, Check], ids: Iterable[str]) -> list[Check]:
    """Choose checks: each id is that of a check or the path of a group, none means all.

    Raises
    ------
    LookupError
        If an id names nothing; it says which ids come near.
    """
    wanted = [wish.strip("/") for wish in ids]
    for wish in wanted:
        if not any(_under(wish, id_) for id_ in checks):
            groups = {id_.rsplit("/", k)[0] for id_ in checks for k in range(id_.count("/") + 1)}
            near = difflib.get_close_matches(wish, sorted(groups), n=3, cutoff=0.4)
            known = near or sorted({id_.split("/")[0] for id_ in checks})
            raise LookupError(f"no check {wish!r}; did you mean {', '.join(known)}?")
    return [
        check
        for id_, check in checks.items()
        if not wanted or any(_under(wish, id_) for wish in wanted)
    ]


def _under(path: str, id_: str) -> bool:
    return id_ == path or id_.startswith(path + "/")
