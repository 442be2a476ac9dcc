# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Opens a stage whole, or says what is missing; its frames, units and up axis."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from math import ceil, floor, isfinite
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Tf, Usd, UsdGeom

from nightcity import schemas
from nightcity.errors import SceneError, UsageError
from nightcity.export.notes import Notes
from nightcity.payloads import loaded, open_outside

_SHOWN_ERRORS = 5


@dataclass
class Source:
    """An open stage and how it is read.

    frames: first and last, USD time codes; attributes are read at the first unless they are
    followed over time. root: (4, 4), from the stage's space to metres with z up, for row vectors.
    districts: paths of the districts, which are not loaded; empty where everything is.
    """

    stage: Usd.Stage
    frames: tuple[int, int]
    frames_per_second: float
    root: NDArray[np.float64]
    knows_frames: bool = True
    districts: tuple[str, ...] = ()
    notes: Notes = field(default_factory=Notes)
    time: Usd.TimeCode = field(init=False)  # the first frame
    still: bool = field(init=False)  # nothing can vary within the frames

    def __post_init__(self) -> None:
        self.time = Usd.TimeCode(self.frames[0])
        self.still = self.knows_frames and self.frames[0] == self.frames[1]

    def value(self, prim: Usd.Prim, name: str, fallback: object = None) -> object:
        """Composed value of an attribute at the first frame; a note where it changes later."""
        attribute = prim.GetAttribute(name)
        if not attribute:
            return fallback
        if not self.still and self.varies(attribute):
            self.notes.about(
                f"An animated {name} is taken at frame {self.frames[0]}", prim.GetPath()
            )
        value = attribute.Get(self.time)
        return fallback if value is None else value

    def change_times(self, attribute: Usd.Attribute) -> list[float]:
        """The first frame, then every time up to the last at which a held attribute is sampled."""
        first, last = self.frames
        if not self.varies(attribute):
            return [float(first)]
        times = attribute.GetTimeSamplesInInterval(Gf.Interval(first, last))
        return [float(first), *(time for time in times if time > first)]

    def varies(self, item: Usd.Attribute | UsdGeom.Xformable) -> bool:
        """Whether an attribute or a local transform may change within the frames."""
        if self.still:
            return False
        check: Callable[[], bool] = (
            item.ValueMightBeTimeVarying
            if isinstance(item, Usd.Attribute)
            else item.TransformMightBeTimeVarying
        )
        if not check():
            return False
        if not self.knows_frames:
            self.notes.say(
                "The stage is animated but states no startTimeCode and endTimeCode: only frame"
                f" {self.frames[0]} is exported, unless frames are asked for"
            )
        return self.frames[0] != self.frames[1]


def open_stage(path: Path, frames: tuple[int, int] | None = None) -> Source:
    """Open a stage with all its payloads but those of districts, where there are several.

    frames: first and last to export; by default the stage's own time codes, or frame 1.
    Raises SceneError where the file or anything that it refers to cannot be read.
    """
    schemas.register()
    if not path.is_file():
        raise SceneError(f"{path}: there is no such stage file")
    try:
        stage, districts = open_outside(path)
    except Tf.ErrorException as error:
        raise SceneError(f"{path}: USD cannot open it: {_first_line(error)}") from error
    refuse_broken(stage)
    notes = Notes()
    return Source(
        stage,
        _frames(stage, frames, notes),
        _frames_per_second(stage, path),
        _root(stage, path, notes),
        knows_frames=frames is not None or stage.HasAuthoredTimeCodeRange(),
        districts=districts,
        notes=notes,
    )


@contextlib.contextmanager
def loaded_district(source: Source, district: str) -> Iterator[Source]:
    """The stage with one district loaded, and notes of its own.

    Raises SceneError where the district refers to what is not there.
    """
    with loaded(source.stage, district):
        refuse_broken(source.stage)
        yield replace(source, notes=Notes())


def refuse_broken(stage: Usd.Stage) -> None:
    """Raises SceneError naming what does not compose."""
    errors = stage.GetCompositionErrors()
    if errors:
        path = stage.GetRootLayer().realPath
        shown = "; ".join(str(error).strip().replace("\n", " ") for error in errors[:_SHOWN_ERRORS])
        more = f"; and {len(errors) - _SHOWN_ERRORS} more" if len(errors) > _SHOWN_ERRORS else ""
        raise SceneError(f"{path}: parts of the stage are missing or broken: {shown}{more}")


def _first_line(error: Tf.ErrorException) -> str:
    parts = [str(part.commentary) for part in error.args if hasattr(part, "commentary")]
    return (parts or str(error).strip().splitlines() or ["unknown error"])[0]


def _frames(stage: Usd.Stage, asked: tuple[int, int] | None, notes: Notes) -> tuple[int, int]:
    if asked is not None:
        first, last = asked
        if first > last:
            raise UsageError(f"frames {first}-{last} end before they begin")
        return first, last
    if not stage.HasAuthoredTimeCodeRange():
        return 1, 1
    start, end = stage.GetStartTimeCode(), stage.GetEndTimeCode()
    if not (isfinite(start) and isfinite(end)) or max(abs(start), abs(end)) >= 2**24:
        raise SceneError(
            f"startTimeCode {start} and endTimeCode {end} are no frames: both must be finite and"
            " below 2^24 in size, so that a float32 holds them"
        )
    first, last = ceil(start), floor(end)
    if last < first:
        notes.say(f"The stage's time codes end before they begin: only frame {first} is exported")
    return first, max(first, last)


def _frames_per_second(stage: Usd.Stage, path: Path) -> float:
    rate = float(stage.GetTimeCodesPerSecond())
    if not (isfinite(rate) and rate > 0):
        raise SceneError(f"{path}: timeCodesPerSecond is {rate}; it must be above 0")
    return rate


def _root(stage: Usd.Stage, path: Path, notes: Notes) -> NDArray[np.float64]:
    for name, meaning in (("metersPerUnit", "centimetres"), ("upAxis", "Y up")):
        if not stage.HasAuthoredMetadata(name):
            notes.say(f"The stage states no {name}, which in USD means {meaning}")
    unit = UsdGeom.GetStageMetersPerUnit(stage)
    if not (isfinite(unit) and unit > 0):
        raise SceneError(f"{path}: metersPerUnit is {unit}; it must be above 0")
    root = np.eye(4)
    root[:3, :3] *= unit
    if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y:  # (x, y, z) -> (x, -z, y)
        root[:3, :3] = unit * np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
    return root
