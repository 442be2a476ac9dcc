# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Cameras that move over the frames: a flight about the city and a drive along a street."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from nightcity.city.model import Camera

_TURN = np.radians(0.25)  # about the vertical through the target, a frame
_DRIVE = 0.5  # m a frame, 12 m/s at 24 frames a second


def moving_cameras(cameras: Sequence[Camera], frames: int) -> tuple[Camera, ...]:
    """``flight``, which circles the city with what overview75 sees at the first frame, and
    ``drive``, which goes on from the camera ``street``; none where there is one frame only, or
    no camera of that name."""
    if frames == 1:
        return ()
    moved = {"overview75": ("flight", _flight), "street": ("drive", _drive)}
    return tuple(
        replace(camera, name=moved[camera.name][0], track=moved[camera.name][1](camera, frames))
        for camera in cameras
        if camera.name in moved
    )


def _flight(camera: Camera, frames: int) -> np.ndarray:
    target = np.array(camera.target)
    arm = np.array(camera.position) - target
    angle = _TURN * np.arange(frames)
    cosine, sine = np.cos(angle), np.sin(angle)
    turned = np.column_stack(
        [
            cosine * arm[0] - sine * arm[1],
            sine * arm[0] + cosine * arm[1],
            np.full(frames, arm[2]),
        ]
    )
    return np.column_stack([target + turned, np.tile(target, (frames, 1))])


def _drive(camera: Camera, frames: int) -> np.ndarray:
    line = np.array([camera.position, camera.target])
    along = (line[1] - line[0]) * (1, 1, 0)
    along /= np.linalg.norm(along)
    steps = _DRIVE * np.arange(frames)[:, None] * along
    return np.column_stack([line[0] + steps, line[1] + steps])
