# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Small stages through the Usd API, and flat scenes read back, for the tests of the export."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from pxr import Sdf, Usd, UsdGeom

from nightcity import schemas
from nightcity.export.export_stage import ExportReport, export_stage
from nightcity.export.records import RECORDS

schemas.register()
COLOR_ARRAY = Sdf.ValueTypeNames.Color3fArray


class Scene:
    """A flat scene as its reader sees it: ``scene["window"]["power"]``, ``scene.manifest``."""

    def __init__(self, folder: Path, report: ExportReport | None = None) -> None:
        self.manifest = json.loads((folder / "scene.json").read_text(encoding="utf-8"))
        self.bytes = (folder / "scene.bin").read_bytes()
        self.report = report

    def __getitem__(self, name: str) -> np.ndarray:
        entry = self.manifest["arrays"][name]
        return np.frombuffer(self.bytes, RECORDS[name], entry["count"], entry["offset"])

    @property
    def notes(self) -> str:
        return "\n".join(self.manifest["notes"])

    def corners(self) -> np.ndarray:
        """(T, 3, 3) m."""
        return self["position"]["position"][self["triangle"]["vertex"]]

    def lists(self) -> dict[int, list[int]]:
        """Window ids of each media box, by mediaId."""
        ids = self["window"]["window_id"][self["light_list"]["window"]]
        return {
            int(box["media_id"]): ids[box["first_light"] :][: box["light_count"]].tolist()
            for box in self["media_box"]
        }


def new_stage(path: Path, *, up: str = "Z", unit: float = 1.0) -> Usd.Stage:
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageUpAxis(stage, up)
    UsdGeom.SetStageMetersPerUnit(stage, unit)
    return stage


def export(stage: Usd.Stage, folder: Path, **options: object) -> Scene:
    """Save the stage and export it."""
    stage.Save()
    path = Path(stage.GetRootLayer().realPath)
    return Scene(folder, export_stage(path, folder, **options))


def add_windows(
    stage: Usd.Stage, path: str, positions: Sequence[Sequence[float]], /, **attributes: object
) -> UsdGeom.PointInstancer:
    """Windows of 2 x 1 stage units that shine along +z, ids from 0."""
    instancer = UsdGeom.PointInstancer.Define(stage, path)
    prim = instancer.GetPrim()
    prim.ApplyAPI("NightcityWindowsAPI")
    UsdGeom.Mesh.Define(stage, f"{path}/Pane")
    instancer.CreatePrototypesRel().AddTarget(f"{path}/Pane")
    values = {
        "positions": positions,
        "protoIndices": [0] * len(positions),
        "ids": range(len(positions)),
        "nightcity:windowSize": (2, 1),
    } | attributes
    for name, value in values.items():
        if value is not None:
            prim.GetAttribute(name).Set(value)
    return instancer


def add_box(
    stage: Usd.Stage,
    path: str,
    number: int,
    lo: Sequence[float] = (-5, -5, 0),
    hi: Sequence[float] = (5, 5, 10),
    **attributes: object,
) -> UsdGeom.Cube:
    """A media box, by its corners in stage units."""
    cube = UsdGeom.Cube.Define(stage, path)
    cube.GetPrim().ApplyAPI("NightcityMediaAPI")
    lo, hi = np.array(lo, float), np.array(hi, float)
    cube.AddTranslateOp().Set(tuple((0.5 * (lo + hi)).tolist()))
    cube.AddScaleOp(UsdGeom.XformOp.PrecisionDouble).Set(tuple((0.5 * (hi - lo)).tolist()))
    cube.GetPrim().GetAttribute("nightcity:mediaId").Set(number)
    for name, value in attributes.items():
        cube.GetPrim().GetAttribute(f"nightcity:{name}").Set(value)
    return cube


def add_mesh(
    stage: Usd.Stage,
    path: str,
    points: Sequence[Sequence[float]],
    faces: Sequence[Sequence[int]],
    /,
    **attributes: object,
) -> UsdGeom.Mesh:
    """A polygon mesh, no subdivision surface."""
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreatePointsAttr(points)
    mesh.CreateFaceVertexCountsAttr([len(face) for face in faces])
    mesh.CreateFaceVertexIndicesAttr([index for face in faces for index in face])
    mesh.CreateSubdivisionSchemeAttr("none")
    for name, value in attributes.items():
        mesh.GetPrim().GetAttribute(name).Set(value)
    return mesh


def add_building(stage: Usd.Stage, path: str, number: int) -> UsdGeom.Xform:
    xform = UsdGeom.Xform.Define(stage, path)
    xform.GetPrim().ApplyAPI("NightcityBuildingAPI")
    xform.GetPrim().GetAttribute("nightcity:buildingId").Set(number)
    return xform


SQUARE = ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [[0, 1, 2, 3]])
