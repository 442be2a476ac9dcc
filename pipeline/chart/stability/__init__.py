# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Where methods break: sweeps through tiny scenes whose glow is known, as tests and as pictures."""
