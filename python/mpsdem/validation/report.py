"""The table that `mpsdem validate` prints."""

from __future__ import annotations

from collections.abc import Iterable

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from mpsdem.validation.registry import Check, Outcome


def report(checks: Iterable[Check], console: Console) -> list[Outcome]:
    """Run checks and print what they gave, with their sources and known differences below."""
    outcomes = []
    with console.status("checking") as status:
        for check in checks:
            status.update(escape(check.id))
            outcomes.append(check.run())
    console.print(table(outcomes))
    sources = {outcome.check.source for outcome in outcomes}
    for source in sorted(sources, key=lambda source: source.cite):
        if source.reference:
            _say(console, f"{source.cite}: {source.reference}")
    for reason in dict.fromkeys(outcome.check.differs for outcome in outcomes):
        if reason:
            _say(console, f"differs: {reason}")
    agree = sum(outcome.agrees for outcome in outcomes)
    fail = sum(outcome.failed for outcome in outcomes)
    known = len(outcomes) - agree - fail
    _say(console, f"{agree} agree, {fail} fail, {known} are known to differ")
    return outcomes


def table(outcomes: Iterable[Outcome]) -> Table:
    """One row per outcome."""
    rows = Table(box=None, pad_edge=False, header_style="dim")
    rows.add_column("", no_wrap=True)
    rows.add_column("id", overflow="fold")
    for heading in ("expected", "got", "error", "tolerance"):
        rows.add_column(heading, justify="right", no_wrap=True)
    rows.add_column("unit", no_wrap=True)
    rows.add_column("source", overflow="fold")
    for outcome in outcomes:
        check = outcome.check
        rows.add_row(
            _mark(outcome),
            escape(check.id),
            f"{check.expected:.5g}",
            f"{outcome.got:.5g}",
            f"{outcome.error:+.2%}" if check.relative else f"{outcome.error:+.1e}",
            f"{100 * check.relative:.3g}%" if check.relative else f"{check.absolute:.1e}",
            check.unit,
            escape(check.source.cite),
        )
    return rows


def _mark(outcome: Outcome) -> str:
    if outcome.agrees:
        return "[green]agrees[/]"
    return "[bold red]fails[/]" if outcome.failed else "[yellow]differs[/]"


def _say(console: Console, text: str) -> None:
    console.print(text, soft_wrap=True, markup=False, highlight=False)
