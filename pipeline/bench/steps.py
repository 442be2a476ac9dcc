# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench``: time, memory and size of every step, then every method beside the march.

Each step is a process of its own, measured by the operating system's accounting.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Sequence
from pathlib import Path

from nightcity.bench.cost import run_nightcity
from nightcity.bench.methods import print_method_table, print_surface_table
from nightcity.render import run_renderer

_SIZE = ["--size", "1920x1061"]
_VIEW = ["--camera", "overview75", *_SIZE]
_REPEATS = 5


def bench(presets: Sequence[str], towns: Sequence[Path], cameras: Sequence[str]) -> None:
    """Print what every step costs, for all scenes named, and every method on the first, through
    each camera."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        sources = [(preset, ["generate", "--preset", preset]) for preset in presets]
        sources += [(town.name.split(".")[0], ["import", str(town)]) for town in towns]
        print("Every step, once (time and peak memory of its process)\n")
        print(
            "| scene | buildings | windows | media boxes | make the stage | stage | export "
            "| flat scene | load | bake | first frame | steady frame |"
        )
        print("|---|---|---|---|---|---|---|---|---|---|---|---|")
        scenes = []
        for label, command in sources:
            scenes.append((label, _measure_steps(label, command, folder)))
        label, scene = scenes[0]
        for camera in cameras:
            view = ["--camera", camera, *_SIZE]
            print_surface_table(f"{label}, {camera}", scene, view, folder)
            print_method_table(f"{label}, {camera}", scene, view, folder)


def _measure_steps(label: str, command: list[str], folder: Path) -> Path:
    stage, scene = folder / f"{label}.usda", folder / f"{label}.scene"
    made = run_nightcity([*command, "-o", str(stage)])
    exported = run_nightcity(["export", str(stage), "-o", str(scene)])
    statistics_file = folder / "statistics.json"
    run_renderer(
        [scene, *_VIEW, "--model", "paper", "--method", "march", "--repeat", str(_REPEATS)]
        + ["--quiet", "-o", folder / "frame.exr", "--stats", statistics_file]
    )
    measured = json.loads(statistics_file.read_text())
    counts, timing = measured["counts"], measured["timing"]
    windows = max(counts["windows"], 1)
    stage_bytes = sum(path.stat().st_size for path in folder.glob(f"{label}.*") if path.is_file())
    scene_bytes = sum(path.stat().st_size for path in scene.iterdir())
    print(
        f"| {label} | {counts['buildings']} | {counts['windows']} | {counts['media_boxes']} "
        f"| {made} | {_size(stage_bytes, windows)} | {exported} | {_size(scene_bytes, windows)} "
        f"| {timing['load_ms']:.0f} ms | {timing['bake_ms']:.0f} ms "
        f"| {timing['first_frame_ms']:.0f} ms | {timing['steady_frame_ms']:.0f} ms |",
        flush=True,
    )
    return scene


def _size(count: int, windows: int) -> str:
    return f"{count / 1e6:.1f} MB ({count / windows:.0f} B a window)"
