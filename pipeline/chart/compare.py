# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity chart --compare``: what became slower or less accurate, beyond the noise.

Times are compared as ratios to the surface frame of the same round, so that another load of the
machine, or another machine of its kind, cancels. The noise of a ratio is the spread of its rounds.
Errors are compared at the same pixels of the same size; the noise is that of Monte Carlo.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from nightcity.chart.results import Row, read_rows
from nightcity.errors import SceneError

SLOWER = 0.1  # of the ratio: what rounds that happen to agree do not show
LESS_ACCURATE = 0.002  # of the glow: twice what the judge of a quick chart is exact to
_SIGMAS = 3.0
_KEY = ("scene", "camera", "size", "setting")
# Errors whose growth says that a method has changed; and the columns of their noise.
_ERRORS = (("bias", "mean_noise"), ("median", "pixel_noise"), ("p95", "pixel_noise"))


def compare(old: Path, new: Path) -> list[str]:
    """A line for each setting that became worse, or was lost; empty where none did."""
    before, after = ({_key(row): row for row in read_rows(path)} for path in (old, new))
    common = [key for key in before if key in after]
    if not common:
        raise SceneError(f"{new}: has no scene, camera, size and setting in common with {old}")
    lost = [f"{_name(key)}: is no longer there" for key in before if key not in after]
    worse = [
        f"{_name(key)}: {change}" for key in common for change in _changes(before[key], after[key])
    ]
    return lost + worse


def _key(row: Row) -> tuple[str, ...]:
    return tuple(row[name] for name in _KEY)


def _name(key: Sequence[str]) -> str:
    scene, camera, size, setting = key
    return f"{scene} {camera} {size}, {setting}"


def _changes(old: Row, new: Row) -> Iterator[str]:
    if new["failure"]:
        if not old["failure"]:
            yield f"fails: {new['failure']}"
        return
    if old["failure"]:
        return
    yield from _slower(old, new)
    if old["numerical_centre_bias"] is not None:
        yield from _less_accurate(old, new)


def _slower(old: Row, new: Row) -> Iterator[str]:
    was, now = old["ratio_to_surface"], new["ratio_to_surface"]
    noise = max(old["ratio_spread"] or 0, new["ratio_spread"] or 0)
    if now - was > max(SLOWER * was, noise):
        yield (
            f"slower, {was:.3g} -> {now:.3g} surface frames (+{100 * (now / was - 1):.0f} %, "
            f"noise {100 * noise / was:.0f} %)"
        )


def _less_accurate(old: Row, new: Row) -> Iterator[str]:
    for name, noise_column in _ERRORS:
        column = f"numerical_centre_{name}"
        was, now = abs(old[column]), abs(new[column])
        noise = max(old[noise_column] or 0, new[noise_column] or 0)
        # The change itself counts for the bias: it may pass through zero.
        change = abs(new[column] - old[column]) if name == "bias" else now - was
        if now > was and change > max(LESS_ACCURATE, _SIGMAS * noise):
            yield (
                f"less accurate, {name} {100 * old[column]:.2g} % -> {100 * new[column]:.2g} % "
                f"(noise {100 * noise:.2g} %)"
            )
