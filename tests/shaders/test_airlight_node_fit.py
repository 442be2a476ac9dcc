# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The fitted node counts are what their generator writes."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

FOLDER = Path(__file__).parents[2] / "shaders" / "transport"
NUMBER = re.compile(r"-?\d+\.\d{5}(?=f)")


def test_fit_is_up_to_date() -> None:
    written = subprocess.run(
        [sys.executable, FOLDER / "fit_airlight_nodes.py"],
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    kept = (FOLDER / "airlight_node_fit.h").read_text()
    assert NUMBER.sub("", written) == NUMBER.sub("", kept), "run fit_airlight_nodes.py again"
    numbers = [[float(n) for n in NUMBER.findall(text)] for text in (written, kept)]
    assert len(numbers[0]) == 52
    # Another linear algebra library may round otherwise.
    drift = max(abs(a - b) for a, b in zip(*numbers, strict=True))
    assert drift < 2e-3, "run fit_airlight_nodes.py again"
