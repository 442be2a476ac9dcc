# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity chart --compare``: a sleep and a wrong power, planted in the renderer, are caught."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import pytest
from conftest import Command
from small_chart import CAMERA, make_small_chart, shared_chart

from nightcity.chart.compare import compare
from nightcity.chart.kept import Kept
from nightcity.chart.results import Row, read_rows, write_rows
from nightcity.chart.settings import PAPER, gauss, march
from nightcity.errors import SceneError

# A renderer that is the real one on a quiet machine, where the surface frame takes 1 ms and any
# other 10 ms; but gauss sleeps for so long, and its windows have so many times their power, in
# which the glow is linear.
_PLANTED = """#!{python}
import json, subprocess, sys
import OpenImageIO
done = subprocess.run([{renderer!r}, *sys.argv[1:]])
given = dict(zip(sys.argv[1:], sys.argv[2:]))
gauss = given.get("--method") == "gauss"
if done.returncode == 0 and "--stats" in given:
    statistics = json.load(open(given["--stats"]))
    frame = 10 + ({sleep!r} if gauss else 0) if "--method" in given else 1
    statistics["timing"]["steady_frame_ms"] = frame
    json.dump(statistics, open(given["--stats"], "w"))
    file = OpenImageIO.ImageInput.open(given["-o"])
    spec, pixels = file.spec(), file.read_image("float")
    file.close()
    glow = [i for i, name in enumerate(spec.channelnames) if name.startswith("glow.")]
    pixels[..., glow] *= {power!r} if gauss else 1
    out = OpenImageIO.ImageOutput.create(given["-o"])
    out.open(given["-o"], spec)
    out.write_image(pixels)
    out.close()
sys.exit(done.returncode)
"""


def plant(folder: Path, sleep: float, power: float) -> None:
    """Write a nightcity-render into the folder. sleep: ms of a frame."""
    program = folder / "nightcity-render"
    real = shutil.which("nightcity-render")
    text = _PLANTED.format(python=sys.executable, renderer=real, sleep=sleep, power=power)
    program.write_text(text)
    program.chmod(0o755)


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return shared_chart(tmp_path_factory) / "results.csv"


def measured_with(clean: Path, folder: Path, sleep: float, power: float) -> Path:
    """The clean chart's table with gauss and one march measured anew by a planted renderer."""
    shutil.copytree(clean.parent, folder / "chart")
    for frame in (folder / "chart" / "measured").glob("frame.*"):
        frame.unlink()
    programs = folder / "programs"
    programs.mkdir()
    # The truth is the real renderer's: it is looked up as if nothing had changed.
    known = Kept(folder / "none", folder).renderer_hash
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Kept, "renderer_hash", known)
        plant(programs, sleep, power)
        patch.setenv("PATH", f"{programs}:{os.environ['PATH']}")
        make_small_chart(folder, (march(25), gauss(PAPER, 0.01)))
    return folder / "chart" / "results.csv"


def test_planted_sleep_and_error_are_caught(clean: Path, tmp_path: Path) -> None:
    before = measured_with(clean, tmp_path / "before", sleep=0, power=1)
    after = measured_with(clean, tmp_path / "after", sleep=3, power=1.02)
    found = compare(before, after)
    assert all("gauss 0.01, paper: " in line for line in found)
    assert [line for line in found if "slower, 10 -> 13 surface frames" in line]
    assert [line for line in found if "less accurate, bias" in line and "-> 2 %" in line]


def test_nothing_is_found_where_nothing_changed(clean: Path) -> None:
    assert compare(clean, clean) == []


def altered(clean: Path, path: Path, setting: str, **changes: object) -> Path:
    rows: list[Row] = read_rows(clean)
    for row in rows:
        if row["setting"] == setting:
            row.update(changes)
    write_rows(rows, path)
    return path


def test_noise_is_no_finding(clean: Path, tmp_path: Path) -> None:
    rows = {row["setting"]: row for row in read_rows(clean)}
    row = rows["march 25"]
    noisy = row["ratio_to_surface"] + 0.9 * row["ratio_spread"]
    new = altered(clean, tmp_path / "new.csv", "march 25", ratio_to_surface=noisy)
    assert not [line for line in compare(clean, new) if row["ratio_spread"] > 0 and "march" in line]
    path = rows["path 16, full"]
    bias = path["numerical_centre_bias"] + 2 * path["mean_noise"]
    new = altered(clean, tmp_path / "new.csv", "path 16, full", numerical_centre_bias=bias)
    assert compare(clean, new) == []


def test_lost_and_failing_settings_are_named(clean: Path, tmp_path: Path) -> None:
    write_rows(
        [row for row in read_rows(clean) if row["setting"] != "march 5"], tmp_path / "new.csv"
    )
    assert ["march 5" in line for line in compare(clean, tmp_path / "new.csv")] == [True]
    new = altered(clean, tmp_path / "new.csv", "gauss 0.01, paper", failure="no memory")
    assert [line for line in compare(clean, new) if "fails: no memory" in line]


def test_command(nightcity: Command, clean: Path, tmp_path: Path) -> None:
    assert "nothing is slower" in nightcity("chart", "--compare", clean, clean).stdout
    slow = altered(clean, tmp_path / "slow.csv", "march 25", ratio_to_surface=1e4)
    assert "march 25: slower" in nightcity("chart", "--compare", clean, slow, code=1).stdout
    (tmp_path / "no.csv").write_text("a,b\n1,2\n")
    nightcity("chart", "--compare", clean, tmp_path / "no.csv", code=3)
    with pytest.raises(SceneError, match="in common"):
        compare(clean, _renamed(clean, tmp_path))


def _renamed(clean: Path, folder: Path) -> Path:
    rows = [{**row, "camera": f"not {CAMERA}"} for row in read_rows(clean)]
    write_rows(rows, folder / "renamed.csv")
    return folder / "renamed.csv"
