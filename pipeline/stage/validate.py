# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Checks any stage against the schemas, whoever wrote it; a large one district by district."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from itertools import chain
from pathlib import Path

from pxr import Tf, Usd, UsdUtils

from nightcity import schemas
from nightcity.errors import SceneError
from nightcity.parallel import in_order
from nightcity.payloads import loaded, open_outside
from nightcity.progress import Progress
from nightcity.stage.boxes import read_boxes
from nightcity.stage.contents import Contents, read_contents
from nightcity.stage.facts import Facts, joined, read_facts
from nightcity.stage.finding import Finding, first_line
from nightcity.stage.validate_attributes import check_names, check_ranges, check_schemas
from nightcity.stage.validate_scene import check_cities, check_grounds, check_purposes, check_units
from nightcity.stage.validate_usd import district_findings, stage_findings
from nightcity.stage.validate_whole import (
    check_building_ids,
    check_lists,
    check_media_ids,
    check_one_ground,
    check_overlaps,
    check_presence,
    check_sources,
    check_window_ids,
)
from nightcity.stage.validate_windows import check_windows

# What each prim says on its own: asked of the stage piece by piece.
CHECKS: tuple[Callable[[Contents], Iterable[Finding]], ...] = (
    check_schemas,
    check_names,
    check_ranges,
    check_windows,
    check_purposes,
    check_grounds,
    check_cities,
)
# What has to be compared across the stage.
WHOLE_CHECKS: tuple[Callable[[Facts], Iterable[Finding]], ...] = (
    check_window_ids,
    check_media_ids,
    check_overlaps,
    check_lists,
    check_sources,
    check_one_ground,
    check_building_ids,
    check_presence,
)


@dataclass(frozen=True)
class _Piece:
    """What was found in a piece of a stage, by each check and by USD's validators; its facts."""

    findings: list[list[Finding]]
    from_usd: list[Finding]
    facts: Facts


@dataclass(frozen=True)
class _District:
    """What a process needs to check one district."""

    stage: Path
    path: str


def validate_stage(path: Path) -> list[Finding]:
    """Everything found on the stage at ``path``: check by check, first those of single prims, then
    those of the whole, then USD's own validators; empty where all is well.

    A stage that cannot be opened is one finding, not an exception. Districts are checked one at a
    time, in several processes; what has to be compared between them is kept as arrays, about 100
    bytes a window.
    """
    try:
        schemas.register()
    except SceneError as unregistered:
        return [Finding("error", "", "", str(unregistered))]
    # USD also prints what it stumbles over; all of it comes back as findings.
    silence = UsdUtils.CoalescingDiagnosticDelegate()
    try:
        return _validate(path)
    finally:
        silence.TakeUncoalescedDiagnostics()


def _validate(path: Path) -> list[Finding]:
    if not path.is_file():
        return [Finding("error", "", "", f"{path}: there is no such file")]
    try:
        stage, districts = open_outside(path)
    except Tf.ErrorException as problem:
        return [Finding("error", "", "", f"{path}: USD cannot open it: {first_line(problem)}")]
    findings = list(check_units(stage))
    from_usd = [each for each in stage_findings(stage) if each.prim not in districts]
    pieces = list(_pieces(path, stage, districts))
    for by_piece in zip(*(piece.findings for piece in pieces), strict=True):
        findings += chain.from_iterable(by_piece)
    from_usd += chain.from_iterable(piece.from_usd for piece in pieces)
    whole = joined(piece.facts for piece in pieces)
    pieces.clear()
    with Progress("comparing", len(WHOLE_CHECKS)) as progress:
        for check in WHOLE_CHECKS:
            findings += check(whole)
            progress.advance()
    # USD's order changes from run to run, and it finds what is wrong outside of districts again
    # with each of them.
    return findings + sorted(set(from_usd), key=str)


def _pieces(path: Path, stage: Usd.Stage, districts: tuple[str, ...]) -> Iterator[_Piece]:
    """All of the stage in its order: districts, and what lies before, between and after them."""
    between = read_contents(stage.GetPseudoRoot(), frozenset(districts))
    yield _checked(between[0])
    work = [_District(path, district) for district in districts]
    if work:
        inside = in_order(_check_district, work, len(work), "validating districts")
        for district, after in zip(inside, between[1:], strict=True):
            yield district
            yield _checked(after)


def _check_district(district: _District) -> _Piece:
    silence = UsdUtils.CoalescingDiagnosticDelegate()
    try:
        with loaded(_opened(district.stage), district.path) as top:
            (contents,) = read_contents(top)
            return _checked(contents, list(district_findings(top)))
    finally:
        silence.TakeUncoalescedDiagnostics()


@cache
def _opened(stage: Path) -> Usd.Stage:
    """Once a process."""
    schemas.register()
    return open_outside(stage)[0]


def _checked(contents: Contents, from_usd: Iterable[Finding] = ()) -> _Piece:
    corners, faults = read_boxes(contents)
    findings = [faults, *(list(check(contents)) for check in CHECKS)]
    return _Piece(findings, list(from_usd), read_facts(contents, corners))
