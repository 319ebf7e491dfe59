"""How a long run drifts: ``python -m mpsdem.validation.long_run RUN``.

Runs case A for 200 s at ``quick``, about seven minutes, unless the directory RUN holds it, and
writes docs/long_run.md and docs/long_run.png.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from rich.console import Console

from mpsdem import Results, Simulation, load_case
from mpsdem.analysis import Ledgers, ledgers, time_average
from mpsdem.plot import ledger_history

CASE = Path("cases", "horizontal_pipe.toml")
PAGE = Path("docs", "long_run.md")
_SECONDS, _WINDOW, _EVERY = 200.0, 40.0, 0.5  # [s]

_out = Console(soft_wrap=True, markup=False, highlight=False)


def page(results: Results) -> str:
    """The page in Markdown."""
    return "\n".join(_lines(results)) + "\n"


def _lines(results: Results) -> Iterator[str]:
    kept = ledgers(results)
    yield "# A long run: what drifts"
    yield ""
    yield f"Written by `python -m {__spec__.name} RUN`: case A (`{CASE}`) for"
    yield f"{results.time[-1]:g} s at `quick`, {results.summary['steps']} steps and"
    yield f"{results.summary['solid_steps']} of the solids,"
    yield f"{results.summary['cpu_seconds']:.0f} s of computing."
    yield ""
    yield f"![mass, momentum and energy over {results.time[-1]:g} s]({PAGE.stem}.png)"
    yield ""
    yield "Momentum is that of the liquid along the pipe, over what the walls took in the window;"
    yield "*given back* is what convection between solids lost, which the step returns; *stored* is"
    yield "energy put in less energy dissipated since the start, over what was put in. ± is one"
    yield "standard error."
    yield ""
    yield (
        "| window (s) | loss of pressure (Pa/m) | solids (m/s) | unexplained (%) | given back (%) "
        "| volume | exchange | stored (%) |"
    )
    yield "|---|---|---|---|---|---|---|---|"
    for begin in np.arange(0.0, results.time[-1] - _WINDOW / 2, _WINDOW):
        yield _row(results, kept, begin, begin + _WINDOW)


def _row(results: Results, kept: Ledgers, begin: float, end: float) -> str:
    first, last = np.searchsorted(kept.time, [begin, end - 1e-9])
    last = min(last, len(kept.time) - 1)

    def share(of: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> str:
        return f"{100 * (of[last] - of[first]) / (kept.friction[last] - kept.friction[first]):+.3f}"

    means = [
        time_average(results.time, values, window=(kept.time[first], kept.time[last]))
        for values in (results.pressure_gradient, results.diagnostics["solids_mean_velocity"])
    ]
    cells = [
        f"{begin:g} to {end:g}",
        f"{means[0].mean:.1f} ± {means[0].error:.1f}",
        f"{means[1].mean:.3f} ± {means[1].error:.3f}",
        share(kept.unexplained),
        share(kept.given_back),
        f"{kept.volume_error[last]:.1e}",
        f"{kept.exchange_error[last]:.1e}",
        f"{100 * kept.stored[last] / kept.put_in[last]:+.2f}",
    ]
    return f"| {' | '.join(cells)} |"


def main(arguments: list[str]) -> int:
    """Run, or read the run, and write the page."""
    if len(arguments) != 1:
        _out.print(f"usage: python -m {__spec__.name} RUN_DIRECTORY")
        return 2
    directory = Path(arguments[0])
    if not (directory / "summary.json").exists():
        case = load_case(CASE).with_(
            end_time=_SECONDS,
            fidelity={"level": "quick"},
            output={"every": _EVERY, "figures": False, "times": []},
        )
        Simulation(case, directory, overwrite=True).run()
    results = Results(directory)
    text = page(results)
    _out.print(text)
    PAGE.write_text(text, "utf-8")
    ledger_history(results).savefig(PAGE.with_suffix(".png"), dpi=130)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
