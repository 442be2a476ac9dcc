# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Files that appear under their name only when they are whole."""

from __future__ import annotations

import contextlib
import fcntl
import os
from collections.abc import Iterator
from pathlib import Path


@contextlib.contextmanager
def whole_file(target: Path) -> Iterator[Path]:
    """A hidden, empty file in the target's folder, to be written in the ``with`` block.

    It becomes the target where the block ends well and is removed where it raises. Its name is
    ``.NAME.PID.part``, and a lock on it says that its writer lives: what killed writers of the
    same target left is removed. The renderer keeps the same rules (renderer/output/whole_file.h).
    """
    with whole_files(target) as (pending,):
        yield pending


@contextlib.contextmanager
def whole_files(*targets: Path) -> Iterator[list[Path]]:
    """As `whole_file`, for files that belong together. The last one says that the others are
    there: it goes away before they change, and comes when they have."""
    pending = [t.with_name(f".{t.name}.{os.getpid()}.part") for t in targets]
    files: list[int] = []
    try:
        for target, path in zip(targets, pending, strict=True):
            target.parent.mkdir(parents=True, exist_ok=True)
            _remove_abandoned(target)
            files.append(_open_locked(path))
        yield pending
        for file in files:
            os.fsync(file)
        if len(targets) > 1:
            targets[-1].unlink(missing_ok=True)
        for target, path in zip(targets, pending, strict=True):
            os.replace(path, target)
    finally:
        for path, file in zip(pending, files, strict=False):
            path.unlink(missing_ok=True)
            os.close(file)


def _open_locked(pending: Path) -> int:
    while True:
        file = os.open(pending, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, 0o666)
        fcntl.flock(file, fcntl.LOCK_EX)
        if os.fstat(file).st_nlink > 0:
            return file
        os.close(file)  # removed by another writer before it was locked


def _remove_abandoned(target: Path) -> None:
    prefix = f".{target.name}."
    for path in target.parent.iterdir():
        if not (path.name.startswith(prefix) and path.name.endswith(".part")):
            continue
        with contextlib.suppress(OSError):
            file = os.open(path, os.O_WRONLY | os.O_CLOEXEC)
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                path.unlink(missing_ok=True)
            finally:
                os.close(file)
