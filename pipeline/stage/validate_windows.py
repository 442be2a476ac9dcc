# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of single instancers: lengths of arrays, ids, and what viewers show of the lit ones."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from pxr import Usd, UsdGeom, UsdShade

from nightcity.stage.contents import Contents
from nightcity.stage.finding import Finding, error, warning
from nightcity.stage.values import as_numbers, at, numbers, samples

_LARGEST_ID = 2**31 - 1  # nightcity:windowLights holds 32-bit integers
_SHORTEST = 0.5  # length of a quaternion that still says what rotation is meant
_ALIKE = 0.01  # two quaternions of one rotation; half precision rounds to 0.0005
# Which arrays may have other lengths than one value an instance.
_LENGTHS = {
    "positions": (),
    "ids": (0,),
    "orientations": (0,),
    "orientationsf": (0,),
    "scales": (0,),
    "nightcity:lightOn": (0, 1),
    "nightcity:power": (1,),
    "nightcity:color": (1,),
}
_FINITE = ("positions", "orientations", "orientationsf", "scales")


def check_windows(contents: Contents) -> Iterator[Finding]:
    """Each instancer on its own."""
    shines = _Shines(contents.stage)
    for prim in contents.windows:
        wrong = list(_check_arrays(prim))
        yield from wrong
        if not wrong:
            yield from _check_prototypes(prim, shines)
            yield from _check_orientations(prim)
        yield from _check_ids(prim)


def _check_arrays(prim: Usd.Prim) -> Iterator[Finding]:
    count = len(numbers(prim, "protoIndices"))
    if count == 0 and not prim.GetAttribute("protoIndices").HasAuthoredValue():
        yield error(prim, "protoIndices", "must be set: it says how many windows there are")
        return
    for name, others in _LENGTHS.items():
        for time, value in [*samples(prim, name)] or [(Usd.TimeCode.Default(), ())]:
            length = len(as_numbers(value))
            if length != count and length not in others:
                also = "".join(f", or {other}" for other in others)
                yield error(
                    prim,
                    name,
                    f"has {length} values{at(time)}, but protoIndices has {count};"
                    f" give it {count}{also}",
                )
                break
    for name in _FINITE:
        if any(not np.isfinite(as_numbers(value)).all() for _, value in samples(prim, name)):
            yield error(prim, name, "holds values that are not finite; replace them")
    if (numbers(prim, "scales") == 0).any():
        yield error(prim, "scales", "holds 0, which leaves no window; make it invisible instead")


def _check_prototypes(prim: Usd.Prim, shines: _Shines) -> Iterator[Finding]:
    targets = prim.GetRelationship("prototypes").GetForwardedTargets()
    missing = [str(target) for target in targets if not prim.GetStage().GetPrimAtPath(target)]
    if missing:
        yield error(prim, "prototypes", f"there is no prim {missing[0]}; correct the path")
        return
    looks = np.array([shines.looks(str(target)) for target in targets], dtype=np.int64)
    names = ("protoIndices", "nightcity:lightOn")
    times = {time.GetValue() for name in names for time, _ in samples(prim, name)}
    for value in sorted(times):
        time = Usd.TimeCode.Default() if math.isnan(value) else Usd.TimeCode(value)
        indices = numbers(prim, "protoIndices", time, np.int64)
        if len(indices) and (indices.min() < 0 or indices.max() >= len(targets)):
            yield error(
                prim,
                "protoIndices",
                f"goes from {indices.min()} to {indices.max()}, but there are {len(targets)}"
                " prototypes, counted from 0",
            )
            return
        lit = numbers(prim, "nightcity:lightOn", time, bool)
        lit = lit if len(lit) else np.ones(1, bool)
        wrong = int((looks[indices] == np.where(lit, _Shines.DARK, _Shines.LIT)).sum())
        if wrong:
            yield warning(
                prim,
                "protoIndices",
                f"shows {wrong} of {len(indices)} windows other than nightcity:lightOn has"
                f" them{at(time)}; viewers show the one, the renderer the other: set protoIndices"
                " to a dark prototype where lightOn is false and to a lit one where it is true",
            )
            return


def _check_orientations(prim: Usd.Prim) -> Iterator[Finding]:
    """Both precisions of the orientations, where both are there, are the same rotations."""
    full, half = (numbers(prim, name) for name in ("orientationsf", "orientations"))
    for name, values in (("orientationsf", full), ("orientations", half)):
        if len(values) and (np.linalg.norm(values, axis=1) < _SHORTEST).any():
            yield error(prim, name, "holds quaternions that are no rotations; give them length 1")
            return
    if len(full) and len(full) == len(half):
        apart = np.minimum(np.abs(full - half).max(axis=1), np.abs(full + half).max(axis=1))
        count = int((apart > _ALIKE).sum())
        if count:
            yield warning(
                prim,
                "orientations",
                f"differs from orientationsf, which USD prefers, for {count} windows;"
                " set both, or block orientationsf",
            )


def _check_ids(prim: Usd.Prim) -> Iterator[Finding]:
    """Ids are there and in range."""
    ids = numbers(prim, "ids", dtype=np.int64)
    if len(ids) == 0 and len(numbers(prim, "protoIndices")):
        yield warning(prim, "ids", "is empty, so no media box can list these windows; number them")
    if len(ids) and (ids.min() < 0 or ids.max() > _LARGEST_ID):
        yield error(prim, "ids", f"must lie in 0 to {_LARGEST_ID}")


class _Shines:
    """Whether a prototype's material emits light, found once each."""

    UNKNOWN, DARK, LIT = 0, 1, 2

    def __init__(self, stage: Usd.Stage) -> None:
        self._stage = stage
        self._looks: dict[str, int] = {}

    def looks(self, path: str) -> int:
        """LIT, DARK, or UNKNOWN where nothing below the prim has a UsdPreviewSurface."""
        if path not in self._looks:
            self._looks[path] = self._find(self._stage.GetPrimAtPath(path))
        return self._looks[path]

    def _find(self, top: Usd.Prim) -> int:
        looks = self.UNKNOWN
        for prim in Usd.PrimRange(top, Usd.PrimIsActive & Usd.PrimIsDefined):
            if not prim.IsA(UsdGeom.Gprim):
                continue
            material = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0]
            surface = material.ComputeSurfaceSource()[0] if material else None
            if not surface or surface.GetShaderId() != "UsdPreviewSurface":
                continue
            emission = surface.GetInput("emissiveColor")
            if emission and (emission.HasConnectedSource() or any(emission.Get() or ())):
                return self.LIT
            looks = self.DARK
        return looks
