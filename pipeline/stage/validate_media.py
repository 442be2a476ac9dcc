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
from nightcity.stage.values import EARLIEST, numbers

_MOST_OVERLAPS = 50  # named; more than that have one cause
_SKEW = 1e-6  # of a box's edge: what float32 transforms leave of an exact quarter turn
_SAME_FACE = 1e-4  # m; the export moves faces closer than this onto each other


def check_media(contents: Contents) -> Iterator[Finding]:
    """Boxes on their own, against one another, and against the windows."""
    yield from _check_numbers(contents.media)
    boxes: list[tuple[Usd.Prim, np.ndarray]] = []
    transforms = UsdGeom.XformCache(EARLIEST)
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
            # Native instances share the number; the export gives them new ones.
            yield (warning if prim.IsInstanceProxy() else error)(
                prim,
                "nightcity:mediaId",
                f"{number} is also the number of {other.GetPath()}; give each box its own",
            )


def _corners(prim: Usd.Prim, transforms: UsdGeom.XformCache) -> tuple[np.ndarray, Finding | None]:
    """Lower and upper corner, (2, 3) in stage units, and what is wrong with the box."""
    matrix = np.array(transforms.GetLocalToWorldTransform(prim))
    size = numbers(prim, "size")
    nothing = np.zeros((2, 3))
    if not (np.isfinite(matrix).all() and size.ndim == 0 and np.isfinite(size)):
        return nothing, error(prim, "xformOpOrder", "its transform or size is not finite; mend it")
    lengths = np.abs(size * matrix[:3, :3])
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
    corners = np.array([corners for _, corners in boxes])
    shrunk = corners[:, 0] + 0.5 * _SAME_FACE, corners[:, 1] - 0.5 * _SAME_FACE
    pairs = box_overlaps(*shrunk, _MOST_OVERLAPS + 1)
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
    lists = [numbers(prim, "nightcity:windowLights", dtype=np.int64) for prim in contents.media]
    owner = np.repeat(np.arange(len(lists)), [each.size for each in lists])
    listed = np.concatenate([*lists, np.empty(0, np.int64)])
    strange = np.bincount(owner[~np.isin(listed, ids)], minlength=len(lists))
    falls = (np.diff(listed) <= 0) & (np.diff(owner) == 0)
    unsorted = np.bincount(owner[1:][falls], minlength=len(lists))
    for index, prim in enumerate(contents.media):
        if strange[index]:
            first = lists[index][~np.isin(lists[index], ids)][0]
            yield error(
                prim,
                "nightcity:windowLights",
                f"lists window {first}, which is in no instancer's ids ({strange[index]} of"
                f" {len(lists[index])} are not); correct the list, or clear it and let the export"
                " compute it",
            )
        elif unsorted[index]:
            yield warning(prim, "nightcity:windowLights", "is not ascending; sort it")
        yield from _check_sources(prim)
    if len(np.unique(ids)) == len(ids):
        by_path = {prim.GetPath(): each for prim, each in zip(contents.media, lists, strict=True)}
        yield from _check_stale(contents, boxes, ids, by_path)


def _check_sources(prim: Usd.Prim) -> Iterator[Finding]:
    for target in prim.GetRelationship("nightcity:windowLightSources").GetForwardedTargets():
        source = prim.GetStage().GetPrimAtPath(target)
        if not source or "NightcityWindowsAPI" not in source.GetAppliedSchemas():
            yield warning(
                prim,
                "nightcity:windowLightSources",
                f"{target} is no instancer of windows; remove it",
            )
            return


def _check_stale(
    contents: Contents, boxes: list[tuple[Usd.Prim, np.ndarray]], ids: np.ndarray, lists: dict
) -> Iterator[Finding]:
    """Whether the lists are those that the rule gives for the geometry as it stands."""
    bounds = _all_window_bounds(contents)
    if bounds is None or len(bounds[0]) != len(ids) or not boxes or not np.isfinite(bounds).all():
        return
    corners = np.array([corners for _, corners in boxes])
    scales = [numbers(prim, "nightcity:reachScale") for prim, _ in boxes]
    reach = np.array([scale if scale.ndim == 0 else np.nan for scale in scales])
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
    transforms = UsdGeom.XformCache(EARLIEST)
    lower, upper = [], []
    for prim in contents.windows:
        instancer = UsdGeom.PointInstancer(prim)
        local = instancer.ComputeInstanceTransformsAtTime(
            EARLIEST, EARLIEST, instancer.IncludeProtoXform, instancer.IgnoreMask
        )
        if not local:
            return None
        world = np.array(local) @ np.array(transforms.GetLocalToWorldTransform(prim))
        half = 0.5 * numbers(prim, "nightcity:windowSize")
        if half.shape != (2,):
            return None  # of a wrong type: USD's own validators name it
        bounds = window_bounds(
            world[:, 3, :3], half[0] * world[:, 0, :3], half[1] * world[:, 1, :3]
        )
        lower.append(contents.metres * bounds[0])
        upper.append(contents.metres * bounds[1])
    return (np.concatenate(lower), np.concatenate(upper)) if lower else None
