# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Models, methods and the settings that a chart tries: data, and no code that knows a method."""

from __future__ import annotations

from dataclasses import dataclass

from nightcity.chart.runs import Setting


@dataclass(frozen=True)
class Model:
    """Which physics, by the switches of nightcity-render (design section 4)."""

    name: str
    lights: str
    visibility: str
    emitter: str
    scattering: str = "single"
    surfaces: str = "dim"

    @property
    def options(self) -> tuple[str, ...]:
        """The switches, spelt out."""
        names = ("lights", "visibility", "emitter", "scattering", "surfaces")
        return tuple(text for name in names for text in (f"--{name}", getattr(self, name)))


PAPER = Model("paper", "listed", "none", "isotropic")
UNOCCLUDED = Model("all lights, no visibility", "all", "none", "isotropic")
ISOTROPIC = Model("isotropic windows", "all", "full", "isotropic")
LAMBERTIAN = Model("Lambertian windows", "all", "full", "lambertian")
SINGLE = Model("single", "all", "full", "pane")
MULTIPLE = Model("multiple", "all", "full", "pane", "multiple")
FULL = Model("full", "all", "full", "pane", "multiple", "lit")
RICHEST = FULL  # what total errors are against
LADDER = (PAPER, UNOCCLUDED, ISOTROPIC, LAMBERTIAN, SINGLE, MULTIPLE, FULL)


@dataclass(frozen=True)
class Point:
    """One setting of one method under one model.

    work: a guess of the core seconds of a call for 100,000 pixels in haze, for the progress line
    alone. frames: how many of them one timed call renders; rounds: calls at most.
    """

    name: str
    method: str
    model: Model
    knobs: tuple[str, ...]
    work: float
    frames: int
    rounds: int = 3

    @property
    def setting(self) -> Setting:
        """As the renderer takes it."""
        channels = "beauty,glow,glowError" if self.method == "path" else "beauty,glow"
        method = ("--method", self.method, *self.knobs, "--aovs", channels)
        return Setting(self.name, (*self.model.options, *method))

    def knob(self, option: str) -> str | None:
        """The value of one of its options; None where it is not given."""
        if option not in self.knobs:
            return None
        return self.knobs[self.knobs.index(option) + 1]


SURFACE = Setting("surface frame", ("--media", "off", "--aovs", "beauty,glow"))


def march(steps: int, order: str = "lights", *more: str, note: str = "") -> Point:
    """The paper's march; ``order``: which loop is outside, ``steps`` as the paper has it."""
    knobs = ("--subdivisions", str(steps), "--march-order", order, *more)
    name = f"march {steps}" + (", steps outside" if order == "steps" else "") + note
    return Point(name, "march", PAPER, knobs, work=0.03 * steps, frames=3)


def gauss(model: Model, tolerance: float, work: float = 100) -> Point:
    """Single scattering to a tolerance."""
    name = f"gauss {tolerance:g}, {model.name}"
    rounds = 3 if work < 100 else 2 if work < 500 else 1
    knobs = ("--tolerance", f"{tolerance:g}")
    return Point(name, "gauss", model, knobs, work, frames=1, rounds=rounds)


def field(tolerance: float, *more: str, model: Model = SINGLE, note: str = "") -> Point:
    """The grid of far light and the near windows."""
    knobs = ("--tolerance", f"{tolerance:g}", *more)
    named = note if model == SINGLE else f", {model.name}"
    lit = model.surfaces == "lit"  # by gauss, in every frame
    work, frames = (100, 1) if lit else (20, 3)
    return Point(f"field {tolerance:g}{named}", "field", model, knobs, work, frames)


def path(model: Model, samples: int) -> Point:
    """Monte Carlo."""
    knobs = ("--samples", str(samples))
    work = 3.0 * samples
    rounds = 3 if samples < 64 else 1
    name = f"path {samples}, {model.name}"
    return Point(name, "path", model, knobs, work, frames=1, rounds=rounds)


_SUPERSAMPLED = ("--pixel-samples", "4")
PAPER_STEPS = (5, 25, 40, 100)  # of the paper's Table 1
QUICK_POINTS = (
    *(march(steps, "steps") for steps in PAPER_STEPS),
    *(march(steps) for steps in (5, 25, 100)),
    gauss(PAPER, 0.1, work=0.5),
    gauss(PAPER, 0.01, work=0.5),
    field(0.1, model=UNOCCLUDED),
    field(0.1),
    field(0.03),
    field(0.1, model=MULTIPLE),
    path(FULL, 4),
)
FULL_POINTS = (
    *(march(steps, order) for order in ("steps", "lights") for steps in PAPER_STEPS),
    march(25, "lights", *_SUPERSAMPLED, note=", 4 rays a pixel"),
    *(gauss(PAPER, tolerance, work=0.5) for tolerance in (0.1, 0.01, 0.001)),
    *(gauss(UNOCCLUDED, tolerance, work=10) for tolerance in (0.1, 0.01)),
    gauss(ISOTROPIC, 0.1),
    gauss(LAMBERTIAN, 0.1),
    *(gauss(SINGLE, tolerance) for tolerance in (0.1, 0.01)),
    *(field(0.03, model=model) for model in (UNOCCLUDED, ISOTROPIC, LAMBERTIAN)),
    *(field(tolerance) for tolerance in (0.1, 0.03, 0.01, 0.003)),
    *(field(tolerance, model=MULTIPLE) for tolerance in (0.1, 0.03, 0.01)),
    *(field(tolerance, model=FULL) for tolerance in (0.1, 0.03)),
    field(0.03, "--glow-rays", "all", note=", every ray"),
    field(0.03, *_SUPERSAMPLED, note=", 4 rays a pixel"),
    *(path(FULL, samples) for samples in (4, 16, 64)),
    path(SINGLE, 16),
)
