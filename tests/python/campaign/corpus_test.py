# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The files that the fuzzer of campaigns keeps, without a fuzzer."""

import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).resolve().parents[2] / "fuzz"))

from campaign_decoders import CORPORA, DECODERS  # noqa: E402 (found by the line above)

TAKEN = {
    "campaign": {"plain", "rocks", "grid"},
    "campaign_json": {"plain"},
    "receipt": {"plain"},
    "manifest": {"plain"},
}


@pytest.mark.parametrize("name", DECODERS)
def test_a_file_of_the_corpus_is_taken_where_it_is_of_its_kind_and_refused_with_an_error_elsewhere(name, tmp_path):
    files = sorted((CORPORA / name).iterdir())
    taken = {file.name for file in files if DECODERS[name].takes(tmp_path, file.read_bytes())}
    assert taken == TAKEN[name]
    assert len(files) > len(taken), "its corpus has files that are refused"
