# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench``: time, memory and size of every step, and every method beside the march.

Each step is a process of its own, measured by the operating system's accounting. Times on a
shared machine mean little; the ratios, from one interleaved run, are what to quote.
"""

from __future__ import annotations

import json
import os
import statistics
import tempfile
from collections.abc import Sequence
from pathlib import Path

from nightcity.bench.cost import run_nightcity
from nightcity.chart.runs import Setting, Timing, time_frames
from nightcity.render import run_renderer

_VIEW = ["--camera", "overview75", "--size", "1920x1061"]
_REPEATS = 5
_ROUNDS = 3
_SURFACE = Setting("surface frame", ("--media", "off"))
_BEAUTY = ("--aovs", "beauty")
# What the surface frame is held against: a dispatch that writes the same channels and no more.
_WRITES = {
    _SURFACE: Setting("write only", ("--media", "off", "--write-only")),
    Setting("surface frame, beauty", ("--media", "off", *_BEAUTY)): Setting(
        "write only, beauty", ("--media", "off", "--write-only", *_BEAUTY)
    ),
}
_MARCHES = tuple(
    Setting(
        f"march-25, {order} outside, {storage}",
        ("--model", "paper", "--method", "march", "--subdivisions", "25")
        + ("--march-order", order, "--light-storage", storage),
    )
    for order in ("steps", "lights")
    for storage in ("uniform", "storage")
)
_METHODS = (
    *_MARCHES,
    Setting("gauss, the paper's model", ("--model", "paper", "--method", "gauss")),
    Setting("field, all lights, full, panes", ("--model", "single", "--method", "field")),
)
# Where each method integrates the light of the windows.
_SCATTER_PASSES = ("march", "gauss", "glow")


def bench(presets: Sequence[str], towns: Sequence[Path]) -> None:
    """Print what every step costs, for all scenes named, and every method on the first."""
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
        _print_surface_table(*scenes[0], folder)
        _print_method_table(*scenes[0], folder)


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


def _print_surface_table(label: str, scene: Path, folder: Path) -> None:
    """The surface frame, found by raster and by rays, beside the dispatch that only writes."""
    timings: dict[Setting, list[Timing]] = {}
    for frame, write in _WRITES.items():
        rays = Setting(f"{frame.name}, rays", (*frame.options, "--primary", "rays"))
        timings |= {write: [], frame: [], rays: []}
    for _ in range(_ROUNDS):
        for setting, measured in timings.items():
            measured.append(time_frames(scene, _VIEW, setting, _REPEATS, folder))
    print(f"\n{label}: the surface frame, one interleaved run, {_ROUNDS} x {_REPEATS} frames\n")
    print("| setting | steady frame, ms | spread, ms | to write only | raster | surface pass, ms |")
    print("|---|---|---|---|---|---|")
    write_ms = 0.0
    for setting, measured in timings.items():
        steady = [t.steady_frame_ms for t in measured]
        middle = statistics.median(steady)
        write_ms = middle if setting in _WRITES.values() else write_ms
        raster, surface = (
            statistics.median(t.passes.get(name, 0.0) for t in measured)
            for name in ("raster", "surface")
        )
        print(
            f"| {setting.name} | {middle:.1f} | {max(steady) - min(steady):.1f} "
            f"| {middle / write_ms:.2f} | {raster:.1f} | {surface:.1f} |",
            flush=True,
        )


def _print_method_table(label: str, scene: Path, folder: Path) -> None:
    timings: dict[Setting, list[Timing]] = {setting: [] for setting in (_SURFACE, *_METHODS)}
    for _ in range(_ROUNDS):
        for setting, measured in timings.items():
            measured.append(time_frames(scene, _VIEW, setting, _REPEATS, folder))
    surface = statistics.median(t.steady_frame_ms for t in timings[_SURFACE])
    cores = len(os.sched_getaffinity(0))
    print(
        f"\n{label}: one interleaved run, {_ROUNDS} x {_REPEATS} frames, camera moving, "
        f"{timings[_SURFACE][0].device}, {cores} cores\n"
    )
    print(
        "| setting | steady frame, ms | spread, ms | to the surface frame | first frame, ms "
        "| bake, ms | memory, MB | surface pass | traverse pass | scatter pass, ms "
        "| G light evaluations/s a core |"
    )
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for setting, measured in timings.items():
        steady = [t.steady_frame_ms for t in measured]
        passes = {
            name: statistics.median(t.passes.get(name, 0.0) for t in measured)
            for name in ("surface", "traverse", *_SCATTER_PASSES)
        }
        scatter = sum(passes[name] for name in _SCATTER_PASSES)
        evaluations = measured[0].light_evaluations
        rate = f"{evaluations / scatter / 1e6 / cores:.2f}" if scatter and evaluations else ""
        print(
            f"| {setting.name} | {statistics.median(steady):.1f} | {max(steady) - min(steady):.1f} "
            f"| {statistics.median(steady) / surface:.2f} | {measured[0].first_frame_ms:.1f} "
            f"| {measured[0].bake_ms:.0f} | {measured[0].memory_bytes / 1e6:.0f} "
            f"| {passes['surface']:.1f} | {passes['traverse']:.1f} | {scatter:.1f} | {rate} |",
            flush=True,
        )
