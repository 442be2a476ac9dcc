# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Reads a flat scene back, for what renders it beside nightcity-render."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nightcity.errors import SceneError
from nightcity.export.records import FORMAT, RECORDS, VERSION


@dataclass(frozen=True)
class FlatScene:
    """The manifest, and the arrays of RECORDS by name, mapped from the file."""

    manifest: dict
    arrays: dict[str, NDArray]

    def camera(self, name: str) -> NDArray:
        """The ``camera_frame`` record of a camera at the first frame."""
        for camera in self.manifest["cameras"]:
            if camera["name"] == name:
                return self.arrays["camera_frame"][camera["first"]]
        raise SceneError(f"the scene has no camera {name}")


def read_scene(folder: Path) -> FlatScene:
    """Read ``folder``; SceneError where it holds no scene of this version."""
    try:
        manifest = json.loads((folder / "scene.json").read_bytes())
        if (manifest["format"], manifest["version"]) != (FORMAT, VERSION):
            raise SceneError(f"{folder}: is no flat scene of version {VERSION}; export it again")
        data = np.memmap(folder / "scene.bin", mode="r")
        arrays = {}
        for name, record in RECORDS.items():
            entry = manifest["arrays"][name]
            end = entry["offset"] + entry["count"] * record.itemsize
            arrays[name] = data[entry["offset"] : end].view(record)
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise SceneError(f"{folder}: cannot be read as a flat scene: {error}") from None
    return FlatScene(manifest, arrays)
