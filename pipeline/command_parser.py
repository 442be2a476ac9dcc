# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A command line whose commands refuse what they do not know with the name that is near."""

from __future__ import annotations

import argparse
import difflib
from collections.abc import Sequence


class CommandParser(argparse.ArgumentParser):
    """Refuses unknown arguments, unless the command has the default ``passes_options_on``: then
    ``parse_known_args`` returns them."""

    def parse_known_args(
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        options, unknown = super().parse_known_args(args, namespace)
        if unknown and not getattr(options, "passes_options_on", False):
            self.error(f"unknown arguments: {' '.join(unknown)}{self._suggestion(unknown)}")
        return options, unknown

    def _suggestion(self, unknown: Sequence[str]) -> str:
        for name in unknown:
            known = list(self._option_string_actions)
            near = difflib.get_close_matches(name.partition("=")[0], known, n=1)
            if name.startswith("--") and near:
                return f"; did you mean {near[0]}?"
        return ""
