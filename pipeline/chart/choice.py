# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity render --model auto --tolerance T``: the cheapest settings for a shot, from a few
hundred of its pixels.

The truth of these pixels is the judge's single scattering and, against the full model, paths of
the other orders. Models are tried from the cheapest up; what is left of the tolerance beside a
model's own error is what its method may lose. A model that leaves out too much falls to the next;
at the end stand paths, as many as their noise asks for.

Nothing here is timed and everything has one seed, so that a farm's tasks choose alike. The pixels
are those of the scene's first frame.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.errors import relative_errors
from nightcity.chart.foretell import PERCENTILE, paths_needed
from nightcity.chart.runs import PixelTable, read_pixels, write_pixels
from nightcity.chart.settings import FULL, MULTIPLE, PAPER, SINGLE, UNOCCLUDED, Model
from nightcity.errors import UsageError
from nightcity.render import run_renderer

PIXELS = 200
_TRUTH_SAMPLES = 64  # paths a pixel of the orders that the judge does not know
_PILOT_SAMPLES = 64  # paths a pixel that tell path's noise


@dataclass(frozen=True)
class Candidate:
    """A model and a method that renders it; finest, coarsest: the tolerances that it takes."""

    model: Model
    method: str
    finest: float
    coarsest: float


# From the cheapest up, as the charts of the paper's city and of Delft have them.
CANDIDATES = (
    Candidate(PAPER, "gauss", 1e-4, 0.1),
    Candidate(UNOCCLUDED, "field", 1e-3, 0.1),
    Candidate(UNOCCLUDED, "gauss", 1e-4, 0.1),
    Candidate(SINGLE, "field", 1e-3, 0.1),
    Candidate(SINGLE, "gauss", 1e-4, 0.1),
    Candidate(MULTIPLE, "field", 1e-3, 0.1),
    Candidate(FULL, "field", 1e-3, 0.1),
)
# The field keeps its tolerance in most pixels and not beside roof edges: less is asked of it.
_FIELD_FLOOR = 0.05


@dataclass(frozen=True)
class Choice:
    """Renderer options, and the sentence that says why."""

    options: tuple[str, ...]
    reason: str


def choose(scene: Path, view: Sequence[str], tolerance: float, against: Model = FULL) -> Choice:
    """For a flat scene seen with ``view`` (camera and size options of the renderer).

    ``against``: the richest model that counts, FULL or SINGLE. UsageError for a tolerance that is
    no share from 0.0001 to 1.
    """
    if not 1e-4 <= tolerance <= 1:
        raise UsageError("--model auto: --tolerance must lie from 0.0001 to 1")
    with tempfile.TemporaryDirectory() as name:
        sampler = _Sampler(scene, view, Path(name), tolerance)
        glow = sampler.glow(against)
        if not glow.any():
            return Choice(_options(CANDIDATES[0], 0.1), "no haze is lit in this shot")
        errors: dict[Model, float] = {}
        for candidate in CANDIDATES:
            model = candidate.model
            if against == SINGLE and model.scattering == "multiple":
                continue
            if model not in errors:
                off = relative_errors(sampler.glow(model), glow)
                errors[model] = float(np.percentile(off, PERCENTILE))
            left = _left(candidate, tolerance - errors[model])
            if left is not None:
                reason = f"{model.name} by {candidate.method} at {left:g}"
                return Choice(_options(candidate, left), _sentence(tolerance, reason, errors))
        pilot = sampler.paths(against, _PILOT_SAMPLES)
        assert pilot.glow_error is not None  # Monte Carlo always states it
        samples = paths_needed(glow, pilot.glow_error, _PILOT_SAMPLES, tolerance)
        options = (*against.options, "--method", "path", "--samples", str(samples))
        reason = f"{against.name} by {samples} paths a pixel"
        return Choice(options, _sentence(tolerance, reason, errors))


def _left(candidate: Candidate, left: float) -> float | None:
    """The tolerance to ask of the candidate's method; None where it cannot be kept."""
    finest = _FIELD_FLOOR if candidate.method == "field" else candidate.finest
    if left < finest:
        return None
    digits = 1 - math.floor(math.log10(left))  # two significant digits, rounded down
    return min(math.floor(left * 10**digits) / 10**digits, candidate.coarsest)


def _options(candidate: Candidate, tolerance: float) -> tuple[str, ...]:
    method = ("--method", candidate.method, "--tolerance", f"{tolerance:g}")
    return (*candidate.model.options, *method)


def _sentence(tolerance: float, chosen: str, errors: Mapping[Model, float]) -> str:
    tried = [f"{model.name} {_percent(error)}" for model, error in errors.items()]
    return (
        f"auto, {_percent(tolerance)} in {PERCENTILE} of 100 pixels: {chosen} "
        f"(without noise {', '.join(tried)} off at {PIXELS} pixels)"
    )


def _percent(share: float) -> str:
    return f"{100 * share:.2g} %" if share < 1 else f"{100 * share:.0f} %"


class _Sampler:
    """Values of the same few pixels, by any model; ``tolerance``: that the choice is for."""

    def __init__(self, scene: Path, view: Sequence[str], work: Path, tolerance: float) -> None:
        self._scene, self._view, self._work = scene, view, work
        self._tolerance = tolerance
        chosen = ("--model", "paper", "--method", "reference", "--subdivisions", "1")
        pixels = self._render(chosen, str(PIXELS)).pixels
        self._pixels = str(write_pixels(pixels, work / "chosen.csv"))
        self._known: dict[Model, NDArray[np.float64]] = {}

    def glow(self, model: Model) -> NDArray[np.float64]:
        """(N, 3): the judge, exact to a tenth of the tolerance, and paths of other orders."""
        if model not in self._known:
            if model.scattering == "single":
                judge = ("--method", "reference", "--tolerance", f"{min(self._tolerance, 0.1):g}")
                glow = self._render((*model.options, *judge), self._pixels).glow
            else:
                glow = self.glow(SINGLE) + self.paths(model, _TRUTH_SAMPLES, "--orders", "2-").glow
            self._known[model] = glow
        return self._known[model]

    def paths(self, model: Model, samples: int, *more: str) -> PixelTable:
        """Monte Carlo."""
        return self._render(
            (*model.options, "--method", "path", "--samples", str(samples), *more), self._pixels
        )

    def _render(self, options: Sequence[str], pixels: str) -> PixelTable:
        table = self._work / "values.csv"
        run_renderer(
            [self._scene, *self._view, *options, "--pixels", pixels, "--quiet", "-o", table]
        )
        return read_pixels(table)
