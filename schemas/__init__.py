# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The folder of Nightcity's USD schemas, and how to register it.

``PATH`` can be had without USD, for hosts that set ``PXR_PLUGINPATH_NAME`` themselves.
"""

from __future__ import annotations

from pathlib import Path

PATH = Path(__file__).resolve().parent


def register() -> None:
    """Make the schemas known to USD; call it before any stage opens or schema is looked up."""
    from pxr import Plug

    Plug.Registry().RegisterPlugins(str(PATH))
