# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The media layer: a cube a media box, with the windows that light it."""

from __future__ import annotations

import numpy as np
from pxr import Gf, Sdf

from nightcity.city.model import City, FloatArray, MediaBox
from nightcity.progress import Progress
from nightcity.stage import layout
from nightcity.stage.attributes import PrimWriter

# Corners are rounded to this many steps a metre, a power of two. Then half the sum and half the
# difference of two corners, and those added again, are exact in double precision up to 2^31 m:
# boxes that touch come back with the same bits. The step, 1 micrometre, is finer than float32
# from 16 m on.
_STEPS = 2.0**20


def write_media(city: City, layer: Sdf.Layer) -> None:
    """Write the media boxes into an empty layer."""
    root = layout.city_prim(layer)
    media = PrimWriter(root, layout.MEDIA.name, "Xform")
    # Only renderers draw haze; a viewer that shows render purposes sees faint boxes.
    media.set("purpose", "render")
    media.set_primvar("displayOpacity", Sdf.ValueTypeNames.FloatArray, np.array([0.05]), "constant")
    sources = _sources(city)
    lists = city.light_lists
    boxes = list(enumerate(city.media))
    with Progress("writing media boxes", len(boxes)) as progress:
        for name, members in layout.groups(boxes):
            group = PrimWriter(media, name, "Xform")
            for index, box in members:
                ids = lists.window_ids[lists.offsets[index] : lists.offsets[index + 1]]
                _write_box(group, box, ids, sources[index])
            progress.advance(len(members))


def _write_box(group: PrimWriter, box: MediaBox, ids: np.ndarray, sources: list[Sdf.Path]) -> None:
    prim = PrimWriter(group, f"Box_{box.media_id}", "Cube", ["NightcityMediaAPI"])
    centre, half = centre_and_half(box.lo, box.hi)
    prim.set("size", 2.0)  # half edge 1, so that the scale is half the box
    prim.place(
        translate=(Sdf.ValueTypeNames.Double3, Gf.Vec3d(*map(float, centre))),
        scale=(Sdf.ValueTypeNames.Double3, Gf.Vec3d(*map(float, half))),
    )
    prim.set("nightcity:mediaId", int(box.media_id))
    prim.set("nightcity:extinction", float(box.extinction))
    prim.set("nightcity:albedo", float(box.albedo))
    prim.set("nightcity:reachScale", float(box.reach_scale))
    prim.set("nightcity:windowLights", ids)
    prim.relate("nightcity:windowLightSources", sources)


def centre_and_half(lo: FloatArray, hi: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Centre and half size, (3,) m each, such that centre -+ half are the corners to the bit."""
    lo, hi = (np.round(np.asarray(corner, float) * _STEPS) / _STEPS for corner in (lo, hi))
    return 0.5 * (lo + hi), 0.5 * (hi - lo)


def _sources(city: City) -> list[list[Sdf.Path]]:
    """For each box the instancers whose windows light it, in the city's order. In a district only
    its own: a payload cannot point at what stands in another."""
    paths = layout.instancer_paths(city)
    ids = np.concatenate([building.windows.ids for building in city.buildings] or [[]])
    owner = np.repeat(np.arange(len(paths)), [len(each.windows) for each in city.buildings])
    order = np.argsort(ids)
    lists = city.light_lists
    found: list[list[Sdf.Path]] = [[] for _ in city.media]
    if len(ids) == 0:
        return found
    place = order[np.minimum(np.searchsorted(ids[order], lists.window_ids), len(ids) - 1)]
    here = ids[place] == lists.window_ids
    box = np.repeat(np.arange(len(city.media)), np.diff(lists.offsets))
    pairs = np.unique(box[here] * len(paths) + owner[place[here]])
    for pair in pairs.tolist():
        found[pair // len(paths)].append(paths[pair % len(paths)])
    return found
