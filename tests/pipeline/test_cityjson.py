# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Reading CityJSON: versions, levels of detail, parts, and files that are wrong."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from town_files import DELFT, DENHAAG, TownFile, box

from nightcity.city.cityjson import read_cityjson
from nightcity.city.cityjson_buildings import SourceBuilding, source_buildings
from nightcity.city.cityjson_geometry import Surface, polygons
from nightcity.city.import_town import import_town
from nightcity.city.town_options import TownOptions
from nightcity.errors import SceneError, UsageError

LO, HI = (0, 0, 0), (10, 8, 6)


def sources(path: Path, lod: str = "finest") -> tuple[list[SourceBuilding], Counter[str]]:
    notes: Counter[str] = Counter()
    return source_buildings(read_cityjson(path), lod, notes), notes


@pytest.mark.parametrize("version", ["1.0", "1.1", "2.0"])
def test_versions_give_the_same_town(tmp_path: Path, version: str) -> None:
    town = TownFile(version)
    town.add("house", box(LO, HI), lod=1 if version == "1.0" else "1")
    city = import_town(town.write(tmp_path))
    positions = city.buildings[0].mesh.positions + city.buildings[0].origin
    assert positions.min(axis=0) == pytest.approx((-5, -4, 0))
    assert positions.max(axis=0) == pytest.approx((5, 4, 6))
    offset = (0, 0, 0) if version == "1.0" else (85000, 447000, 2)
    assert city.origin_offset == pytest.approx(np.add((5, 4, 0), offset))


def test_transform_is_applied_where_version_1_0_has_one(tmp_path: Path) -> None:
    town = TownFile("1.0")
    town.add("house", box(LO, HI))
    document = town.document()
    document["transform"] = {"scale": [2.0, 1.0, 0.5], "translate": [100.0, 200.0, 300.0]}
    path = tmp_path / "town.json"
    path.write_text(json.dumps(document))
    vertices = read_cityjson(path).vertices
    assert vertices.min(axis=0) == pytest.approx((100, 200, 300))
    assert vertices.max(axis=0) == pytest.approx((120, 208, 303))


@pytest.mark.parametrize(
    "kind", ["Solid", "MultiSurface", "CompositeSurface", "MultiSolid", "CompositeSolid"]
)
def test_kinds_of_geometry_give_the_same_mesh(tmp_path: Path, kind: str) -> None:
    town = TownFile()
    town.add("house", box(LO, HI), kind=kind)
    mesh = import_town(town.write(tmp_path)).buildings[0].mesh
    assert (
        len(mesh.counts) == 10
    )  # 4 walls and a roof of two triangles; the floor lies in the ground
    assert np.ptp(mesh.positions, axis=0) == pytest.approx((10, 8, 6))


def test_only_the_outer_shell_of_a_solid_is_taken(tmp_path: Path) -> None:
    town = TownFile()
    geometry = town.add("house", box(LO, HI))
    cavity = [[town.ring(ring) for ring in face] for face in box((1, 1, 1), (9, 7, 5))]
    geometry["boundaries"].append(cavity)
    assert len(import_town(town.write(tmp_path)).buildings[0].mesh.counts) == 10


def test_finest_level_is_taken_or_the_one_asked_for(tmp_path: Path) -> None:
    town = TownFile("1.0")
    for lod, height in ((1, 6), ("2.2", 7), (2, 8)):
        town.add("house", box(LO, (10, 8, height)), lod=lod)
    path = town.write(tmp_path)

    def height_at(lod: str) -> float:
        return float(
            import_town(path, TownOptions(lod=lod)).buildings[0].mesh.positions[:, 2].max()
        )

    assert [height_at(lod) for lod in ("finest", "1", "2", "2.2", "2.0")] == [7, 6, 8, 7, 8]
    with pytest.raises(SceneError, match=r"level of detail 3; levels there: 1, 2, 2\.2"):
        import_town(path, TownOptions(lod="3"))


def test_buildings_without_the_level_are_counted(tmp_path: Path) -> None:
    town = TownFile()
    town.add("a", box(LO, HI), lod="1.2")
    town.add("b", box((20, 0, 0), (30, 8, 6)), lod="2.2")
    found, notes = sources(town.write(tmp_path), "1.2")
    assert [building.name for building in found] == ["a"]
    assert notes == {"buildings without level of detail 1.2, left out": 1}


@pytest.mark.parametrize("lod", ["fine", "", "nan", "inf"])
def test_lod_option_must_be_a_level(lod: str) -> None:
    with pytest.raises(UsageError, match=r"^lod = "):
        TownOptions(lod=lod)


def test_parts_belong_to_their_building(tmp_path: Path) -> None:
    town = TownFile()
    town.objects["house"] = {"type": "Building", "children": ["left", "right"]}
    town.add("left", box(LO, HI), type="BuildingPart", parents=["house"])
    town.add("right", box((10, 0, 0), (14, 8, 3)), type="BuildingPart", parents=["house"])
    town.add("orphan", box((30, 0, 0), (34, 8, 3)), type="BuildingPart")
    city = import_town(town.write(tmp_path))
    assert [building.name for building in city.buildings] == ["house", "orphan"]
    assert len(city.buildings[0].mesh.counts) == 20
    assert city.notes == ("BuildingParts without a parent, taken as buildings: 1",)


def test_part_named_only_by_itself_still_joins_its_parent(tmp_path: Path) -> None:
    town = TownFile()
    town.objects["house"] = {"type": "Building"}
    town.add("part", box(LO, HI), type="BuildingPart", parents=["house"])
    found, notes = sources(town.write(tmp_path))
    assert [(item.name, [part.name for part in item.parts]) for item in found] == [
        ("house", ["part"])
    ]
    assert not notes


def test_children_in_a_circle_or_missing_do_no_harm(tmp_path: Path) -> None:
    town = TownFile()
    town.objects["house"] = {"type": "Building", "children": ["a", "gone"]}
    town.add("a", box(LO, HI), type="BuildingPart", children=["b"])
    town.add("b", box((10, 0, 0), (14, 8, 3)), type="BuildingPart", children=["a"])
    found, notes = sources(town.write(tmp_path))
    assert [part.name for part in found[0].parts] == ["a", "b"]
    assert notes == {"children of buildings that are not in the file, left out": 1}


def test_hull_around_parts_is_left_out_and_a_body_beside_them_is_not(tmp_path: Path) -> None:
    """Some files give a Building with parts a second geometry around all of them; in others it is
    the main house beside its annexes."""
    town = TownFile()
    town.add("hull", box((0, 0, 0), (20, 8, 9)), children=["h1", "h2"])
    town.add("h1", box((0, 0, 0), (10, 8, 9)), type="BuildingPart")
    town.add("h2", box((10, 0, 0), (20, 8, 5)), type="BuildingPart")
    town.add("main", box((40, 0, 0), (50, 8, 9)), children=["annex"])
    town.add("annex", box((50, 0, 0), (54, 8, 3)), type="BuildingPart")
    city = import_town(town.write(tmp_path))
    assert [len(building.mesh.counts) for building in city.buildings] == [20, 20]
    assert city.notes == ("Buildings with geometry around their parts, which are taken instead: 1",)


def test_part_in_less_detail_fills_its_place(tmp_path: Path) -> None:
    town = TownFile()
    town.objects["house"] = {"type": "Building", "children": ["a", "b"]}
    town.add("a", box(LO, HI), type="BuildingPart", lod="2")
    town.add("a", box(LO, (10, 8, 5)), lod="1", type="BuildingPart")
    town.add("b", box((10, 0, 0), (14, 8, 3)), type="BuildingPart", lod="1")
    found, _ = sources(town.write(tmp_path))
    assert [part.name for part in found[0].parts] == ["a", "b"]


def test_other_objects_and_geometries_are_counted(tmp_path: Path) -> None:
    town = TownFile()
    geometry = town.add("house", box(LO, HI))
    town.objects["house"]["geometry"] = [
        {"type": "GeometryInstance", "template": 0, "boundaries": [0]},
        {"type": "MultiPoint", "lod": "1", "boundaries": [0]},
        geometry,
    ]
    town.objects["tree"] = {"type": "SolitaryVegetationObject"}
    town.objects["shed"] = {"type": "Building"}
    assert set(import_town(town.write(tmp_path)).notes) == {
        "objects of type SolitaryVegetationObject, no buildings, left out: 1",
        "geometries of type GeometryInstance, not supported, left out: 1",
        "geometries of type MultiPoint, not supported, left out: 1",
        "buildings without solid or surface geometry, left out: 1",
    }


def test_semantics_are_read_at_every_depth() -> None:
    ring = [[0, 1, 2]]
    surfaces = [{"type": "RoofSurface"}, {"type": "WallSurface"}, {"type": "Door"}]
    solid = {"surfaces": surfaces, "values": [[1, None, 2]]}
    found = polygons(
        {"type": "Solid", "boundaries": [[ring, ring, ring]], "semantics": solid}, "g", 3
    )
    assert found.surfaces == [Surface.WALL, Surface.UNKNOWN, Surface.OTHER]
    flat = {"surfaces": surfaces, "values": [0]}
    found = polygons({"type": "MultiSurface", "boundaries": [ring], "semantics": flat}, "g", 3)
    assert found.surfaces == [Surface.ROOF]
    for misfit in ([0, 1], [[7, 0, 0]], [[0]], "x", [[-1, 0, 0]]):
        semantics = {"surfaces": surfaces, "values": misfit}
        boundaries = {"type": "Solid", "boundaries": [[ring, ring, ring]], "semantics": semantics}
        assert polygons(boundaries, "g", 3).semantics_misfit


def edited(change: Callable[[dict[str, Any]], object]) -> bytes:
    document = json.loads(DELFT.read_text())
    change(document)
    return json.dumps(document).encode()


def first_building(document: dict[str, Any]) -> dict[str, Any]:
    return next(item for item in document["CityObjects"].values() if item["type"] == "Building")


def with_boundaries(boundaries: object) -> bytes:
    return edited(lambda d: first_building(d)["geometry"][0].update(boundaries=boundaries))


BAD_FILES = {
    "empty": (b"", "not JSON"),
    "binary": (b"\xff\xfe\x00", "not JSON: no UTF-8"),
    "cut off": (DELFT.read_bytes()[:5000], "not JSON: .*line"),
    "nested without end": (b"[" * 100_000, "not JSON"),
    "a list": (b"[1]", "not CityJSON"),
    "GeoJSON": (b'{"type": "FeatureCollection"}', "not CityJSON: type is 'FeatureCollection'"),
    "a feature": (b'{"type": "CityJSONFeature"}', "CityJSONSeq must be collected"),
    "no version": (edited(lambda d: d.pop("version")), "version: None is none of 1.0, 1.1, 2.0"),
    "old version": (edited(lambda d: d.update(version="0.9")), "version: '0.9'"),
    "version no text": (edited(lambda d: d.update(version=2.0)), "version: 2.0"),
    "no objects": (edited(lambda d: d.pop("CityObjects")), "CityObjects: missing"),
    "empty town": (edited(lambda d: d.update(CityObjects={})), "there is no Building"),
    "object no object": (edited(lambda d: d.update(CityObjects={"a": 1})), r"CityObjects\['a'\]"),
    "no vertices": (edited(lambda d: d.pop("vertices")), "vertices: missing or empty"),
    "empty vertices": (edited(lambda d: d.update(vertices=[])), "vertices: missing or empty"),
    "flat vertices": (edited(lambda d: d.update(vertices=[1, 2])), "vertices: must be a list of"),
    "ragged": (edited(lambda d: d["vertices"].append([1, 2])), "vertices: entries differ"),
    "text vertex": (edited(lambda d: d["vertices"].append(["a", 1, 2])), "vertices: .* no number"),
    "null vertex": (edited(lambda d: d["vertices"].append([None, 1, 2])), "vertices: .* no number"),
    "NaN": (edited(lambda d: d["vertices"].insert(3, [float("nan"), 1, 2])), r"vertices\[3\]: not"),
    "infinity": (edited(lambda d: d["vertices"].insert(3, [1e999, 1, 2])), r"vertices\[3\]: not a"),
    "no transform": (edited(lambda d: d.pop("transform")), "transform: missing"),
    "bad scale": (edited(lambda d: d["transform"].update(scale=[1, 0, 1])), "scale above 0"),
    "short scale": (edited(lambda d: d["transform"].update(scale=[1, 1])), "three numbers"),
    "degrees": (
        edited(lambda d: d["metadata"].update(referenceSystem="urn:ogc:def:crs:EPSG::4979")),
        "is in degrees; reproject",
    ),
    "index outside": (with_boundaries([[[[0, 1, 999999]]]]), "vertex index 999999 is none of"),
    "index negative": (with_boundaries([[[[0, 1, -1]]]]), "vertex index -1 is none of"),
    "index no number": (with_boundaries([[[[0, 1, "2"]]]]), "no vertex index"),
    "index a fraction": (with_boundaries([[[[0, 1, 2.5]]]]), "no vertex index"),
    "too shallow": (with_boundaries([[0, 1, 2]]), "boundaries"),
    "too deep": (with_boundaries([[[[[0, 1, 2]]]]]), "boundaries"),
    "boundaries missing": (with_boundaries(None), "boundaries: must be a list"),
    "surface without ring": (with_boundaries([[[]]]), "a surface without a ring"),
    "lod missing": (edited(lambda d: first_building(d)["geometry"][0].pop("lod")), "lod: None"),
    "geometry no list": (edited(lambda d: first_building(d).update(geometry=5)), "must be a list"),
    "stray vertex": (
        edited(lambda d: d["vertices"].__setitem__(0, [10**12, 0, 0])),
        "the buildings span 1e.09 m",
    ),
    "children no list": (edited(lambda d: first_building(d).update(children="a")), "list of ids"),
}


@pytest.mark.parametrize("name", BAD_FILES)
def test_bad_files_are_named(tmp_path: Path, name: str) -> None:
    content, message = BAD_FILES[name]
    path = tmp_path / "bad.city.json"
    path.write_bytes(content)
    with pytest.raises(SceneError, match=message) as error:
        import_town(path)
    assert str(error.value).startswith(str(path))


def test_missing_file_and_footprints_only(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="cannot be read"):
        import_town(tmp_path / "nothing.json")
    town = TownFile()
    town.add("flat", box(LO, (10, 8, 0))[4:5], kind="MultiSurface", lod="0")
    with pytest.raises(SceneError, match=r"no building has a shape; .*footprints only.*: 1"):
        import_town(town.write(tmp_path))


def test_excerpts_skip_what_is_no_building() -> None:
    assert set(import_town(DELFT).notes) == {
        f"objects of type {kind}, no buildings, left out: 2"
        for kind in ("LandUse", "PlantCover", "Road")
    }
    assert import_town(DENHAAG).notes == ("objects of type TINRelief, no buildings, left out: 1",)
