# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The districts of a stage: payloads that are read one at a time."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

from pxr import Sdf, Usd


def open_outside(path: Path) -> tuple[Usd.Stage, tuple[str, ...]]:
    """A stage with all its payloads but those of districts, and the paths of these in the stage's
    order: none where there is at most one, since then everything is loaded.

    Raises Tf.ErrorException where USD cannot open the stage.
    """
    stage = Usd.Stage.Open(str(path), Usd.Stage.LoadNone)
    districts = _districts(stage)
    stage.LoadAndUnload(_outside(stage, districts), [])
    return stage, tuple(districts)


@contextlib.contextmanager
def loaded(stage: Usd.Stage, district: str) -> Iterator[Usd.Prim]:
    """The prim of one district, while it is loaded."""
    stage.Load(district)
    try:
        yield stage.GetPrimAtPath(district)
    finally:
        stage.Unload(district)


def _districts(stage: Usd.Stage) -> list[str]:
    """Paths of the payloads that can be read one at a time, if there are several."""
    found = [
        str(prim.GetPath())
        for prim in Usd.PrimRange(stage.GetPseudoRoot(), Usd.PrimIsActive & Usd.PrimIsDefined)
        if not prim.IsLoaded() and "NightcityDistrictAPI" in prim.GetAppliedSchemas()
    ]
    return found if len(found) > 1 else []


def _outside(stage: Usd.Stage, districts: list[str]) -> list[Sdf.Path]:
    """The payloads that belong to no district."""
    inside = set(map(Sdf.Path, districts))
    return [
        path
        for path in stage.FindLoadable()
        if not any(prefix in inside for prefix in path.GetPrefixes())
    ]
