# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A shot through the night: frames of one process equal those rendered alone, to the bit."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from conftest import Command

from nightcity.render import run_renderer

VIEW = ("--camera", "flight", "--size", "64x36", "--quiet")
METHODS = {
    "march": ("--model", "paper"),
    "gauss": ("--model", "paper"),
    "field": ("--model", "single"),
}


@pytest.fixture(scope="module")
def scene(nightcity: Command, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("shot")
    stage = folder / "city.usda"
    options = ("--preset", "paper-2x2", "--time", "18:00-02:00", "--frames", "9")
    nightcity("generate", *options, "-o", stage)
    nightcity("export", stage, "-o", folder / "scene")
    return folder / "scene"


@pytest.mark.parametrize("method", METHODS)
def test_a_frame_alone_is_that_of_the_shot(scene: Path, tmp_path: Path, method: str) -> None:
    """Windows go on and off between the frames; what is baked of them is updated or made anew."""
    options = [scene, *VIEW, "--method", method, *METHODS[method]]
    statistics = tmp_path / "shot.json"
    shot = ("--frames", "1,5,9", "-o", tmp_path / "shot.####.exr", "--stats", statistics)
    run_renderer([*options, *shot])
    timing = json.loads(statistics.read_text())["timing"]
    assert timing["bake_updates"] == 2 and 0 < timing["bake_update_ms"] < timing["bake_ms"]
    run_renderer([*options, "--frames", "9", "-o", tmp_path / "alone.####.exr"])
    frames = [(tmp_path / f"shot.000{frame}.exr").read_bytes() for frame in (1, 5, 9)]
    assert len(set(frames)) == 3
    assert (tmp_path / "alone.0009.exr").read_bytes() == frames[2]
