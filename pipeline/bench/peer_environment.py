# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Other renderers in Python environments of their own: no other command and no test needs them."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from nightcity.bench.judge import say
from nightcity.errors import NightcityError, UsageError


@dataclass(frozen=True)
class PeerEnvironment:
    """The folder that holds one; ``install`` first.

    requirements: of pip, pinned, the renderer first. name: of the renderer, for messages.
    """

    folder: Path
    name: str
    requirements: tuple[str, ...]

    @property
    def python(self) -> Path:
        return self.folder / "bin" / "python"

    def install(self) -> None:
        """Make the environment anew. NightcityError says what failed."""
        if self.folder.exists() and not (self.folder / "pyvenv.cfg").is_file():
            raise UsageError(
                f"--environment {self.folder}: is there already and no Python environment; "
                "name a folder that --install may make"
            )
        say(f"installing {self.requirements[0]} in {self.folder}")
        shutil.rmtree(self.folder, ignore_errors=True)
        run_checked([sys.executable, "-m", "venv", self.folder])
        install = [self.python, "-m", "pip", "install", "--quiet", "--no-input"]
        run_checked([*install, *self.requirements])

    def require(self) -> None:
        """UsageError where it is not there."""
        if not self.python.is_file():
            raise UsageError(f"{self.folder}: holds no {self.name}; add --install")

    def variables(self) -> dict[str, str]:
        """What programs in it find around them."""
        return dict(os.environ)

    def run(self, program: Path, arguments: Sequence[str | Path]) -> None:
        """Run a Python file in it; its standard error passes through."""
        self.require()
        # -P: the folder of the program is no place to import from.
        command = [self.python, "-P", program, *arguments]
        run_checked(command, variables=self.variables(), shown=True)


def run_checked(
    command: Sequence[str | Path],
    cwd: Path | None = None,
    variables: dict[str, str] | None = None,
    shown: bool = False,
) -> None:
    errors = None if shown else subprocess.PIPE
    done = subprocess.run(
        [str(part) for part in command],
        cwd=cwd,
        env=variables,
        stdout=subprocess.DEVNULL,
        stderr=errors,
        text=True,
        check=False,
    )
    if done.returncode:
        what = " ".join(str(part) for part in command[:4])
        said = f": {done.stderr.strip()}" if done.stderr else ""
        raise NightcityError(f"{what} ... ended with {done.returncode}{said}")
