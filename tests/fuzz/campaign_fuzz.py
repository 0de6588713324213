# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""libFuzzer for the readers of a campaign's files, which are written in Python: `./dev fuzz`.

usage: campaign_fuzz.py DECODER [OPTIONS AND CORPORA OF LIBFUZZER...]
"""

import sys

import atheris

with atheris.instrument_imports(include=["glidar.campaign"]):
    import campaign_decoders


def main():
    decoder = campaign_decoders.DECODERS[sys.argv.pop(1)]
    with campaign_decoders.scratch_folder() as folder:
        atheris.Setup(sys.argv, lambda data: decoder.takes(folder, data) and None)
        atheris.Fuzz()


if __name__ == "__main__":
    main()
