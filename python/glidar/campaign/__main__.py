# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""python3 -m glidar.campaign: the same as the program glidar-campaign."""

import sys

from glidar.campaign.cli import main

if __name__ == "__main__":
    sys.exit(main())
