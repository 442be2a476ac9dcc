# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Growth on logarithmic axes: seconds in one picture, bytes in the other."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib
from matplotlib.axes import Axes

matplotlib.use("Agg")
import matplotlib.pyplot as plt

if TYPE_CHECKING:
    from nightcity.bench.growth_record import Growth

# Wall time of what processor time is shown of, and what every method repeats.
_HIDDEN = (" wall s",)
_ONCE = (" load s", " host memory bytes")


def draw_growth(found: Growth, stem: Path) -> list[Path]:
    """STEM.svg and STEM.png; slopes stand in the legends."""
    plt.rcParams["svg.hashsalt"] = "nightcity"  # the same rows give the same bytes
    figure, (seconds, memory) = plt.subplots(1, 2, figsize=(14, 6.5), layout="constrained")
    _draw(seconds, found, " s", "seconds")
    _draw(memory, found, " bytes", "bytes")
    paths = [stem.with_suffix(".svg"), stem.with_suffix(".png")]
    figure.savefig(paths[0], metadata={"Date": None})
    figure.savefig(paths[1], dpi=110, metadata={"Software": None})
    plt.close(figure)
    return paths


def _draw(axes: Axes, found: Growth, ending: str, label: str) -> None:
    shown: set[str] = set()
    colours = iter([*plt.get_cmap("tab20").colors])
    for name in found.columns(ending):
        once = next((each for each in _ONCE if name.endswith(each)), None)
        if name.endswith(_HIDDEN) or once in shown:
            continue
        shown.add(once or name)
        windows, values = found.series(name)
        title = (once or name).removesuffix(ending).strip()
        axes.plot(
            windows, values, marker="o", markersize=4, color=next(colours),
            label=f"{title}: {found.slope(name):.2f}",
        )  # fmt: skip
    axes.set(xscale="log", yscale="log", xlabel="windows", ylabel=label)
    axes.grid(which="both", color="0.92")
    axes.legend(
        fontsize=8, title="step: slope of the larger half", title_fontsize=8,
        loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=3,
    )  # fmt: skip
