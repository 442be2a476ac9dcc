# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Every method beside the march, and the surface frame beside a dispatch that only writes.

Times on a shared machine mean little; the ratios, from one interleaved run, are what to quote.
"""

from __future__ import annotations

import os
from pathlib import Path

from nightcity.bench.in_turn import ROUNDS, InTurn, time_in_turn
from nightcity.chart.paper_tables import FRAMES_PER_SECOND
from nightcity.chart.runs import Setting

_FRAMES = 5  # a round
_SLOW_FRAMES = 2  # of settings whose frame takes seconds on a CPU
_BEAUTY = ("--aovs", "beauty")
SURFACE = Setting("surface frame", ("--media", "off"))
_SURFACE_BEAUTY = Setting("surface frame, beauty", ("--media", "off", *_BEAUTY))
# What the surface frame is held against: a dispatch that writes the same channels and no more.
_WRITES = {
    SURFACE: Setting("write only", ("--media", "off", "--write-only")),
    _SURFACE_BEAUTY: Setting("write only, beauty", ("--media", "off", "--write-only", *_BEAUTY)),
}
# Where each method integrates the light of the windows.
_SCATTER_PASSES = ("march", "gauss", "glow")


def march(steps: int, order: str, storage: str = "uniform") -> Setting:
    """The paper's method and model; order: which loop is outside, steps (as the paper has it) or
    lights. storage: of the lists of lights."""
    options = ("--model", "paper", "--method", "march", "--subdivisions", str(steps))
    return Setting(
        f"march-{steps}, {order} outside, {storage}",
        (*options, "--march-order", order, "--light-storage", storage),
    )


def field(tolerance: float) -> Setting:
    """All windows, full visibility, panes."""
    options = ("--model", "single", "--method", "field", "--tolerance", f"{tolerance:g}")
    return Setting(f"field {tolerance:g}", options)


def _methods() -> dict[Setting, int]:
    """Every setting of the table, and how many frames of it a round renders."""
    frames = {SURFACE: _FRAMES, _SURFACE_BEAUTY: _FRAMES}
    for order in ("steps", "lights"):
        for steps in FRAMES_PER_SECOND:
            for storage in ("uniform", "storage"):
                slow = steps > 5
                frames[march(steps, order, storage)] = _SLOW_FRAMES if slow else _FRAMES
    paper = ("--model", "paper", "--method", "gauss", "--tolerance")
    for tolerance in ("0.01", "0.001"):
        frames[Setting(f"gauss {tolerance}, the paper's model", (*paper, tolerance))] = _FRAMES
    for tolerance in (0.1, 0.03, 0.01):
        every = field(tolerance)
        beauty = Setting(f"{every.name}, beauty", (*every.options, *_BEAUTY))
        frames |= {every: _FRAMES, beauty: _FRAMES}
    return frames


def print_surface_table(label: str, scene: Path, view: list[str], folder: Path) -> None:
    """The surface frame, found by raster and by rays, beside the dispatch that only writes."""
    frames: dict[Setting, int] = {}
    for frame, write in _WRITES.items():
        rays = Setting(f"{frame.name}, rays", (*frame.options, "--primary", "rays"))
        frames |= {write: _FRAMES, frame: _FRAMES, rays: _FRAMES}
    timed = time_in_turn(scene, view, frames, folder, f"{label}: surface frames")
    print(f"\n{label}: the surface frame, one interleaved run, {ROUNDS} x {_FRAMES} frames\n")
    print("| setting | steady frame, ms | spread, ms | to write only | raster | surface pass, ms |")
    print("|---|---|---|---|---|---|")
    write_ms = 0.0
    for setting, measured in timed.items():
        write_ms = measured.steady_ms if setting in _WRITES.values() else write_ms
        print(
            f"| {setting.name} | {measured.steady_ms:.1f} | {measured.spread_ms:.1f} "
            f"| {measured.steady_ms / write_ms:.2f} | {measured.pass_ms('raster'):.1f} "
            f"| {measured.pass_ms('surface'):.1f} |",
            flush=True,
        )


def print_method_table(label: str, scene: Path, view: list[str], folder: Path) -> None:
    """Every setting: ratios to the surface frame of the same channels, bake and memory apart."""
    timed = time_in_turn(scene, view, _methods(), folder, f"{label}: methods")
    cores = len(os.sched_getaffinity(0))
    print(
        f"\n{label}: one interleaved run, {ROUNDS} x {_FRAMES} frames ({_SLOW_FRAMES} of slow "
        f"marches), camera moving, {timed[SURFACE].first.device}, {cores} cores; field: all "
        "windows, full visibility, panes; beauty: against the surface frame of beauty alone\n"
    )
    print(
        "| setting | steady frame, ms | spread, ms | to the surface frame | first frame, ms "
        "| bake, ms | memory, MB | surface pass | traverse pass | scatter pass, ms "
        "| G light evaluations/s a core |"
    )
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for setting, measured in timed.items():
        is_beauty = setting.options[-2:] == _BEAUTY
        surface = timed[_SURFACE_BEAUTY if is_beauty else SURFACE].steady_ms
        print(_method_row(setting, measured, surface, cores), flush=True)


def _method_row(setting: Setting, measured: InTurn, surface_ms: float, cores: int) -> str:
    scatter = sum(map(measured.pass_ms, _SCATTER_PASSES))
    evaluations = measured.first.light_evaluations
    rate = f"{evaluations / scatter / 1e6 / cores:.2f}" if scatter and evaluations else ""
    return (
        f"| {setting.name} | {measured.steady_ms:.1f} | {measured.spread_ms:.1f} "
        f"| {measured.steady_ms / surface_ms:.2f} | {measured.first.first_frame_ms:.1f} "
        f"| {measured.first.bake_ms:.0f} | {measured.first.memory_bytes / 1e6:.0f} "
        f"| {measured.pass_ms('surface'):.1f} | {measured.pass_ms('traverse'):.1f} "
        f"| {scatter:.1f} | {rate} |"
    )
