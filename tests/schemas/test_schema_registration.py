# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""USD takes the schemas for built-in ones, through register() and through the environment."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest
from pxr import Gf, Tf, Usd

from nightcity import schemas

schemas.register()

PRIM_TYPES = {
    "NightcityCityAPI": "Xform",
    "NightcityBuildingAPI": "Xform",
    "NightcityGroundAPI": "Mesh",
    "NightcityWindowsAPI": "PointInstancer",
    "NightcityMediaAPI": "Cube",
}
DEFAULTS = {
    ("NightcityCityAPI", "nightcity:originOffset"): Gf.Vec3d(0),
    ("NightcityCityAPI", "nightcity:crs"): "",
    ("NightcityCityAPI", "nightcity:parameters"): "",
    ("NightcityBuildingAPI", "nightcity:buildingId"): -1,
    ("NightcityWindowsAPI", "nightcity:lightOn"): [],
    ("NightcityWindowsAPI", "nightcity:power"): [50.0],
    ("NightcityWindowsAPI", "nightcity:color"): [Gf.Vec3f(1)],
    ("NightcityWindowsAPI", "nightcity:windowSize"): Gf.Vec2f(1.2, 1.5),
    ("NightcityMediaAPI", "nightcity:mediaId"): -1,
    ("NightcityMediaAPI", "nightcity:extinction"): pytest.approx(0.01),
    ("NightcityMediaAPI", "nightcity:albedo"): pytest.approx(0.9),
    ("NightcityMediaAPI", "nightcity:reachScale"): pytest.approx(1.2),
    ("NightcityMediaAPI", "nightcity:windowLights"): [],
}


def prim_of_type(type_name: str) -> tuple[Usd.Prim, Usd.Stage]:
    """A prim, and its stage, which must outlive it."""
    stage = Usd.Stage.CreateInMemory()
    return stage.DefinePrim("/Prim", type_name), stage


@pytest.mark.parametrize(("schema", "name"), DEFAULTS)
def test_attribute_comes_with_its_schema_and_its_default(schema: str, name: str) -> None:
    prim, _stage = prim_of_type(PRIM_TYPES[schema])
    assert not prim.HasAttribute(name)
    prim.ApplyAPI(schema)
    attribute = prim.GetAttribute(name)
    assert attribute.IsDefined() and not attribute.IsCustom() and not attribute.IsAuthored()
    value = attribute.Get()
    assert (list(value) if isinstance(DEFAULTS[schema, name], list) else value) == DEFAULTS[
        schema, name
    ]


def test_the_table_of_defaults_is_whole() -> None:
    registry = Usd.SchemaRegistry()
    known = {
        (schema, name)
        for schema in schemas.NAMES
        for name in registry.FindAppliedAPIPrimDefinition(schema).GetPropertyNames()
    }
    assert known - set(DEFAULTS) == {("NightcityMediaAPI", "nightcity:windowLightSources")}
    assert set(DEFAULTS) <= known


def test_window_light_sources_is_a_relationship() -> None:
    prim, _stage = prim_of_type("Cube")
    prim.ApplyAPI("NightcityMediaAPI")
    assert prim.GetRelationship("nightcity:windowLightSources").IsDefined()


@pytest.mark.parametrize(
    ("schema", "wrong"),
    [
        ("NightcityMediaAPI", "Mesh"),
        ("NightcityMediaAPI", "Xform"),
        ("NightcityWindowsAPI", "Mesh"),
        ("NightcityWindowsAPI", "Camera"),
        ("NightcityGroundAPI", "Cube"),
    ],
)
def test_wrong_prim_type_is_refused(schema: str, wrong: str) -> None:
    prim, _stage = prim_of_type(wrong)
    allowed = prim.CanApplyAPI(schema)
    assert not allowed and PRIM_TYPES[schema] in allowed.whyNot


_PROBE = """
import json
from pxr import Usd
stage = Usd.Stage.CreateInMemory()
cube = stage.DefinePrim("/Box", "Cube")
applied = bool(cube.ApplyAPI("NightcityMediaAPI"))
attribute = cube.GetAttribute("nightcity:extinction")
print(json.dumps([applied, attribute.IsDefined(), attribute.IsCustom(), attribute.Get()]))
"""


def run_python(code: str, **environment: str) -> subprocess.CompletedProcess[str]:
    clean = {key: value for key, value in os.environ.items() if key != "PXR_PLUGINPATH_NAME"}
    return subprocess.run(
        [sys.executable, "-c", code], env=clean | environment, capture_output=True, text=True
    )


def test_any_tool_finds_the_schemas_through_the_plugin_path_alone() -> None:
    done = run_python(_PROBE, PXR_PLUGINPATH_NAME=str(schemas.PATH))
    assert json.loads(done.stdout) == [True, True, False, pytest.approx(0.01)], done.stderr
    assert run_python(_PROBE).returncode != 0  # so it was the plugin path that did it


def test_register_may_follow_the_plugin_path_and_itself() -> None:
    code = "from nightcity.schemas import register; register(); register()"
    done = run_python(code, PXR_PLUGINPATH_NAME=str(schemas.PATH))
    assert (done.returncode, done.stderr) == (0, "")


def test_registering_too_late_is_an_error_that_says_so() -> None:
    done = run_python(
        "from pxr import Usd\n"
        "Usd.SchemaRegistry().FindAppliedAPIPrimDefinition('CollectionAPI')\n"
        "from nightcity.schemas import register\n"
        "register()"
    )
    assert done.returncode == 1
    assert "before any stage is opened" in done.stderr and "PXR_PLUGINPATH_NAME" in done.stderr


def test_the_folder_is_known_without_usd() -> None:
    code = "import sys, nightcity.schemas; print('pxr' in sys.modules, nightcity.schemas.PATH)"
    assert run_python(code).stdout.split() == ["False", str(schemas.PATH)]


def test_unregistered_names_are_errors() -> None:
    prim, _stage = prim_of_type("Cube")
    with pytest.raises(Tf.ErrorException):
        prim.ApplyAPI("NightcityFogAPI")
