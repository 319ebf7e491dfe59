"""What all parts of a case have in common."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Annotated, Any, Self

import numpy as np
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    ModelWrapValidatorHandler,
    ValidationError,
    model_validator,
)
from pydantic_core import InitErrorDetails, PydanticCustomError

from mpsdem.case.errors import (
    BRANCH,
    CaseError,
    Problem,
    problems_of,
    refusal,
    unknown_key,
    validation_error,
)
from mpsdem.case.units import Quantity, Range

if TYPE_CHECKING:
    _Meta = type
else:

    class _Meta(type(BaseModel)):
        """A part that is built in Python is refused with the same words as one in a file."""

        def __call__(cls, *args, **fields):
            try:
                return super().__call__(*args, **fields)
            except ValidationError as error:
                raise CaseError(problems_of(error)) from None


class Part(BaseModel, metaclass=_Meta):
    """A frozen table of the case; changing it means making a new one."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    def problems(self) -> Iterable[Problem]:
        """Yield what is wrong although every field alone is right; fields relative to this part."""
        return ()

    @model_validator(mode="wrap")
    @classmethod
    def _check(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        try:
            part = handler(data)
        except ValidationError as error:
            raise ValidationError.from_exception_data(
                cls.__name__, [cls._explained(details) for details in error.errors()]
            ) from None
        if problems := list(part.problems()):
            raise validation_error(cls.__name__, problems)
        return part

    @classmethod
    def _explained(cls, details: Any) -> InitErrorDetails:
        """Say more of an error where this part knows more: its keys, and their units."""
        kind, location = details["type"], details["loc"]
        context = details.get("ctx", {})
        if kind == "extra_forbidden" and len(location) == 1:
            kind = unknown_key(str(location[0]), cls.model_fields)
        elif kind == "missing" and len(location) == 1:
            metadata = cls.model_fields[location[0]].metadata
            units = [m.unit for m in metadata if isinstance(m, Range) and m.unit != "-"]
            if units:
                kind = refusal(Problem(rule=f"is required, in {units[0]}"))
                details = details | {"input": None}
        elif kind == "case":
            kind = PydanticCustomError("case", "{rule}", context)
        return InitErrorDetails(type=kind, loc=location, input=details["input"], ctx=context)


def _as_tuple(value: object) -> object:
    if isinstance(value, np.ndarray):
        value = value.tolist()
    return tuple(value) if isinstance(value, list) else value


def branch(value: object) -> str:
    """Name the branch of a union that `value` belongs to: its kind, or that it is a number."""
    if isinstance(value, Mapping):
        return f"{BRANCH}{value.get('kind', 'not given')}"
    return f"{BRANCH}{getattr(value, 'kind', 'number')}"


#: Marks a tuple that a TOML list or an array may fill.
FromList = BeforeValidator(_as_tuple)

Velocity = Annotated[
    tuple[
        Annotated[float, Quantity("m/s")],
        Annotated[float, Quantity("m/s")],
        Annotated[float, Quantity("m/s")],
    ],
    FromList,
]
