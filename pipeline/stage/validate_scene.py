# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of units, of cities, of grounds and of the purpose of boxes, each on its own."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator

import numpy as np
from pxr import Usd, UsdGeom

from nightcity.stage.contents import Contents
from nightcity.stage.finding import Finding, error, warning
from nightcity.stage.values import EARLIEST, numbers

_FLAT = 1e-3  # m; twice float32's rounding at 8 km


def check_units(stage: Usd.Stage) -> Iterator[Finding]:
    metres = UsdGeom.GetStageMetersPerUnit(stage)
    rate = stage.GetTimeCodesPerSecond()
    if not (math.isfinite(metres) and metres > 0):
        message = f"is {metres}; it must be above 0, 1 for metres"
        yield Finding("error", "", "metersPerUnit", message)
    if not (math.isfinite(rate) and rate > 0):
        message = f"is {rate}; it must be above 0, for example 24"
        yield Finding("error", "", "timeCodesPerSecond", message)


def check_cities(contents: Contents) -> Iterator[Finding]:
    """The attributes of a city that no range can describe."""
    for prim in contents.cities:
        text = prim.GetAttribute("nightcity:parameters").Get()
        if text and not _is_json_object(text):
            yield error(prim, "nightcity:parameters", "is no JSON object; mend it or clear it")


def check_grounds(contents: Contents) -> Iterator[Finding]:
    """A ground is horizontal."""
    axis = 1 if UsdGeom.GetStageUpAxis(contents.stage) == UsdGeom.Tokens.y else 2
    for prim in contents.grounds:
        points = numbers(prim, "points").reshape(-1, 3)
        if len(points) == 0:
            yield error(prim, "points", "a ground needs a mesh with at least one face; add it")
            continue
        matrix = np.array(UsdGeom.XformCache(EARLIEST).GetLocalToWorldTransform(prim))
        heights = contents.metres * (points @ matrix[:3, axis] + matrix[3, axis])
        if not np.ptp(heights) <= _FLAT:  # also where they are not finite
            yield error(
                prim,
                "points",
                f"a ground is horizontal, but this one's height goes from {heights.min():g} to"
                f" {heights.max():g} m; level it, or remove NightcityGroundAPI",
            )


def check_purposes(contents: Contents) -> Iterator[Finding]:
    """Boxes of haze are rendered."""
    for prim in contents.media:
        purpose = UsdGeom.Imageable(prim).ComputePurpose()
        if purpose not in ("default", "render"):
            yield warning(
                prim, "purpose", f"is {purpose}, so the box is not rendered; make it render"
            )


def _is_json_object(text: str) -> bool:
    try:
        return isinstance(json.loads(text), dict)
    except (ValueError, RecursionError):
        return False
