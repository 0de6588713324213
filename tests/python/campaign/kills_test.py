# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A campaign that is killed at random calls never has a receipt of an incomplete file, and resumes."""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from campaign_support import memory_folder
from faults import NO_LIBRARY, library
from waiting import MAX_WAIT_S

SCRIPT = Path(__file__).resolve().parents[3] / "scripts" / "kill_campaign.py"
pytestmark = pytest.mark.skipif(not library(), reason=NO_LIBRARY)


@pytest.mark.parametrize("more", [["--kills", "20"], ["--kills", "5", "--workers", "2", "--no-durable"]], ids=["one", "two"])
def test_killed_campaigns_have_valid_receipts_and_finish_with_identical_bytes(more):
    with tempfile.TemporaryDirectory(dir=memory_folder()) as folder:
        done = subprocess.run([sys.executable, "-B", str(SCRIPT), "--seed", "3", *more], cwd=folder, capture_output=True,
                              text=True, timeout=MAX_WAIT_S, check=False, env=dict(os.environ, TMPDIR=folder))
        # a killed process may leave the file with which tempfile tries a folder
        assert not list(Path(folder).glob("glidar-kills-*")) or done.returncode != 0
    assert done.returncode == 0, done.stdout + done.stderr
    printed = re.search(rf"{more[1]} kills \(.*\); (\d+) receipts checked; (\d+) campaigns completed; 0 errors", done.stdout)
    assert printed and int(printed[1]) > 0 and int(printed[2]) > 0, done.stdout
