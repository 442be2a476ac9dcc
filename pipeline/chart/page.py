# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The chart as one file that any browser opens from disk: data, pictures and plotly.js inside.

plotly.js is MIT-licensed and states so at its head, which is kept.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from importlib import resources
from pathlib import Path
from typing import Any

from plotly.offline import get_plotlyjs

from nightcity.chart import paper_tables
from nightcity.chart.measure import ShotResults
from nightcity.chart.pictures import colour_scale, error_map, picture
from nightcity.chart.results import Row
from nightcity.chart.settings import RICHEST
from nightcity.whole_file import whole_file


def write_page(
    rows: Sequence[Row],
    results: Sequence[ShotResults],
    needs: dict[str, str],
    growth: dict[str, Any],
    path: Path,
) -> None:
    """Write the page. needs: HTML by the shot's name; growth: as growth.series makes it."""
    numbered = [
        {**row, "id": number, "shot": f"{row['scene']} {row['camera']}"}
        for number, row in enumerate(rows)
    ]
    data = {
        "about": _about(rows, results),
        "rows": [{name: _plain(value) for name, value in row.items()} for row in numbered],
        "pictures": {str(each.shot): _pictures(numbered, each) for each in results},
        "paper": {
            "source": paper_tables.SOURCE,
            "framesPerSecond": paper_tables.FRAMES_PER_SECOND,
        },
        "richestName": RICHEST.name,
        "richest": f"{RICHEST.name}: {_in_words(RICHEST.options)}",
        "scale": colour_scale(),
        "needs": needs,
        "growth": growth,
    }
    # "</" would end the script element that holds the data.
    text = json.dumps(data, allow_nan=False, separators=(",", ":")).replace("</", "<\\/")
    parts = {
        "/*STYLE*/": _part("page.css"),
        "/*SCRIPT*/": _part("page.js"),
        "/*DATA*/": text,
        "/*PLOTLY*/": get_plotlyjs(),
    }
    page = _part("page.html")
    for place, content in parts.items():
        before, after = page.split(place, 1)
        page = before + content + after
    with whole_file(path) as pending:
        pending.write_text(page, encoding="utf-8")


def _part(name: str) -> str:
    return (resources.files("nightcity.chart") / "page_parts" / name).read_text(encoding="utf-8")


def _plain(value: object) -> object:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _in_words(options: Sequence[str]) -> str:
    pairs = zip(options[::2], options[1::2], strict=True)
    return ", ".join(f"{name[2:]} {value}" for name, value in pairs)


def _about(rows: Sequence[Row], results: Sequence[ShotResults]) -> str:
    first = results[0]
    return (
        f"{len(first.settings)} settings, {len(results)} shot{'s' * (len(results) > 1)}, on "
        f"{rows[0]['device']}, "
        f"{first.shot.size} pixels, {len(first.surface)} rounds. Errors at {len(first.pixels)} "
        f"random pixels that see haze, integrated ones at {len(first.integrated_pixels)}; pictures "
        f"are every third pixel of every third row."
    )


def _pictures(rows: Sequence[Row], results: ShotResults) -> dict[str, Any]:
    richest = results.truths[RICHEST.name].image
    own = {row["setting"]: row["id"] for row in rows if row["shot"] == str(results.shot)}
    shown = {}
    for measured in results.settings:
        if measured.frame is None:
            continue
        frame = measured.frame.thinned()
        shown[own[measured.point.name]] = {
            "image": picture(frame, richest),
            "numerical": error_map(frame, results.truths[measured.point.model.name].image),
            "total": error_map(frame, richest),
        }
    truths = {name: picture(truth.image, richest) for name, truth in results.truths.items()}
    return {"rows": shown, "truths": truths}
