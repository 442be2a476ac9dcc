# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Nightcity's pipeline: parameters or a real town -> city -> USD stage -> flat scene -> charts."""

__version__ = "0.1.0"
