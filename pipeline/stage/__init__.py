# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a city as a USD stage, and checks stages against the schemas."""
