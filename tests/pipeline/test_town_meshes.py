# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Triangles of real buildings: holes, bent and broken faces, orientation, standing on z = 0."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from town_files import DENHAAG, TownFile, box

from nightcity.city.import_town import import_town
from nightcity.city.model import Building, FloatArray, Mesh
from nightcity.city.triangulate import newell_normal, plane_axes, triangulate

SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]
HOLE = [(1, 1), (1, 3), (3, 3), (3, 1)]


def vector_areas(corners: FloatArray) -> FloatArray:
    return 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def corners_of(mesh: Mesh) -> FloatArray:
    return mesh.positions[mesh.indices.reshape(-1, 3)]


def volume(mesh: Mesh) -> float:
    corners = corners_of(mesh)
    return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6


@pytest.mark.parametrize("tilt", [0.0, 0.6, 1.2])
@pytest.mark.parametrize("turned", [False, True])
def test_holes_stay_open_and_faces_keep_their_side(tilt: float, turned: bool) -> None:
    """The square with a square hole, 12 m^2, tilted in space and seen from either side."""
    plan = np.array(SQUARE + HOLE, dtype=float)
    points = np.column_stack([plan[:, 0], plan[:, 1] * np.cos(tilt), plan[:, 1] * np.sin(tilt)])
    outer, hole = [0, 1, 2, 3], [4, 5, 6, 7]
    rings = [outer[::-1], hole[::-1]] if turned else [outer, hole]
    notes: Counter[str] = Counter()
    found = triangulate([rings], points, notes)
    areas = vector_areas(points[found.vertices])
    wanted = 12.0 * np.array((0, -np.sin(tilt), np.cos(tilt))) * (-1 if turned else 1)
    assert areas.sum(axis=0) == pytest.approx(wanted, abs=1e-12)
    assert np.linalg.norm(areas, axis=1).sum() == pytest.approx(12.0)
    assert not notes


def test_a_hole_may_run_either_way() -> None:
    points = np.column_stack([np.array(SQUARE + HOLE, dtype=float), np.zeros(8)])
    for hole in ([4, 5, 6, 7], [7, 6, 5, 4]):
        found = triangulate([[[0, 1, 2, 3], hole]], points, Counter())
        assert vector_areas(points[found.vertices]).sum(axis=0) == pytest.approx((0, 0, 12))


def test_faces_without_area_are_left_out_and_counted() -> None:
    points = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (1, 0, 0)], dtype=float)
    notes: Counter[str] = Counter()
    found = triangulate([[[0, 1, 2]], [[0, 1, 4]], [[0, 1]], [[0, 1, 3]]], points, notes)
    assert found.vertices.tolist() == [[0, 1, 3]]
    assert found.polygon.tolist() == [3]
    assert notes == {"faces without area, left out": 3}


def test_repeated_vertices_are_dropped() -> None:
    points = np.column_stack([np.array([*SQUARE, SQUARE[0]], dtype=float), np.zeros(5)])
    found = triangulate([[[0, 0, 1, 2, 2, 3, 4]]], points, Counter())
    assert vector_areas(points[found.vertices]).sum(axis=0) == pytest.approx((0, 0, 16))
    assert len(found.vertices) == 2


def test_bent_faces_keep_their_vertices() -> None:
    """A corner 3 cm out of the plane, as the files have it, stays where its neighbours meet it."""
    points = np.array([(0, 0, 0), (4, 0, 0.03), (4, 4, 0), (0, 4, 0)], dtype=float)
    found = triangulate([[[0, 1, 2, 3]]], points, Counter())
    assert set(found.vertices.ravel()) == {0, 1, 2, 3}
    assert vector_areas(points[found.vertices]).sum(axis=0) == pytest.approx(
        0.5 * newell_normal(points)
    )


def test_outline_that_crosses_itself_is_counted() -> None:
    points = np.array([(0, 0, 0), (4, 0, 0), (1, 4, 0), (3, 4, 0)], dtype=float)
    notes: Counter[str] = Counter()
    triangulate([[[0, 1, 2, 3]]], points, notes)
    assert notes == {"faces whose outline crosses itself, kept as they could be cut": 1}


def one_building(town: TownFile, folder: Path) -> Building:
    return import_town(town.write(folder)).buildings[0]


def test_inside_out_solids_are_turned(tmp_path: Path) -> None:
    for kind in ("Solid", "MultiSurface"):
        town = TownFile()
        town.add("house", [[ring[::-1] for ring in face] for face in box((0, 0, 0), (6, 6, 9))])
        assert volume(one_building(town, tmp_path).mesh) == pytest.approx(324), kind


@pytest.mark.parametrize("level", [-3.0, 0.0, 20.0])
def test_every_building_stands_on_zero_and_keeps_its_height(tmp_path: Path, level: float) -> None:
    town = TownFile()
    town.add("low", box((0, 0, level), (10, 8, level + 6)))
    town.add("hill", box((30, 0, level + 5), (40, 8, level + 12)))
    city = import_town(town.write(tmp_path))
    heights = [np.ptp(b.mesh.positions[:, 2]) for b in city.buildings]
    assert [b.mesh.positions[:, 2].min() for b in city.buildings] == [0, 0]
    assert heights == pytest.approx([6, 7])
    ground = city.parameters["ground"]
    assert ground == {"lowest": 2 + level, "highest": 2 + level + 5}


def test_parts_on_higher_ground_reach_down_and_parts_on_parts_do_not(tmp_path: Path) -> None:
    """On a slope the second part's ground is 2 m up: its walls run down. The tower stands on the
    first part's roof: its walls do not."""
    town = TownFile()
    town.objects["house"] = {"type": "Building", "children": ["low", "up", "tower"]}
    town.add("low", box((0, 0, 0), (10, 8, 6)), type="BuildingPart")
    town.add("up", box((10, 0, 2), (20, 8, 7)), type="BuildingPart")
    town.add("tower", box((3, 3, 6), (6, 6, 11)), type="BuildingPart")
    building = one_building(town, tmp_path)
    points = building.mesh.positions + building.origin
    up = points[points[:, 0] > 0.5]
    assert (up[:, 2].min(), up[:, 2].max()) == (0, 7)
    tower = points[(points[:, 0] > -7.5) & (points[:, 0] < -3.5)]
    assert (tower[:, 2].min(), tower[:, 2].max()) == (6, 11)


def test_foot_follows_the_terrain_where_nothing_marks_the_ground(tmp_path: Path) -> None:
    """Walls whose feet lie on a slope of 0.5 m all end at z = 0; eaves stay level."""
    faces = [
        [[(x, y, 0.05 * x if z == 0 else z) for x, y, z in ring] for ring in face]
        for face in box((0, 0, 0), (10, 8, 6), floor=False)
    ]
    town = TownFile()
    town.add("house", faces, kind="MultiSurface")
    z = one_building(town, tmp_path).mesh.positions[:, 2]
    assert set(np.round(z, 9)) == {0.0, 6.0}


def test_meshes_of_the_hague_are_closed_above_the_ground() -> None:
    """Every edge above z = 0 is run through as often one way as the other, as in the file, whose
    solids are closed; edges on the ground are open, as the floors are left out."""
    for building in import_town(DENHAAG).buildings:
        triangles = building.mesh.indices.reshape(-1, 3)
        points = [tuple(p) for p in np.round(building.mesh.positions, 6)]
        edges: Counter[tuple] = Counter()
        for triangle in triangles:
            for a, b in zip(triangle, np.roll(triangle, -1), strict=True):
                if max(points[a][2], points[b][2]) > 0:
                    edges[points[a], points[b]] += 1
                    edges[points[b], points[a]] -= 1
        assert not any(edges.values()), building.name
        assert volume(building.mesh) > 0


@pytest.mark.parametrize(
    "normal", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0.6, -0.8, 0), (0.1, 0.2, 0.9)]
)
def test_plane_axes_are_right_handed_and_point_up(normal: tuple[float, ...]) -> None:
    n = np.array(normal, dtype=float) / np.linalg.norm(normal)
    u, v = plane_axes(n)
    assert np.cross(u, v) == pytest.approx(n)
    assert np.linalg.norm(u) == pytest.approx(1) and u @ v == pytest.approx(0)
    if abs(n[2]) < 0.9:
        assert u[2] == 0 and v[2] > 0
