# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What a generated city is made from: fields, presets, TOML files and options.

A field that is not named takes its default, which is the paper's 4 x 4 city.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from nightcity.city.checked_fields import (
    Check,
    add_field_arguments,
    arguments_given,
    check_values,
    choice,
    custom,
    identifier,
    integer,
    markdown_table,
    number,
    numbers,
    pair,
)
from nightcity.city.night import frames_field, offices_field, time_field
from nightcity.city.textures import BUILT_IN, accept_texture_names
from nightcity.city.window_colours import colours_field
from nightcity.errors import UsageError

PRESETS = Path(__file__).with_name("presets")
DEFAULT_PRESET = "default"
MOST_WINDOWS = 50_000_000  # 0.34 GB a million while a city is made


_STEPS_PER_METRE = 256
_SNAPPED = {"street_width", "building_base", "haze_layer_thickness"}


def snap(length: float) -> float:
    """A length (m) rounded to 1/256 m: sums and halves stay exact, in float32 too up to 32 km."""
    return round(length * _STEPS_PER_METRE) / _STEPS_PER_METRE


@dataclass(frozen=True)
class CityParameters:
    """City parameters

    Plan lengths and heights are rounded to 1/256 m, so that buildings and haze meet exactly.
    Raises UsageError, starting with the field's name, for a value that is wrong.
    """

    name: str = identifier("City", "name of the city's prim")
    grid: tuple[int, int] = pair((4, 4), 1, 2000, "buildings along x and along y")
    street_width: float = number(10.0, 4, 200, "width of the streets", "m")
    building_base: float = number(10.0, 4, 200, "edge of a building's square base", "m")

    heights: str = choice(
        "templates",
        ("templates", "floors"),
        "templates: small and big buildings; floors: any height from min_height to max_height",
    )
    noise_frequency: float = number(
        0.17,
        0.001,
        0.9,
        "frequency of the Perlin noise that makes neighbours alike in height",
        "1/building",
    )
    big_share: float = number(0.0, 0, 1, "share of big buildings (templates)")
    small_height: float = number(30.0, 4, 500, "height of a small building (templates)", "m")
    small_rows: int = integer(5, 1, 200, "rows of windows on a small building (templates)")
    big_height: float = number(60.0, 4, 500, "height of a big building (templates)", "m")
    big_rows: int = integer(10, 1, 200, "rows of windows on a big building (templates)")
    min_height: float = number(12.0, 4, 500, "height of the lowest building (floors)", "m")
    max_height: float = number(60.0, 4, 500, "height of the highest building (floors)", "m")
    floor_height: float = number(
        5.0, 2, 20, "height of a floor; windows stand on every floor's line but the ground", "m"
    )
    height_exponent: float = number(
        1.0, 0.1, 10, "1: all heights alike often; larger: most buildings low (floors)"
    )

    windows_across: int = integer(4, 1, 100, "windows in a row of a facade")
    window_width: float = number(1.2, 0.05, 50, "width of a window", "m")
    window_height: float = number(1.5, 0.05, 50, "height of a window", "m")
    window_offset: float = number(0.01, 0.001, 0.5, "distance of windows from the wall", "m")
    window_power: float = number(50.0, 0, 1e6, "radiant power of a lit window", "W")
    window_colours: tuple[tuple[float, ...], ...] = colours_field(((1.0, 1.0, 1.0, 1.0),))
    lit: float = number(1.0, 0, 1, "share of windows that are lit")
    billboard_power: float = number(
        0.0, 0, 1e6, "radiant power of a lit panel on a facade; 0: there is none", "W"
    )
    billboard_width: float = number(10.0, 0.1, 200, "width of the panel", "m")
    billboard_height: float = number(6.0, 0.1, 200, "height of the panel", "m")

    extinction: float = number(0.01, 0, 10, "extinction of the haze in the streets", "1/m")
    albedo: float = number(0.9, 0, 1, "albedo of the haze in the streets")
    haze_layer_thickness: float = number(
        0.0, 0, 1000, "thickness of the haze above the highest roof; 0: none above any", "m"
    )
    haze_layer_extinction: float = number(0.002, 0, 10, "extinction above the roofs", "1/m")
    haze_layer_albedo: float = number(0.9, 0, 1, "albedo above the roofs")

    facade_textures: tuple[str, ...] = custom(
        ("plain",),
        Check(
            "textures of facades, one drawn for each building",
            "",
            f"a list out of {', '.join(BUILT_IN)} and paths of PNG or JPEG files, which a TOML "
            "file names from its own folder",
            accept_texture_names,
            True,
        ),
    )
    facade_texture_size: float = number(10.0, 0.1, 1000, "width of a texture from a file", "m")
    facade_reflectance: tuple[float, ...] = numbers(
        (0.16, 0.16, 0.16), 0, 1, "linear reflectance of facades; multiplies the texture"
    )
    roof_reflectance: tuple[float, ...] = numbers(
        (0.06, 0.06, 0.06), 0, 1, "linear reflectance of roofs"
    )
    ground_reflectance: tuple[float, ...] = numbers(
        (0.03, 0.03, 0.03), 0, 1, "linear reflectance of the ground"
    )

    frames: int = frames_field()
    time: str = time_field()
    office_share: float = offices_field()

    seed: int = integer(1, 0, 2**63 - 1, "seed of heights, lit windows, colours, textures, night")
    resolution: tuple[int, int] = pair((1920, 1061), 1, 65536, "width and height of pictures, px")

    def __post_init__(self) -> None:
        values = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        for name, value in check_values(CityParameters, values).items():
            object.__setattr__(self, name, snap(value) if name in _SNAPPED else value)
        if self.time and self.frames == 1:
            raise UsageError("time spans one frame only; give frames")
        self._check_heights()
        self._check_windows()
        self._check_size()

    def _check_heights(self) -> None:
        if self.heights == "templates" and self.big_height < self.small_height:
            raise UsageError("big_height is below small_height; swap them")
        if self.heights == "floors" and self.max_height < self.min_height:
            raise UsageError("max_height is below min_height; swap them")
        if self.heights == "floors" and self.min_height < 2 * self.floor_height:
            raise UsageError(
                "min_height is below two floors, so its facades have no window; raise min_height "
                "or lower floor_height"
            )
        if self.heights == "floors" and self.max_height < self.lowest_floors * self.floor_height:
            raise UsageError(
                f"floor_height: no whole number of floors of {self.floor_height:g} m lies between "
                "min_height and max_height; raise max_height"
            )

    @property
    def lowest_floors(self) -> int:
        """Floors of the lowest building (floors)."""
        return math.ceil(self.min_height / self.floor_height - 1e-9)

    def _check_windows(self) -> None:
        """Windows on one facade must not overlap (their spacing is that of templates.py)."""
        if self.building_base / (self.windows_across + 1) < self.window_width:
            raise UsageError(
                f"window_width: {self.windows_across} windows of {self.window_width:g} m overlap "
                f"on a facade of {self.building_base:g} m; lower window_width or windows_across"
            )
        spacings = {"floor_height": self.floor_height}
        if self.heights == "templates":
            spacings = {
                "small_rows": self.small_height / (self.small_rows + 1),
                "big_rows": self.big_height / (self.big_rows + 1),
            }
        for name, spacing in spacings.items():
            if spacing < self.window_height:
                raise UsageError(
                    f"window_height: rows of windows {spacing:g} m apart overlap at "
                    f"{self.window_height:g} m each; lower window_height or change {name}"
                )
        if self.billboard_power > 0 and self.billboard_width > self.building_base:
            raise UsageError("billboard_width is wider than building_base; lower it")

    def _check_size(self) -> None:
        rows = max(self.small_rows, self.big_rows)
        if self.heights == "floors":
            rows = int(self.max_height / self.floor_height)
        windows = 4 * self.windows_across * rows * self.grid[0] * self.grid[1]
        if windows > MOST_WINDOWS:
            raise UsageError(
                f"grid: the city could hold {windows:,} windows, more than {MOST_WINDOWS:,}; "
                "lower grid or windows_across"
            )


def preset_names() -> list[str]:
    """The names that ``load_parameters`` and --preset take."""
    return sorted(path.stem for path in PRESETS.glob("*.toml"))


def load_parameters(
    source: str | Path, overrides: Mapping[str, object] | None = None
) -> CityParameters:
    """Parameters of a preset (a name) or a TOML file (a path), with fields overridden.

    UsageError names the file and the field that is wrong.
    """
    if isinstance(source, Path) or source.endswith(".toml"):
        path = Path(source)
    else:
        path = _preset_file(source)
    values = _read(path)
    with _naming(path, ", with what overrides it" if overrides else ""):
        return CityParameters(**(values | dict(overrides or {})))


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """--preset, --config and one option for every field of CityParameters."""
    parser.add_argument(
        "--preset", metavar="NAME", help=f"start from one of {', '.join(preset_names())}"
    )
    parser.add_argument(
        "--config",
        metavar="FILE",
        type=Path,
        help="TOML file of fields, over those of the preset. With neither, the preset "
        f"{DEFAULT_PRESET} is taken. Options override both",
    )
    add_field_arguments(parser, CityParameters)


def parameters_from_arguments(options: argparse.Namespace) -> CityParameters:
    """What ``add_arguments`` read, as parameters; UsageError names option or file."""
    overrides = arguments_given(options, CityParameters)
    if options.config is None:
        return load_parameters(options.preset or DEFAULT_PRESET, overrides)
    if options.preset is None:
        return load_parameters(options.config, overrides)
    values = _read(options.config) | overrides
    return load_parameters(options.preset, values)


def _preset_file(name: str) -> Path:
    path = PRESETS / f"{name}.toml"
    if name not in preset_names():
        raise UsageError(
            f"--preset {name}: no such preset; there are {', '.join(preset_names())}. "
            "A file of your own goes with --config and ends in .toml"
        )
    return path


def _read(path: Path) -> dict[str, object]:
    """The checked fields of a TOML file, texture paths taken from its folder."""
    try:
        text = path.read_bytes().decode("utf-8")
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise UsageError(f"{path}: is not UTF-8 text") from None
    with _naming(path):
        try:
            values = check_values(CityParameters, tomllib.loads(text))
        except (ValueError, RecursionError) as error:  # TOMLDecodeError, or a number too long
            raise UsageError(f"is not TOML: {error}") from None
    if "facade_textures" in values:
        values["facade_textures"] = tuple(
            name if name in BUILT_IN else str(path.parent / name)
            for name in values["facade_textures"]
        )
    return values


@contextmanager
def _naming(path: Path, suffix: str = "") -> Iterator[None]:
    """Puts the file in front of what a check says."""
    shown = (f"preset {path.stem}" if path.parent == PRESETS else str(path)) + suffix
    try:
        yield
    except UsageError as error:
        raise UsageError(f"{shown}: {error}") from None


if __name__ == "__main__":
    print(markdown_table(CityParameters), end="")
