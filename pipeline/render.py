# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Drives nightcity-render: from a stage, or from a flat scene that is there already."""

from __future__ import annotations

import contextlib
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from nightcity.errors import DeviceError, NightcityError, SceneError, UsageError

# A command goes with the process that waits for it, also where that is killed (prctl(2),
# PR_SET_PDEATHSIG); setpriv is part of util-linux.
WITH_ITS_PARENT = ("setpriv", "--pdeathsig", "TERM", "--")

_ERRORS = {2: UsageError, 3: SceneError, 4: DeviceError}


def renderer() -> str:
    """The path of nightcity-render; an error that says how to build it where it is not there."""
    found = shutil.which("nightcity-render")
    if found is None:
        raise NightcityError(
            "nightcity-render is not on the PATH: call this through ./nightcity, "
            "which builds it, or add build/release/bin to the PATH"
        )
    return found


@contextlib.contextmanager
def flat_scene(stage: Path, keep: Path | None = None, lists: str = "recomputed") -> Iterator[Path]:
    """The folder of the stage's flat scene; made for the ``with`` block unless ``keep`` names one.

    A folder that already holds a flat scene is taken as it is.
    """
    if (stage / "scene.json").is_file():
        yield stage
        return
    from nightcity.export.export_stage import export_stage

    with contextlib.ExitStack() as stack:
        folder = keep or Path(stack.enter_context(tempfile.TemporaryDirectory())) / "scene"
        for note in export_stage(stage, folder, lists=lists).notes:
            print(f"note: {note}", file=sys.stderr)
        yield folder


def run_renderer(arguments: Sequence[str | Path]) -> None:
    """Run nightcity-render; raises the error of its exit code, with what it wrote."""
    command = [renderer(), *map(str, arguments)]
    done = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        message = done.stderr.strip() or f"nightcity-render ended with {done.returncode}"
        raise _ERRORS.get(done.returncode, NightcityError)(message)


def render(stage: Path, options: Sequence[str], keep: Path | None, lists: str) -> int:
    """``nightcity render``: the renderer's own progress, messages and exit code pass through.

    With ``--model auto`` among the options, what they leave open is chosen first.
    """
    program = renderer()
    with flat_scene(stage, keep, lists) as scene:
        from nightcity.chart.automatic import chosen_options

        options = chosen_options(scene, options)
        process = subprocess.Popen([*WITH_ITS_PARENT, program, str(scene), *options])
        try:
            return process.wait()
        except BaseException:
            process.terminate()
            process.wait()
            raise
