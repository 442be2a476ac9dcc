# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Work over many parts on all cores: processes that die with the one that started them."""

from __future__ import annotations

import ctypes
import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from typing import TypeVar

from nightcity.progress import Progress

_Part = TypeVar("_Part")
_Result = TypeVar("_Result")

_MOST_PROCESSES = 8  # each holds USD and a part; more wait for the disk
_AHEAD = 2  # parts in work or waiting, a process: bounds the memory
_SET_PARENT_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG of prctl(2)


def in_order(
    work: Callable[[_Part], _Result], parts: Iterable[_Part], count: int, label: str
) -> Iterator[_Result]:
    """``work(part)`` of each part in the order of the parts, in processes of their own.

    work: a function of a module; parts and results are pickled. count: how many parts, for the
    progress line. What ``work`` raises is raised here, and the rest is dropped.
    """
    cores = min(len(os.sched_getaffinity(0)), _MOST_PROCESSES, max(count, 1))
    # Spawned rather than forked: USD has threads, which a fork would lose.
    context = multiprocessing.get_context("spawn")
    with (
        Progress(label, count) as progress,
        ProcessPoolExecutor(cores, context, _begin, (os.getpid(),)) as pool,
    ):
        waiting: deque[Future[_Result]] = deque()
        try:
            for part in parts:
                waiting.append(pool.submit(work, part))
                if len(waiting) == _AHEAD * cores:
                    yield waiting.popleft().result()
                    progress.advance()
            while waiting:
                yield waiting.popleft().result()
                progress.advance()
        finally:
            pool.shutdown(cancel_futures=True)


def _begin(parent: int) -> None:
    """Die with the parent, however it dies; leave interrupts and the progress line to it."""
    ctypes.CDLL(None).prctl(_SET_PARENT_DEATH_SIGNAL, signal.SIGKILL)
    if os.getppid() != parent:
        os.kill(os.getpid(), signal.SIGKILL)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Progress.shown = False
