# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
import pytest
from campaign_support import Campaign


@pytest.fixture
def campaign(tmp_path):
    return Campaign(tmp_path)
