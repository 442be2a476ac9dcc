# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A flat scene as other renderers take it: one box of haze, black walls, one-sided rectangles."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nightcity.bench.judge import View
from nightcity.errors import SceneError
from nightcity.export.read import FlatScene, read_scene
from nightcity.export.records import WINDOW_ON, WINDOW_SPHERE

_GREEN = 1  # the one channel that is rendered
_CAMERA = ("position", "right", "up", "forward", "tan_half_fov", "shift_x", "shift_y")


def write_peer_scene(view: View, pixels: NDArray[np.int64], file: Path) -> None:
    """Write what the peers' programs read: geometry, haze, camera, and pixels (N, 2) with rays.

    SceneError where the haze is more than one box or not one haze, or a lamp is a sphere.
    """
    scene = read_scene(view.scene.folder)
    origins, directions = pixel_rays(scene, view, pixels)
    camera = scene.camera(view.camera)
    lo, hi, extinction, albedo = _haze(scene, view.scene.name)
    corners, radiance = _panes(scene, view.scene.name)
    np.savez(
        file,
        vertices=scene.arrays["position"]["position"],
        faces=scene.arrays["triangle"]["vertex"],
        corners=corners,
        radiance=radiance,
        lo=lo,
        hi=hi,
        extinction=extinction,
        albedo=albedo,
        origins=origins,
        directions=directions,
        pixels=pixels,
        size=[int(side) for side in view.size.split("x")],
        **{field: camera[field] for field in _CAMERA},
    )


def pixel_rays(
    scene: FlatScene, view: View, pixels: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Origins (N, 3) m and unit directions (N, 3) through pixel centres, docs/scene_format.md."""
    width, height = (int(side) for side in view.size.split("x"))
    camera = scene.camera(view.camera)
    vectors = {name: camera[name].astype(float) for name in ("right", "up", "forward", "position")}
    tangent = float(camera["tan_half_fov"])
    x, y = pixels[:, 0] + 0.5, pixels[:, 1] + 0.5
    across = tangent * ((2 * x - width) / height + float(camera["shift_x"]))
    upward = tangent * ((height - 2 * y) / height + float(camera["shift_y"]))
    directions = vectors["forward"] + np.outer(across, vectors["right"])
    directions += np.outer(upward, vectors["up"])
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return np.tile(vectors["position"], (len(pixels), 1)), directions


def _haze(
    scene: FlatScene, name: str
) -> tuple[NDArray[np.float64], NDArray[np.float64], float, float]:
    """The one box that media and buildings fill together: corners (m), 1/m, albedo."""
    boxes = scene.arrays["media_box"]
    if not len(boxes):
        raise SceneError(f"{name}: has no haze")
    for field in ("extinction", "albedo"):
        if np.ptp(boxes[field]) > 0:
            raise SceneError(f"{name}: boxes of haze differ in {field}; peers are given one")
    lo, hi = boxes["lo"].min(axis=0).astype(float), boxes["hi"].max(axis=0).astype(float)
    media = float(np.prod(boxes["hi"].astype(float) - boxes["lo"], axis=1).sum())
    if not np.isclose(media + _building_volume(scene), np.prod(hi - lo), rtol=1e-4):
        raise SceneError(
            f"{name}: haze and buildings do not fill one box together; take a paper-NxN preset"
        )
    return lo, hi, float(boxes["extinction"][0]), float(boxes["albedo"][0])


def _building_volume(scene: FlatScene) -> float:
    """Of closed triangle meshes, m^3, by the divergence theorem: walls and roofs; an open base at
    z = 0 adds nothing."""
    corners = scene.arrays["position"]["position"].astype(float)
    first, second, third = (corners[scene.arrays["triangle"]["vertex"][:, i]] for i in range(3))
    return float(np.sum(first * np.cross(second, third)) / 6)


def _panes(scene: FlatScene, name: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lit windows: corners (M, 4, 3) m, counter-clockwise seen from outside, and radiance (M,)
    P / (pi A), W m^-2 sr^-1."""
    windows = scene.arrays["window"]
    windows = windows[(windows["flags"] & WINDOW_ON) != 0]
    if not len(windows):
        raise SceneError(f"{name}: no window is lit")
    if np.any(windows["flags"] & WINDOW_SPHERE):
        raise SceneError(f"{name}: a lamp is a sphere; peers are given rectangles only")
    centre, u, v = (windows[field].astype(float) for field in ("centre", "half_u", "half_v"))
    corners = np.stack([centre - u - v, centre + u - v, centre + u + v, centre - u + v], axis=1)
    area = 4 * np.linalg.norm(np.cross(u, v), axis=1)
    power = windows["power"].astype(float) * windows["colour"][:, _GREEN]
    return corners, power / (np.pi * area)
