# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of the stage as a whole: units, ground, what is missing, and USD's own validators."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator

import numpy as np
from pxr import Tf, UsdGeom, UsdValidation

from nightcity.stage.contents import Contents
from nightcity.stage.finding import Finding, error, first_line, warning
from nightcity.stage.values import EARLIEST, numbers

_FLAT = 1e-3  # m; twice float32's rounding at 8 km
# Packages, skeletons, physics and sound are no part of a city.
_SKIPPED = ("Usdz", "UsdSkel", "UsdPhysics", "UsdMedia")
_MENDS = {
    "UnresolvableDependency": "put the file there, or correct the path that names it",
    "CompositionError": "correct the path or the layer that it names",
    "MissingDefaultPrim": 'name the root prim in the root layer: defaultPrim = "City"',
    "MissingMetersPerUnitMetadata": (
        "without it USD takes centimetres; set metersPerUnit = 1 in the root layer if it is metres"
    ),
    "MissingUpAxisMetadata": (
        'without it USD takes Y; set upAxis = "Z" in the root layer if z is up'
    ),
    "AttributeTypeMismatch": "author it with the type that the schema states",
}


def check_units(contents: Contents) -> Iterator[Finding]:
    metres = UsdGeom.GetStageMetersPerUnit(contents.stage)
    rate = contents.stage.GetTimeCodesPerSecond()
    if not (math.isfinite(metres) and metres > 0):
        yield _stage_error("metersPerUnit", f"is {metres}; it must be above 0, 1 for metres")
    if not (math.isfinite(rate) and rate > 0):
        yield _stage_error("timeCodesPerSecond", f"is {rate}; it must be above 0, for example 24")


def check_presence(contents: Contents) -> Iterator[Finding]:
    """Without windows, haze or a camera there is a picture, but hardly one that was meant."""
    if not contents.windows and not contents.lights:
        yield _stage_warning("there are no windows: apply NightcityWindowsAPI to a PointInstancer")
    if not contents.media:
        yield _stage_warning("there is no haze: apply NightcityMediaAPI to a Cube")
    if not contents.cameras:
        yield _stage_warning("there is no camera to render from: add a Camera")


def check_city(contents: Contents) -> Iterator[Finding]:
    """The attributes of city and buildings that no range can describe."""
    for prim in contents.cities:
        text = prim.GetAttribute("nightcity:parameters").Get()
        if text and not _is_json_object(text):
            yield error(prim, "nightcity:parameters", "is no JSON object; mend it or clear it")
    first: dict[int, str] = {}
    for prim in contents.buildings:
        number, path = prim.GetAttribute("nightcity:buildingId").Get(), str(prim.GetPath())
        if number is not None and number >= 0 and first.setdefault(number, path) != path:
            yield (warning if prim.IsInstanceProxy() else error)(
                prim, "nightcity:buildingId", f"{number} is also that of {first[number]}; renumber"
            )


def check_ground(contents: Contents) -> Iterator[Finding]:
    """At most one ground, and it is horizontal."""
    axis = 1 if UsdGeom.GetStageUpAxis(contents.stage) == UsdGeom.Tokens.y else 2
    for prim in contents.grounds[1:]:
        yield error(
            prim,
            "apiSchemas",
            f"{contents.grounds[0].GetPath()} is the ground already; remove NightcityGroundAPI"
            " from one of them",
        )
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


def check_with_usd(contents: Contents) -> Iterator[Finding]:
    """What USD's own validators find, missing files among it."""
    validators = [
        validator
        for validator in UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
        if not any(
            keyword.startswith(_SKIPPED) for keyword in validator.GetMetadata().GetKeywords()
        )
    ]
    for validator in validators:
        try:
            errors = UsdValidation.ValidationContext([validator]).Validate(contents.stage)
        except Tf.ErrorException as problem:  # a layer that is broken half-way, for example
            yield _stage_error("", f"{validator.GetMetadata().name} gave up: {first_line(problem)}")
            continue
        yield from map(_translated, errors)


def _translated(found: UsdValidation.ValidationError) -> Finding:
    kind = found.GetType()
    severity = "error" if kind == UsdValidation.ValidationErrorType.Error else "warning"
    prim, attribute = _place(found)
    mend = _MENDS.get(str(found.GetName()), "")
    message = found.GetMessage().strip().rstrip(".")
    return Finding(severity, prim, attribute, f"{message}; {mend}" if mend else message)


def _place(found: UsdValidation.ValidationError) -> tuple[str, str]:
    """Prim path and attribute name of the first site that names either."""
    for site in found.GetSites():
        if not site.IsValid():
            continue
        if site.IsProperty():
            return str(site.GetProperty().GetPrim().GetPath()), site.GetProperty().GetName()
        if site.IsPrim() and not site.GetPrim().IsPseudoRoot():
            return str(site.GetPrim().GetPath()), ""
        if site.IsValidSpecInLayer():
            if spec := site.GetPropertySpec():
                return str(spec.path.GetPrimPath()), spec.name
            if spec := site.GetPrimSpec():
                return str(spec.path), ""
    return "", ""


def _is_json_object(text: str) -> bool:
    try:
        return isinstance(json.loads(text), dict)
    except (ValueError, RecursionError):
        return False


def _stage_error(attribute: str, message: str) -> Finding:
    return Finding("error", "", attribute, message)


def _stage_warning(message: str) -> Finding:
    return Finding("warning", "", "", message)
