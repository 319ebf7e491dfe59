"""The runs that the statements are read from: made where they are missing, else read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from mpsdem.case import Case, load_case
from mpsdem.results import Results, ResultsError
from mpsdem.simulation import Simulation
from mpsdem.validation.reproduction import reasons
from mpsdem.validation.reproduction.horizontal import SCENE
from mpsdem.validation.reproduction.inclined import SIDEWAYS, STILL, UPRIGHT
from mpsdem.validation.reproduction.scene import Scene

FINEST = "finest"  # the paper's spacing; over an hour of CPU time, so made only if asked for

#: Spacings by the name of their column; how many fit across the bore.
LEVELS: Mapping[str, dict[str, Any]] = MappingProxyType(
    {
        "quick": {"level": "quick"},
        "balanced": {"level": "balanced"},
        FINEST: {"level": "balanced", "particle_spacing": 0.0075},
    }
)

SETTLED = 3.0  # [s] from which on the solids of case B have come to rest on the wall

_GAPS = (0.005, 0.006, 0.007)  # of the block [diameters]: starts that differ by a thousandth
_INSTANTS_END = 5.0  # [s] of the further starts: the last instant that the paper speaks of singly
_MAY_DIFFER = ("title", "end_time", "output", "fidelity.threads")


def cases(level: str, folder: Path) -> dict[str, Case]:
    """All runs at one spacing, by the names of their directories.

    Parameters
    ----------
    level : str
        A key of `LEVELS`.
    folder : Path
        Where the case files are.
    """
    numerics = {"fidelity": LEVELS[level] | {"threads": 1}, "output": {"figures": False}}
    shipped = {
        name: load_case(folder / f"{name}.toml").with_(**numerics)
        for name in (SCENE, STILL, SIDEWAYS, UPRIGHT)
    }
    found = {SCENE: shipped[SCENE]}
    if level != FINEST:
        found |= dict(_starts(shipped[SCENE]))
        found |= {name: shipped[name] for name in (STILL, SIDEWAYS, UPRIGHT)}
    if level == reasons.LEVEL:
        for name, (of, changes) in reasons.VARIANTS.items():
            found[name] = _until(shipped[of], changes["end_time"]).with_(**changes)
    return {f"{name}_{level}": case for name, case in found.items()}


def scenes(level: str, directory: Path, folder: Path, *, make: bool = True) -> dict[str, Scene]:
    """Read the runs of one spacing, and make those that are missing.

    Parameters
    ----------
    level : str
        A key of `LEVELS`.
    directory : Path
        Where the runs are, one a directory.
    folder : Path
        Where the case files are.
    make : bool
        Whether missing runs are made; else they are left out.

    Returns
    -------
    dict of str to Scene
        By the name of the case.

    Raises
    ------
    ResultsError
        If a directory holds a run of another case.
    """
    found: dict[str, list[Results]] = {}
    for name, case in cases(level, folder).items():
        where = directory / name
        if not _finished(where):
            if not make:
                continue
            Simulation(case, where, overwrite=True).run().close()
        results = Results(where)
        _refuse_another_case(results, case)
        found.setdefault(name.removesuffix(f"_{level}").split("+")[0], []).append(results)
    return {
        name: Scene(*runs, since=0.0 if _level_pipe(runs[0]) else SETTLED)
        for name, runs in found.items()
    }


def _starts(case: Case) -> Iterator[tuple[str, Case]]:
    assert case.solids is not None
    for number, gap in enumerate(_GAPS[1:], start=2):
        block = case.solids.arrangement.model_copy(update={"gap": gap})
        solids = {"arrangement": block.model_dump()}
        yield f"{SCENE}+{number}", _until(case, _INSTANTS_END).with_(solids=solids)


def _until(case: Case, end_time: float) -> Case:
    times = [time for time in case.output.times or () if time <= end_time]
    return case.with_(end_time=end_time, output={"times": times})


def _finished(where: Path) -> bool:
    if not (where / "summary.json").exists():
        return False
    with Results(where) as results:
        return results.summary.get("status") == "finished"


def _refuse_another_case(results: Results, case: Case) -> None:
    differences = [
        difference
        for difference in results.case.differences(case)
        if not any(f"{difference.split(':')[0]}.".startswith(f"{key}.") for key in _MAY_DIFFER)
        and not difference.endswith("!= 'auto'")  # what it became may be asked for
    ]
    if differences or results.case.end_time < case.end_time:
        raise ResultsError(
            f"{results.directory} holds another case than is asked for: remove it, or choose "
            "another directory\n  " + "\n  ".join(differences or ["it ends earlier"])
        )


def _level_pipe(results: Results) -> bool:
    return results.case.pipe.inclination == 0
