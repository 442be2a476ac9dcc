# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A stage's own UsdLux lights as emitters: rectangles, disks and spheres.

UsdLux leaves the unit of its emission open; it is read as radiance in W m^-2 sr^-1. A surface of
area A (m^2) and radiance L then sends pi A L watts, since it is Lambertian.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdLux

from nightcity.errors import SceneError
from nightcity.export.emitters import NO_ID
from nightcity.export.findings import Item
from nightcity.export.open_stage import Source

Columns = dict[str, NDArray]
FloatArray = NDArray[np.float64]

_POINT_RADIUS = 1e-3  # m, of a SphereLight with treatAsPoint
_ROUND = 1e-3  # the axes of a sphere may differ by this share
# Attributes that narrow or colour a light, and the values at which they do nothing.
_SHAPING = {
    "inputs:shaping:focus": (0.0,),
    "inputs:shaping:cone:angle": (90.0, 180.0),
    "inputs:shaping:ies:file": (None, ""),
    "inputs:texture:file": (None, ""),
}


def read_lights(source: Source, items: Sequence[Item]) -> tuple[list[Columns], list[str]]:
    """Columns of the table of emitters and a path for each light that can be exported; a note for
    each that is changed or cannot. Raises SceneError for values that are not finite."""
    parts, paths = [], []
    for item in items:
        columns = _read(source, item)
        if columns is not None:
            parts.append(columns)
            paths.append(str(item.prim.GetPath()))
    return parts, paths


def _read(source: Source, item: Item) -> Columns | None:
    prim = item.prim
    path, kind = prim.GetPath(), prim.GetTypeName()
    shaper = _SHAPERS.get(kind)
    if shaper is None:
        source.notes.say(
            f"The {kind} {path} is left out: only RectLight, DiskLight and SphereLight are rendered"
        )
        return None
    half_u, half_v, area = shaper(source, prim, item.matrices)
    if not (area > 0).all():
        source.notes.say(f"The {kind} {path} is left out: it has no surface")
        return None
    for name, neutral in _SHAPING.items():
        value = source.value(prim, name)
        if getattr(value, "path", value) not in (*neutral, None):
            source.notes.about(f"{name} of a light is left out", path)
    radiance, colour = _emission(source, prim)
    if source.value(prim, "inputs:normalize"):
        radiance = radiance / area
    copies = len(area)
    first = float(source.frames[0])
    times = [time for time in item.visible.times if time > first]
    return {
        "centre": item.matrices[:, 3, :3],
        "half_u": half_u,
        "half_v": half_v,
        "outward": -item.matrices[:, 2, :3],  # UsdLux lights shine along -z
        "power": np.pi * area * radiance,
        "colour": np.tile(colour, (copies, 1)),
        "id": np.full(copies, NO_ID),
        "building": np.full(copies, -1),
        "sphere": np.full(copies, kind == "SphereLight"),
        "foreign": np.ones(copies, bool),
        "on": np.full(copies, item.visible.at(first)),
        "number": np.arange(copies),
        "event_time": np.tile(np.array(times, dtype=np.float64), copies),
        "event_row": np.repeat(np.arange(copies), len(times)),
        "event_on": np.tile(np.array([item.visible.at(t) for t in times], bool), copies),
    }


def _emission(source: Source, prim: Usd.Prim) -> tuple[float, FloatArray]:
    """Radiance and colour (3,), before normalize."""
    intensity = float(source.value(prim, "inputs:intensity"))
    radiance = intensity * 2.0 ** float(source.value(prim, "inputs:exposure"))
    colour = np.array(source.value(prim, "inputs:color"), dtype=np.float64)
    if source.value(prim, "inputs:enableColorTemperature"):
        kelvin = float(source.value(prim, "inputs:colorTemperature"))
        colour = colour * np.array(UsdLux.BlackbodyTemperatureAsRgb(kelvin))
    if not (np.isfinite(radiance) and radiance >= 0) or not (colour >= 0).all():
        raise SceneError(
            f"{prim.GetPath()}: intensity, exposure and color must be finite and not negative"
        )
    return radiance, colour


def _rectangle(source: Source, prim: Usd.Prim, matrices: FloatArray) -> tuple[FloatArray, ...]:
    width, height = (_length(source, prim, f"inputs:{name}") for name in ("width", "height"))
    half_u, half_v = 0.5 * width * matrices[:, 0, :3], 0.5 * height * matrices[:, 1, :3]
    return _with_area(half_u, half_v)


def _disk(source: Source, prim: Usd.Prim, matrices: FloatArray) -> tuple[FloatArray, ...]:
    source.notes.about("A DiskLight becomes a square of equal area and power", prim.GetPath())
    half = 0.5 * np.sqrt(np.pi) * _length(source, prim, "inputs:radius")
    return _with_area(half * matrices[:, 0, :3], half * matrices[:, 1, :3])


def _with_area(half_u: FloatArray, half_v: FloatArray) -> tuple[FloatArray, ...]:
    area = 4 * np.linalg.norm(np.cross(half_u, half_v), axis=1)
    return half_u, half_v, area


def _sphere(source: Source, prim: Usd.Prim, matrices: FloatArray) -> tuple[FloatArray, ...]:
    radius = _length(source, prim, "inputs:radius")
    axes = np.linalg.norm(matrices[:, :3, :3], axis=2)
    scale = np.cbrt(np.abs(np.linalg.det(matrices[:, :3, :3])))
    if (np.ptp(axes, axis=1) > _ROUND * axes.max(axis=1)).any():
        source.notes.about("A scaled SphereLight becomes a ball of equal volume", prim.GetPath())
    radii = radius * scale
    area = 4 * np.pi * radii**2
    if source.value(prim, "treatAsPoint"):
        radii = np.full_like(radii, _POINT_RADIUS)
        area = np.where(area > 0, area, 4 * np.pi * radii**2)
    return radii[:, None] * np.eye(3)[0], radii[:, None] * np.eye(3)[1], area


def _length(source: Source, prim: Usd.Prim, name: str) -> float:
    value = float(source.value(prim, name))
    if not (np.isfinite(value) and value >= 0):
        raise SceneError(f"{prim.GetPath()}.{name} is {value}; it must be finite, not negative")
    return value


_SHAPERS = {"RectLight": _rectangle, "DiskLight": _disk, "SphereLight": _sphere}
