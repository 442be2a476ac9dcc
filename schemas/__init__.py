# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The folder of Nightcity's USD schemas, and how to register it.

``PATH`` can be had without USD, for hosts that set ``PXR_PLUGINPATH_NAME`` themselves.
"""

from __future__ import annotations

from pathlib import Path

from nightcity.errors import SceneError

PATH = Path(__file__).resolve().parent
NAMES = (
    "NightcityCityAPI",
    "NightcityDistrictAPI",
    "NightcityBuildingAPI",
    "NightcityGroundAPI",
    "NightcityWindowsAPI",
    "NightcityMediaAPI",
)


def register() -> None:
    """Make the schemas known to USD; call it before any stage opens or schema is looked up.

    Does nothing where ``PXR_PLUGINPATH_NAME`` has brought them already. Raises SceneError where
    USD has read its schemas before, because it never reads them again.
    """
    from pxr import Plug, Usd

    plugins = Plug.Registry()
    if plugins.GetPluginWithName("nightcity") is None:
        plugins.RegisterPlugins(str(PATH))
    known = Usd.SchemaRegistry()
    missing = [name for name in NAMES if known.FindAppliedAPIPrimDefinition(name) is None]
    if missing:
        raise SceneError(
            f"USD does not know the schemas {', '.join(missing)}: call nightcity.schemas.register()"
            f" before any stage is opened, or set PXR_PLUGINPATH_NAME={PATH} before Python starts"
        )
