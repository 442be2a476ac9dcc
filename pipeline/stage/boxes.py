# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The corners of media boxes as they stand on a stage, and what is wrong with one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from nightcity.stage.contents import Contents
from nightcity.stage.finding import Finding, error
from nightcity.stage.values import EARLIEST, numbers

_SKEW = 1e-6  # of a box's edge: what float32 transforms leave of an exact quarter turn


def read_boxes(contents: Contents) -> tuple[NDArray[np.float64], list[Finding]]:
    """Lower and upper corner of each media box, (M, 2, 3) m, NaN for what is none, and why."""
    transforms = UsdGeom.XformCache(EARLIEST)
    corners = np.full((len(contents.media), 2, 3), np.nan)
    findings = []
    for row, prim in enumerate(contents.media):
        box = _box_or_fault(prim, transforms)
        if isinstance(box, Finding):
            findings.append(box)
        else:
            corners[row] = contents.metres * box
    return corners, findings


def _box_or_fault(prim: Usd.Prim, transforms: UsdGeom.XformCache) -> NDArray[np.float64] | Finding:
    """Lower and upper corner, (2, 3) in stage units, or what is wrong with the box."""
    matrix = np.array(transforms.GetLocalToWorldTransform(prim))
    size = numbers(prim, "size")
    if not (np.isfinite(matrix).all() and size.ndim == 0 and np.isfinite(size)):
        return error(prim, "xformOpOrder", "its transform or size is not finite; mend it")
    lengths = np.abs(size * matrix[:3, :3])
    if (lengths.max(axis=1) == 0).any() or (lengths.max(axis=0) == 0).any():
        return error(prim, "size", "the box is flat; give it a size and scale above 0")
    along = lengths.argmax(axis=1)
    skew = lengths.copy()
    skew[np.arange(3), along] = 0
    if len(set(along)) < 3 or (skew.max(axis=1) > _SKEW * lengths.max(axis=1)).any():
        return error(
            prim,
            "xformOpOrder",
            "the box is turned or skewed, but haze fills axis-aligned boxes only; remove the"
            " rotation from it and from its parents (quarter turns are fine)",
        )
    reach = 0.5 * lengths.max(axis=0)
    return np.array([matrix[3, :3] - reach, matrix[3, :3] + reach])
