# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench ladder``: what each physical term changes in the glow of a scene.

Two tables for each camera and extinction. The first holds every model against the richest. The
second changes one switch at a time, as design section 4 does, and quotes its figures. Orders 2
and up are Monte Carlo; everything else is the judge, in double precision.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nightcity.bench.accuracy import percent
from nightcity.bench.judge import Keeper, View, choose_pixels, say
from nightcity.bench.scenes import open_scene
from nightcity.chart.errors import LUMINANCE, error_statistics
from nightcity.errors import UsageError

INTEGRATED_SAMPLES = 64  # places in a pixel (design section 5)
EXTINCTIONS = (0.001, 0.003, 0.01, 0.03, 0.1)  # 1/m
_TOLERANCE = "0.01"  # of the judge, which converges to a tenth of it
_FORWARD = 0.8  # g of real fog is 0.8 and more

Options = tuple[str, ...]


@dataclass(frozen=True)
class LadderOptions:
    """Which pixels and how many paths for each; samples is for the pixel centre."""

    cameras: Sequence[str] | None
    extinctions: Sequence[float] | None  # 1/m; none: the scene's own
    size: str
    pixels: int
    integrated_pixels: int  # 0: no pixel-integrated columns
    samples: int
    kept: Path | None

    def __post_init__(self) -> None:
        if self.pixels < 1 or self.integrated_pixels < 0:
            raise UsageError("--pixels: give at least 1; --integrated-pixels: at least 0")
        if self.samples < 2 * INTEGRATED_SAMPLES:
            raise UsageError(f"--samples: give at least {2 * INTEGRATED_SAMPLES}")


@dataclass(frozen=True)
class Model:
    """A model by name, as the renderer options of what adds up to it: the exact first order, and
    what only paths know."""

    name: str
    exact: Options | None
    paths: Options | None


@dataclass(frozen=True)
class Switch:
    """One step of the ladder: ``model`` instead of ``against``, and design section 4's figure."""

    name: str
    model: Model
    against: Model
    expected: str


def _exact(lights: str, visibility: str, emitter: str) -> Options:
    return (
        *("--lights", lights, "--visibility", visibility, "--emitter", emitter),
        *("--method", "reference", "--tolerance", _TOLERANCE),
    )


def _paths(*more: str) -> Options:
    window = ("--lights", "all", "--visibility", "full", "--emitter", "pane")
    return (*window, "--method", "path", *more)


_HIGHER = ("--scattering", "multiple", "--orders", "2-")
_PANES = _exact("all", "full", "pane")
MARCHED = Model(
    "paper: listed, none, isotropic, 25 steps",
    ("--model", "paper", "--method", "reference", "--subdivisions", "25"),
    None,
)
LISTED = Model("paper, exact: listed, none, isotropic", _exact("listed", "none", "isotropic"), None)
UNOCCLUDED = Model("all, none, isotropic", _exact("all", "none", "isotropic"), None)
ISOTROPIC = Model("all, full, isotropic", _exact("all", "full", "isotropic"), None)
NEAR = tuple(
    Model(
        f"all within {reach} m, full, isotropic",
        (*_exact("all", "full", "isotropic"), "--reach", str(reach)),
        None,
    )
    for reach in (20, 30, 45)
)
LAMBERTIAN = Model("all, full, lambertian", _exact("all", "full", "lambertian"), None)
SINGLE = Model("single: all, full, pane", _PANES, None)
FORWARD = Model(f"all, full, pane, g = {_FORWARD:g}", None, _paths("--g", f"{_FORWARD:g}"))
MULTIPLE = Model("all, full, pane, multiple", _PANES, _paths(*_HIGHER))
RICHEST = Model(
    "full: all, full, pane, multiple, lit", _PANES, _paths(*_HIGHER, "--surfaces", "lit")
)
LADDER = (MARCHED, LISTED, UNOCCLUDED, *NEAR, ISOTROPIC, LAMBERTIAN, SINGLE, MULTIPLE)
SWITCHES = (
    Switch("25 steps instead of the integral", MARCHED, LISTED, "0.1 to 0.5 %; 13 % by a window"),
    Switch("the paper's lists, no visibility", LISTED, ISOTROPIC, "-41 to -48 %"),
    Switch("no visibility", UNOCCLUDED, ISOTROPIC, "+84 to +124 %"),
    *(
        Switch(f"visible windows within {reach} m", model, ISOTROPIC, expected)
        for reach, model, expected in zip(
            (20, 30, 45), NEAR, ("-20 %", "-7.5 %", "-2 %"), strict=True
        )
    ),
    Switch("isotropic instead of Lambertian", ISOTROPIC, LAMBERTIAN, "about -40 %"),
    Switch("points instead of panes", LAMBERTIAN, SINGLE, "within about 1 m of a pane only"),
    Switch("single instead of multiple", SINGLE, MULTIPLE, "-12 % (black walls)"),
    Switch("black instead of lit surfaces", MULTIPLE, RICHEST, "none given"),
    Switch(f"isotropic phase instead of g = {_FORWARD:g}", SINGLE, FORWARD, "none given"),
)


@dataclass(frozen=True)
class Values:
    """Glow (N, 3) of some pixels, and its standard error; 0 where nothing is random."""

    glow: NDArray[np.float64]
    error: NDArray[np.float64]


def ladder(source: str, options: LadderOptions) -> int:
    """Print the tables of one scene; ``extinctions`` can be given for presets only."""
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        keeper = Keeper(options.kept or work / "kept")
        for extinction in options.extinctions or [None]:
            overrides = None if extinction is None else {"extinction": extinction}
            scene = open_scene(source, work, overrides)
            for camera in scene.choose_cameras(options.cameras):
                view = View(scene, camera, options.size)
                for line in _tables(view, options, keeper, work):
                    print(line, flush=True)
    return 0


def _tables(view: View, options: LadderOptions, keeper: Keeper, work: Path) -> Iterator[str]:
    columns = [_measure_models(view, options, 1, options.pixels, keeper, work)]
    if options.integrated_pixels:
        columns.append(
            _measure_models(
                view, options, INTEGRATED_SAMPLES, options.integrated_pixels, keeper, work
            )
        )
    yield f"\n{view}: {options.pixels} pixel centres" + (
        f"; {options.integrated_pixels} pixels integrated over {INTEGRATED_SAMPLES} places"
        if options.integrated_pixels
        else ""
    )
    heads = ["centre: bias", "relative RMSE", "integrated: bias", "relative RMSE"]
    heads = heads[: 2 * len(columns)]
    yield "\n" + table_head(f"against {RICHEST.name}", *heads)
    for model in LADDER:
        yield _row(model.name, [(values[model], values[RICHEST]) for values in columns])
    yield "\n" + table_head("one switch", *heads, "design.md, section 4")
    for switch in SWITCHES:
        pairs = [(values[switch.model], values[switch.against]) for values in columns]
        yield _row(switch.name, pairs, switch.expected)
    yield "\n" + _noise(columns[0])


def _measure_models(
    view: View,
    options: LadderOptions,
    places: int,
    count: int,
    keeper: Keeper,
    work: Path,
) -> dict[Model, Values]:
    """Every model on the same pixels, each the mean over ``places`` in it; 1: its centre."""
    pixels = choose_pixels(view, count, work)
    sampling = ("--pixel-samples", str(places)) if places > 1 else ()
    measured = {}
    for model in (*LADDER, FORWARD, RICHEST):
        say(f"{view}: {model.name}, {'integrated' if places > 1 else 'centre'}")
        glow = np.zeros((len(pixels), 3))
        error = np.zeros_like(glow)
        if model.exact:
            glow += keeper.measure(view, pixels, (*model.exact, *sampling), work).glow
        if model.paths:
            samples = ("--samples", str(options.samples // places))
            found = keeper.measure(view, pixels, (*model.paths, *samples, *sampling), work)
            glow += found.glow
            error = found.glow_error if found.glow_error is not None else error
        measured[model] = Values(glow, error)
    return measured


def table_head(*names: str) -> str:
    """The head of a markdown table."""
    return f"| {' | '.join(names)} |\n|{'---|' * len(names)}"


def _row(name: str, pairs: list[tuple[Values, Values]], *more: str) -> str:
    cells = [name]
    for value, truth in pairs:
        errors = error_statistics(value.glow, truth.glow)
        cells += [f"{'+' if errors.bias > 0 else ''}{percent(errors.bias)}"]
        cells += [percent(errors.relative_rmse)]
    return f"| {' | '.join([*cells, *more])} |"


def _noise(values: dict[Model, Values]) -> str:
    parts = []
    for model in (MULTIPLE, FORWARD, RICHEST):
        glow, error = values[model].glow @ LUMINANCE, values[model].error @ LUMINANCE
        mean = float(np.sqrt(np.sum(error**2)) / glow.sum())
        each = float(np.median(error / np.maximum(glow, np.finfo(float).tiny)))
        parts.append(f"{model.name}: {percent(mean)} of the mean, {percent(each)} of a pixel")
    return f"Standard errors of what is Monte Carlo (centres): {'; '.join(parts)}."
