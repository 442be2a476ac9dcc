# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What has to be compared across a whole stage, read piece by piece as plain arrays."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from nightcity.light_lists import window_bounds
from nightcity.stage.contents import Contents
from nightcity.stage.finding import Finding
from nightcity.stage.values import EARLIEST, numbers

NO_NUMBER = -1


@dataclass(frozen=True)
class Places:
    """Where prims lie: their paths, and which are inside native instances, (P,) bool."""

    paths: list[str]
    proxies: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.paths)

    def error(self, row: int, attribute: str, message: str) -> Finding:
        return Finding("error", self.paths[row], attribute, message)

    def warning(self, row: int, attribute: str, message: str) -> Finding:
        return Finding("warning", self.paths[row], attribute, message)

    def twice(self, row: int, attribute: str, message: str) -> Finding:
        """An error, but a warning inside an instance: those share their values, so that nothing
        can be renumbered there."""
        return (self.warning if self.proxies[row] else self.error)(row, attribute, message)


@dataclass(frozen=True)
class Facts:
    """Of a stage or a piece of it, in the order of its walk; lengths in metres.

    windows: the instancers; id_counts: (P,) how many ids each has; ids: all of them, (N,).
    bounds: (N, 2, 3), lower and upper corner of each window; bounded: every window has them.
    boxes: the media boxes; corners: (M, 2, 3), NaN for one that is no box; media_ids, reach: (M,),
    NO_NUMBER and NaN where there is none. list_counts: (M,), listed: the windows that they list.
    far_sources: box and targets of its windowLightSources that are no instancers in the piece.
    building_ids: of each of ``buildings``, NO_NUMBER where there is none.
    """

    windows: Places
    id_counts: NDArray[np.int64]
    ids: NDArray[np.int64]
    bounds: NDArray[np.float64]
    bounded: bool
    boxes: Places
    corners: NDArray[np.float64]
    media_ids: NDArray[np.int64]
    reach: NDArray[np.float64]
    list_counts: NDArray[np.int64]
    listed: NDArray[np.int64]
    far_sources: list[tuple[str, list[str]]]
    buildings: Places
    building_ids: NDArray[np.int64]
    grounds: Places
    cameras: int
    lights: int


def read_facts(contents: Contents, corners: NDArray[np.float64]) -> Facts:
    """corners: of the media boxes, (M, 2, 3) m."""
    transforms = UsdGeom.XformCache(EARLIEST)
    ids = [numbers(prim, "ids", dtype=np.int64) for prim in contents.windows]
    bounds = [_bounds(prim, transforms) for prim in contents.windows]
    lists = [numbers(prim, "nightcity:windowLights", dtype=np.int64) for prim in contents.media]
    return Facts(
        windows=_places(contents.windows),
        id_counts=np.array([len(each) for each in ids], np.int64),
        ids=np.concatenate([np.empty(0, np.int64), *ids]),
        bounds=contents.metres
        * np.concatenate([np.empty((0, 2, 3)), *(each for each in bounds if each is not None)]),
        bounded=all(each is not None for each in bounds),
        boxes=_places(contents.media),
        corners=corners,
        media_ids=_numbers_of(contents.media, "nightcity:mediaId"),
        reach=np.array([_reach(prim) for prim in contents.media], float),
        list_counts=np.array([each.size for each in lists], np.int64),
        listed=np.concatenate([np.empty(0, np.int64), *(each.ravel() for each in lists)]),
        far_sources=_far_sources(contents.media),
        buildings=_places(contents.buildings),
        building_ids=_numbers_of(contents.buildings, "nightcity:buildingId"),
        grounds=_places(contents.grounds),
        cameras=contents.cameras,
        lights=contents.lights,
    )


def joined(pieces: Iterable[Facts]) -> Facts:
    """All pieces as one, in their order."""
    pieces = list(pieces)
    return Facts(
        **{
            field.name: _together([getattr(piece, field.name) for piece in pieces])
            for field in fields(Facts)
        }
    )


def _together(values: list) -> object:
    if isinstance(values[0], Places):
        paths = [path for each in values for path in each.paths]
        return Places(paths, np.concatenate([each.proxies for each in values]))
    if isinstance(values[0], np.ndarray):
        return np.concatenate(values)
    if isinstance(values[0], list):
        return [item for each in values for item in each]
    return all(values) if isinstance(values[0], bool) else sum(values)


def _places(prims: list[Usd.Prim]) -> Places:
    proxies = np.array([prim.IsInstanceProxy() for prim in prims], bool)
    return Places([str(prim.GetPath()) for prim in prims], proxies)


def _numbers_of(prims: list[Usd.Prim], name: str) -> NDArray[np.int64]:
    values = [prim.GetAttribute(name).Get() for prim in prims]
    whole = [isinstance(value, int) and value >= 0 for value in values]  # else out of range
    return np.where(whole, np.where(whole, values, NO_NUMBER), NO_NUMBER).astype(np.int64)


def _reach(prim: Usd.Prim) -> float:
    scale = numbers(prim, "nightcity:reachScale")
    return float(scale) if scale.ndim == 0 else np.nan


def _bounds(prim: Usd.Prim, transforms: UsdGeom.XformCache) -> NDArray[np.float64] | None:
    """Corners of the windows of an instancer, (N, 2, 3) in stage units; None where it has none."""
    instancer = UsdGeom.PointInstancer(prim)
    local = instancer.ComputeInstanceTransformsAtTime(
        EARLIEST, EARLIEST, instancer.IncludeProtoXform, instancer.IgnoreMask
    )
    half = 0.5 * numbers(prim, "nightcity:windowSize")
    if not local or half.shape != (2,):  # a size of a wrong type: USD's own validators name it
        return None
    world = np.array(local) @ np.array(transforms.GetLocalToWorldTransform(prim))
    lower, upper = window_bounds(
        world[:, 3, :3], half[0] * world[:, 0, :3], half[1] * world[:, 1, :3]
    )
    return np.stack([lower, upper], axis=1)


def _far_sources(media: list[Usd.Prim]) -> list[tuple[str, list[str]]]:
    found = []
    for prim in media:
        targets = prim.GetRelationship("nightcity:windowLightSources").GetForwardedTargets()
        far = [str(target) for target in targets if not _has_windows(prim.GetStage(), target)]
        if far:
            found.append((str(prim.GetPath()), far))
    return found


def _has_windows(stage: Usd.Stage, path: object) -> bool:
    prim = stage.GetPrimAtPath(path)
    return bool(prim) and "NightcityWindowsAPI" in prim.GetAppliedSchemas()
