# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The code of pages that need packages from PyPI works. For the other pages see tests/docs_test.py."""

import pytest
from doc_blocks import link_inputs, run_page

NAME = "tests/python/pages_test.py"
PAGES = ["docs/tutorial/3-data-set.md", "docs/tutorial/5-survey.md", "docs/cookbook.md", "docs/boxes.md", "docs/doppler.md",
         "docs/stereo.md", "docs/time-of-flight.md", "docs/depth-filters.md", "docs/structured-light.md", "docs/files/kitti.md",
         "docs/files/nuscenes.md", "docs/files/parts.md"]


@pytest.mark.parametrize("page", PAGES)
def test_the_code_blocks_of_a_page_run(page, tmp_path):
    link_inputs(tmp_path)
    run_page(page, NAME, tmp_path)
