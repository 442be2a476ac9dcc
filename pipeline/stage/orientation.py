# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Rotations as quaternions."""

from __future__ import annotations

import numpy as np

from nightcity.city.model import FloatArray


def orientations(half_u: FloatArray, half_v: FloatArray) -> FloatArray:
    """Quaternions that turn x to half_u, y to half_v and z to half_u x half_v.

    half_u, half_v: (N, 3), at right angles, of any length above 0. Returns (N, 4): x, y, z, real,
    of unit length, the real part not negative.
    """
    x = half_u / np.linalg.norm(half_u, axis=1, keepdims=True)
    z = np.cross(x, half_v)
    z /= np.linalg.norm(z, axis=1, keepdims=True)
    y = np.cross(z, x)
    m = np.stack([x, y, z], axis=2)  # columns are the images of the axes
    # Shepperd's method: each row is the quaternion times four times one of its components; the
    # longest row divides by the largest component.
    products = np.empty((len(m), 4, 4))
    diagonal = np.stack([m[:, 0, 0], m[:, 1, 1], m[:, 2, 2]], axis=1)
    trace = diagonal.sum(axis=1)
    for i in range(3):
        products[:, i, i] = 1 + 2 * diagonal[:, i] - trace
    products[:, 3, 3] = 1 + trace
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        products[:, i, j] = products[:, j, i] = m[:, j, i] + m[:, i, j]
        products[:, k, 3] = products[:, 3, k] = m[:, j, i] - m[:, i, j]
    largest = np.argmax(np.einsum("nii->ni", products), axis=1)
    quaternion = products[np.arange(len(m)), largest]
    quaternion /= np.linalg.norm(quaternion, axis=1, keepdims=True)
    quaternion = np.where(quaternion[:, 3:] < 0, -quaternion, quaternion)
    return quaternion + 0.0  # -0 and 0 are one rotation and must be the same bytes
