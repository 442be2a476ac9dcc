# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Dataclass fields that carry their own meaning, unit and range.

The same metadata checks values from Python, TOML and the command line, and writes --help and the
documentation. Messages start with the field's name; whoever reads a file puts its name in front.
"""

from __future__ import annotations

import argparse
import dataclasses
import difflib
import json
import math
import re
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from nightcity.errors import UsageError


@dataclass(frozen=True)
class Check:
    """What a field accepts: ``accept`` returns the value in its final type or raises ValueError."""

    meaning: str
    unit: str
    range: str
    accept: Callable[[object], object]
    text_is_value: bool = False  # an option's text is the value itself, not TOML


def integer(default: int, low: int, high: int, meaning: str) -> int:
    """A whole number from low to high."""

    def accept(value: object) -> int:
        if isinstance(value, bool) or not isinstance(value, int):
            raise ValueError("must be a whole number")
        _require(low <= value <= high)
        return value

    return _field(default, Check(meaning, "", f"{low} to {high}", accept))


def number(
    default: float, low: float, high: float, meaning: str, unit: str = "", *, above: bool = False
) -> float:
    """A finite number from low (or above it) to high."""

    def accept(value: object) -> float:
        result = _finite(value)
        _require(low < result <= high if above else low <= result <= high)
        return result

    text = f"above {low:g}, to {high:g}" if above else f"{low:g} to {high:g}"
    return _field(default, Check(meaning, unit, text, accept))


def choice(default: str, options: Sequence[str], meaning: str) -> str:
    """One of a few words."""

    def accept(value: object) -> str:
        if value not in options:
            raise ValueError(f"is not known{_nearest(value, options)}")
        return str(value)

    return _field(default, Check(meaning, "", " or ".join(options), accept, True))


def identifier(default: str, meaning: str) -> str:
    """A name that can be a prim's: ASCII letters, digits, underscores, no leading digit."""

    def accept(value: object) -> str:
        _require(isinstance(value, str) and bool(re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", value)))
        return value

    text = "letters, digits and underscores, not starting with a digit"
    return _field(default, Check(meaning, "", text, accept, True))


def pair(default: tuple[int, int], low: int, high: int, meaning: str) -> tuple[int, int]:
    """Two whole numbers: [a, b] in TOML, axb as an option."""

    def accept(value: object) -> tuple[int, int]:
        if isinstance(value, str) and (match := re.fullmatch(r"(\d+)x(\d+)", value)):
            value = [int(part) for part in match.groups()]
        if not isinstance(value, list | tuple) or len(value) != 2:
            raise ValueError("must be two whole numbers, [a, b], or axb as an option")
        if any(isinstance(part, bool) or not isinstance(part, int) for part in value):
            raise ValueError("must be two whole numbers, [a, b], or axb as an option")
        _require(all(low <= part <= high for part in value))
        return value[0], value[1]

    return _field(default, Check(meaning, "", f"each {low} to {high}", accept))


def numbers(
    default: Sequence[float], low: float, high: float, meaning: str, unit: str = ""
) -> tuple[float, ...]:
    """As many finite numbers as the default has, each from low to high."""

    def accept(value: object) -> tuple[float, ...]:
        if not isinstance(value, list | tuple) or len(value) != len(default):
            raise ValueError(f"must be a list of {len(default)} numbers")
        result = tuple(_finite(part) for part in value)
        _require(all(low <= part <= high for part in result))
        return result

    return _field(tuple(default), Check(meaning, unit, f"each {low:g} to {high:g}", accept))


def custom(default: Any, check: Check) -> Any:
    """A field with a check of its own."""
    return _field(default, check)


def check_values(cls: type, values: Mapping[str, object]) -> dict[str, object]:
    """The values in their final types; UsageError on an unknown key, a wrong type or range."""
    checks = checks_of(cls)
    checked = {}
    for name, value in values.items():
        if name not in checks:
            raise UsageError(f"{name} is not a known key{_nearest(name, checks)}")
        try:
            checked[name] = checks[name].accept(value)
        except ValueError as error:
            problem = str(error) or "is out of range"
            check = checks[name]
            accepted = f"{check.range} {check.unit}".rstrip()
            raise UsageError(
                f"{name} = {_shown(value)} {problem}; {check.meaning}: {accepted}"
            ) from None
    return checked


def checks_of(cls: type) -> dict[str, Check]:
    """Field name -> check, in the order of declaration."""
    return {field.name: field.metadata["check"] for field in dataclasses.fields(cls)}


def add_field_arguments(parser: argparse.ArgumentParser, cls: type) -> None:
    """One option a field: ``window_power`` becomes ``--window-power``."""
    group = parser.add_argument_group(cls.__doc__.splitlines()[0])
    for name, check in checks_of(cls).items():
        accepted = f"{check.range} {check.unit}".rstrip()
        group.add_argument(
            option_name(name),
            metavar="VALUE",
            help=f"{check.meaning} ({accepted}; default {_default_text(cls, name)})".replace(
                "%", "%%"
            ),
        )


def arguments_given(options: argparse.Namespace, cls: type) -> dict[str, object]:
    """The values of the options that were given, checked; UsageError names the option."""
    given = {}
    for name, check in checks_of(cls).items():
        text = getattr(options, name)
        if text is None:
            continue
        try:
            given |= check_values(cls, {name: _from_text(text, check)})
        except UsageError as error:
            raise UsageError(f"{option_name(name)}: {error}") from None
    return given


def markdown_table(cls: type) -> str:
    """The fields as a table: name, meaning, unit, range, default."""
    lines = ["| field | meaning | unit | range | default |", "| --- | --- | --- | --- | --- |"]
    for name, check in checks_of(cls).items():
        default = _default_text(cls, name)
        lines.append(f"| `{name}` | {check.meaning} | {check.unit} | {check.range} | `{default}` |")
    return "\n".join(lines) + "\n"


def option_name(field_name: str) -> str:
    return "--" + field_name.replace("_", "-")


def _field(default: Any, check: Check) -> Any:
    return dataclasses.field(default=default, metadata={"check": check})


def _require(condition: bool) -> None:
    if not condition:
        raise ValueError


def _finite(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError("must be a number")
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not math.isfinite(result):
        raise ValueError("must be a finite number")
    return result


def _nearest(name: object, known: Iterable[str]) -> str:
    known = list(known)
    near = difflib.get_close_matches(str(name), known, n=1, cutoff=0.5)
    return f"; did you mean {near[0]}?" if near else f"; known are {', '.join(known)}"


def _from_text(text: str, check: Check) -> object:
    if check.text_is_value:
        return text
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (ValueError, RecursionError):  # TOMLDecodeError, or a number too long
        return text


def _shown(value: object) -> str:
    text = json.dumps(value, default=str)
    return text if len(text) <= 80 else text[:77] + "..."


def _default_text(cls: type, name: str) -> str:
    default = next(field.default for field in dataclasses.fields(cls) if field.name == name)
    return default if isinstance(default, str) else json.dumps(default)
