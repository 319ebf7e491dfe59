"""Speed against accuracy: what each knob of the fidelity costs, and how far it moves the results.

`trade` measures that for a case. ``table.json`` holds it for scenes with a known answer and for
the two reference cases; by it `choose` finds the fidelity for a budget, or for an error.
"""

from __future__ import annotations

from mpsdem.trade.choice import Candidate, choose, expectation, seconds_of, share_of
from mpsdem.trade.outcome import Outcome, Row, front
from mpsdem.trade.report import report_rows
from mpsdem.trade.trading import trade

__all__ = [
    "Candidate",
    "Outcome",
    "Row",
    "choose",
    "expectation",
    "front",
    "report_rows",
    "seconds_of",
    "share_of",
    "trade",
]
