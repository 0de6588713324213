# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What the pages that need packages from PyPI show works; the other pages: tests/docs_test.py."""

import pytest
from doc_blocks import link_inputs, run_page

NAME = "tests/python/pages_test.py"


@pytest.mark.parametrize("page", ["docs/tutorial/3-data-set.md", "docs/cookbook.md"])
def test_the_blocks_of_a_page_run(page, tmp_path):
    link_inputs(tmp_path)
    run_page(page, NAME, tmp_path)
