# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What can go wrong, by exit code: 2 usage, 3 scene or asset, 4 device or memory."""

from __future__ import annotations


class NightcityError(Exception):
    """A failure with a message for people: what, where (file, prim, field), and the mend."""

    exit_code = 1


class UsageError(NightcityError):
    """The command or a parameter is wrong."""

    exit_code = 2


class SceneError(NightcityError):
    """A file, stage or flat scene is wrong."""

    exit_code = 3


class DeviceError(NightcityError):
    """The device or its memory does not suffice; worth a retry elsewhere."""

    exit_code = 4
