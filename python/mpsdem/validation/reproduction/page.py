"""Tables of statements, in Markdown."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from mpsdem.validation.reproduction.measured import Measured
from mpsdem.validation.reproduction.scene import Scene
from mpsdem.validation.reproduction.statement import Scenes, Statement


def table(statements: Sequence[Statement], of: Mapping[str, Scenes]) -> str:
    """One row a statement: what it says, what was measured at each spacing, whether it holds.

    Parameters
    ----------
    statements : sequence of Statement
        The rows.
    of : mapping of str to scenes
        By the name of the fidelity, in the order of the columns; those without any run of these
        statements are left out.
    """
    needed = {name for statement in statements for name in statement.scenes}
    of = {level: scenes for level, scenes in of.items() if needed & scenes.keys()}
    lines = [
        f"| said | measured | holds if | {' | '.join(f'{level} | holds' for level in of)} |",
        "|---" * (3 + 2 * len(of)) + "|",
    ]
    for statement in statements:
        cells = [statement.claim, statement.number, _bounds(statement)]
        for scenes in of.values():
            if all(name in scenes for name in statement.scenes):
                measured = statement.measure(scenes)
                cells += [number(measured), f"**{statement.verdict(measured)}**"]
            else:
                cells += ["", ""]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def number(measured: Measured) -> str:
    """A number with as many digits as its error allows."""
    mean, error = measured.mean, measured.error
    if math.isnan(error):
        return f"{mean:.3g}"
    if not error:
        return f"{mean:.3g} +- 0"
    digits = max(0, 1 - math.floor(math.log10(error)))
    return f"{mean:.{digits}f} +- {error:.{digits}f}"


def costs(of: Mapping[str, Mapping[str, Scene]]) -> str:
    """CPU seconds of the first run of every scene, in Markdown."""
    lines = ["| run | fidelity | end | CPU s |", "|---|---|---|---|"]
    for level, scenes in of.items():
        for name, scene in scenes.items():
            run = scene.starts[0]
            spent = run.summary.get("cpu_seconds", math.nan)
            lines.append(f"| {name} | {level} | {run.time[-1]:g} s | {spent:.0f} |")
    return "\n".join(lines) + "\n"


def _bounds(statement: Statement) -> str:
    low, high = statement.at_least, statement.at_most
    if math.isinf(high):
        return f">= {low:.3g}"
    return f"<= {high:.3g}" if math.isinf(low) else f"{low:.3g} to {high:.3g}"
