# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The geometry layer: buildings, the ground and their materials."""

from __future__ import annotations

import numpy as np
from pxr import Gf, Sdf, Vt

from nightcity.city.model import Building, City
from nightcity.progress import Progress
from nightcity.stage import layout
from nightcity.stage.attributes import PrimWriter
from nightcity.stage.bounds import city_bounds
from nightcity.stage.materials import write_material

_GROUND_MARGIN = 10.0  # the ground shown to viewers reaches this many city radii out
_GROUND_LEAST = 5000.0  # m, and at least so far: close to the horizon


def write_geometry(city: City, layer: Sdf.Layer, texture_folder: str) -> None:
    """Write everything opaque, about each building's own origin, into an empty layer."""
    root = write_ground(city, layer, texture_folder)
    buildings = PrimWriter(root, layout.BUILDINGS.name, "Xform")
    buildings.spec.kind = "group"
    with Progress("writing buildings", len(city.buildings)) as progress:
        for name, members in layout.groups(city.buildings):
            group = PrimWriter(buildings, name, "Xform")
            group.spec.kind = "group"
            for building in members:
                _write_building(city, group, building)
            progress.advance(len(members))


def write_ground(city: City, layer: Sdf.Layer, texture_folder: str) -> PrimWriter:
    """Write the looks and the ground into an empty layer; returns the city's prim."""
    root = layout.city_prim(layer)
    looks = PrimWriter(root, layout.LOOKS.name, "Scope")
    for material in city.materials:
        write_material(looks, material, texture_folder)
    _write_ground(city, root)
    return root


def _write_building(city: City, group: PrimWriter, building: Building) -> None:
    prim = PrimWriter(group, layout.building_name(building), "Xform", ["NightcityBuildingAPI"])
    prim.spec.kind = "component"
    if building.name:
        prim.spec.SetInfo("displayName", building.name)
    prim.set("nightcity:buildingId", int(building.building_id))
    origin = Gf.Vec3d(*map(float, building.origin))
    prim.place(translate=(Sdf.ValueTypeNames.Double3, origin))

    mesh = building.mesh
    used = np.unique(mesh.materials)
    bound = ["MaterialBindingAPI"] if len(used) == 1 else []
    shell = PrimWriter(prim, "Shell", "Mesh", bound)
    _write_polygons(shell, mesh.positions, mesh.counts, mesh.indices)
    if mesh.texcoords is not None:
        texcoords = Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(mesh.texcoords, np.float32))
        shell.set_primvar("st", Sdf.ValueTypeNames.TexCoord2fArray, texcoords, "faceVarying")
    if bound:
        _bind(city, shell, used[0])
        return
    if len(used):
        partition = Sdf.AttributeSpec(
            shell.spec,
            "subsetFamily:materialBind:familyType",
            Sdf.ValueTypeNames.Token,
            Sdf.VariabilityUniform,
        )
        partition.default = "partition"
    for material in used:
        name = city.materials[material].name
        subset = PrimWriter(shell, name, "GeomSubset", ["MaterialBindingAPI"])
        subset.set("elementType", "face")
        subset.set("familyName", "materialBind")
        subset.set("indices", np.flatnonzero(mesh.materials == material))
        _bind(city, subset, material)


def _write_polygons(
    prim: PrimWriter, positions: np.ndarray, counts: np.ndarray, indices: np.ndarray
) -> None:
    points = np.ascontiguousarray(positions, np.float32)
    prim.set("points", points)
    prim.set("faceVertexCounts", counts)
    prim.set("faceVertexIndices", indices)
    prim.set("subdivisionScheme", "none")
    prim.set("doubleSided", True)  # as the renderer takes them
    if len(points):
        prim.set("extent", [points.min(axis=0), points.max(axis=0)])


def _bind(city: City, prim: PrimWriter, material: int) -> None:
    prim.relate("material:binding", [layout.material_path(city.materials[material])])


def _write_ground(city: City, root: PrimWriter) -> None:
    """A square around the city; renderers take it for a plane without end."""
    if city.ground_material is None:
        return
    lo, hi = (corner[:2] for corner in city_bounds(city))
    centre = 0.5 * (lo + hi)
    reach = max(_GROUND_MARGIN * 0.5 * float(np.linalg.norm(hi - lo)), _GROUND_LEAST)
    corners = centre + reach * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], float)
    positions = np.column_stack([corners, np.full(4, city.ground_height)])
    ground = PrimWriter(root, "Ground", "Mesh", ["NightcityGroundAPI", "MaterialBindingAPI"])
    _write_polygons(ground, positions, np.array([4]), np.arange(4))
    _bind(city, ground, city.ground_material)
