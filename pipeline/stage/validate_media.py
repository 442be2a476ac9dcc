# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of media boxes: numbers, shape, overlaps, and the windows that they list."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from pxr import Usd, UsdGeom

from nightcity.box_overlaps import box_overlaps
from nightcity.light_lists import light_lists, window_bounds
from nightcity.stage.contents import Contents
from nightcity.stage.finding import Finding, error, warning
from nightcity.stage.validate_windows import window_ids

_MOST_OVERLAPS = 50  # named; more than that have one cause
_SKEW = 1e-6  # of a box's edge: what float32 transforms leave of an exact quarter turn
_TIME = Usd.TimeCode.EarliestTime()


def check_media(contents: Contents) -> Iterator[Finding]:
    """Boxes on their own, against one another, and against the windows."""
    yield from _check_numbers(contents.media)
    boxes: list[tuple[Usd.Prim, np.ndarray]] = []
    transforms = UsdGeom.XformCache(_TIME)
    for prim in contents.media:
        corners, wrong = _corners(prim, transforms)
        if wrong:
            yield wrong
        else:
            boxes.append((prim, contents.metres * corners))
        purpose = UsdGeom.Imageable(prim).ComputePurpose()
        if purpose not in ("default", "render"):
            yield warning(
                prim, "purpose", f"is {purpose}, so the box is not rendered; make it render"
            )
    yield from _check_overlaps(boxes)
    yield from _check_lists(contents, boxes)


def _check_numbers(media: list[Usd.Prim]) -> Iterator[Finding]:
    first: dict[int, Usd.Prim] = {}
    for prim in media:
        number = prim.GetAttribute("nightcity:mediaId").Get()
        if not isinstance(number, int) or number < 0:
            continue  # reported with the ranges
        other = first.setdefault(number, prim)
        if other != prim:
            yield error(
                prim,
                "nightcity:mediaId",
                f"{number} is also the number of {other.GetPath()}; give each box its own",
            )


def _corners(prim: Usd.Prim, transforms: UsdGeom.XformCache) -> tuple[np.ndarray, Finding | None]:
    """Lower and upper corner, (2, 3) in stage units, and what is wrong with the box."""
    matrix = np.array(transforms.GetLocalToWorldTransform(prim))
    size = float(prim.GetAttribute("size").Get(_TIME))
    edges = size * matrix[:3, :3]
    nothing = np.zeros((2, 3))
    if not (np.isfinite(matrix).all() and np.isfinite(size)):
        return nothing, error(prim, "xformOpOrder", "its transform or size is not finite; mend it")
    lengths = np.abs(edges)
    if (lengths.max(axis=1) == 0).any() or (lengths.max(axis=0) == 0).any():
        return nothing, error(prim, "size", "the box is flat; give it a size and scale above 0")
    along = lengths.argmax(axis=1)
    skew = lengths.copy()
    skew[np.arange(3), along] = 0
    if len(set(along)) < 3 or (skew.max(axis=1) > _SKEW * lengths.max(axis=1)).any():
        return nothing, error(
            prim,
            "xformOpOrder",
            "the box is turned or skewed, but haze fills axis-aligned boxes only; remove the"
            " rotation from it and from its parents (quarter turns are fine)",
        )
    reach = 0.5 * lengths.max(axis=0)
    return np.array([matrix[3, :3] - reach, matrix[3, :3] + reach]), None


def _check_overlaps(boxes: list[tuple[Usd.Prim, np.ndarray]]) -> Iterator[Finding]:
    if not boxes:
        return
    # As the renderer holds them: what float32 cannot tell apart does not overlap.
    corners = np.array([corners for _, corners in boxes]).astype(np.float32)
    pairs = box_overlaps(corners[:, 0], corners[:, 1], _MOST_OVERLAPS + 1)
    for first, second in pairs[:_MOST_OVERLAPS]:
        yield error(
            boxes[second][0],
            "xformOpOrder",
            f"overlaps {boxes[first][0].GetPath()}; boxes may touch but not overlap, so move or"
            " cut one of them",
        )
    if len(pairs) > _MOST_OVERLAPS:
        yield error(
            boxes[0][0].GetParent(), "", f"more than {_MOST_OVERLAPS} pairs of boxes overlap"
        )


def _check_lists(contents: Contents, boxes: list[tuple[Usd.Prim, np.ndarray]]) -> Iterator[Finding]:
    ids = np.concatenate([*map(window_ids, contents.windows), np.empty(0, np.int64)])
    known = np.unique(ids)
    lists = {}
    for prim in contents.media:
        listed = np.array(prim.GetAttribute("nightcity:windowLights").Get() or [], np.int64)
        lists[prim.GetPath()] = listed
        strange = listed[~np.isin(listed, known)]
        if len(strange):
            yield error(
                prim,
                "nightcity:windowLights",
                f"lists window {strange[0]}, which is in no instancer's ids"
                f" ({len(strange)} of {len(listed)} are not); correct the list, or clear it and"
                " let the export compute it",
            )
        elif (np.diff(listed) <= 0).any():
            yield warning(prim, "nightcity:windowLights", "is not ascending; sort it")
        for target in prim.GetRelationship("nightcity:windowLightSources").GetForwardedTargets():
            source = contents.stage.GetPrimAtPath(target)
            if not source or "NightcityWindowsAPI" not in source.GetAppliedSchemas():
                yield warning(
                    prim,
                    "nightcity:windowLightSources",
                    f"{target} is no instancer of windows; remove it",
                )
                break
    if len(known) == len(ids):
        yield from _check_stale(contents, boxes, ids, lists)


def _check_stale(
    contents: Contents, boxes: list[tuple[Usd.Prim, np.ndarray]], ids: np.ndarray, lists: dict
) -> Iterator[Finding]:
    """Whether the lists are those that the rule gives for the geometry as it stands."""
    bounds = _all_window_bounds(contents)
    if bounds is None or len(bounds[0]) != len(ids) or not boxes or not np.isfinite(bounds).all():
        return
    corners = np.array([corners for _, corners in boxes])
    reach = np.array([prim.GetAttribute("nightcity:reachScale").Get() for prim, _ in boxes], float)
    if not (np.isfinite(reach) & (reach > 0)).all():
        return  # reported with the ranges
    offsets, found = light_lists(*bounds, corners[:, 0], corners[:, 1], reach)
    stale = [
        prim
        for index, (prim, _) in enumerate(boxes)
        if not np.array_equal(
            np.sort(lists[prim.GetPath()]), np.sort(ids[found[offsets[index] : offsets[index + 1]]])
        )
    ]
    if stale:
        yield warning(
            stale[0],
            "nightcity:windowLights",
            f"no longer fits the geometry, here and in {len(stale) - 1} more of {len(boxes)}"
            " boxes; the export computes lists anew unless it is told --lists authored",
        )


def _all_window_bounds(contents: Contents) -> tuple[np.ndarray, np.ndarray] | None:
    """Lower and upper corners of every window, (N, 3) m each; None where they have none."""
    transforms = UsdGeom.XformCache(_TIME)
    lower, upper = [], []
    for prim in contents.windows:
        instancer = UsdGeom.PointInstancer(prim)
        local = instancer.ComputeInstanceTransformsAtTime(
            _TIME, _TIME, instancer.IncludeProtoXform, instancer.IgnoreMask
        )
        if not local:
            return None
        world = np.array(local) @ np.array(transforms.GetLocalToWorldTransform(prim))
        half = 0.5 * np.array(prim.GetAttribute("nightcity:windowSize").Get(), float)
        bounds = window_bounds(
            world[:, 3, :3], half[0] * world[:, 0, :3], half[1] * world[:, 1, :3]
        )
        lower.append(contents.metres * bounds[0])
        upper.append(contents.metres * bounds[1])
    return (np.concatenate(lower), np.concatenate(upper)) if lower else None
