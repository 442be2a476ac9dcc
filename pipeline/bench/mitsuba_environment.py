# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Mitsuba 3 and its LLVM.

Its LLVM variants compile with Debian's LLVM 19; LLVM 15 aborts in them. The library is unpacked
into the environment, so that nothing is installed on the machine.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path

from nightcity.bench.peer_environment import PeerEnvironment, run_checked
from nightcity.errors import NightcityError, UsageError

_LLVM = "libllvm19"  # Debian's package
_LIBRARY = "libLLVM.so.19*"
_LIBRARY_VARIABLE = "DRJIT_LIBLLVM_PATH"


class MitsubaEnvironment(PeerEnvironment):
    """The folder that holds both."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, "Mitsuba with its LLVM", ("mitsuba==3.9.1", "numpy==2.4.6"))

    def install(self) -> None:
        """Packages by pip, LLVM by apt. A library that DRJIT_LIBLLVM_PATH names is used instead of
        Debian's."""
        super().install()
        if _LIBRARY_VARIABLE in os.environ:
            return
        if shutil.which("apt-get") is None:
            raise NightcityError(
                f"this machine has no apt-get: name a libLLVM of version 19 in {_LIBRARY_VARIABLE}"
            )
        with tempfile.TemporaryDirectory() as download:
            run_checked(["apt-get", "download", _LLVM], cwd=Path(download))
            (package,) = Path(download).glob("*.deb")
            run_checked(["dpkg-deb", "-x", package, self.folder / "llvm"])

    def require(self) -> None:
        super().require()
        if not self._library:
            raise UsageError(f"{self.folder}: holds no {self.name}; add --install")

    def variables(self) -> dict[str, str]:
        return super().variables() | {_LIBRARY_VARIABLE: self._library}

    @property
    def _library(self) -> str:
        """The path of libLLVM; empty where there is none."""
        unpacked = sorted((self.folder / "llvm").rglob(_LIBRARY))
        return os.environ.get(_LIBRARY_VARIABLE) or (str(unpacked[0]) if unpacked else "")
