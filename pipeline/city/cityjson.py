# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Reads a CityJSON file, versions 1.0 to 2.0 (https://www.cityjson.org/specs/).

What is checked here holds for the whole file: that it is CityJSON, its version, its vertices and
transform. Geometry is read, and checked, by cityjson_geometry where a building uses it.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from nightcity.city.model import FloatArray
from nightcity.errors import SceneError

VERSIONS = ("1.0", "1.1", "2.0")
# EPSG codes in degrees that CityJSON files are seen with: metres cannot be had from them here.
_GEOGRAPHIC_EPSG = ("4326", "4258", "4937", "4979", "6697")


@dataclass(frozen=True)
class CityJson:
    """A file as read. vertices: (V, 3) m in the file's own coordinates, double precision.

    crs: the coordinate reference system as the file names it, or "". objects: CityObjects by id.
    """

    path: Path
    version: str
    vertices: FloatArray
    crs: str
    objects: Mapping[str, Mapping[str, Any]]


def read_cityjson(path: Path) -> CityJson:
    """The file at path. SceneError, naming the field, if it is no sound CityJSON."""
    document = _document(path)
    version = _version(document, path)
    objects = document.get("CityObjects")
    if not isinstance(objects, dict):
        raise SceneError(f"{path}: CityObjects: missing or no JSON object")
    for name, item in objects.items():
        if not isinstance(item, dict) or not isinstance(item.get("type"), str):
            raise SceneError(f"{path}: CityObjects[{name!r}]: no JSON object with a type")
    crs = _crs(document, path)
    return CityJson(path, version, _vertices(document, version, path), crs, objects)


def _document(path: Path) -> dict[str, Any]:
    try:
        document = json.loads(path.read_bytes().decode("utf-8-sig"))
    except OSError as error:
        raise SceneError(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise SceneError(f"{path}: not JSON: no UTF-8 text (byte {error.start})") from error
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise SceneError(f"{path}: not JSON: {error.msg} ({place})") from error
    except (RecursionError, ValueError) as error:  # nested too deep; a number of too many digits
        raise SceneError(f"{path}: not JSON that can be read: {error}") from error
    if not isinstance(document, dict) or document.get("type") != "CityJSON":
        kind = document.get("type") if isinstance(document, dict) else None
        hint = "; CityJSONSeq must be collected into one CityJSON first (cjseq, cjio)"
        raise SceneError(
            f'{path}: not CityJSON: type is {kind!r}, not "CityJSON"'
            + (hint if kind == "CityJSONFeature" else "")
        )
    return document


def _version(document: dict[str, Any], path: Path) -> str:
    version = document.get("version")
    # Files of the 1.0 series also write 1.0.1 and the like.
    series = ".".join(version.split(".")[:2]) if isinstance(version, str) else None
    if series not in VERSIONS:
        known = ", ".join(VERSIONS)
        raise SceneError(f"{path}: version: {version!r} is none of {known}; upgrade it with cjio")
    return series


def _crs(document: dict[str, Any], path: Path) -> str:
    metadata = document.get("metadata")
    crs = metadata.get("referenceSystem", "") if isinstance(metadata, dict) else ""
    if not isinstance(crs, str):
        raise SceneError(f"{path}: metadata.referenceSystem: must be text, not {crs!r}")
    code = re.split(r"[:/#]", crs.rstrip("/"))[-1]
    if code in _GEOGRAPHIC_EPSG:
        raise SceneError(
            f"{path}: metadata.referenceSystem: {crs} is in degrees; reproject the file to "
            "metres first (cjio FILE reproject EPSG save OUT)"
        )
    return crs


def _vertices(document: dict[str, Any], version: str, path: Path) -> FloatArray:
    vertices = _numbers(document.get("vertices"), path, "vertices")
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise SceneError(f"{path}: vertices: must be a list of [x, y, z]")
    transform = document.get("transform")
    if transform is None:
        if version != "1.0":
            raise SceneError(f"{path}: transform: missing; CityJSON {version} requires it")
    else:
        if not isinstance(transform, dict):
            raise SceneError(f"{path}: transform: no JSON object")
        scale, translate = (
            _numbers(transform.get(name), path, f"transform.{name}")
            for name in ("scale", "translate")
        )
        if scale.shape != (3,) or translate.shape != (3,) or not (scale > 0).all():
            raise SceneError(
                f"{path}: transform: scale and translate must be three numbers, scale above 0"
            )
        vertices = vertices * scale + translate
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(bad):
        raise SceneError(f"{path}: vertices[{bad[0]}]: not a finite number")
    return vertices


def _numbers(values: object, path: Path, field: str) -> FloatArray:
    if not isinstance(values, list) or not values:
        raise SceneError(f"{path}: {field}: missing or empty")
    try:
        array = np.array(values)
    except ValueError as error:  # rows of different length
        raise SceneError(f"{path}: {field}: entries differ in length") from error
    if array.dtype.kind not in "iuf":
        raise SceneError(f"{path}: {field}: holds something that is no number")
    return array.astype(np.float64)
