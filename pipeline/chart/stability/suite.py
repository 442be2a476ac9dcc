# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""All sweeps, and the 26 ways to break that they answer."""

from __future__ import annotations

from dataclasses import dataclass

from nightcity.chart.stability import (
    hazes,
    lights,
    lists,
    moved_stage,
    mutants,
    orders,
    panes,
    shadows,
    states,
    views,
)
from nightcity.chart.stability.sweep import Sweep

SWEEPS: tuple[Sweep, ...] = (
    *lights.SWEEPS,
    *hazes.SWEEPS,
    *panes.SWEEPS,
    *shadows.SWEEPS,
    *lists.SWEEPS,
    *views.SWEEPS,
    *moved_stage.SWEEPS,
    *states.SWEEPS,
    *orders.SWEEPS,
    *mutants.SWEEPS,
)


@dataclass(frozen=True)
class Case:
    """One way to break. sweeps: by name; elsewhere: the tests that show it below the pictures."""

    what: str
    sweeps: tuple[str, ...] = ()
    elsewhere: str = ""


_TESTS = "`tests/renderer/{}_test.cpp`"

CASES = (
    Case("A ray through a light", ("light-distance",)),
    Case(
        "Rings of equal steps",
        ("march-rings-aligned", "march-rings-staggered", "march-steps"),
    ),
    Case("The perpendicular cancels, 0.1 m at 1 km", ("eye-distance",)),
    Case("Angles cancel, 1 m at 10 km", ("thin-slab",)),
    Case("A light 200 optical depths behind the eye", ("light-behind",)),
    Case("Haze from none to 10 /m", ("extinction",)),
    Case("200 optical depths of haze", ("optical-length",)),
    Case("1000 slices sum to the whole", ("slices",)),
    Case("The driver's trigonometry", elsewhere=_TESTS.format("airlight_trig")),
    Case("Lists that end: reach and seam", ("list-reach", "list-seam")),
    Case("Light through walls", ("courtyard",)),
    Case("Haze in 65 boxes, coplanar faces", ("cut-haze",)),
    Case("The eye moves by millimetres", ("dolly",)),
    Case("Two resolutions of the grid", elsewhere="of `field`"),
    Case("NaN and Inf", ("bad-numbers",)),
    Case("Windows switched", ("switched",)),
    Case("A halo from outside the haze", ("halo-depth",)),
    Case("A box of haze from 4 to 400 m", ("box-size",)),
    Case(
        "Panes a centimetre away, grazing, and as points",
        ("pane-distance", "pane-onto", "pane-away", "lambertian-distance"),
    ),
    Case(
        "The solid angle 128 sides away",
        ("pane-distance",),
        elsewhere=_TESTS.format("airlight_pane"),
    ),
    Case("Bounds of clusters", elsewhere="of `field`"),
    Case("Random numbers: no light left out, none shared", ("seeds", "samples")),
    Case(
        "Far from the origin, high up, grazing; image size",
        ("moved-scene", "moved-stage", "eye-height", "grazing-haze", "image-size"),
    ),
    Case(
        "The order of the lights; units of power and length",
        ("light-order", "power", "unit-scale"),
    ),
    Case("Multiple scattering", ("multiple-scattering",)),
    Case("Light around a corner", ("shadow-edge",)),
)
PLANTED = Case("Planted faults are noticed", ("mutants", "mutants-dark"))
