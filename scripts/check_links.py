#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the relative links of every tracked *.md file: the file exists, and so does the heading of the anchor.
Also checks that every docs/*.md page that any other tracked text file mentions exists.

usage: check_links.py; exit status 1 when a link is broken.
"""

import re
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).resolve().parent.parent
LINK = re.compile(r"\]\(\s*<?([^)<>\s]+)>?(?:\s+\"[^\"]*\")?\s*\)")
EXTERNAL = re.compile(r"[a-z][a-z0-9+.-]*:", re.IGNORECASE)
HEADING = re.compile(r"#{1,6}\s+(.*?)\s*#*\s*")
MENTION = re.compile(r"(?<![\w/.-])docs/[\w/.-]*?\w\.md\b")
FOREIGN = {"docs/bop_datasets_format.md", "docs/GaussianNoise.md"}  # pages of other projects


def visible_lines(text):
    """(number, line) of every line that is not in a fenced code block."""
    fence = ""
    for number, line in enumerate(text.splitlines(), 1):
        mark = re.match(r"\s*(```+|~~~+)", line)
        if mark and not fence:
            fence = mark[1]
        elif mark and line.strip().startswith(fence):
            fence = ""
        elif not fence:
            yield number, line


def slug(heading):
    """The anchor that GitHub generates for a heading."""
    shown = re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", heading)
    kept = re.sub(r"[^\w\- ]", "", shown.lower().replace("`", ""))
    return kept.replace(" ", "-")


def anchors(text):
    """All anchors of a page; repeated headings get -1, -2, ..."""
    found, counts = set(), {}
    for _, line in visible_lines(text):
        heading = HEADING.fullmatch(line)
        if not heading:
            continue
        name = slug(heading[1])
        count = counts.get(name, 0)
        counts[name] = count + 1
        found.add(f"{name}-{count}" if count else name)
    return found


def check_link(root, page, target):
    """What is wrong with a link of a page, or an empty text."""
    path, _, anchor = unquote(target).partition("#")
    file = (root / page).parent / path if path else root / page
    if not file.exists():
        return f"no such file: {target}"
    if anchor and file.suffix == ".md" and anchor not in anchors(file.read_text(encoding="utf-8")):
        return f"no heading for the anchor: {target}"
    return ""


def check_page(root, page):
    """All complaints about the links of a page."""
    complaints = []
    for number, line in visible_lines((root / page).read_text(encoding="utf-8")):
        for target in LINK.findall(re.sub(r"(`+).+?\1", "", line)):
            problem = "" if EXTERNAL.match(target) else check_link(root, page, target)
            if problem:
                complaints.append(f"{page}:{number}: {problem}")
    return complaints


def check_mentions(root, path, text):
    """All complaints about pages that a file names outside links."""
    return [
        f"{path}:{number}: no such page: {page}"
        for number, line in enumerate(text.splitlines(), 1)
        for page in MENTION.findall(line)
        if page not in FOREIGN and not (root / page).exists()
    ]


def check_file(root, path):
    try:
        text = (root / path).read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return []  # not a text file
    complaints = check_mentions(root, path, text)
    return complaints + check_page(root, path) if path.endswith(".md") else complaints


def main():
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    complaints = []
    for path in filter(None, listed.split("\0")):
        if (ROOT / path).is_file():
            complaints += check_file(ROOT, path)
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
