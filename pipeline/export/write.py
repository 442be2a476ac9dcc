# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the two files of a flat scene, both or neither."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import xxhash
from numpy.typing import NDArray

from nightcity import __version__
from nightcity.errors import NightcityError
from nightcity.export.records import ALIGNMENT, FORMAT, RECORDS, VERSION, fields
from nightcity.whole_file import whole_files

_JSON, _BINARY = "scene.json", "scene.bin"


def write_scene(
    folder: Path, arrays: Mapping[str, NDArray], manifest: Mapping[str, object]
) -> dict[str, int]:
    """Write ``folder/scene.json`` and ``folder/scene.bin``; returns their sizes in bytes.

    arrays: every array of RECORDS, of its type. manifest: what docs/scene_format.md lists beside
    the arrays and the constants. An earlier scene in the folder is replaced only once the new one
    is complete; a failure leaves the earlier one. Raises NightcityError where writing fails.
    """
    try:
        # Without its manifest the folder holds no scene: an interrupted exchange is no mixture.
        with whole_files(folder / _BINARY, folder / _JSON) as (binary_file, json_file):
            table, binary = _write_binary(binary_file, arrays)
            json_file.write_text(_manifest_text(manifest, table, binary), encoding="utf-8")
    except OSError as error:
        raise NightcityError(
            f"{folder}: the flat scene cannot be written: {error.strerror}"
        ) from error
    return {name: (folder / name).stat().st_size for name in (_JSON, _BINARY)}


def _manifest_text(manifest: Mapping[str, object], table: dict, binary: dict) -> str:
    content = dict(manifest) | {
        "format": FORMAT,
        "version": VERSION,
        "byte_order": "little",
        "generator": f"nightcity {__version__}",
        "units": {
            "length": "m",
            "power": "W",
            "extinction": "1/m",
            "radiance": "W m^-2 sr^-1",
        },
        "up_axis": "z",
        "binary": binary,
        "arrays": table,
    }
    text = json.dumps(content, indent=1, sort_keys=True, ensure_ascii=False, allow_nan=False)
    return text + "\n"


def _write_binary(path: Path, arrays: Mapping[str, NDArray]) -> tuple[dict, dict]:
    """The manifest's ``arrays`` and ``binary``."""
    digest = xxhash.xxh3_128()
    table, chunks, offset = {}, [], 0
    for name, record in RECORDS.items():
        array = arrays[name]
        if array.dtype != record:
            raise TypeError(f"array {name} is {array.dtype}, not {record}")
        gap = -offset % ALIGNMENT
        chunks += [bytes(gap), array.view("u1").data if len(array) else b""]
        offset += gap
        table[name] = {
            "offset": offset,
            "count": len(array),
            "stride": record.itemsize,
            "fields": fields(name),
        }
        offset += array.nbytes
    for chunk in chunks:
        digest.update(chunk)
    with path.open("wb") as file:
        for chunk in chunks:
            file.write(chunk)
    return table, {"file": _BINARY, "bytes": offset, "hash": digest.hexdigest()}
