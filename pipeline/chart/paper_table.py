# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The times that the paper states, to stand beside ours.

Brito, Real-time Night City Rendering, Table 1 ("Performance given the number of ray
subdivisions"): GeForce RTX 2080, 1920 x 1061 pixels; the paper names neither the city nor the
camera of this table. It states no error: the chart takes ours at the same number of steps.
"""

from __future__ import annotations

SOURCE = "Brito, Real-time Night City Rendering, Table 1: GeForce RTX 2080, 1920 x 1061"
FRAMES_PER_SECOND = {5: 197, 25: 109, 40: 75, 100: 36}  # by steps a segment
