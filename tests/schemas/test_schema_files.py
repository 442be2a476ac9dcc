# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The generated schema files are those that schema.usda makes, and say what they must."""

from __future__ import annotations

import json
import re

import pytest
from pxr import Sdf

from nightcity.schemas import NAMES, PATH
from nightcity.schemas.__main__ import generate

GENERATED = ("generatedSchema.usda", "plugInfo.json")
DOC = re.compile(r"^[A-Z].+; (unit: [a-zA-Z0-9/ ]+|no unit); range: .+\.$")


@pytest.fixture(scope="module")
def generated() -> dict[str, str]:
    return generate()


def documented_properties() -> list[tuple[str, str]]:
    layer = Sdf.Layer.FindOrOpen(str(PATH / "generatedSchema.usda"))
    return [
        (f"{prim.name}.{prop.name}", prop.customData.get("userDocBrief", ""))
        for prim in layer.rootPrims
        for prop in prim.properties
    ]


@pytest.mark.parametrize("name", GENERATED)
def test_committed_file_is_what_the_schema_makes(name: str, generated: dict[str, str]) -> None:
    committed = (PATH / name).read_text(encoding="utf-8")
    assert committed == generated[name], "run `python -m nightcity.schemas` and commit the result"


def test_no_placeholder_and_no_absolute_path_is_left() -> None:
    text = (PATH / "plugInfo.json").read_text(encoding="utf-8")
    assert "@" not in text
    (plugin,) = json.loads(re.sub(r"(?m)^#.*$", "", text))["Plugins"]
    assert (plugin["Root"], plugin["ResourcePath"], plugin["LibraryPath"]) == (".", ".", "")
    assert sorted(plugin["Info"]["Types"]) == sorted(NAMES)
    assert {entry["schemaKind"] for entry in plugin["Info"]["Types"].values()} == {"singleApplyAPI"}


def test_there_are_properties_to_check() -> None:
    names = {name for name, _ in documented_properties()}
    assert {
        "NightcityMediaAPI.nightcity:mediaId",
        "NightcityMediaAPI.nightcity:windowLights",
        "NightcityWindowsAPI.nightcity:lightOn",
    } <= names


@pytest.mark.parametrize(("name", "doc"), documented_properties())
def test_doc_holds_meaning_unit_and_range(name: str, doc: str) -> None:
    assert DOC.match(doc), f"{name}: {doc!r}"
