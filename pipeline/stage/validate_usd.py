# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What USD's own validators find, missing files among it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from pxr import Tf, Usd, UsdValidation

from nightcity.stage.contents import CHILDREN
from nightcity.stage.finding import Finding, first_line

# Packages, skeletons, physics and sound are no part of a city.
_SKIPPED = ("Usdz", "UsdSkel", "UsdPhysics", "UsdMedia")
_COMPOSITION = "usdValidation:CompositionErrorTest"
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

_Validate = Callable[[UsdValidation.ValidationContext], list[UsdValidation.ValidationError]]


def stage_findings(stage: Usd.Stage) -> Iterator[Finding]:
    """Of the stage as a whole, every file that it names, and the prims that are loaded."""
    for validator in _validators():
        yield from _found(validator, lambda context: context.Validate(stage, CHILDREN))


def district_findings(top: Usd.Prim) -> Iterator[Finding]:
    """Of the prims of a loaded district, and of how the stage composes with it."""
    prims = Usd.PrimRange(top, CHILDREN)
    for validator in _validators():
        if validator.GetMetadata().name == _COMPOSITION:
            yield from _found(validator, lambda context: context.Validate(top.GetStage()))
        else:
            yield from _found(validator, lambda context: context.Validate(prims))


def _validators() -> list[UsdValidation.Validator]:
    return [
        validator
        for validator in UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
        if not any(
            keyword.startswith(_SKIPPED) for keyword in validator.GetMetadata().GetKeywords()
        )
    ]


def _found(validator: UsdValidation.Validator, validate: _Validate) -> Iterator[Finding]:
    try:
        errors = validate(UsdValidation.ValidationContext([validator]))
    except Tf.ErrorException as problem:  # a layer that is broken half-way, for example
        message = f"{validator.GetMetadata().name} gave up: {first_line(problem)}"
        yield Finding("error", "", "", message)
        return
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
