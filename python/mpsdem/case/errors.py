"""What a case may be refused for, in the words of someone who has to repair it."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError
from pydantic_core import InitErrorDetails, PydanticCustomError

#: Marks the entries of a pydantic location that name a branch of a union, not a key of the file.
BRANCH = "kind:"


@dataclass(frozen=True, kw_only=True)
class Problem:
    """One thing that is wrong with a case.

    Parameters
    ----------
    rule : str
        What has to hold instead, unit included.
    field : str
        Dotted key, as in ``--set``; empty for the case as a whole.
    value : object
        What was found; None if there is nothing to show.
    unit : str
        Unit in which the rule is written; empty for none.
    remedy : str
        What to do about it, if that is known.
    """

    rule: str
    field: str = ""
    value: object = None
    unit: str = ""
    remedy: str = ""

    def __str__(self) -> str:
        shown = "" if self.value is None else f" = {_shortened(self.value)}"
        start = f"{self.field}{shown}: " if self.field else ""
        return f"{start}{self.rule}" + (f"; {self.remedy}" if self.remedy else "")


class CaseError(ValueError):
    """A case that cannot be run, with everything that is wrong with it.

    Attributes
    ----------
    problems : tuple of Problem
        One per field, in the order of the case.
    source : str
        The file that was read; empty for a case that was built in Python.
    """

    def __init__(self, problems: Iterable[Problem], source: str = "") -> None:
        self.problems = tuple(problems)
        self.source = source
        super().__init__(self.problems, source)

    def __str__(self) -> str:
        lines = [f"{self.source}:"] if self.source else []
        return "\n".join(lines + [str(problem) for problem in self.problems])


def nearest(word: str, known: Iterable[str]) -> str:
    """Suggest the known word that `word` was probably meant to be.

    Examples
    --------
    >>> nearest("denisty", ["density", "diameter"])
    "did you mean 'density'?"
    """
    known = list(known)
    close = difflib.get_close_matches(word, known, n=1, cutoff=0.6)
    return f"did you mean {close[0]!r}?" if close else f"known are {', '.join(map(repr, known))}"


def unknown_key(key: str, known: Iterable[str]) -> PydanticCustomError:
    """Error for a key that the part of the case does not have."""
    return refusal(Problem(rule="unknown key", remedy=nearest(key, known)))


def refusal(problem: Problem) -> PydanticCustomError:
    """Carry a problem through pydantic; the location, and the value if None, are added there."""
    context = {"rule": problem.rule, "unit": problem.unit, "remedy": problem.remedy}
    # Braces in a template are placeholders, so the text travels in the context.
    return PydanticCustomError("case", "{rule}", context)


def validation_error(title: str, problems: Sequence[Problem]) -> ValidationError:
    """Gather problems, whose fields are relative to the part `title`, in one exception."""
    details = [
        InitErrorDetails(
            type=refusal(problem),
            loc=tuple(problem.field.split(".")) if problem.field else (),
            input=problem.value,
        )
        for problem in problems
    ]
    return ValidationError.from_exception_data(title, details)


def problems_of(error: ValidationError) -> list[Problem]:
    """Translate what pydantic found, one problem per line."""
    return [_translated(details) for details in error.errors(include_url=False)]


def _translated(details: Any) -> Problem:
    context = details.get("ctx", {})
    field = _dotted(details["loc"])
    value = details["input"]
    match details["type"]:
        case "case":
            return Problem(field=field, value=value, **context)
        case "missing":
            return Problem(field=field, rule="is required")
        case "literal_error":
            return Problem(field=field, value=value, rule=f"must be {context['expected']}")
        case "union_tag_invalid":
            known = context["expected_tags"].replace(BRANCH, "")
            kind = context["tag"].removeprefix(BRANCH)
            return Problem(field=f"{field}.kind", value=kind, rule=f"must be one of {known}")
        case "model_type" | "model_attributes_type":
            return Problem(field=field, value=value, rule="must be a table of keys")
        case _:
            rule = details["msg"].replace("Input should be", "must be")
            return Problem(field=field, value=value, rule=rule)


def _dotted(location: Iterable[int | str]) -> str:
    path = ""
    for part in location:
        if isinstance(part, int):
            path += f"[{part}]"
        elif not part.startswith(BRANCH):
            path += f".{part}" if path else part
    return path


def _shortened(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:56]} ..."
