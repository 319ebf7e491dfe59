"""The runs that the statements are read from: made where they are missing, else read."""

from __future__ import annotations

from pathlib import Path

from mpsdem.case import Case, load_case
from mpsdem.results import Results
from mpsdem.simulation import Simulation
from mpsdem.validation.reproduction.horizontal import SCENE
from mpsdem.validation.reproduction.inclined import SIDEWAYS, STILL, UPRIGHT
from mpsdem.validation.reproduction.scene import Scene

LEVELS = ("quick", "balanced")

_GAPS = (0.005, 0.006, 0.007)  # of the block [diameters]: starts that differ by a thousandth
_INSTANTS_END = 5.0  # [s] of the further starts: the last instant that the paper speaks of singly
_INCLINED_END = {"balanced": 6.0}  # [s] three periods after they have settled
SETTLED = 3.0  # [s] from which on the solids of case B have come to rest on the wall


def cases(level: str, folder: Path) -> dict[str, Case]:
    """All runs at one fidelity, by the names of their directories.

    Parameters
    ----------
    level : {"quick", "balanced"}
        Of fidelity.
    folder : Path
        Where the case files are.
    """
    numerics = {"fidelity": {"level": level, "threads": 1}, "output": {"figures": False}}
    horizontal = load_case(folder / f"{SCENE}.toml").with_(**numerics)
    assert horizontal.solids is not None
    found = {f"{SCENE}_{level}": horizontal}
    for number, gap in enumerate(_GAPS[1:], start=2):
        block = horizontal.solids.arrangement.model_copy(update={"gap": gap})
        found[f"{SCENE}+{number}_{level}"] = horizontal.with_(
            end_time=_INSTANTS_END,
            solids={"arrangement": block.model_dump()},
            output={"times": [0.0, 1.0, 2.0, 5.0]},
        )
    for name in (STILL, SIDEWAYS, UPRIGHT):
        case = load_case(folder / f"{name}.toml").with_(**numerics)
        end = _INCLINED_END.get(level, case.end_time)
        times = [time for time in case.output.times or () if time <= end]
        found[f"{name}_{level}"] = case.with_(end_time=end, output={"times": times})
    return found


def scenes(level: str, directory: Path, folder: Path, *, make: bool = True) -> dict[str, Scene]:
    """Read the runs of one fidelity, and make those that are missing.

    Parameters
    ----------
    level : {"quick", "balanced"}
        Of fidelity.
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
    """
    found: dict[str, list[Results]] = {}
    for name, case in cases(level, folder).items():
        where = directory / name
        if not (where / "summary.json").exists():
            if not make:
                continue
            Simulation(case, where, overwrite=True).run().close()
        found.setdefault(name.split("_" + level)[0].split("+")[0], []).append(Results(where))
    return {
        name: Scene(*runs, since=0.0 if name == SCENE else SETTLED) for name, runs in found.items()
    }
