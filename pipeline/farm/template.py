# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A shot as an OpenJobDescription template (2023-09): export, frames, check, sheet and movie.

Every task is one ``nightcity`` command, so that any engine which runs the template, or only its
commands, does the same work.
"""

from __future__ import annotations

import os
import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import yaml

from nightcity.errors import UsageError
from nightcity.frames import frame_files, parse_frames
from nightcity.whole_file import whole_file

EXPORT, FRAMES, STITCH, CHECK = "Export", "Frames", "Stitch", "Check"
SHEET, MOVIE = "ContactSheet", "Movie"

_SCENE = "{{Param.OutputDir}}/scene"  # the flat scene that every step reads
_IMAGES = "{{Param.OutputDir}}/{{Param.FrameName}}"
_STOP_SECONDS = 60  # that a task has between TERM and KILL


@dataclass(frozen=True)
class Shot:
    """What a template is made of. ``scene``: the stage; ``output``: the images' path, with ####;
    ``camera``: empty for the stage's; ``frames``: like 1-10,20; ``chunk``: frames a task;
    ``tiles``: of each frame; ``options``: more options of the renderer."""

    scene: Path
    output: Path
    camera: str = ""
    frames: str = "1"
    chunk: int = 1
    tiles: int = 1
    lists: str = "recomputed"
    options: Sequence[str] = ()


def write_template(shot: Shot, job: Path) -> None:
    """Write the template of the shot. Its paths are kept relative to the job file's folder, as
    OpenJobDescription has it: a job moves with its folder. Raises UsageError."""
    with whole_file(job) as pending:
        pending.write_text(yaml.safe_dump(template(shot, job.parent), sort_keys=False, width=100))


def template(shot: Shot, folder: Path) -> dict[str, object]:
    """The template as plain data. Raises UsageError where the shot makes none."""
    if shot.chunk < 1 or shot.tiles < 1:
        raise UsageError("--chunk and --tiles must be at least 1")
    if shot.tiles > 1 and shot.output.suffix.lower() != ".exr":
        raise UsageError(f"-o {shot.output}: tiles are .exr")
    frame_files(shot.output, shot.frames)
    steps = [_export(), _frames(shot)]
    if shot.tiles > 1:
        steps.append(_stitch())
    steps += _after_the_frames(steps[-1]["name"])
    return {
        "specificationVersion": "jobtemplate-2023-09",
        "extensions": ["TASK_CHUNKING"],
        "name": f"Nightcity {shot.scene.stem}"[:128],
        "parameterDefinitions": _parameters(shot, folder),
        "steps": steps,
    }


def _parameters(shot: Shot, folder: Path) -> list[dict[str, object]]:
    definitions = [
        {
            "name": "Scene",
            "type": "PATH",
            "objectType": "FILE",
            "dataFlow": "IN",
            "default": _inside(shot.scene, folder),
            "description": "The USD stage.",
        },
        {
            "name": "OutputDir",
            "type": "PATH",
            "objectType": "DIRECTORY",
            "dataFlow": "OUT",
            "default": _inside(shot.output.parent, folder),
            "description": "Folder of the images, the flat scene, the contact sheet, the movie.",
        },
        _text("FrameName", shot.output.name, "File name of an image; #### stands for the frame."),
        _text("Camera", shot.camera, "Name of the camera; empty: the stage's."),
        _text("Frames", _ranges(shot.frames), "Frames, like 1-10, 1-10:2 or 1,5,20-30."),
        _number("ChunkSize", shot.chunk, "Frames a task: they share loading and baking."),
        _text("RendererOptions", shlex.join(shot.options), "More options of nightcity-render."),
        _text("LightLists", shot.lists, "recomputed or authored.")
        | {"allowedValues": ["recomputed", "authored"]},
        _text("Nightcity", "nightcity", "The command, where it is not on the PATH."),
    ]
    if shot.tiles > 1:
        definitions.append(_number("Tiles", shot.tiles, "Tiles of each frame."))
    return definitions


def _text(name: str, default: str, description: str) -> dict[str, object]:
    return {"name": name, "type": "STRING", "default": default, "description": description}


def _number(name: str, default: int, description: str) -> dict[str, object]:
    return {
        "name": name,
        "type": "INT",
        "minValue": 1,
        "default": default,
        "description": description,
    }


def _inside(path: Path, folder: Path) -> str:
    """The path from the job's folder, which OpenJobDescription does not let a default leave."""
    relative = os.path.relpath(path, folder)
    if relative == ".." or relative.startswith("../"):
        raise UsageError(
            f"{path} lies outside the folder of the job file, {folder.absolute()}: put the job "
            "file into a folder that holds both the stage and the images"
        )
    return relative


def _ranges(frames: str) -> str:
    """The frames as OpenJobDescription writes them: a step after a colon."""
    parse_frames(frames)
    return frames.replace("x", ":")


def _step(name: str, after: str | None, arguments: list[str]) -> dict[str, object]:
    step: dict[str, object] = {"name": name}
    if after:
        step["dependencies"] = [{"dependsOn": after}]
    step["script"] = {
        "actions": {
            "onRun": {
                "command": "{{Param.Nightcity}}",
                "args": arguments,
                "cancelation": {
                    "mode": "NOTIFY_THEN_TERMINATE",
                    "notifyPeriodInSeconds": _STOP_SECONDS,
                },
            }
        }
    }
    return step


def _export() -> dict[str, object]:
    arguments = ["export", "{{Param.Scene}}", "-o", _SCENE, "--lists", "{{Param.LightLists}}"]
    return _step(EXPORT, None, arguments)


def _render(frames: str) -> list[str]:
    return [
        "render",
        _SCENE,
        "--camera={{Param.Camera}}",
        "--frames",
        frames,
        "-o",
        _IMAGES,
        "--options={{Param.RendererOptions}}",
    ]


def _chunks() -> dict[str, object]:
    return {
        "name": "Frame",
        "type": "CHUNK[INT]",
        "range": "{{Param.Frames}}",
        "chunks": {
            "defaultTaskCount": "{{Param.ChunkSize}}",
            "rangeConstraint": "NONCONTIGUOUS",
        },
    }


def _frames(shot: Shot) -> dict[str, object]:
    arguments = [*_render("{{Task.Param.Frame}}"), "--skip-existing", "--progress", "farm"]
    parameters = [_chunks()]
    if shot.tiles > 1:
        arguments.append("--tile={{Task.Param.Tile}}/{{Param.Tiles}}")
        parameters.append({"name": "Tile", "type": "INT", "range": "1-{{Param.Tiles}}"})
    step = _step(FRAMES, EXPORT, arguments)
    return step | {"parameterSpace": {"taskParameterDefinitions": parameters}}


def _stitch() -> dict[str, object]:
    arguments = ["stitch", _IMAGES, "--frames", "{{Task.Param.Frame}}", "--remove-tiles"]
    step = _step(STITCH, FRAMES, arguments)
    return step | {"parameterSpace": {"taskParameterDefinitions": [_chunks()]}}


def _after_the_frames(last: str) -> list[dict[str, object]]:
    pictures = [_IMAGES, "--frames", "{{Param.Frames}}"]
    return [
        _step(CHECK, last, [*_render("{{Param.Frames}}"), "--list-missing"]),
        _step(SHEET, CHECK, ["sheet", *pictures, "-o", "{{Param.OutputDir}}/contact-sheet.png"]),
        _step(
            MOVIE,
            CHECK,
            ["movie", *pictures, "--scene", _SCENE, "-o", "{{Param.OutputDir}}/movie.mp4"],
        ),
    ]
