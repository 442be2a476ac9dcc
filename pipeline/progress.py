# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Progress of long work on standard error: one moving line on a terminal, plain lines elsewhere."""

from __future__ import annotations

import sys
import time

_LINE_SECONDS = 10.0  # between plain lines: farm managers look for one a minute
_TERMINAL_SECONDS = 0.1
_FORETELLS = 0.01  # share of the work; less says nothing about the rest


class Progress:
    """``with Progress("writing windows", total) as progress: ... progress.advance()``.

    shown: False in a process whose parent shows the progress.
    """

    shown = True

    def __init__(self, label: str, total: int) -> None:
        self._label, self._total, self._done = label, max(total, 1), 0
        self._terminal = sys.stderr.isatty()
        self._start = self._shown = time.monotonic()

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *exception: object) -> None:
        if self._terminal and self.shown:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()

    def advance(self, count: int = 1) -> None:
        """Say that ``count`` more of the total are done."""
        self._done += count
        now = time.monotonic()
        if not self.shown:
            return
        if now - self._shown < (_TERMINAL_SECONDS if self._terminal else _LINE_SECONDS):
            return
        self._shown = now
        share = self._done / self._total
        left = (now - self._start) * (1 - share) / max(share, 1e-9)
        text = f"{self._label}: {100 * share:.0f} %"
        if share >= _FORETELLS:
            text += f", about {left:.0f} s left"
        sys.stderr.write(f"\r\x1b[K{text}" if self._terminal else f"{text}\n")
        sys.stderr.flush()
