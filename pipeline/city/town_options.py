# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What a real town is imported with: level of detail, windows and haze.

Fields that a generated city has too carry the same names.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
from dataclasses import dataclass

from nightcity.city.checked_fields import (
    Check,
    add_field_arguments,
    arguments_given,
    check_values,
    custom,
    integer,
    number,
    pair,
)
from nightcity.city.night import frames_field, offices_field, time_field
from nightcity.city.window_colours import colours_field
from nightcity.errors import UsageError

FINEST = "finest"


def _accept_lod(value: object) -> str:
    """A level of detail as text: "finest", or a number such as 2 or 2.2."""
    if isinstance(value, bool):
        raise ValueError("is no level of detail")
    text = f"{value:g}" if isinstance(value, int | float) else str(value)
    if text == FINEST:
        return text
    try:
        number_of_it = float(text)
    except ValueError:
        raise ValueError("is no level of detail") from None
    if not math.isfinite(number_of_it):
        raise ValueError("is no level of detail")
    return text


@dataclass(frozen=True)
class TownOptions:
    """Town options

    Raises UsageError, starting with the field's name, for a value that is wrong.
    """

    lod: str = custom(
        FINEST,
        Check(
            "level of detail to take; finest: of each building the finest that it has",
            "",
            "finest, or a level in the file such as 1, 2 or 2.2",
            _accept_lod,
            True,
        ),
    )
    floor_height: float = number(3.0, 2, 20, "height of a floor, counted from the street", "m")
    sill_height: float = number(0.75, 0, 10, "height of a window's lower edge above its floor", "m")
    window_spacing: float = number(2.4, 0.1, 100, "distance of window centres along a wall", "m")
    window_width: float = number(1.2, 0.05, 50, "width of a window", "m")
    window_height: float = number(1.5, 0.05, 50, "height of a window", "m")
    window_offset: float = number(0.01, 0.001, 0.5, "distance of windows from the wall", "m")
    window_margin: float = number(
        0.15, 0, 10, "least distance of a window from the edges of its wall", "m"
    )
    window_clearance: float = number(
        1.0, 0, 50, "free space in front of a window; walls with less carry none", "m"
    )
    shed_area: float = number(
        16.0, 0, 1e6, "buildings with a smaller footprint are sheds, without windows", "m^2"
    )
    window_power: float = number(50.0, 0, 1e6, "radiant power of a lit window", "W")
    window_colours: tuple[tuple[float, ...], ...] = colours_field(
        (
            (1.0, 0.78, 0.52, 5.0),  # incandescent and warm LED lamps, about 2700 K
            (1.0, 0.9, 0.76, 3.0),  # neutral
            (0.86, 0.94, 1.0, 1.0),  # cool tubes
            (0.62, 0.76, 1.0, 0.5),  # a screen
        )
    )
    lit: float = number(0.5, 0, 1, "share of windows that are lit")
    cell_size: float = number(20.0, 2, 1000, "edge of a media box in plan", "m")
    extinction: float = number(0.01, 0, 10, "extinction of the haze in the streets", "1/m")
    albedo: float = number(0.9, 0, 1, "albedo of the haze in the streets")
    frames: int = frames_field()
    time: str = time_field()
    office_share: float = offices_field()
    seed: int = integer(1, 0, 2**63 - 1, "seed of lit windows, colours, walls and night")
    resolution: tuple[int, int] = pair((1920, 1061), 1, 65536, "width and height of pictures, px")

    def __post_init__(self) -> None:
        values = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        for name, value in check_values(TownOptions, values).items():
            object.__setattr__(self, name, value)
        if self.time and self.frames == 1:
            raise UsageError("time spans one frame only; give frames")
        if self.window_spacing < self.window_width:
            raise UsageError("window_spacing is below window_width, so windows overlap; raise it")
        if self.floor_height < self.window_height:
            raise UsageError("floor_height is below window_height, so windows overlap; raise it")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """One option for every field of TownOptions."""
    add_field_arguments(parser, TownOptions)


def options_from_arguments(options: argparse.Namespace) -> TownOptions:
    """What ``add_arguments`` read, as options; UsageError names the option."""
    return TownOptions(**arguments_given(options, TownOptions))
