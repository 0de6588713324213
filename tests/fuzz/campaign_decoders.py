# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The readers of a campaign's files, as the fuzzer and the test of its corpora call them."""

import os
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

from glidar import Error
from glidar.campaign import records
from glidar.campaign.spec import read_spec

CORPORA = Path(__file__).parent / "campaign_corpus"
# What a receipt is checked against: two shards of four trials.
DESCRIBED = {"trials": 8, "shards": 2, "shard_trials": 4}


@dataclass(frozen=True)
class Decoder:
    """A reader of one kind of file."""

    file_name: str  # readers go by it
    read: Callable

    def takes(self, folder, data):
        """Writes the bytes to a file in `folder` and reads it: True where the reader takes it, False where it raises
        Error. No other exception is caught: none may come."""
        file = Path(folder) / self.file_name
        file.write_bytes(data)
        try:
            self.read(file)
        except Error:
            return False
        return True


DECODERS = {
    "campaign": Decoder("campaign.yaml", read_spec),
    "campaign_json": Decoder("campaign.json", records.read_campaign),
    "receipt": Decoder("000000.json", lambda file: records.read_receipt(file, DESCRIBED)),
    "manifest": Decoder("manifest.json", records.read_manifest),
}


def scratch_folder():
    """A folder in memory, where there is one."""
    return tempfile.TemporaryDirectory(dir="/dev/shm" if os.access("/dev/shm", os.W_OK) else None)
