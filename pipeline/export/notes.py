# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What the exporter changed or left out, collected as sentences for people."""

from __future__ import annotations

_NAMED = 20  # prims that one sentence names; the rest are counted


class Notes:
    """Sentences in the order in which they first came up; equal ones share their prims."""

    def __init__(self) -> None:
        self._prims: dict[str, dict[str, None]] = {}

    def say(self, sentence: str) -> None:
        """Add one sentence that stands alone."""
        self._prims.setdefault(sentence, {})

    def about(self, sentence: str, prim: object) -> None:
        """Add ``prim`` (a path) to those that ``sentence`` is true of."""
        self._prims.setdefault(sentence, {})[str(prim)] = None

    def take_in(self, other: Notes) -> None:
        """Add the notes of another part of the same stage."""
        for sentence, prims in other._prims.items():
            self._prims.setdefault(sentence, {}).update(prims)

    def sentences(self) -> list[str]:
        """Every note, ended by the prims it is about."""
        return [_ended(sentence, list(prims)) for sentence, prims in self._prims.items()]


def _ended(sentence: str, prims: list[str]) -> str:
    if not prims:
        return f"{sentence}."
    return f"{sentence}: {named(prims)}."


def named(prims: list[str]) -> str:
    """The first prims by name, the rest as a number."""
    rest = len(prims) - _NAMED
    return ", ".join(prims[:_NAMED]) + (f" and {rest} more" if rest > 0 else "")
