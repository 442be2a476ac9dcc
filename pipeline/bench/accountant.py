# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A small process between the one that measures and the one that is measured.

    python accountant.py FD COMMAND ...

Linux counts to the peak memory of a process what its parent held when it started it (the peak
outlives exec), so whatever measures has to be small itself. Runs the command, writes its processor
time in seconds and its peak resident bytes to FD, and ends as the command did: with its exit code,
or 128 + the signal that ended it. TERM is handed on.
"""

from __future__ import annotations

import os
import signal
import sys


def main() -> int:
    report, command = int(sys.argv[1]), sys.argv[2:]
    child = os.posix_spawnp(command[0], command, os.environ)
    signal.signal(signal.SIGTERM, lambda number, frame: os.kill(child, number))
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the terminal sends the command its own
    _, status, usage = os.wait4(child, 0)
    peak = usage.ru_maxrss * 1024
    os.write(report, f"{usage.ru_utime + usage.ru_stime} {peak}\n".encode())
    code = os.waitstatus_to_exitcode(status)
    return 128 - code if code < 0 else code


if __name__ == "__main__":
    sys.exit(main())
