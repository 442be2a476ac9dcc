# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Cuts a large city into districts: squares of a grid, each a small city of its own."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from nightcity.city.model import City, FloatArray, IntArray, LightLists

WHOLE = 2500  # buildings that a city may have to stay in one piece
_BUILDINGS = 400  # in a district, on average


def is_large(city: City) -> bool:
    """Whether the city is kept in districts."""
    return len(city.buildings) > WHOLE


def districts(city: City) -> list[tuple[IntArray, IntArray]]:
    """The buildings and the media boxes, (N,) and (M,) ascending indices, of each district.

    Row by row from the south-west, without those that hold nothing. A building goes with its
    origin, a box with its centre, or with the nearest square where it lies outside of all.
    """
    places = np.array([building.origin[:2] for building in city.buildings])
    lo, span = places.min(axis=0), np.ptp(places, axis=0)
    edge = math.sqrt(max(float(span.prod()), 1.0) * _BUILDINGS / len(places))
    edge = max(edge, float(span.max()) * _BUILDINGS / len(places))  # buildings in one line
    counts = np.maximum(np.round(span / edge).astype(int), 1)
    centres = np.array([0.5 * (box.lo[:2] + box.hi[:2]) for box in city.media]).reshape(-1, 2)
    owners = [_squares(points, lo, span, counts) for points in (places, centres)]
    members = [_members(owner, int(counts.prod())) for owner in owners]
    return [pair for pair in zip(*members, strict=True) if len(pair[0]) or len(pair[1])]


def district_cities(city: City, parts: list[tuple[IntArray, IntArray]]) -> Iterator[City]:
    """Each district with its own buildings, boxes and light lists; without cameras and ground."""
    for buildings, boxes in parts:
        yield replace(
            city,
            buildings=tuple(city.buildings[index] for index in buildings),
            media=tuple(city.media[index] for index in boxes),
            light_lists=_lists_of(city.light_lists, boxes),
            cameras=(),
            ground_material=None,
            notes=(),
        )


def _squares(points: FloatArray, lo: FloatArray, span: FloatArray, counts: IntArray) -> IntArray:
    """Which square each of the (N, 2) points lies in, (N,)."""
    share = (points - lo) / np.where(span > 0, span, 1.0)
    column, row = np.clip((share * counts).astype(int), 0, counts - 1).T
    return row * counts[0] + column


def _members(owner: IntArray, count: int) -> list[IntArray]:
    order = np.argsort(owner, kind="stable")
    return np.split(order, np.searchsorted(owner[order], np.arange(1, count)))


def _lists_of(lists: LightLists, boxes: IntArray) -> LightLists:
    runs = [lists.window_ids[lists.offsets[box] : lists.offsets[box + 1]] for box in boxes]
    offsets = np.concatenate(([0], np.cumsum([len(run) for run in runs], dtype=np.int64)))
    return LightLists(offsets, np.concatenate([np.empty(0, np.int64), *runs]))
