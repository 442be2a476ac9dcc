# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What the Python tests share: the built programs, and the command as a user calls it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
os.environ["PATH"] = f"{ROOT / 'build/release/bin'}:{os.environ['PATH']}"

Command = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def nightcity() -> Command:
    """Run ``nightcity ARGUMENTS`` in a process of its own; ``code`` is the exit code expected."""

    def run(*arguments: str | Path, code: int = 0) -> subprocess.CompletedProcess[str]:
        done = subprocess.run(
            [sys.executable, "-m", "nightcity", *map(str, arguments)],
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == code, f"exit {done.returncode}\n{done.stdout}\n{done.stderr}"
        return done

    return run
