# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Runs one task's command wherever it is called: in a Dask worker, or in a job of Slurm."""

from __future__ import annotations

import collections
import signal
import subprocess
import threading
import uuid
from collections.abc import Callable, Mapping, Sequence

from nightcity.errors import NightcityError
from nightcity.render import WITH_ITS_PARENT

# Exit codes that would come again wherever the task runs: usage, scene.
HOPELESS = frozenset({2, 3})

_KEPT_LINES = 20  # of what a command that failed said last, less what tells of progress
_PROGRESS = ("openjd_progress:", "ALF_PROGRESS ", "wrote ", "kept ")
_STOP_SECONDS = 60  # between TERM and KILL

_lock = threading.Lock()
_running: dict[str, set[subprocess.Popen[str]]] = collections.defaultdict(set)
_stopped: set[str] = set()


class TaskFailed(Exception):  # noqa: N818 - an outcome: Dask retries what raises
    """A task that may succeed elsewhere or later."""


def run_command(command: Sequence[str], run: str, say: Callable[[str], None]) -> tuple[int, str]:
    """Exit code (negative: ended by that signal) and last lines of a command.

    ``say`` gets each line as it comes. ``run``: whose command it is, for `stop_commands`.
    """
    with _lock:
        if run in _stopped:
            return 128 + signal.SIGTERM, "not started"
        process = subprocess.Popen(
            [*WITH_ITS_PARENT, *command],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
        )
        _running[run].add(process)
    try:
        last: collections.deque[str] = collections.deque(maxlen=_KEPT_LINES)
        for line in process.stdout:
            say(line.rstrip())
            if not line.startswith(_PROGRESS):
                last.append(line.rstrip())
        return process.wait(), "\n".join(last)
    finally:
        with _lock:
            _running[run].discard(process)


def run_here(command: Sequence[str], retries: int, environment: Mapping[str, str]) -> int:
    """Run a command to its end, with its output on standard output; returns its exit code.

    Tries again where that may help: here, or, where the device does not suffice (4) in a job of
    Slurm, on another node through a requeue.
    """
    run = uuid.uuid4().hex
    try:
        for attempt in range(retries + 1):
            code, _ = run_command(command, run, lambda line: print(line, flush=True))
            if code == 0 or code in HOPELESS:
                break
            print(f"try {attempt + 1} failed with exit code {code}", flush=True)
            if code == 4 and "SLURM_JOB_ID" in environment:
                _requeue(environment, retries)
                break
        return code if code >= 0 else 128 - code
    finally:
        stop_commands(run)


def _requeue(environment: Mapping[str, str], retries: int) -> None:
    if int(environment.get("SLURM_RESTART_COUNT", "0")) >= retries:
        return
    done = subprocess.run(["scontrol", "requeue", environment["SLURM_JOB_ID"]], check=False)
    if done.returncode:
        raise NightcityError("scontrol requeue failed; the task is not tried on another node")


def is_stopped(run: str) -> bool:
    """Whether `stop_commands` was called for the run in this process."""
    return run in _stopped


def stop_commands(run: str) -> None:
    """End the run's commands in this process, and start none of it any more."""
    with _lock:
        _stopped.add(run)
        processes = list(_running.get(run, ()))
    for process in processes:
        process.terminate()
    for process in processes:
        try:
            process.wait(_STOP_SECONDS)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
