# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""City parameters: presets, TOML files, options, and every kind of bad input."""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path

import pytest

from nightcity.city.checked_fields import checks_of, markdown_table, option_name
from nightcity.city.parameters import (
    CityParameters,
    add_arguments,
    load_parameters,
    parameters_from_arguments,
    preset_names,
)
from nightcity.errors import UsageError

ROOT = Path(__file__).parents[2]


def config(folder: Path, text: str | bytes) -> Path:
    path = folder / "mine.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def from_options(*options: str) -> CityParameters:
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    return parameters_from_arguments(parser.parse_args(options))


def test_every_preset_loads_and_the_promised_ones_are_there():
    assert {f"paper-{n}x{n}" for n in range(1, 5)} <= set(preset_names())
    assert {"billboard", "default", "mixed-6x6", "city-100x100"} <= set(preset_names())
    for name in preset_names():
        assert isinstance(load_parameters(name), CityParameters)


@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_paper_presets_are_the_paper(n):
    p = load_parameters(f"paper-{n}x{n}")
    assert p == CityParameters(grid=(n, n))
    assert (p.street_width, p.building_base, p.small_height, p.big_height) == (10, 10, 30, 60)
    assert (p.windows_across, p.small_rows, p.big_rows, p.window_power) == (4, 5, 10, 50)
    assert (p.window_width, p.window_height, p.window_offset) == (1.2, 1.5, 0.01)
    assert (p.extinction, p.albedo, p.lit, p.haze_layer_thickness) == (0.01, 0.9, 1, 0)
    assert p.window_colours == ((1, 1, 1, 1),) and p.facade_textures == ("plain",)
    assert p.resolution == (1920, 1061)


def test_every_field_is_described():
    for name, check in checks_of(CityParameters).items():
        assert check.meaning and check.range, name


def test_the_documentation_holds_the_fields():
    text = (ROOT / "docs/city_parameters.md").read_text()
    assert markdown_table(CityParameters) in text, (
        "copy the table that `python -m nightcity.city.parameters` prints"
    )
    for name in preset_names():
        assert f"`{name}`" in text


def test_file_over_preset_and_options_over_both(tmp_path):
    path = config(tmp_path, "seed = 5\nlit = 0.25\n")
    p = from_options("--preset", "paper-2x2", "--config", str(path), "--lit", "0.75")
    assert (p.grid, p.seed, p.lit) == ((2, 2), 5, 0.75)
    assert load_parameters(path) == CityParameters(seed=5, lit=0.25)
    assert load_parameters(path, {"seed": 6}).seed == 6
    assert from_options() == load_parameters("default")


def test_options_of_every_kind():
    p = from_options(
        "--preset", "paper-1x1", "--grid", "3x2", "--heights", "floors", "--window-power", "7.5",
        "--window-colours", "[[1, 0.5, 0.25, 2], [0, 0, 1, 1]]", "--facade-textures",
        "brick,glass", "--roof-reflectance", "[0, 0.5, 1]", "--resolution", "[64, 32]",
        "--name", "Night_1", "--seed", "9",
    )  # fmt: skip
    assert p == CityParameters(
        grid=(3, 2),
        heights="floors",
        window_power=7.5,
        window_colours=((1, 0.5, 0.25, 2), (0, 0, 1, 1)),
        facade_textures=("brick", "glass"),
        roof_reflectance=(0, 0.5, 1),
        resolution=(64, 32),
        name="Night_1",
        seed=9,
    )


def test_every_field_has_an_option():
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    text = parser.format_help()
    for field in dataclasses.fields(CityParameters):
        assert option_name(field.name) in text


def test_texture_paths_are_taken_from_the_files_folder(tmp_path):
    p = load_parameters(config(tmp_path, 'facade_textures = ["brick", "wall.png"]'))
    assert p.facade_textures == ("brick", str(tmp_path / "wall.png"))


BAD = [
    ("seeed = 1", "seeed", "did you mean seed"),
    ("window_colors = 1", "window_colors", "did you mean window_colours"),
    ("grid = [0, 4]", "grid", "each 1 to"),
    ("grid = [4]", "grid", "two whole numbers"),
    ("grid = [4, 4.0]", "grid", "two whole numbers"),
    ("grid = [true, 4]", "grid", "two whole numbers"),
    ('grid = "4x"', "grid", "two whole numbers"),
    ("street_width = 3.9", "street_width", "4 to 200 m"),
    ("street_width = nan", "street_width", "finite"),
    ("street_width = inf", "street_width", "finite"),
    ("street_width = true", "street_width", "a number"),
    ('street_width = "10"', "street_width", "a number"),
    ("street_width = 1979-05-27", "street_width", "a number"),
    ("[street_width]\nm = 10", "street_width", "a number"),
    (f"street_width = {'9' * 400}", "street_width", "finite|out of range"),
    ("seed = 1.5", "seed", "whole number"),
    ("seed = -1", "seed", "0 to 9223372036854775807"),
    ("seed = true", "seed", "whole number"),
    ("lit = 1.01", "lit", "0 to 1"),
    ("albedo = -0.1", "albedo", "0 to 1"),
    ("extinction = -0.01", "extinction", "0 to 10 1/m"),
    ('heights = "template"', "heights", "did you mean templates"),
    ("heights = 3", "heights", "is not known"),
    ("heights = [1]", "heights", "is not known"),
    ('name = "9 lives"', "name", "digits and underscores"),
    ("name = 9", "name", "digits and underscores"),
    ("window_colours = []", "window_colours", "red, green, blue, weight"),
    ("window_colours = [[1, 1, 1]]", "window_colours", "red, green, blue, weight"),
    ("window_colours = [[1, 1, nan, 1]]", "window_colours", "out of range"),
    ("window_colours = [[1, 1, -1, 1]]", "window_colours", "out of range"),
    ("window_colours = [[1, 1, 1, 0]]", "window_colours", "no weight above 0"),
    ('window_colours = [[1, 1, 1, "1"]]', "window_colours", "numbers"),
    ("facade_textures = []", "facade_textures", "list of names"),
    ('facade_textures = ["brik"]', "facade_textures", "did you mean brick"),
    ('facade_textures = ["wall.exr"]', "facade_textures", "PNG or JPEG"),
    ('facade_textures = ["brick", "brick"]', "facade_textures", "twice"),
    ('facade_textures = ["a\\u0000.png"]', "facade_textures", "list of names"),
    ("facade_reflectance = [0.5, 0.5]", "facade_reflectance", "list of 3 numbers"),
    ("facade_reflectance = [0.5, 0.5, 1.5]", "facade_reflectance", "each 0 to 1"),
    ("big_height = 20", "big_height", "below small_height"),
    ('heights = "floors"\nmax_height = 10', "max_height", "below min_height"),
    ('heights = "floors"\nfloor_height = 7', "min_height", "below two floors"),
    (
        'heights = "floors"\nmin_height = 16\nmax_height = 19',
        "floor_height",
        "no whole number of floors",
    ),
    ("window_width = 2.5", "window_width", "overlap"),
    ("window_height = 5.1", "window_height", "small_rows"),
    ("small_height = 59\nsmall_rows = 60", "window_height", "small_rows"),
    ("billboard_power = 1\nbillboard_width = 11", "billboard_width", "wider than building_base"),
    ("grid = [2000, 2000]\nbig_rows = 10", "grid", "lower grid"),
    (f"seed = {'9' * 5000}", "mine.toml", "not TOML"),
    (f"seed = {'[' * 5000}", "mine.toml", "not TOML"),
    ("seed = ", "mine.toml", "not TOML"),
    (b"seed = 1\xff", "mine.toml", "UTF-8"),
]


@pytest.mark.parametrize("text, field, message", BAD, ids=[str(row[0])[:40] for row in BAD])
def test_bad_input_names_file_and_field(tmp_path, text, field, message):
    path = config(tmp_path, text)
    with pytest.raises(UsageError, match=message) as caught:
        load_parameters(path)
    assert str(caught.value).startswith(f"{path}: ") and field in str(caught.value)


@pytest.mark.parametrize(
    "options, message",
    [
        (["--preset", "paper-5x5"], "no such preset; there are .*paper-4x4"),
        (["--preset", "../../etc/passwd"], "no such preset"),
        (["--config", "none.toml"], "none.toml: cannot be read"),
        (["--lit", "half"], '--lit: lit = "half" must be a number'),
        (["--grid", "4by4"], '--grid: grid = "4by4" must be two whole numbers'),
        (["--lit", "nan"], "--lit: .*finite"),
        (
            ["--window-width", "3"],
            "preset default, with what overrides it: window_width: 4 windows",
        ),
    ],
)
def test_bad_options_name_the_option(options, message):
    with pytest.raises(UsageError, match=message):
        from_options(*options)


def test_a_wrong_value_from_python_names_the_field():
    with pytest.raises(UsageError, match=r"^lit = 2 is out of range"):
        CityParameters(lit=2)
    with pytest.raises(UsageError, match=r"^lit"):
        dataclasses.replace(CityParameters(), lit=float("nan"))


def test_lengths_are_rounded_so_that_halves_are_exact():
    assert CityParameters(street_width=12.3001).street_width == 12.30078125
