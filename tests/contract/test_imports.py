# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Data flows one way: who may import or include whom."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

# A folder of pipeline/ -> what its files may not import.
FORBIDDEN_IMPORTS = {
    "city": ("pxr", "nightcity.stage", "nightcity.export", "nightcity.chart", "nightcity.render"),
    "stage": ("nightcity.export", "nightcity.chart", "nightcity.render", "nightcity.city.generate"),
    "export": ("nightcity.city", "nightcity.stage", "nightcity.chart", "nightcity.render"),
    "farm": ("pxr", "nightcity.city", "nightcity.stage", "nightcity.export", "nightcity.chart"),
    "chart": ("pxr", "nightcity.stage"),
}
# A folder of renderer/ -> the folders of renderer/ whose headers it may include.
ALLOWED_INCLUDES = {
    "scene": {"scene"},
    "reference": {"scene", "reference"},
    "output": {"output"},
    "gpu": {"gpu"},
    "passes": {"scene", "gpu", "passes"},
}


def imported_modules(path: Path) -> set[str]:
    modules = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            modules |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            modules |= {node.module or ""} | {f"{node.module}.{a.name}" for a in node.names}
    return modules


@pytest.mark.parametrize("folder", FORBIDDEN_IMPORTS)
def test_python_arrows(folder: str) -> None:
    files = sorted((ROOT / "pipeline" / folder).rglob("*.py"))
    assert files
    for path in files:
        for module in imported_modules(path):
            for forbidden in FORBIDDEN_IMPORTS[folder]:
                assert module != forbidden and not module.startswith(forbidden + "."), (
                    f"{path.relative_to(ROOT)} imports {module}"
                )


@pytest.mark.parametrize("folder", ALLOWED_INCLUDES)
def test_cpp_arrows(folder: str) -> None:
    folders = {path.name for path in (ROOT / "renderer").iterdir() if path.is_dir()}
    assert folders == set(ALLOWED_INCLUDES)
    files = [p for p in (ROOT / "renderer" / folder).iterdir() if p.suffix in {".h", ".cpp"}]
    assert files
    for path in files:
        for include in re.findall(r'#include "(\w+)/', path.read_text()):
            if include in folders:
                assert include in ALLOWED_INCLUDES[folder], f"{path.name} includes {include}/"


@pytest.mark.parametrize("folder", ["scene", "reference", "output"])
def test_no_vulkan_outside_the_gpu_side(folder: str) -> None:
    for path in (ROOT / "renderer" / folder).iterdir():
        if path.suffix in {".h", ".cpp"}:
            assert "vulkan" not in path.read_text().lower().replace("no vulkan", ""), path.name
