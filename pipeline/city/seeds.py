# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""One independent random stream for each purpose, so that changing one changes no other."""

from __future__ import annotations

from enum import IntEnum

import numpy as np


class Purpose(IntEnum):
    """What a stream is for; the numbers are part of what a seed means and never change."""

    HEIGHTS = 1
    NOISE_START = 2
    LIT = 3
    COLOURS = 4
    TEXTURES = 5
    NIGHT = 6


def sequence(seed: int, purpose: Purpose) -> np.random.SeedSequence:
    """The seed of one stream."""
    return np.random.SeedSequence([seed, int(purpose)])


def generator(seed: int, purpose: Purpose) -> np.random.Generator:
    """One stream."""
    return np.random.Generator(np.random.PCG64(sequence(seed, purpose)))


def stream(seed: int, purpose: Purpose, number: int) -> np.random.Generator:
    """One stream of many for the same purpose."""
    key = np.random.SeedSequence([seed, int(purpose), number])
    return np.random.Generator(np.random.PCG64(key))
