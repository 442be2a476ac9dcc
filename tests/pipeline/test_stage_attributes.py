# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The helper through which every prim is written refuses what no schema knows."""

from __future__ import annotations

import numpy as np
import pytest
from pxr import Gf, Sdf, Vt

from nightcity import schemas
from nightcity.stage.attributes import PrimWriter, UnknownAttributeError

schemas.register()


def layer() -> Sdf.Layer:
    return Sdf.Layer.CreateAnonymous("layer.usda")


def test_types_and_variability_come_from_the_schema() -> None:
    stage = layer()
    prim = PrimWriter(stage, "Windows", "PointInstancer", ["NightcityWindowsAPI"])
    prim.set("nightcity:windowSize", Gf.Vec2f(1, 2))
    prim.set("nightcity:power", np.array([1.0, 2.0]))
    prim.set("ids", np.array([2**40]))
    size = stage.GetAttributeAtPath("/Windows.nightcity:windowSize")
    power = stage.GetAttributeAtPath("/Windows.nightcity:power")
    assert (size.typeName, size.variability) == ("float2", Sdf.VariabilityUniform)
    assert (power.typeName, power.variability) == ("float[]", Sdf.VariabilityVarying)
    assert power.default == Vt.FloatArray([1, 2])
    assert stage.GetAttributeAtPath("/Windows.ids").default == Vt.Int64Array([2**40])


@pytest.mark.parametrize(
    ("type_name", "applied", "name"),
    [
        ("Cube", ["NightcityMediaAPI"], "nightcity:extinktion"),
        ("Cube", [], "nightcity:extinction"),
        ("Mesh", [], "positions"),
        ("Cube", ["NightcityMediaAPI"], "nightcity:windowLightSources"),
    ],
)
def test_unknown_attributes_are_refused(type_name: str, applied: list[str], name: str) -> None:
    stage = layer()
    prim = PrimWriter(stage, "Prim", type_name, applied)
    with pytest.raises(UnknownAttributeError, match=name):
        prim.set(name, 1.0)


def test_unknown_relationships_are_refused() -> None:
    stage = layer()
    prim = PrimWriter(stage, "Prim", "Mesh")
    for name in ("prototypes", "material:binding", "points"):
        with pytest.raises(UnknownAttributeError, match=name):
            prim.relate(name, [Sdf.Path("/Other")])


def test_quaternions_keep_their_real_part() -> None:
    stage = layer()
    prim = PrimWriter(stage, "Prim", "PointInstancer")
    prim.set("orientationsf", np.array([[0.1, 0.2, 0.3, 0.9]]))
    prim.set("orientations", np.array([[0.25, 0.5, 0.75, 1.0]]))
    full = stage.GetAttributeAtPath("/Prim.orientationsf").default[0]
    half = stage.GetAttributeAtPath("/Prim.orientations").default[0]
    assert full == Gf.Quatf(0.9, Gf.Vec3f(0.1, 0.2, 0.3))
    assert half == Gf.Quath(1.0, Gf.Vec3h(0.25, 0.5, 0.75))
