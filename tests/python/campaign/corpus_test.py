# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The corpus of the campaign fuzzer, checked without a fuzzer."""

import sys
import zipfile
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).resolve().parents[2] / "fuzz"))

from campaign_decoders import CORPORA, DECODERS  # noqa: E402 (needs the path set above)

TAKEN = {
    "campaign": {"plain", "rocks", "grid"},
    "campaign_json": {"plain"},
    "receipt": {"plain"},
    "manifest": {"plain"},
}


@pytest.mark.parametrize("name", DECODERS)
def test_corpus_files_are_accepted_by_their_own_decoder_and_rejected_by_others(name, tmp_path):
    files = list(zipfile.Path(CORPORA / f"{name}.zip").iterdir())
    taken = {file.name for file in files if DECODERS[name].takes(tmp_path, file.read_bytes())}
    assert taken == TAKEN[name]
    assert len(files) > len(taken), "its corpus has files that are refused"
