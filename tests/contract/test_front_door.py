# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The front door without root: it changes nothing and prints lines that would mend the machine."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def write_program(path: Path, text: str) -> None:
    path.write_text("#!/bin/sh\n" + text)
    path.chmod(0o755)


@pytest.fixture
def bare_machine(tmp_path: Path) -> dict[str, str]:
    """An environment in which no package is installed and the user is not root."""
    programs = tmp_path / "programs"
    programs.mkdir()
    write_program(programs / "id", "echo 1000\n")
    write_program(programs / "dpkg-query", "exit 1\n")
    write_program(
        programs / "apt-get",
        'case "$1" in indextargets) echo "http://archive.example/debian bookworm";; '
        "*) exit 1;; esac\n",
    )
    # `sudo tee FILE` writes below etc/ instead; `sudo apt-get ...` says what it was asked.
    write_program(
        programs / "sudo",
        f'if [ "$1" = tee ]; then cat >"{tmp_path}/$(basename "$2")"; '
        f'else echo "$@" >>"{tmp_path}/asked"; fi\n',
    )
    return {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}


def test_prints_the_sudo_lines(bare_machine: dict[str, str], tmp_path: Path) -> None:
    door = subprocess.run(
        [ROOT / "nightcity", "demo"], env=bare_machine, capture_output=True, text=True, check=False
    )
    assert door.returncode == 1
    assert "mesa-vulkan-drivers" in door.stderr
    subprocess.run(["bash", "-euc", door.stdout], env=bare_machine, check=True)

    asked = (tmp_path / "asked").read_text().splitlines()
    assert asked[0] == "apt-get update"
    assert asked[1].startswith("apt-get install -y --no-install-recommends ")
    assert "libvulkan-dev" in asked[1]
    if "bookworm" in Path("/etc/os-release").read_text():
        sources = (tmp_path / "nightcity-backports.sources").read_text()
        assert "URIs: http://archive.example/debian\nSuites: bookworm-backports\n" in sources
        pin = (tmp_path / "nightcity").read_text()
        packages, priorities = re.findall(r"Package: (.*)", pin), re.findall(r"ority: (.*)", pin)
        assert priorities == ["-1", "500"]
        assert packages[0] == "*"
        assert "mesa-vulkan-drivers" in packages[1].split()


def test_shell_scripts_parse() -> None:
    for script in ("nightcity", ".ci/run", "tests/run"):
        subprocess.run(["bash", "-n", ROOT / script], check=True)
        assert os.access(ROOT / script, os.X_OK)
