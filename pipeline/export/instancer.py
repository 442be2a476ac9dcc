# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The instances of a PointInstancer: lengths checked, transforms and masks from USD itself."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from nightcity.errors import SceneError
from nightcity.export.open_stage import Source
from nightcity.export.timeline import change_times


def instance_transforms(
    source: Source, prim: Usd.Prim, *, with_prototype: bool
) -> NDArray[np.float64]:
    """(N, 4, 4), from instance to instancer, for row vectors, at the first frame.

    with_prototype: include the transform that each prototype's root has itself.
    Raises SceneError naming the attribute whose length or content does not fit.
    """
    instancer = UsdGeom.PointInstancer(prim)
    count = _checked_count(source, instancer)
    if count == 0:
        return np.empty((0, 4, 4))
    transforms = instancer.ComputeInstanceTransformsAtTime(
        source.time,
        source.time,
        instancer.IncludeProtoXform if with_prototype else instancer.ExcludeProtoXform,
        instancer.IgnoreMask,
    )
    if transforms is None or len(transforms) != count:
        raise SceneError(
            f"{prim.GetPath()}: USD cannot compute the transforms of its instances;"
            " check prototypes and protoIndices"
        )
    return np.array(transforms, dtype=np.float64)


def prototype_indices(source: Source, prim: Usd.Prim) -> NDArray[np.int64]:
    """(N,) into the targets of ``prototypes``."""
    indices = prim.GetAttribute("protoIndices").Get(source.time)
    return np.array(indices if indices is not None else [], dtype=np.int64)


def instance_masks(
    source: Source, prim: Usd.Prim, count: int
) -> tuple[list[float], NDArray[np.bool_]]:
    """Times (T,) and, from each on, which of the instances exist and are visible (T, N)."""
    instancer = UsdGeom.PointInstancer(prim)
    times = change_times(instancer.GetInvisibleIdsAttr(), source.frames)
    masks = [instancer.ComputeMaskAtTime(Usd.TimeCode(time)) for time in times]
    rows = [np.array(mask, dtype=bool) if mask else np.ones(count, dtype=bool) for mask in masks]
    return times, np.stack(rows)


def _checked_count(source: Source, instancer: UsdGeom.PointInstancer) -> int:
    prim, time = instancer.GetPrim(), source.time
    for name in ("positions", "protoIndices", "orientations", "orientationsf", "scales"):
        attribute = prim.GetAttribute(name)
        if attribute and source.varies(attribute):
            source.notes.about(
                f"Moving instances are taken at frame {source.frames[0]}", prim.GetPath()
            )
    indices = prototype_indices(source, prim)
    count = len(indices)
    required = {"positions"}
    for name in ("positions", "orientations", "orientationsf", "scales", "ids"):
        values = prim.GetAttribute(name).Get(time) if prim.GetAttribute(name) else None
        length = 0 if values is None else len(values)
        if length != count and (length > 0 or name in required):
            raise SceneError(
                f"{prim.GetPath()}: {name} has {length} values, but protoIndices has {count};"
                " there must be one for each instance"
            )
    targets = len(instancer.GetPrototypesRel().GetForwardedTargets())
    if count and (indices.min() < 0 or indices.max() >= targets):
        raise SceneError(
            f"{prim.GetPath()}: protoIndices must lie between 0 and {targets - 1}"
            f" (there are {targets} prototypes), but reaches {indices.min()} and {indices.max()}"
        )
    return count
