"""How far the program goes: runs at the extremes of all that a case may say.

``python -m mpsdem.validation.extremes`` runs all of them in less than ten minutes of one core, and
writes ``docs/extremes.md``; with the beginnings of rows' names it runs these, and prints them.
"""

from mpsdem.validation.extremes.measure import Figures, doubts, faults, measure
from mpsdem.validation.extremes.rows import Row, rows
from mpsdem.validation.extremes.run import Came, run_row, run_rows, timed
from mpsdem.validation.extremes.table import markdown

__all__ = [
    "Came",
    "Figures",
    "Row",
    "doubts",
    "faults",
    "markdown",
    "measure",
    "rows",
    "run_row",
    "run_rows",
    "timed",
]
