# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Writes PNG, and notices where the disk did not take all of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO
from numpy.typing import NDArray

_END = b"IEND\xae\x42\x60\x82"  # of every PNG (ISO/IEC 15948, 11.2.5)


def write_png(path: Path, pixels: NDArray[np.uint8] | NDArray[np.float32]) -> None:
    """Write sRGB pixels (rows, columns, channels), of float 0 to 1, with 8 bits a channel.

    Raises OSError where the file is not whole.
    """
    rows, columns, channels = pixels.shape
    spec = OpenImageIO.ImageSpec(columns, rows, channels, "uint8")
    spec.attribute("oiio:ColorSpace", "sRGB")
    out = OpenImageIO.ImageOutput.create("png")
    done = (
        out.open(str(path), spec)
        and out.write_image(np.ascontiguousarray(pixels))
        and out.close()
        # On a full disk the writer reports success.
        and path.read_bytes().endswith(_END)
    )
    if not done:
        raise OSError(f"{path}: cannot be written: {out.geterror() or 'the disk is full'}")
