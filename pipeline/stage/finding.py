# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What validation says about one place of a stage."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from pxr import Tf, Usd


@dataclass(frozen=True)
class Finding:
    """severity: an error keeps the stage from being exported as meant, a warning may be meant.

    prim: its path, or "" where the stage as a whole is meant. attribute: its name, or "".
    message: what is wrong, and the mend.
    """

    severity: Literal["error", "warning"]
    prim: str
    attribute: str
    message: str

    def __str__(self) -> str:
        where = ".".join(filter(None, [self.prim, self.attribute])) or "the stage"
        return f"{self.severity}: {where}: {self.message}"


def error(prim: Usd.Prim, attribute: str, message: str) -> Finding:
    return Finding("error", str(prim.GetPath()), attribute, message)


def warning(prim: Usd.Prim, attribute: str, message: str) -> Finding:
    return Finding("warning", str(prim.GetPath()), attribute, message)


def first_line(problem: Tf.ErrorException) -> str:
    """What USD says went wrong, without where in its source."""
    parts = [str(part.commentary) for part in problem.args if hasattr(part, "commentary")]
    return (parts or [str(problem).strip()])[0]
