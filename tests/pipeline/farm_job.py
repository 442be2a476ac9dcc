# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of the farm share: a tiny shot, and a stand-in that fails where told."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

BIN = Path(sys.executable).parent
ENVIRONMENT = {**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}"}
# No device, next to no work: what is tested is what happens around the renderer.
OPTIONS = ("--size", "32x18", "--method", "reference", "--subdivisions", "2", "--camera", "street")

# Stands for the command `nightcity`; before it does a task of Frames it runs `faults FRAME`.
_STAND_IN = """#!/bin/sh
if [ "$1" = render ]; then
    case "$*" in *--list-missing*) ;; *)
        frame=$(printf '%s\\n' "$*" | sed -n 's/.*--frames \\([0-9,]*\\) .*/\\1/p')
        echo "$frame" >>"$0.tried"
        {faults}
    esac
fi
exec nightcity "$@"
"""


@dataclass(frozen=True)
class Shot:
    """A job in a folder of its own."""

    folder: Path

    @property
    def job(self) -> Path:
        return self.folder / "job.yaml"

    @property
    def out(self) -> Path:
        return self.folder / "out"

    def stand_in(self, faults: str) -> Path:
        """A command with shell code for faults: ``$frame``, and ``$0`` for files of its own."""
        path = self.folder / "stand-in"
        path.write_text(_STAND_IN.replace("{faults}", faults or ":"))
        path.chmod(0o755)
        return path

    def tried(self) -> list[str]:
        """The frames of each task that was begun, in order."""
        return (self.folder / "stand-in.tried").read_text().split()

    def run(self, *arguments: str | Path, code: int = 0) -> subprocess.CompletedProcess[str]:
        """``nightcity farm run`` on the job."""
        done = subprocess.run(
            ["nightcity", "farm", "run", self.job, *arguments],
            env=ENVIRONMENT,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == code, f"exit {done.returncode}\n{done.stdout}\n{done.stderr}"
        return done

    def files(self) -> dict[str, bytes]:
        """Every file below the output folder, hidden ones too."""
        return {
            str(path.relative_to(self.out)): path.read_bytes()
            for path in sorted(self.out.rglob("*"))
            if path.is_file()
        }

    def processes(self) -> list[str]:
        """Command lines of living processes that name the shot's folder."""
        found = []
        for entry in Path("/proc").iterdir():
            if entry.name.isdigit() and int(entry.name) != os.getpid():
                try:
                    line = (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode()
                except OSError:
                    continue
                if str(self.folder) in line:
                    found.append(line)
        return found


def call(*command: str | Path, code: int = 0) -> subprocess.CompletedProcess[str]:
    """Run a command of the environment; ``code`` is the exit code expected."""
    done = subprocess.run(
        list(map(str, command)), env=ENVIRONMENT, capture_output=True, text=True, check=False
    )
    assert done.returncode == code, f"exit {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done


def make_shot(folder: Path, stage: Path, *options: str) -> Shot:
    """A job on a copy of the stage's files."""
    folder.mkdir()
    for layer in stage.parent.glob("city.*"):
        (folder / layer.name).write_bytes(layer.read_bytes())
    shot = Shot(folder)
    call(
        *("nightcity", "farm", "template", folder / "city.usda", "--job", shot.job),
        *("-o", shot.out / "frame.####.exr", *OPTIONS, *options),
    )
    return shot
