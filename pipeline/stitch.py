# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Joins the tiles of a frame, which ``nightcity-render --tile`` wrote, into the frame."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import OpenImageIO

from nightcity.errors import SceneError
from nightcity.whole_file import whole_file

_ROWS = 64  # read and written at once: memory does not grow with the frame
_HASH = "nightcity:settingsHash"


def stitch(frame: Path, remove_tiles: bool = False) -> str:
    """Write ``frame`` (.exr) from ``NAME.IofN.exr`` beside it; returns a line that says so.

    The frame has the pixels, channels and metadata that it has when rendered in one piece.
    ``remove_tiles``: once it is whole. Where no tile is left and the frame is there, it is kept.
    Raises SceneError naming the tiles that are missing, not whole or of other settings.
    """
    tiles = _find_tiles(frame)
    if not tiles:
        if not frame.is_file():
            raise SceneError(f"{frame}: no tiles like {frame.stem}.1of4{frame.suffix} beside it")
        return f"kept {frame}"
    specs = [_spec(tile) for tile in tiles]
    _check(tiles, specs)
    with whole_file(frame) as pending:
        _write(pending, tiles, specs[0])
    if remove_tiles:
        for tile in tiles:
            tile.unlink()
    return f"wrote {frame}"


def _find_tiles(frame: Path) -> list[Path]:
    """All tiles of the frame, topmost first; an error where some of a set are missing."""
    name = re.compile(re.escape(frame.stem) + r"\.(\d+)of(\d+)" + re.escape(frame.suffix))
    found: dict[int, dict[int, Path]] = {}
    folder = frame.parent
    for path in sorted(folder.iterdir()) if folder.is_dir() else []:
        if match := name.fullmatch(path.name):
            found.setdefault(int(match[2]), {})[int(match[1])] = path
    if len(found) > 1:
        counts = " and ".join(map(str, sorted(found)))
        raise SceneError(f"{frame}: there are tiles of {counts} a frame; remove those of one kind")
    for count, tiles in found.items():
        missing = [str(number) for number in range(1, count + 1) if number not in tiles]
        if missing:
            raise SceneError(f"{frame}: of {count} tiles these are missing: {', '.join(missing)}")
        return [tiles[number] for number in range(1, count + 1)]
    return []


def _open(tile: Path) -> OpenImageIO.ImageInput:
    image = OpenImageIO.ImageInput.open(str(tile))
    if image is None:
        raise SceneError(f"{tile}: is no image that can be read: {OpenImageIO.geterror()}")
    return image


def _spec(tile: Path) -> OpenImageIO.ImageSpec:
    image = _open(tile)
    spec = image.spec()
    image.close()
    return spec


def _check(tiles: list[Path], specs: list[OpenImageIO.ImageSpec]) -> None:
    """That the tiles are of one frame and leave no row out."""
    row, first = 0, specs[0]
    for tile, spec in zip(tiles, specs, strict=True):
        if spec.get_string_attribute(_HASH) != first.get_string_attribute(_HASH) or not (
            spec.get_string_attribute(_HASH)
        ):
            raise SceneError(f"{tile}: is of other settings than {tiles[0].name}; render it again")
        same = (spec.width, spec.full_height, spec.channelnames) == (
            first.width,
            first.full_height,
            first.channelnames,
        )
        if not same or spec.y != row:
            raise SceneError(f"{tile}: does not continue the tile above it; render it again")
        row += spec.height
    if row != first.full_height:
        raise SceneError(f"{tiles[-1]}: ends at row {row} of {first.full_height}; render it again")


def _write(pending: Path, tiles: list[Path], first: OpenImageIO.ImageSpec) -> None:
    spec = OpenImageIO.ImageSpec(first)
    spec.y, spec.height = 0, first.full_height
    spec.erase_attribute("nightcity:tile")
    spec.attribute("DateTime", "")  # or OpenImageIO puts the time of writing here
    out = OpenImageIO.ImageOutput.create("exr")
    if not out.open(str(pending), spec):
        raise OSError(f"{pending}: {out.geterror()}")
    for first_row, rows in _rows(tiles):
        written = out.write_scanlines(first_row, first_row + len(rows), 0, rows)
        if not written:
            raise OSError(f"{pending}: {out.geterror()}")
    if not out.close():
        raise OSError(f"{pending}: {out.geterror()}")


def _rows(tiles: list[Path]) -> Iterator[tuple[int, object]]:
    """First row and pixels (rows, width, channels) of bands, from the top."""
    for tile in tiles:
        image = _open(tile)
        spec = image.spec()
        for row in range(spec.y, spec.y + spec.height, _ROWS):
            end = min(row + _ROWS, spec.y + spec.height)
            rows = image.read_scanlines(row, end, 0, 0, spec.nchannels, "float")
            if rows is None:
                raise SceneError(f"{tile}: is not whole: {image.geterror()}; render it again")
            yield row, rows.reshape(end - row, spec.width, spec.nchannels)
        image.close()
