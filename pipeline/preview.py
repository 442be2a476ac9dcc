# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What a rendered sequence looks like at a glance: a contact sheet, a movie."""

from __future__ import annotations

import json
import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import OpenImageIO
from numpy.typing import NDArray

from nightcity.display import read_display
from nightcity.errors import NightcityError, SceneError
from nightcity.png_file import write_png
from nightcity.whole_file import whole_file

_MOST_THUMBNAILS = 100
_SHEET_WIDTH = 1920  # pixels, at most
_GAP = 4  # pixels between thumbnails
_BT709, _LIMITED = 1, 1  # H.273: matrix, primaries and transfer; range 16 to 235
_QUALITY = "18"  # of x264, crf: visually lossless


def contact_sheet(frames: list[Path], sheet: Path, exposure: float) -> str:
    """Write thumbnails of the frames as one PNG; of more than 100, evenly chosen ones.

    Returns a line that says so. Raises SceneError naming a frame that cannot be read.
    """
    step = math.ceil(len(frames) / _MOST_THUMBNAILS)
    chosen = frames[::step]
    columns = math.ceil(math.sqrt(len(chosen)))
    width = (_SHEET_WIDTH - _GAP) // columns - _GAP
    thumbnails = [_thumbnail(read_display(frame, exposure), width) for frame in chosen]
    width = max(t.shape[1] for t in thumbnails)
    height = max(t.shape[0] for t in thumbnails)
    rows = math.ceil(len(chosen) / columns)
    pixels = np.full(
        (rows * (height + _GAP) + _GAP, columns * (width + _GAP) + _GAP, 3), 0.2, np.float32
    )
    for i, thumbnail in enumerate(thumbnails):
        y, x = _GAP + i // columns * (height + _GAP), _GAP + i % columns * (width + _GAP)
        pixels[y : y + thumbnail.shape[0], x : x + thumbnail.shape[1]] = thumbnail
    with whole_file(sheet) as pending:
        write_png(pending, pixels)
    return f"wrote {sheet}: {len(chosen)} of {len(frames)} frames"


def _thumbnail(pixels: NDArray[np.float32], width: int) -> NDArray[np.float32]:
    """At most so wide; never enlarged."""
    if pixels.shape[1] <= width:
        return pixels
    height = max(1, round(pixels.shape[0] * width / pixels.shape[1]))
    image = OpenImageIO.ImageBuf(np.ascontiguousarray(pixels, np.float32))
    roi = OpenImageIO.ROI(0, width, 0, height, 0, 1, 0, 3)
    small = OpenImageIO.ImageBufAlgo.resize(image, filtername="box", roi=roi)
    return small.get_pixels("float").reshape(height, width, 3)


def movie(frames: list[Path], target: Path, scene: Path, exposure: float) -> str:
    """Write the frames as H.264 in MP4, at the frame rate of the flat scene.

    Odd widths and heights lose a pixel, which H.264 asks for. Returns a line that says so. Raises
    SceneError naming a frame that cannot be read or is of another size.
    """
    try:
        import av  # large: only where there is a farm
    except ImportError:
        raise NightcityError("av is not installed: pip install 'nightcity[farm]'") from None
    rate = Fraction(_frame_rate(scene)).limit_denominator(1001)
    first = read_display(frames[0], exposure)
    height, width = first.shape[0] & ~1, first.shape[1] & ~1
    if not (width and height):
        raise SceneError(f"{frames[0]}: is too small for a movie")
    with (
        whole_file(target) as pending,
        av.open(
            str(pending),
            "w",
            format="mp4",
            options={"movflags": "+faststart", "fflags": "+bitexact"},
        ) as container,
    ):
        # One thread: the bytes do not depend on the machine's cores.
        stream = container.add_stream(
            "libx264", rate=rate, options={"crf": _QUALITY, "threads": "1", "flags": "+bitexact"}
        )
        stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
        coding = stream.codec_context
        coding.colorspace = coding.color_primaries = coding.color_trc = _BT709
        coding.color_range = _LIMITED
        for frame in frames:
            pixels = read_display(frame, exposure)
            if pixels.shape != first.shape:
                raise SceneError(f"{frame}: is of another size than {frames[0].name}")
            bytes_ = (pixels[:height, :width] * 255 + 0.5).astype(np.uint8)
            picture = av.VideoFrame.from_ndarray(np.ascontiguousarray(bytes_), format="rgb24")
            converted = picture.reformat(
                format="yuv420p", dst_colorspace=av.video.reformatter.Colorspace.ITU709
            )
            container.mux(stream.encode(converted))
        container.mux(stream.encode(None))
    return f"wrote {target}: {len(frames)} frames at {float(rate):g} a second"


def _frame_rate(scene: Path) -> float:
    try:
        return float(json.loads((scene / "scene.json").read_text())["frames"]["per_second"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise SceneError(f"{scene}: is no flat scene with a frame rate ({error})") from None
