# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What is submitted to Slurm, told by stand-ins for its commands.

tests/farm/slurm_here runs the same against real daemons.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from farm_job import ENVIRONMENT, Shot, call, make_shot

_SBATCH = """#!/bin/sh
number=$(($(cat {0}/number) + 1))
echo $number >{0}/number
echo "$*" >>{0}/submitted
cat >{0}/script.$number
echo "$number;cluster"
"""
_SCONTROL = """#!/bin/sh
[ "$1" = requeue ] && {{ echo "$2" >>{0}/requeued; exit 0; }}
echo "MaxArraySize            = 4"
"""


@pytest.fixture
def cluster(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with sbatch and scontrol, which is on the PATH."""
    folder = tmp_path / "cluster"
    folder.mkdir()
    (folder / "number").write_text("0")
    for name, text in (("sbatch", _SBATCH), ("scontrol", _SCONTROL)):
        (folder / name).write_text(text.format(folder))
        (folder / name).chmod(0o755)
    monkeypatch.setitem(ENVIRONMENT, "PATH", f"{folder}:{ENVIRONMENT['PATH']}")
    return folder


@pytest.fixture
def shot(tmp_path: Path) -> Shot:
    call("nightcity", "generate", "--preset", "paper-1x1", "-o", tmp_path / "city.usda")
    return make_shot(tmp_path / "shot", tmp_path / "city.usda", "--frames", "1-6")


def submitted(cluster: Path) -> list[dict[str, str]]:
    """The options of each array."""
    lines = (cluster / "submitted").read_text().splitlines()
    return [dict(word.lstrip("-").partition("=")[::2] for word in line.split()) for line in lines]


def test_arrays_dependencies_and_resubmission(shot: Shot, cluster: Path) -> None:
    submit = ("nightcity", "farm", "submit", shot.job, "--engine", "slurm")
    said = call(*submit, "--partition=night").stdout
    assert "Frames: job 2, 4 tasks\nFrames: job 3, 2 tasks\n" in said
    arrays = submitted(cluster)
    names = ["Export", "Frames", "Frames", "Check", "ContactSheet", "Movie"]
    assert [array["job-name"] for array in arrays] == names
    assert [array["array"] for array in arrays] == ["0", "0-3", "0-1", "0", "0", "0"]
    after = [array.get("dependency") for array in arrays]
    assert after == [None, "afterok:1", "afterok:1", "afterany:2:3", "afterok:4", "afterok:4"]
    assert all("partition" in array for array in arrays)

    # What Slurm would do: each array's script, for each of its numbers.
    for number, last in ((1, 0), (2, 3), (3, 1)):
        for task in range(last + 1):
            run = {**ENVIRONMENT, "SLURM_ARRAY_TASK_ID": str(task)}
            script = cluster / f"script.{number}"
            subprocess.run(["sh", script], env=run, check=True, capture_output=True)
    for name in ("frame.0002.exr", "frame.0006.exr"):
        (shot.out / name).unlink()
    (cluster / "submitted").unlink()
    call(*submit, "--resubmit")
    arrays = submitted(cluster)
    assert [a["job-name"] for a in arrays] == ["Frames", "Frames", "Check", "ContactSheet", "Movie"]
    assert [a["array"] for a in arrays[:2]] == ["1", "1"]
    assert "dependency" not in arrays[0]
    assert arrays[2]["dependency"] == "afterany:7:8"


def test_a_device_that_does_not_suffice_is_left_to_another_node(
    shot: Shot, cluster: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(ENVIRONMENT, "SLURM_JOB_ID", "17")
    call("nightcity", "farm", "task", shot.job, "--step", "Export")
    task = ("nightcity", "farm", "task", shot.job, "--step", "Frames")
    stand_in = ("-p", f"Nightcity={shot.stand_in('exit 4')}")
    call(*task, *stand_in, code=4)
    assert (cluster / "requeued").read_text() == "17\n"
    monkeypatch.setitem(ENVIRONMENT, "SLURM_RESTART_COUNT", "2")
    call(*task, *stand_in, code=4)
    assert (cluster / "requeued").read_text() == "17\n"
    assert shot.tried() == ["1", "1"]


def test_without_slurm(shot: Shot, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    programs = tmp_path / "programs"
    programs.mkdir()
    for program in ("nightcity",):
        target = next(Path(p, program) for p in ENVIRONMENT["PATH"].split(":"))
        (programs / program).symlink_to(target)
    monkeypatch.setitem(ENVIRONMENT, "PATH", str(programs))
    done = call("nightcity", "farm", "submit", shot.job, "--engine", "slurm", code=1)
    assert "scontrol is not on the PATH" in done.stderr
