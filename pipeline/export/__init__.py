# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Reads any stage that carries the schemas and writes the flat scene."""
