# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Stops a job at random moments with TERM or KILL and runs it again: the same final files.

    python tests/farm/stop_anywhere.py [MOMENTS]    with nightcity, nightcity-render on the PATH

The suite has two such moments (tests/pipeline/test_farm.py); this has 20 by default, over the
whole job: export, frames, contact sheet, movie.
"""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "pipeline"))

from farm_job import ENVIRONMENT, Shot, call, make_shot


def main() -> None:
    moments = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    draw = random.Random(1)
    with tempfile.TemporaryDirectory() as folder:
        stage = Path(folder) / "stage/city.usda"
        stage.parent.mkdir()
        call("nightcity", "generate", "--preset", "paper-1x1", "-o", stage)
        whole = make_shot(Path(folder) / "whole", stage, "--frames", "1-6")
        started = time.monotonic()
        whole.run()
        longest = time.monotonic() - started
        stops = 0
        while stops < moments:
            folder_of_this = Path(tempfile.mkdtemp(dir=folder)) / "shot"
            shot = make_shot(folder_of_this, stage, "--frames", "1-6")
            stop = draw.choice([signal.SIGTERM, signal.SIGKILL])
            delay = draw.uniform(0, longest)
            if found := stop_and_run_again(shot, whole, stop, delay):
                stops += 1
                print(f"{stops}: {stop.name} after {delay:.2f} s, {found}", flush=True)
            else:
                longest = delay  # the machine has become faster
    print(f"{moments} moments, the same final files")


def stop_and_run_again(shot: Shot, whole: Shot, stop: signal.Signals, delay: float) -> str:
    """What was there when the job was stopped; raises where anything is not as it must be.

    Empty where the job had ended before.
    """
    process = subprocess.Popen(
        ["nightcity", "farm", "run", shot.job],
        env=ENVIRONMENT,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    time.sleep(delay)
    if process.poll() is not None:
        assert process.returncode == 0 and shot.files() == whole.files()
        return ""
    process.send_signal(stop)
    code = process.wait(60)
    deadline = time.monotonic() + 30
    while stop == signal.SIGKILL and shot.processes() and time.monotonic() < deadline:
        time.sleep(0.1)
    assert not shot.processes(), shot.processes()
    expected = whole.files()
    there = {n: data for n, data in shot.files().items() if not n.rpartition("/")[2][0] == "."}
    for name, data in there.items():
        assert data == expected[name], f"{name} is not as it ends"
    shot.run()
    final = shot.files()
    other = {name for name in final.keys() | expected if final.get(name) != expected.get(name)}
    assert not other, f"other files than at the end of an unbroken run: {other}"
    return f"exit {code}, {len(there)} files were there"


if __name__ == "__main__":
    main()
