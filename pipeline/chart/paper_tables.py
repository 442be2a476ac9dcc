# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The times that the paper states, to stand beside ours.

Brito, Real-time Night City Rendering, section 6: GeForce RTX 2080, 1920 x 1061 pixels, 25 steps a
segment where the table does not vary them. It states no errors, and not the camera of Table 1.
"""

from __future__ import annotations

_MACHINE = "GeForce RTX 2080, 1920 x 1061"
SOURCE = f"Brito, Real-time Night City Rendering, Table 1: {_MACHINE}"
# Table 1, "Performance given the number of ray subdivisions", by steps a segment.
FRAMES_PER_SECOND = {5: 197, 25: 109, 40: 75, 100: 36}
# Table 2, the 4 x 4 city, by the share of the screen's height that it fills, per cent.
FRAMES_PER_SECOND_BY_HEIGHT = {25: 300, 50: 150, 75: 75, 100: 50}
# Table 3, at 75 % of the screen's height, by buildings along a side of the grid.
FRAMES_PER_SECOND_BY_GRID = {1: 250, 2: 140, 3: 90, 4: 75}
