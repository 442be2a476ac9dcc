# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Checks any stage against the schemas, whoever wrote it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from pxr import Tf, Usd, UsdUtils

from nightcity import schemas
from nightcity.errors import SceneError
from nightcity.progress import Progress
from nightcity.stage.contents import Contents, read_contents
from nightcity.stage.finding import Finding, first_line
from nightcity.stage.validate_attributes import check_names, check_ranges, check_schemas
from nightcity.stage.validate_media import check_media
from nightcity.stage.validate_scene import (
    check_city,
    check_ground,
    check_presence,
    check_units,
    check_with_usd,
)
from nightcity.stage.validate_windows import check_windows

CHECKS: tuple[Callable[[Contents], Iterable[Finding]], ...] = (
    check_units,
    check_schemas,
    check_names,
    check_ranges,
    check_windows,
    check_media,
    check_ground,
    check_city,
    check_presence,
    check_with_usd,
)


def validate_stage(path: Path) -> list[Finding]:
    """Everything found on the stage at ``path``, in the order of CHECKS; empty where all is well.

    A stage that cannot be opened is one finding, not an exception.
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
        stage = Usd.Stage.Open(str(path), Usd.Stage.LoadAll)
    except Tf.ErrorException as problem:
        return [Finding("error", "", "", f"{path}: USD cannot open it: {first_line(problem)}")]
    contents = read_contents(stage)
    findings: list[Finding] = []
    with Progress("validating", len(CHECKS)) as progress:
        for check in CHECKS:
            findings += check(contents)
            progress.advance()
    return findings
