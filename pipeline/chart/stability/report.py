# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity chart --stability``: a table and a picture a sweep, and the table of the cases."""

from __future__ import annotations

import csv
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from nightcity.chart.stability.lab import Lab
from nightcity.chart.stability.methods import METHODS, choose_methods
from nightcity.chart.stability.pictures import draw
from nightcity.chart.stability.suite import CASES, PLANTED, SWEEPS, Case
from nightcity.chart.stability.sweep import Outcome, Sweep, run
from nightcity.progress import Progress

Outcomes = Mapping[str, Sequence[Outcome]]  # by the name of the sweep


def chart_stability(output: Path, methods: list[str] | None, quick: bool) -> list[Path]:
    """Run all sweeps with the methods named (default: all that the renderer knows); returns the
    files written: NAME.csv, NAME.svg and NAME.png a sweep, and stability.md."""
    chosen = choose_methods(methods)
    output.mkdir(parents=True, exist_ok=True)
    outcomes: dict[str, list[Outcome]] = {}
    paths = []
    work = [[name for name in chosen if name in sweep.methods] for sweep in SWEEPS]
    with Progress("stability", sum(map(len, work))) as progress:
        for sweep, names in zip(SWEEPS, work, strict=True):
            outcomes[sweep.name] = _outcomes(sweep, names, quick, progress)
            if outcomes[sweep.name]:
                paths += _write(sweep, outcomes[sweep.name], output / sweep.name)
    table = output / "stability.md"
    table.write_text(markdown(outcomes, chosen))
    return [*paths, table]


def _outcomes(sweep: Sweep, names: list[str], quick: bool, progress: Progress) -> list[Outcome]:
    outcomes = []
    with tempfile.TemporaryDirectory() as folder:
        lab = Lab(Path(folder))
        for name in names:
            outcome = run(sweep, lab, METHODS[name], quick)
            outcomes += [outcome] if outcome else []
            progress.advance()
    return outcomes


def _write(sweep: Sweep, outcomes: Sequence[Outcome], stem: Path) -> list[Path]:
    table = stem.with_suffix(".csv")
    with table.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow([sweep.axis.label, "method", "relative error", "standard error"]
                      + ["beyond noise", "bar"])  # fmt: skip
        for outcome in outcomes:
            errors = outcome.errors
            columns = (outcome.points, errors.error, errors.noise, errors.beyond_noise)
            for point, error, noise, beyond in zip(*columns, strict=True):
                rows.writerow(
                    [f"{point:.9g}", outcome.method, f"{error:.6g}", f"{noise:.3g}"]
                    + [f"{beyond:.6g}", f"{sweep.bar:g}"]
                )
    return [table, *draw(sweep, outcomes, stem)]


def markdown(outcomes: Outcomes, methods: Sequence[str]) -> str:
    """The table of the cases: of each sweep and method the worst error beyond noise."""
    lines = [
        "| case | sweep | bar | " + " | ".join(f"`{name}`" for name in methods) + " |",
        "|---|---|---|" + "---|" * len(methods),
    ]
    for number, case in [*enumerate(CASES, 1), ("", PLANTED)]:
        lines += _rows(number, case, outcomes, methods)
    return "\n".join([*lines, "", *_causes(outcomes), ""])


def _rows(number: int | str, case: Case, outcomes: Outcomes, methods: Sequence[str]) -> list[str]:
    rows = []
    title = f"{number} {case.what}".strip()
    for name in case.sweeps:
        found = {outcome.method: outcome for outcome in outcomes[name]}
        cells = [_cell(found[m]) if m in found else "-" for m in methods]
        bar = next(sweep.bar for sweep in SWEEPS if sweep.name == name)
        rows.append(f"| {title} | {name} | {bar:g} | " + " | ".join(cells) + " |")
        title = ""
    if case.elsewhere:
        rows.append(f"| {title} | {case.elsewhere} | " + " | " * len(methods) + "|")
    return rows


def _cell(outcome: Outcome) -> str:
    if outcome.sweep.must_notice:
        return "noticed" if outcome.holds else "**NOT NOTICED**"
    number = f"{outcome.errors.worst:.2g}"
    if outcome.holds:
        return number
    known = outcome.method in outcome.sweep.failures
    return f"**{number}**" if known else f"**{number} UNEXPECTED**"


def _causes(outcomes: Outcomes) -> list[str]:
    """What failed, and why."""
    lines = []
    for name, found in outcomes.items():
        for outcome in found:
            failure = outcome.sweep.failures.get(outcome.method)
            if outcome.fault:
                lines.append(f"* `{outcome.method}`, {name}: {outcome.fault}")
            elif not outcome.holds and failure:
                lines.append(f"* `{outcome.method}`, {name}: {failure.cause}.")
        note = found[0].sweep.note if found else ""
        if note:
            lines.append(f"* {name}: {note}")
    return lines
