# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The cameras layer."""

from __future__ import annotations

import math

import numpy as np
from pxr import Gf, Sdf

from nightcity.city.model import Camera, City, FloatArray
from nightcity.stage import layout
from nightcity.stage.attributes import PrimWriter
from nightcity.stage.bounds import city_bounds

# Apertures and focal lengths of UsdGeomCamera are in tenths of a stage unit, here 0.1 m.
_VERTICAL_APERTURE = 0.24  # 24 mm
_NEAREST = 0.1  # m
_BEHIND = 1e4  # m of ground shown beyond the city


def write_cameras(city: City, layer: Sdf.Layer) -> None:
    """Write the cameras into an empty layer."""
    cameras = PrimWriter(layout.city_prim(layer), layout.CAMERAS.name, "Scope")
    bounds = city_bounds(city)
    aspect = city.resolution[0] / city.resolution[1]
    for camera in city.cameras:
        _write_camera(cameras, camera, aspect, bounds)


def _write_camera(
    cameras: PrimWriter, camera: Camera, aspect: float, bounds: tuple[np.ndarray, np.ndarray]
) -> None:
    prim = PrimWriter(cameras, camera.name, "Camera")
    line = np.array([[*camera.position, *camera.target]], float)
    track = line if camera.track is None else camera.track
    matrices = [_matrix(*place) for place in track.reshape(-1, 2, 3)]
    prim.place(transform=(Sdf.ValueTypeNames.Matrix4d, matrices[0]))
    if len(matrices) > 1:
        prim.sample_transform(dict(enumerate(matrices, start=1)))
    half = math.radians(camera.vertical_fov_degrees) / 2
    prim.set("projection", "perspective")
    prim.set("verticalAperture", _VERTICAL_APERTURE)
    prim.set("horizontalAperture", _VERTICAL_APERTURE * aspect)
    prim.set("focalLength", 0.5 * _VERTICAL_APERTURE / math.tan(half))
    prim.set("focusDistance", math.dist(camera.position, camera.target))
    # Viewers with a linear depth buffer lose the centimetre between a window and its wall when
    # the near plane is close, so it goes out half-way to the city.
    positions = track[:, :3]
    lo, hi = bounds
    outside = np.maximum(np.maximum(lo - positions, positions - hi), 0)
    near = float(np.linalg.norm(outside, axis=1).min())
    farthest = np.maximum(np.abs(positions - lo), np.abs(positions - hi))
    far = float(np.linalg.norm(farthest, axis=1).max())
    prim.set("clippingRange", Gf.Vec2f(max(0.5 * near, _NEAREST), far + _BEHIND))


def _matrix(position: FloatArray, target: FloatArray) -> Gf.Matrix4d:
    """Camera to world: rows are right, up, back and the position; up is z where it can be."""
    back = position - target
    back /= np.linalg.norm(back)
    up = np.array([0.0, 0.0, 1.0])
    right = np.cross(up, back)
    if np.linalg.norm(right) < 1e-9:  # straight up or down: then y is up in the picture
        right = np.cross([0.0, 1.0, 0.0], back)
    right /= np.linalg.norm(right)
    up = np.cross(back, right)
    rows = np.zeros((4, 4))
    rows[0, :3], rows[1, :3], rows[2, :3], rows[3, :3], rows[3, 3] = right, up, back, position, 1
    return Gf.Matrix4d(rows.tolist())
