# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What a process costs, by the operating system's accounting."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from nightcity.errors import NightcityError

_ACCOUNTANT = Path(__file__).with_name("accountant.py")
# The command ends with the process that waits for it, whatever ends that.
_WITH_ACCOUNTANT = ("setpriv", "--pdeathsig", "KILL", "--")
_GRACE = 10.0  # s between TERM and KILL


@dataclass(frozen=True)
class Cost:
    """What one process took, those that it started and waited for included.

    seconds: wall. cpu_seconds: of all of them. memory: peak resident bytes of the largest.
    """

    seconds: float
    cpu_seconds: float
    memory: int

    def __str__(self) -> str:
        return f"{self.seconds:.1f} s, {self.memory / 1e9:.2f} GB"


def run_nightcity(arguments: Sequence[str | Path], limit: float | None = None) -> Cost:
    """Run a command of ``nightcity``; see ``run_measured``."""
    return run_measured([sys.executable, "-m", "nightcity", *arguments], limit)


def run_measured(command: Sequence[str | Path], limit: float | None = None) -> Cost:
    """Run a command and wait for it; what it prints is dropped.

    limit: seconds after which it is stopped. Raises NightcityError with what it wrote to standard
    error where it fails or is stopped.
    """
    start = time.monotonic()
    with tempfile.TemporaryFile("w+") as errors, tempfile.TemporaryFile("w+") as report:
        process = subprocess.Popen(
            [sys.executable, "-I", "-S", _ACCOUNTANT, str(report.fileno())]
            + [*_WITH_ACCOUNTANT, *map(str, command)],
            stdout=subprocess.DEVNULL,
            stderr=errors,
            pass_fds=[report.fileno()],
        )
        try:
            returncode = _wait(process, limit)
        except BaseException:
            process.kill()
            process.wait()
            raise
        seconds = time.monotonic() - start
        if returncode:
            errors.seek(0)
            said = (errors.read().strip().splitlines() or [f"exit code {returncode}"])[-1]
            if limit is not None and seconds >= limit:
                said = f"took longer than {limit:g} s"
            raise NightcityError(f"{Path(str(command[0])).name}: {said}")
        report.seek(0)
        cpu_seconds, memory = report.read().split()
    return Cost(seconds, float(cpu_seconds), int(memory))


def _wait(process: subprocess.Popen, limit: float | None) -> int:
    try:
        return process.wait(limit)
    except subprocess.TimeoutExpired:
        process.terminate()
        try:
            return process.wait(_GRACE)
        except subprocess.TimeoutExpired:
            process.kill()
            return process.wait()
