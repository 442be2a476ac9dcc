# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m nightcity``."""

from nightcity.cli import main

raise SystemExit(main())
