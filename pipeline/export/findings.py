# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What the walk over a stage finds: prims by kind, each with where it stands."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from pxr import Usd

from nightcity.export.timeline import Timeline

KINDS = ("geometry", "ground", "windows", "media", "light", "camera")


@dataclass(slots=True)
class Item:
    """A visible prim and its K copies (one, unless it stands in an instancer's prototype).

    matrices: (K, 4, 4) from the prim's space to metres with z up, for row vectors.
    buildings: (K,) into ``Findings.building_ids``, -1 for none.
    visible: over the frames; never false throughout.
    """

    prim: Usd.Prim
    matrices: NDArray[np.float64]
    buildings: NDArray[np.int64]
    visible: Timeline

    @property
    def source_path(self) -> str:
        """Path that every native instance of the same prim shares."""
        prim = self.prim
        return str((prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim).GetPath())


@dataclass
class Findings:
    """Items by kind in the order of the walk, and ``nightcity:buildingId`` of each building.

    hidden_windows: instancers of windows that are not visible at any frame.
    """

    items: dict[str, list[Item]] = field(default_factory=lambda: {kind: [] for kind in KINDS})
    building_ids: list[int] = field(default_factory=list)
    hidden_windows: list[Usd.Prim] = field(default_factory=list)

    def add_copies(
        self,
        prototype: Findings,
        transforms: NDArray[np.float64],
        building: int,
        visible: Timeline,
    ) -> None:
        """Add everything in ``prototype`` once for each of the (N, 4, 4) ``transforms``.

        A building inside becomes N buildings; what stands in none belongs to ``building``.
        """
        count, inside = len(transforms), len(prototype.building_ids)
        if count == 0:
            return
        first = len(self.building_ids)
        self.building_ids += prototype.building_ids * count
        copy_start = first + inside * np.arange(count)[:, None]
        for kind, items in prototype.items.items():
            for item in items:
                own = item.buildings[None, :]
                self.items[kind].append(
                    Item(
                        item.prim,
                        (item.matrices[None] @ transforms[:, None]).reshape(-1, 4, 4),
                        np.where(own >= 0, copy_start + own, building).reshape(-1),
                        item.visible.both(visible),
                    )
                )
        self.hidden_windows += prototype.hidden_windows
