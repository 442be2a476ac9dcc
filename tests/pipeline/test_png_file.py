# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""PNG files are whole, or an error says that they are not."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from nightcity.display import read_display
from nightcity.png_file import write_png


def test_bytes_and_floats_are_kept(tmp_path: Path) -> None:
    pixels = np.random.default_rng(1).integers(0, 256, (5, 7, 3), np.uint8)
    write_png(tmp_path / "bytes.png", pixels)
    write_png(tmp_path / "floats.png", (pixels / 255).astype(np.float32))
    for name in ("bytes.png", "floats.png"):
        assert np.array_equal(np.rint(read_display(tmp_path / name, 0) * 255), pixels)


@pytest.mark.parametrize("limit", [0, 100, 8192, 12000])
def test_a_full_disk_is_an_error(tmp_path: Path, limit: int) -> None:
    """A limit on file sizes stands for a full disk."""
    script = (
        "import resource, signal, sys, pathlib, numpy\n"
        "from nightcity.png_file import write_png\n"
        "noise = numpy.random.default_rng(1).integers(0, 256, (64, 64, 3), numpy.uint8)\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        f"resource.setrlimit(resource.RLIMIT_FSIZE, ({limit}, {limit}))\n"
        "write_png(pathlib.Path(sys.argv[1]), noise)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script, tmp_path / "a.png"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert f"OSError: {tmp_path}/a.png: cannot be written" in done.stderr
