# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``--model auto`` among the renderer's options: taken out, and what was chosen put in."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from nightcity.errors import UsageError

# What the choice decides.
_DECIDED = ("--method", "--lights", "--visibility", "--emitter", "--scattering", "--surfaces")
_DECIDED += ("--subdivisions", "--samples", "--orders", "--g", "--march-order", "--glow-rays")
_DECIDED += ("--bricks",)


def chosen_options(scene: Path, options: Sequence[str]) -> list[str]:
    """The options with which nightcity-render gets ``--model auto`` replaced; others as they are.

    UsageError where something is given that the choice decides, or no tolerance.
    """
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    parser.add_argument("--model")
    if parser.parse_known_args(list(options))[0].model != "auto":
        return list(options)
    parser.add_argument("--tolerance")
    parser.add_argument("--against", choices=("full", "single"), default="full")
    known, rest = parser.parse_known_args(list(options))
    given = [name for name in _DECIDED if any(o.split("=")[0] == name for o in rest)]
    if given:
        raise UsageError(f"{given[0]}: --model auto chooses it; name a model, or leave it out")
    try:
        tolerance = float(known.tolerance or "")
    except ValueError:
        raise UsageError("--model auto needs --tolerance T, a share like 0.02") from None
    from nightcity.chart.choice import choose
    from nightcity.chart.settings import FULL, SINGLE

    against = FULL if known.against == "full" else SINGLE
    choice = choose(scene, _view(rest), tolerance, against)
    print(f"note: {choice.reason}", file=sys.stderr)
    return [*rest, *choice.options, "--choice", choice.reason]


def _view(options: Sequence[str]) -> list[str]:
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    for name in ("--camera", "--size"):
        parser.add_argument(name)
    found = vars(parser.parse_known_args(list(options))[0])
    return [text for name, value in found.items() if value for text in (f"--{name}", value)]
