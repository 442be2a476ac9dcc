# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m nightcity.schemas [FOLDER]``: make generatedSchema.usda and plugInfo.json.

Both are made from schema.usda and committed beside it; run this after every change to it.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

from nightcity.schemas import PATH

# usdGenSchema leaves these for a build system; the schemas hold no code, and everything
# that plugInfo.json points at lies beside it.
_PLACEHOLDERS = {
    "@PLUG_INFO_LIBRARY_PATH@": "",
    "@PLUG_INFO_RESOURCE_PATH@": ".",
    "@PLUG_INFO_ROOT@": ".",
}


def generate() -> dict[str, str]:
    """Return the text of each generated file by its name."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "pxr.Usd.usdGenSchema", "-q"]
        done = subprocess.run(
            [*command, str(PATH / "schema.usda"), folder], capture_output=True, text=True
        )
        if done.returncode != 0:
            raise SystemExit(f"usdGenSchema refused schema.usda:\n{done.stdout}{done.stderr}")
        names = ("generatedSchema.usda", "plugInfo.json")
        texts = {name: (Path(folder) / name).read_text(encoding="utf-8") for name in names}
    for placeholder, value in _PLACEHOLDERS.items():
        texts["plugInfo.json"] = texts["plugInfo.json"].replace(placeholder, value)
    return {name: _tidy(text) for name, text in texts.items()}


def _tidy(text: str) -> str:
    """Drop the trailing blanks that usdGenSchema leaves."""
    return "\n".join(line.rstrip() for line in text.rstrip().splitlines()) + "\n"


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else PATH
    for name, text in generate().items():
        new = folder / f".{name}.new"
        new.write_text(text, encoding="utf-8")
        new.replace(folder / name)
        print(folder / name)


if __name__ == "__main__":
    main()
