# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Cameras placed by how much of the frame they fill.

The share of a box is the height that its eight projected corners span, over the height of the
frame: 0.75 fills three quarters. Pixels are square and up is z.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from nightcity.city.model import Camera, FloatArray

Vector = Sequence[float] | FloatArray

# The paper's cameras: towards the eye from the target (m) in the 4 x 4 city.
OVERVIEW_TARGET = (0.0, 0.0, 6.0)
OVERVIEW_EYE = (95.0, -125.0, 62.0)
OVERVIEW_FOV = 33.141  # degrees, vertical
FAR_TARGET = (0.0, 0.0, 8.0)
FAR_EYE = (300.0, -390.0, 150.0)
FAR_FOV = 27.79
_SHARE_TOLERANCE = 5e-4  # an eye whose share is this near stays where it is


def frame_height_share(camera: Camera, lo: Vector, hi: Vector) -> float:
    """Share of the frame's height that the box from lo to hi (m) spans; inf if the box reaches
    behind the camera."""
    eye = np.asarray(camera.position, dtype=float)
    forward = np.asarray(camera.target, dtype=float) - eye
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    up = np.cross(right / np.linalg.norm(right), forward)
    corners = _corners(lo, hi) - eye
    depth = corners @ forward
    if depth.min() <= 0:
        return float("inf")
    return float(np.ptp(corners @ up / depth) / (2 * _tan_half(camera.vertical_fov_degrees)))


def frame_box(
    name: str,
    lo: Vector,
    hi: Vector,
    *,
    share: float,
    towards_eye: Vector,
    target: Vector,
    vertical_fov_degrees: float,
) -> Camera:
    """A camera on the ray from target along towards_eye, as far out as the box fills the share.

    lo, hi: corners of the box, m. share: above 0, of the frame's height. towards_eye: any length,
    not vertical. ValueError where no distance gives the share.
    """
    target = np.asarray(target, dtype=float)
    direction = np.asarray(towards_eye, dtype=float)
    direction = direction / np.linalg.norm(direction)

    def at(distance: float) -> Camera:
        position = tuple(map(float, target + distance * direction))
        return Camera(name, position, tuple(map(float, target)), vertical_fov_degrees)

    def too_near(distance: float) -> bool:
        return frame_height_share(at(distance), lo, hi) > share

    size = float(np.linalg.norm(np.subtract(hi, lo)))
    near = max(float(((_corners(lo, hi) - target) @ direction).max()), 0.0) + 1e-6 * size
    if not (size > 0 and 0 < share < np.inf and too_near(near)):
        raise ValueError(f"camera {name}: no distance fills {share} of the frame with this box")
    far = near + size
    while too_near(far):
        near, far = far, 2 * far
    while near < (middle := 0.5 * (near + far)) < far:
        near, far = (middle, far) if too_near(middle) else (near, middle)
    return at(far)


def overview_cameras(lo: Vector, hi: Vector, centre: Vector = (0.0, 0.0)) -> tuple[Camera, ...]:
    """overview75, 25, 50, 100 and far25 of a city between lo and hi (m), seen as in the paper.

    centre: (x, y) m, what they look at, on ground at lo's height. The paper's own eye is kept
    where it already gives the share.
    """
    base = np.array((centre[0], centre[1], lo[2]))
    views = [
        (f"overview{percent}", percent / 100, OVERVIEW_EYE, OVERVIEW_TARGET, OVERVIEW_FOV)
        for percent in (75, 25, 50, 100)
    ]
    views.append(("far25", 0.25, FAR_EYE, FAR_TARGET, FAR_FOV))
    cameras = []
    for name, share, eye, target, fov in views:
        position, aim = (tuple(map(float, base + point)) for point in (eye, target))
        camera = Camera(name, position, aim, fov)
        if abs(frame_height_share(camera, lo, hi) - share) > _SHARE_TOLERANCE:
            camera = frame_box(
                name,
                lo,
                hi,
                share=share,
                towards_eye=np.subtract(eye, target),
                target=aim,
                vertical_fov_degrees=fov,
            )
        cameras.append(camera)
    return tuple(cameras)


def look_along(name: str, eye: Vector, direction: Vector, vertical_fov_degrees: float) -> Camera:
    """A camera at eye (m) that looks along direction, to a target 10 m away."""
    direction = np.asarray(direction, dtype=float)
    target = np.asarray(eye, dtype=float) + 10.0 * direction / np.linalg.norm(direction)
    return Camera(name, tuple(map(float, eye)), tuple(map(float, target)), vertical_fov_degrees)


def _corners(lo: Vector, hi: Vector) -> FloatArray:
    return np.array(list(product(*zip(lo, hi, strict=True))), dtype=float)


def _tan_half(fov_degrees: float) -> float:
    return float(np.tan(np.radians(fov_degrees) / 2))
