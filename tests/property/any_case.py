"""Strategies that draw tables of a case from its schema: a new key is drawn without a word here."""

import copy
import re
import types
import typing
from collections.abc import Collection, Mapping

from hypothesis import strategies as st

from mpsdem.case import Case, CaseError
from mpsdem.case.motion import Vibration
from mpsdem.case.part import Part
from mpsdem.case.units import Quantity, Range, Whole

WILD = 1e12  # where a key has no bound


def number(limits: Range, narrow):
    """Numbers that a field takes; `narrow` is a range to stay in, or None for all."""
    low, high = narrow or (-WILD, WILD)
    for bound in (limits.at_least, limits.above):
        low = low if bound is None else max(low, bound)
    for bound in (limits.at_most, limits.below):
        high = high if bound is None else min(high, bound)
    if isinstance(limits, Whole):
        return st.integers(int(low), int(high)).filter(limits.holds)
    spread = st.floats(low, high)
    if low >= 0 < high:  # as many small ones as large ones
        spread = st.floats(-12.0, 0.0).map(
            lambda e: high * 10.0**e if low == 0 else low + (high - low) * 10.0**e
        )
        if low > 0:
            spread = st.floats(0.0, 1.0).map(lambda share: low * (high / low) ** share)
    edges = [edge for edge in (low, high, 0.0) if low <= edge <= high]
    return st.one_of(spread, st.sampled_from(edges)).filter(limits.holds)


def of_type(annotation, metadata, path, ranges, always=frozenset()):
    """What a field of that type may hold, as a file would give it."""
    origin = typing.get_origin(annotation)
    arguments = typing.get_args(annotation)
    if origin is typing.Annotated:
        return of_type(arguments[0], [*arguments[1:], *metadata], path, ranges, always)
    if origin is typing.Literal:
        return st.sampled_from(arguments)
    if origin in (typing.Union, types.UnionType):
        kinds = [kind for kind in arguments if kind is not type(None)]
        return st.one_of(*(of_type(kind, metadata, path, ranges, always) for kind in kinds))
    if origin is tuple:
        if arguments[-1] is Ellipsis:
            return st.lists(of_type(arguments[0], [], path, ranges, always), min_size=1, max_size=3)
        return st.tuples(*(of_type(kind, [], path, ranges, always) for kind in arguments)).map(list)
    limits = [m for m in metadata if isinstance(m, Quantity | Whole)]
    if limits:
        return number(limits[0], ranges.get(path))
    if annotation is float:
        return st.floats(-1.0, 1.0)
    if annotation is bool:
        return st.booleans()
    if annotation is str:
        return st.text(st.characters(exclude_categories=["Cs"]), max_size=8)
    assert issubclass(annotation, Part), f"{path}: draw {annotation} too"
    return of_part(annotation, path, ranges, always)


def of_part(part: type[Part], path, ranges, always=frozenset()):
    """Tables that fit one part of a case; what has a default is there or not, or `always`."""
    keys = {}
    for name, field in part.model_fields.items():
        where = f"{path}.{name}" if path else name
        if ranges.get(where, ()) is None:
            continue
        required = field.is_required() or where in always or name == "kind"
        strategy = of_type(field.annotation, field.metadata, where, ranges, always)
        keys[name] = (required, strategy)
    drawn = st.fixed_dictionaries(
        {name: strategy for name, (required, strategy) in keys.items() if required},
        optional={name: strategy for name, (required, strategy) in keys.items() if not required},
    )
    return drawn.map(_one_vibration) if part is Vibration else drawn


def _one_vibration(table):
    """Of the keys of a vibration that exclude each other, one."""
    table.pop("period" if "frequency" in table else "frequency", None)
    if "frequency" not in table:
        table.setdefault("period", 0.1)
    table["mode"] = table.get("mode", 0) // 2 * 2  # the outlet moves as the inlet does
    if table["mode"] and table["direction"] not in ("y", "z"):
        table["direction"] = "z"
    return table


def tables(
    ranges: Mapping[str, tuple[float, float] | None] | None = None,
    always: Collection[str] = (),
):
    """Tables of whole cases.

    `ranges` narrows keys, by their dotted names; one that is None is never given. Those of `always`
    are given even where they have a default.
    """
    return of_part(Case, "", ranges or {}, frozenset(always))


def leaves(table, path=()):
    """Paths of all keys of a table that hold no table."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from leaves(value, (*path, key))
        else:
            yield (*path, key)


# What a case asks for and cannot be left out.
_GIVEN = {
    "": ("liquid", {"density": 1000.0, "kinematic_viscosity": 1e-6, "bulk_velocity": 1.0}),
    "pipe.stroke": ("pipe.ends", "periodic"),
    "pipe.ends": ("pipe.ends", "periodic"),
    "solids.count": ("solids.count", 5),
    "solids.diameter": ("solids.diameter", 0.01),
    "solids.arrangement": ("solids.arrangement", {"kind": "random"}),
}


def agreed(table, attempts=12):
    """The case of a table, without those keys that do not go with others; None if there is none."""
    table = copy.deepcopy(table)
    for _ in range(attempts):
        try:
            return Case(**table)
        except CaseError as error:
            fields = {re.sub(r"\[.*", "", problem.field) for problem in error.problems}
        for field in fields:
            if not _left_out(table, field):
                whole = ".".join(field.split(".")[:2])
                _put(table, *_GIVEN.get(field, _GIVEN.get(whole, ("title", ""))))
    return None


def _holder(table, field):
    *parents, last = field.split(".")
    for key in parents:
        table = table.get(key) if isinstance(table, dict) else None
    return (table, last) if isinstance(table, dict) else ({}, last)


def _left_out(table, field):
    table, last = _holder(table, field)
    return table.pop(last, None) is not None


def _put(table, field, value):
    table, last = _holder(table, field)
    table[last] = value
