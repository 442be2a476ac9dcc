# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A shot as a batch job: every engine makes the files of a single process, whatever fails."""

from __future__ import annotations

import random
import signal
import subprocess
import time
from pathlib import Path

import pytest
from farm_job import ENVIRONMENT, OPTIONS, Shot, call, make_shot

FRAMES = 6


@pytest.fixture(scope="module")
def stage(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("stage") / "city.usda"
    call("nightcity", "generate", "--preset", "paper-1x1", "-o", path)
    return path


@pytest.fixture(scope="module")
def images(stage: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The images as one process renders them."""
    folder = tmp_path_factory.mktemp("images")
    call(
        *("nightcity", "render", stage, *OPTIONS, "--frames", f"1-{FRAMES}"),
        *("-o", folder / "frame.####.exr"),
    )
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def images_of(shot: Shot) -> dict[str, bytes]:
    return {name: data for name, data in shot.files().items() if name.endswith(".exr")}


def test_openjd_checks_and_runs_the_template(
    stage: Path, images: dict[str, bytes], tmp_path: Path
) -> None:
    shot = make_shot(tmp_path / "shot", stage, "--frames", "1-3x2,4", "--chunk", "2")
    call("openjd", "check", shot.job)
    call("openjd", "run", shot.job)
    wanted = {f"frame.{n:04d}.exr" for n in (1, 3, 4)}
    assert images_of(shot) == {name: images[name] for name in wanted}
    assert {"contact-sheet.png", "movie.mp4"} <= set(shot.files())


def test_a_stage_runs_without_a_template(
    stage: Path, images: dict[str, bytes], tmp_path: Path
) -> None:
    """It is written first, so that the same job can be run again."""
    shot = Shot(tmp_path)
    (tmp_path / "city").mkdir()
    for layer in stage.parent.glob("city.*"):
        (tmp_path / "city" / layer.name).write_bytes(layer.read_bytes())
    out = shot.out / "frame.####.exr"
    told = call(
        *("nightcity", "farm", "run", tmp_path / "city" / "city.usda", "-o", out, *OPTIONS),
        *("--frames", "1-2", "--workers", "1"),
    )
    assert told.stdout.splitlines()[0] == str(tmp_path / "out.job.yaml")
    wanted = {f"frame.{n:04d}.exr" for n in (1, 2)}
    assert images_of(shot) == {name: images[name] for name in wanted}
    again = call("nightcity", "farm", "run", tmp_path / "out.job.yaml", "--workers", "1")
    assert again.stdout.count("kept ") == 2


def test_a_dead_worker_and_a_frame_that_fails_once(
    stage: Path, images: dict[str, bytes], tmp_path: Path
) -> None:
    shot = make_shot(tmp_path / "shot", stage, "--frames", f"1-{FRAMES}")
    faults = """
        case $frame in
        2) mkdir "$0.failed" 2>/dev/null && exit 4 ;;
        esac
        # Once its worker has finished others, and that is known.
        done=$(find "${0%/*}/out" -name 'frame.*' | wc -l)
        [ $done -ge 3 ] && mkdir "$0.killed" 2>/dev/null && {
            echo $$ >"$0.pid"; echo $frame >"$0.again"; sleep 1; kill -9 $PPID; exec sleep 600; }"""
    done = shot.run("-p", f"Nightcity={shot.stand_in(faults)}")
    assert images_of(shot) == images
    again = (tmp_path / "shot/stand-in.again").read_text().strip()
    assert sorted(shot.tried()) == sorted([*map(str, range(1, FRAMES + 1)), "2", again])
    assert done.stdout.count("wrote ") == FRAMES + 2  # and the sheet, the movie
    assert "kept " not in done.stdout
    assert "try failed: Frames Frame 2 (exit code 4)" in done.stdout
    orphan = Path("/proc", (tmp_path / "shot/stand-in.pid").read_text().strip())
    assert not orphan.exists()
    assert shot.processes() == []


def test_what_cannot_succeed_is_tried_once_and_named(stage: Path, tmp_path: Path) -> None:
    shot = make_shot(tmp_path / "shot", stage, "--frames", "1-3")
    done = shot.run(
        "-p", f"Nightcity={shot.stand_in('[ $frame = 2 ] && exit 3')}", "--workers", "1", code=3
    )
    assert sorted(shot.tried()) == ["1", "2", "3"]
    assert f"missing {shot.out}/frame.0002.exr" in done.stdout
    assert set(images_of(shot)) == {"frame.0001.exr", "frame.0003.exr"}
    assert "contact-sheet.png" not in shot.files()


@pytest.mark.parametrize("stop", [signal.SIGTERM, signal.SIGKILL])
def test_stopped_anywhere_and_run_again(
    stage: Path, images: dict[str, bytes], tmp_path: Path, stop: signal.Signals
) -> None:
    shot = make_shot(tmp_path / "shot", stage, "--frames", f"1-{FRAMES}")
    slow = ("-p", f"Nightcity={shot.stand_in('sleep 0.3')}")
    process = subprocess.Popen(
        ["nightcity", "farm", "run", shot.job, *slow],
        env=ENVIRONMENT,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    first = shot.out / "frame.0001.exr"
    while process.poll() is None and not first.exists():
        time.sleep(0.01)
    time.sleep(random.Random(stop).random())
    process.send_signal(stop)
    assert process.wait(60) == (143 if stop == signal.SIGTERM else -9)
    if stop == signal.SIGKILL:
        await_end(shot)
    assert shot.processes() == []
    finished = images_of(shot)
    assert 0 < len(finished) < FRAMES
    assert finished.items() <= images.items()
    done = shot.run()
    assert images_of(shot) == images
    assert done.stdout.count("kept ") == len(finished)
    assert not [name for name in shot.files() if ".part" in name]


def await_end(shot: Shot) -> None:
    """Of what was started by a process that was killed: it hears of that in a moment."""
    deadline = time.monotonic() + 20
    while shot.processes() and time.monotonic() < deadline:
        time.sleep(0.05)


def test_a_scene_that_cannot_be_read(stage: Path, tmp_path: Path) -> None:
    shot = make_shot(tmp_path / "shot", stage)
    (shot.folder / "city.usda").write_text("#usda 1.0\nnonsense")
    done = shot.run(code=3)
    assert f"missing {shot.out}/frame.0001.exr" in done.stdout
    assert "city.usda" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.fixture(scope="module")
def plain(stage: Path, tmp_path_factory: pytest.TempPathFactory) -> Shot:
    """A job that is not run."""
    return make_shot(tmp_path_factory.mktemp("plain") / "shot", stage)


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("run", "job.yaml", "-p", "Frames=5-1"), "descending"),
        (("run", "job.yaml", "-p", "Frame=1"), "Frame"),
        (("run", "job.yaml", "-p", "Frames"), "NAME=VALUE"),
        (("run", "none.yaml"), "none.yaml"),
        (("run", "city.usda"), "city.usda: -o is missing"),
        (("run", "job.yaml", "--size", "32x18"), "--size: job.yaml is a template"),
        (("run", "job.yaml", "-o", "a.exr"), "-o a.exr: job.yaml is a template"),
        (("task", "job.yaml", "--step", "Frames", "--number", "7"), "1 tasks"),
        (("template", "city.usda", "--job", "sub/job.yaml", "-o", "a.exr"), "outside the folder"),
        (("template", "city.usda", "--job", "j.yaml", "-o", "a.exr", "--frames", "1-2"), "####"),
        (("template", "city.usda", "--job", "j.yaml", "-o", "a.png", "--tiles", "2"), ".exr"),
    ],
)
def test_wrong_usage(
    plain: Shot, arguments: tuple[str, ...], word: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(plain.folder)
    done = call("nightcity", "farm", *arguments, code=2)
    assert word in done.stderr
    assert "Traceback" not in done.stderr
