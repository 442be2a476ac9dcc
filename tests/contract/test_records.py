# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""numpy, C++ and SPIR-V agree on every record's offsets; docs/scene_format.md names them all."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from nightcity.export.records import RECORDS

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "build/release/bin/record_layout"
PLAIN = {"position", "texcoord", "texel", "light_list"}  # arrays of a plain GLSL type
Layout = dict[str, tuple[int, dict[str, int]]]  # record -> size, field -> offset


def snake(name: str) -> str:
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


@pytest.fixture(scope="module")
def cpp_layout() -> Layout:
    layout: Layout = {}
    for line in subprocess.check_output([PROGRAM], text=True).splitlines():
        record, middle, number = line.split()
        size, fields = layout.get(snake(record), (0, {}))
        if middle == "=":
            size = int(number)
        else:
            fields[snake(middle)] = int(number)
        layout[snake(record)] = (size, fields)
    return layout


@pytest.fixture(scope="module")
def spirv_layout(tmp_path_factory: pytest.TempPathFactory) -> Layout:
    module = tmp_path_factory.mktemp("spirv") / "records.spv"
    subprocess.run(
        ["glslangValidator", "--target-env", "vulkan1.2", f"-I{ROOT / 'shaders/shared'}"]
        + ["-o", module, Path(__file__).with_name("records.comp")],
        check=True,
        stdout=subprocess.PIPE,
    )
    text = subprocess.check_output(["spirv-dis", "--raw-id", module], text=True)
    names = dict(re.findall(r'OpName (%\d+) "(\w+)"', text))
    offsets = re.findall(r"OpMemberDecorate (%\d+) (\d+) Offset (\d+)", text)
    members = re.findall(r'OpMemberName (%\d+) (\d+) "(\w+)"', text)
    strides = dict(re.findall(r"OpDecorate (%\d+) ArrayStride (\d+)", text))
    arrays = dict((b, a) for a, b in re.findall(r"(%\d+) = OpTypeRuntimeArray (%\d+)", text))
    member_names = {(struct, index): name for struct, index, name in members}
    layout: Layout = {}
    for struct, index, offset in offsets:
        if struct not in arrays:
            continue
        size = int(strides[arrays[struct]])
        fields = layout.setdefault(snake(names[struct]), (size, {}))[1]
        fields[snake(member_names[struct, index])] = int(offset)
    return layout


def numpy_layout() -> Layout:
    return {
        name: (dtype.itemsize, {field: dtype.fields[field][1] for field in dtype.names})
        for name, dtype in RECORDS.items()
        if name not in PLAIN
    }


def test_numpy_equals_cpp(cpp_layout: Layout) -> None:
    expected = numpy_layout()
    assert {name: cpp_layout[name] for name in expected} == expected


def test_cpp_equals_spirv(cpp_layout: Layout, spirv_layout: Layout) -> None:
    assert spirv_layout == cpp_layout


def test_documentation_states_every_record() -> None:
    text = (ROOT / "docs/scene_format.md").read_text()
    for name, dtype in RECORDS.items():
        assert re.search(rf"`{name}` \(stride {dtype.itemsize}\)", text), name
    for name in set(RECORDS) - PLAIN:
        section = text[text.index(f"`{name}` (stride") :]
        rows = re.findall(r"^\| `(\w+)` \| [^|]+ \| (\d+) \|", section, re.M)
        fields = RECORDS[name].fields
        assert rows[: len(fields)] == [(field, str(fields[field][1])) for field in fields], name
