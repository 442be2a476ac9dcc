# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Commands that measure: what a step costs, how right a method is, what a model leaves out."""
