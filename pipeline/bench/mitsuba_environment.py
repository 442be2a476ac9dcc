# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Mitsuba 3 in a Python environment of its own: no other command and no test needs it.

Its LLVM variants compile with Debian's LLVM 19; LLVM 15 aborts in them. The library is unpacked
into the environment, so that nothing is installed on the machine.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from nightcity.bench.judge import say
from nightcity.errors import NightcityError, UsageError

_REQUIREMENTS = ("mitsuba==3.9.1", "numpy==2.4.6")
_LLVM = "libllvm19"  # Debian's package
_LIBRARY = "libLLVM.so.19*"
_LIBRARY_VARIABLE = "DRJIT_LIBLLVM_PATH"


@dataclass(frozen=True)
class MitsubaEnvironment:
    """The folder that holds it; ``install`` first."""

    folder: Path

    @property
    def _python(self) -> Path:
        return self.folder / "bin" / "python"

    def install(self) -> None:
        """Make the environment anew: packages by pip, LLVM by apt. NightcityError says what failed.

        A library that DRJIT_LIBLLVM_PATH names is used instead of Debian's.
        """
        if self.folder.exists() and not (self.folder / "pyvenv.cfg").is_file():
            raise UsageError(
                f"--environment {self.folder}: is there already and no Python environment; "
                "name a folder that --install may make"
            )
        say(f"installing {_REQUIREMENTS[0]} in {self.folder}")
        shutil.rmtree(self.folder, ignore_errors=True)
        _run([sys.executable, "-m", "venv", self.folder])
        _run([self._python, "-m", "pip", "install", "--quiet", "--no-input", *_REQUIREMENTS])
        if _LIBRARY_VARIABLE in os.environ:
            return
        if shutil.which("apt-get") is None:
            raise NightcityError(
                f"this machine has no apt-get: name a libLLVM of version 19 in {_LIBRARY_VARIABLE}"
            )
        with tempfile.TemporaryDirectory() as download:
            _run(["apt-get", "download", _LLVM], cwd=Path(download))
            (package,) = Path(download).glob("*.deb")
            _run(["dpkg-deb", "-x", package, self.folder / "llvm"])

    def require(self) -> None:
        """UsageError where Mitsuba or its library is not there."""
        if not self._python.is_file() or not self._library:
            raise UsageError(f"{self.folder}: holds no Mitsuba with its LLVM; add --install")

    def run(self, program: Path, arguments: Sequence[str | Path]) -> None:
        """Run a Python file in it; its standard error passes through."""
        self.require()
        variables = os.environ | {_LIBRARY_VARIABLE: self._library}
        # -P: the folder of the program is no place to import from.
        _run([self._python, "-P", program, *arguments], variables=variables, shown=True)

    @property
    def _library(self) -> str:
        """The path of libLLVM; empty where there is none."""
        unpacked = sorted((self.folder / "llvm").rglob(_LIBRARY))
        return os.environ.get(_LIBRARY_VARIABLE) or (str(unpacked[0]) if unpacked else "")


def _run(
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
