# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Monte Carlo campaigns: many trials, sampled from distributions and measured into a data set.

    glidar campaign run campaign.yaml -o folder

or, from Python:

    from glidar.campaign.run import run

    if __name__ == "__main__":  # worker processes import this file
        run("campaign.yaml", "folder")

See docs/campaigns.md. Requires the package's optional dependencies: pip install '.[campaign]' in GLIDAR's source.
"""
