"""A run's whole state in one file, to continue from as if it had never stopped."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import h5py  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import NDArray

from mpsdem.case import Case, CaseError
from mpsdem.results.errors import CheckpointError
from mpsdem.results.files import new_hdf5, reading, sealed_hdf5

FORMAT = "mpsdem checkpoint"
FORMAT_VERSION = 1

State: TypeAlias = Mapping[str, "NDArray[Any] | int | float | bool | str | State"]

MAY_DIFFER = ("title", "end_time", "output", "fidelity.threads")
"""Keys of a case that do not touch the numbers of a step, so a run may continue with others."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Checkpoint:
    """What a run was at one instant.

    Parameters
    ----------
    case_toml : str
        The case, every default written out.
    time : float
        Simulated time [s].
    step : int
        Number of coupling steps done.
    state : nested mapping
        Arrays and numbers of every stage, bit by bit.
    """

    case_toml: str
    time: float
    step: int
    state: dict[str, Any]


def write_checkpoint(
    path: str | os.PathLike[str], *, case_toml: str, time: float, step: int, state: State
) -> None:
    """Write a checkpoint that is at every instant either the old one or the new one, whole.

    Parameters
    ----------
    path : path-like
        The file; its directory exists.
    case_toml : str
        The case, every default written out.
    time : float
        Simulated time [s].
    step : int
        Number of coupling steps done.
    state : nested mapping of str to ndarray, int, float, bool or str
        What the run needs to go on.

    Raises
    ------
    OutputError
        If it cannot be written; the checkpoint before it is then untouched.
    """
    with new_hdf5(Path(path), seal=True) as file:
        file.attrs["format"] = FORMAT
        file.attrs["format_version"] = FORMAT_VERSION
        file.attrs["time"] = time
        file.attrs["step"] = step
        file["case"] = case_toml
        _write(file.create_group("state"), state)


def read_checkpoint(path: str | os.PathLike[str], case: Case | None = None) -> Checkpoint:
    """Read a checkpoint, and refuse one of another case.

    Parameters
    ----------
    path : path-like
        The file.
    case : Case, optional
        The case to continue; it may differ from the checkpoint's in the keys of `MAY_DIFFER`.

    Returns
    -------
    Checkpoint
        With arrays and numbers equal to the bit to those written.

    Raises
    ------
    CheckpointError
        If there is none, or it is damaged, or the cases differ: the message says in which keys.
    """
    path = Path(path)
    if not path.is_file():
        raise CheckpointError(f"no checkpoint at {path}: the run must start from the beginning")
    with reading(path, CheckpointError), sealed_hdf5(path) as file:
        if file.attrs.get("format") != FORMAT:
            raise CheckpointError(f"{path} is an HDF5 file, but not a checkpoint of mpsdem")
        if file.attrs["format_version"] != FORMAT_VERSION:
            raise CheckpointError(
                f"{path} has format version {file.attrs['format_version']}, this mpsdem reads "
                f"{FORMAT_VERSION}: continue with the version that wrote it"
            )
        checkpoint = Checkpoint(
            case_toml=str(file["case"].asstr()[()]),
            time=float(file.attrs["time"]),
            step=int(file.attrs["step"]),
            state=_read(file["state"]),
        )
    if case is not None:
        _refuse_another_case(path, checkpoint, case)
    return checkpoint


def _refuse_another_case(path: Path, checkpoint: Checkpoint, case: Case) -> None:
    try:
        started = Case.from_toml(checkpoint.case_toml)
    except CaseError as error:
        raise CheckpointError(f"{path} holds a case of another version: {error}") from error
    differences = [
        difference
        for difference in started.differences(case)
        if not any(f"{difference.split(':')[0]}.".startswith(f"{key}.") for key in MAY_DIFFER)
    ]
    if differences:
        raise CheckpointError(
            f"{path} is of another case and cannot be continued with this one; "
            "they differ in (checkpoint != case)\n  " + "\n  ".join(differences)
        )


def _write(group: h5py.Group, state: State) -> None:
    for name, value in state.items():
        if isinstance(value, Mapping):
            _write(group.create_group(name), value)
        elif isinstance(value, np.ndarray):
            group.create_dataset(name, data=value)
        else:
            group.attrs[name] = value


def _read(group: h5py.Group) -> dict[str, Any]:
    scalars = {
        name: value.item() if isinstance(value, np.generic) else value
        for name, value in group.attrs.items()
    }
    items = {
        name: _read(item) if isinstance(item, h5py.Group) else item[()]
        for name, item in group.items()
    }
    return scalars | items
