# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes and materials of generated buildings: boxes of six quads."""

from __future__ import annotations

import numpy as np

from nightcity.city.model import Material, Mesh
from nightcity.city.parameters import CityParameters
from nightcity.city.textures import FacadeTexture

# Corners 0 to 3 at the bottom, 4 to 7 above them, counter-clockwise from (-x, -y).
_CORNERS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], dtype=float)
# South, east, north, west, roof, bottom; each from its lower left as seen from outside.
_QUADS = np.array(
    [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7), (1, 0, 3, 2)]
)
_CORNER_SHARES = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], dtype=float)


def city_materials(
    parameters: CityParameters, textures: tuple[FacadeTexture, ...]
) -> tuple[Material, ...]:
    """One facade for each texture, then the roof, then the ground."""
    facades = [
        Material(texture.name, parameters.facade_reflectance, texture.texels)
        for texture in textures
    ]
    roof = Material("roof", parameters.roof_reflectance)
    return (*facades, roof, Material("ground", parameters.ground_reflectance))


def box_mesh(
    base: float, height: float, facade: int, roof: int, texture_size: tuple[float, float]
) -> Mesh:
    """A box on the ground about the origin, its arrays read-only.

    base, height: m. facade, roof: materials; the bottom takes the roof's. texture_size: m that a
    repeat covers; it starts at the lower left of each face.
    """
    positions = np.zeros((8, 3))
    positions[:, :2] = np.tile(0.5 * base * _CORNERS, (2, 1))
    positions[4:, 2] = height
    sizes = np.array([(base, height)] * 4 + [(base, base)] * 2) / np.array(texture_size)
    texcoords = (sizes[:, None] * _CORNER_SHARES).reshape(-1, 2)
    mesh = Mesh(
        positions,
        np.full(6, 4),
        _QUADS.ravel().copy(),
        np.array([facade] * 4 + [roof] * 2),
        texcoords,
    )
    for array in (mesh.positions, mesh.counts, mesh.indices, mesh.materials, mesh.texcoords):
        array.setflags(write=False)
    return mesh
