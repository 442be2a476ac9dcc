# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The instances of a PointInstancer: lengths checked, transforms and masks from USD itself."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from nightcity.errors import SceneError
from nightcity.export.open_stage import Source


def instance_transforms(
    source: Source, prim: Usd.Prim, *, with_prototype: bool
) -> NDArray[np.float64]:
    """(N, 4, 4), from instance to instancer, for row vectors, at the first frame.

    with_prototype: include the transform that each prototype's root has itself.
    Raises SceneError naming the attribute whose length or content does not fit.
    """
    instancer = UsdGeom.PointInstancer(prim)
    # Without a note where they change: windows change them to show what lightOn says.
    count = len(prim.GetAttribute("protoIndices").Get(source.time) or ())
    _check_lengths(source, prim, count)
    transforms = instancer.ComputeInstanceTransformsAtTime(
        source.time,
        source.time,
        instancer.IncludeProtoXform if with_prototype else instancer.ExcludeProtoXform,
        instancer.IgnoreMask,
    )
    if len(transforms) != count:
        raise SceneError(_misfit(source, instancer, count))
    return np.array(transforms, dtype=np.float64).reshape(-1, 4, 4)


def prototype_indices(source: Source, prim: Usd.Prim) -> NDArray[np.int64]:
    """(N,) into the targets of ``prototypes``."""
    return np.array(source.value(prim, "protoIndices", ()), dtype=np.int64)


def instance_masks(
    source: Source, prim: Usd.Prim, count: int
) -> tuple[list[float], NDArray[np.bool_]]:
    """Times (T,) and, from each on, which of the instances exist and are visible (T, N)."""
    instancer = UsdGeom.PointInstancer(prim)
    times = source.change_times(instancer.GetInvisibleIdsAttr())
    masks = [instancer.ComputeMaskAtTime(Usd.TimeCode(time)) for time in times]
    rows = [np.array(mask, dtype=bool) if mask else np.ones(count, dtype=bool) for mask in masks]
    return times, np.stack(rows)


def _check_lengths(source: Source, prim: Usd.Prim, count: int) -> None:
    """USD drops these arrays with no more than a warning where their length does not fit."""
    for name in ("orientations", "orientationsf", "scales", "ids"):
        attribute = prim.GetAttribute(name)
        if not attribute or not attribute.HasAuthoredValue():
            continue
        values = source.value(prim, name, ())
        if len(values) not in (0, count):
            raise SceneError(_wrong_length(prim, name, len(values), count))


def _wrong_length(prim: Usd.Prim, name: str, length: int, count: int) -> str:
    return (
        f"{prim.GetPath()}.{name} has {length} values, but protoIndices has {count}; there must be"
        " one for each instance"
    )


def _misfit(source: Source, instancer: UsdGeom.PointInstancer, count: int) -> str:
    """Why USD computes no transforms."""
    prim = instancer.GetPrim()
    positions = len(source.value(prim, "positions", ()))
    if positions != count:
        return _wrong_length(prim, "positions", positions, count)
    indices = prototype_indices(source, prim)
    targets = len(instancer.GetPrototypesRel().GetForwardedTargets())
    return (
        f"{prim.GetPath()}: its {targets} prototypes do not fit its protoIndices, which reach from"
        f" {indices.min()} to {indices.max()}, or one of them is no prim of the stage"
    )
