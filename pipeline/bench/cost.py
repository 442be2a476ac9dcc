# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What a process costs, by the operating system's accounting."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from nightcity.errors import NightcityError

_POLL = 0.02  # s
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
    with tempfile.TemporaryFile("w+") as errors:
        process = subprocess.Popen(
            list(map(str, command)), stdout=subprocess.DEVNULL, stderr=errors
        )
        try:
            status, usage = _wait(process, None if limit is None else start + limit)
        except BaseException:
            process.kill()
            process.wait()
            raise
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            errors.seek(0)
            said = (errors.read().strip().splitlines() or [f"exit code {process.returncode}"])[-1]
            if limit is not None and time.monotonic() - start >= limit:
                said = f"took longer than {limit:g} s"
            raise NightcityError(f"{Path(str(command[0])).name}: {said}")
    return Cost(time.monotonic() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024)


def _wait(process: subprocess.Popen, deadline: float | None) -> tuple[int, os.struct_rusage]:
    stopped = False
    while True:
        child, status, usage = os.wait4(process.pid, 0 if deadline is None else os.WNOHANG)
        if child:
            return status, usage
        if time.monotonic() > deadline:
            os.kill(process.pid, 9 if stopped else 15)
            stopped, deadline = True, deadline + _GRACE
        time.sleep(_POLL)
