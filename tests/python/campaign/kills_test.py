# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A campaign that is killed at random calls never has a receipt of an incomplete file, and resumes."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from faults import NO_LIBRARY, library
from waiting import MAX_WAIT_S

SCRIPT = Path(__file__).resolve().parents[3] / "scripts" / "kill_campaign.py"
pytestmark = pytest.mark.skipif(not library(), reason=NO_LIBRARY)


@pytest.mark.parametrize("more", [["--kills", "20"], ["--kills", "5", "--workers", "2", "--no-durable"]], ids=["one", "two"])
def test_killed_campaigns_have_valid_receipts_and_finish_with_identical_bytes(tmp_path, more):
    done = subprocess.run([sys.executable, "-B", str(SCRIPT), "--seed", "3", *more], cwd=tmp_path, capture_output=True,
                          text=True, timeout=MAX_WAIT_S, check=False, env=dict(os.environ, TMPDIR=str(tmp_path)))
    assert done.returncode == 0, done.stdout + done.stderr
    printed = re.search(rf"{more[1]} kills \(.*\); (\d+) receipts checked; (\d+) campaigns completed; 0 errors", done.stdout)
    assert printed and int(printed[1]) > 0 and int(printed[2]) > 0, done.stdout
    assert not list(tmp_path.iterdir())
