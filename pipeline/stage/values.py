# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Reads attributes of a stage that may hold anything."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import DTypeLike, NDArray
from pxr import Usd

EARLIEST = Usd.TimeCode.EarliestTime()


def numbers(
    prim: Usd.Prim, name: str, time: Usd.TimeCode = EARLIEST, dtype: DTypeLike = np.float64
) -> NDArray:
    """The numbers of an attribute; empty where it has none or is of a wrong type, which USD's own
    validators name. Quaternions come as x, y, z, real."""
    attribute = prim.GetAttribute(name)
    return as_numbers(attribute.Get(time) if attribute else None, dtype)


def as_numbers(value: object, dtype: DTypeLike = np.float64) -> NDArray:
    """``value`` as numpy has it; empty where it holds no numbers."""
    try:
        found = np.array([] if value is None else value)
    except (TypeError, ValueError):
        return np.empty(0, dtype)
    return found.astype(dtype) if found.dtype.kind in "biuf" else np.empty(0, dtype)


def samples(prim: Usd.Prim, name: str) -> Iterator[tuple[Usd.TimeCode, object]]:
    """Every value of an attribute with its time: all time samples, or else the default."""
    attribute = prim.GetAttribute(name)
    if not attribute:
        return
    times = [Usd.TimeCode(time) for time in attribute.GetTimeSamples()]
    for time in times or [Usd.TimeCode.Default()]:
        value = attribute.Get(time)
        if value is not None:
            yield time, value


def at(time: Usd.TimeCode) -> str:
    """Words for a time that a finding is about, none for the default."""
    return "" if time.IsDefault() else f" at time {time.GetValue():g}"
