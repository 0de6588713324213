#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the wording of every tracked *.md file against a list of discouraged words, each with its replacement.

usage: check_prose.py [--sources] [FILE...]
  FILE       check only these files
  --sources  also check comments and string literals of C++ and Python files
Exit status 1 when a file has discouraged words.
"""

import argparse
import io
import re
import subprocess
import sys
import tokenize
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WORD_LISTS = {"scripts/check_prose.py", "tests/scripts/check_prose_test.py"}  # contain the discouraged words

WORDS = [
    (r"\b(tells?|telling|told)\b", "report, print, write, return, list, specify, distinguish"),
    (r"\b(said|says?)\b", "report, state, specify"),
    (r"\bif not (said|given|told)\b", "by default"),
    (r"\b(stands?|stood)\b", "is"),
    (r"\bstanding still\b", "stationary"),
    (r"\blies\b", "is"),
    (r"\b(go|goes|going|went|gone) with\b", "is for, belongs to, has, omits"),
    (r"\b(go|goes|going|went|gone) on\b", "continue"),
    (r"\b(come|comes|coming|came) (along|out)\b", "bundled; result"),
    (r"\bmatt\b", "diffuse"),
    (r"\bsquare on\b", "at normal incidence"),
    (r"\bhairs?\b", "epsilon, offset"),
    (r"\btwins?\b", "coincident, duplicate"),
    (r"\bwho (is|are|was|were) (slow|late|near|first|last|hit)\b", "a noun: slow subscribers"),
    (r"\bby itself\b", "automatically, alone"),
    (r"\basked for\b", "requested"),
    (r"\bjudge(s|d|ment)?\b", "test, re-test, classify"),
    (r"\bsettle[sd]?\b", "refine, decide, re-test"),
    (r"\bhug(s|ged|ging)?\b", "tight-fitting"),
    (r"\bsight(s|ing|ings)\b", "visible cluster, view"),
    (r"\blamps?\b", "light source, street light"),
    (r"(?<!data )(?<!data-)\bsheets?\b", "data sheet"),
    (r"(?<!ground )(?<!ground-)\btruth\b", "ground truth"),
    (r"(?<!page )(?<!segmentation )\bfaults?\b(?! injection)", "error"),
    (r"\bstor(y|ies)\b", "point trace, explanation"),
    (r"\banew\b", "again"),
    (r"\bbut for\b", "except for"),
    (r"\bin the place of\b", "instead of"),
    (r"\bto the bit\b", "bit for bit, bit-identical"),
    (r"\bto and fro\b", "bidirectional"),
    (r"\bthe way of the (2015|2016|paper)", "the original GLIDAR's method"),
    (r"\bone learns\b", "results show"),
    (r"\b(lay|lays|laid|laying) out\b", "format"),
    (r"\blikewise\b", "name what is the same"),
]
RULES = [(re.compile(pattern, re.IGNORECASE), advice) for pattern, advice in WORDS]
IDENTIFIER = re.compile(r"`[^`]*`|(?<=\")\w+(?=\")|--[\w-]+|\w*_\w+|\b\w+\(\)|\b[\w.-]+\.(?:md|py|cpp|hpp|yaml)\b")
CPP = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<mark>[^()\\\s]{0,16})\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.DOTALL
)


def blank(match):
    """Spaces of the same shape, so that lines keep their numbers."""
    return re.sub(r"[^\n]", " ", match[0])


def without_indented_code(text):
    """The text with the code blocks blanked that are indented by four spaces after an empty line."""
    lines, code = [], True
    for line in text.split("\n"):
        code = line.startswith("    ") and code or not line.strip()
        lines.append("" if code else line)
    return "\n".join(lines)


def markdown_prose(text):
    """A page without code blocks, inline code and targets of links."""
    text = re.sub(r"^(\s*)(```+|~~~+).*?^\s*\2\s*$", blank, text, flags=re.DOTALL | re.MULTILINE)
    text = re.sub(r"(`+)(?:(?!\n\n).)+?\1", blank, without_indented_code(text), flags=re.DOTALL)
    return re.sub(r"\]\([^)]*\)|<!--.*?-->|https?://\S+", blank, text, flags=re.DOTALL)


def cpp_prose(text):
    """Comments and string literals of a C++ file; all else is blank."""
    kept, end = [], 0
    for match in CPP.finditer(text):
        kept += [re.sub(r"[^\n]", " ", text[end : match.start()]), match[0]]
        end = match.end()
    return "".join(kept)


def python_prose(text):
    """Comments and string literals of a Python file; all else is blank."""
    kinds = {tokenize.COMMENT, tokenize.STRING} | {getattr(tokenize, "FSTRING_MIDDLE", tokenize.STRING)}
    lines = [""] * (text.count("\n") + 2)
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type in kinds:
            formatted = re.match(r"[rR]?[fF]", token.string)
            shown = re.sub(r"\{[^{}]*\}", blank, token.string) if formatted else token.string
            for offset, part in enumerate(shown.split("\n")):
                lines[token.start[0] - 1 + offset] += part + " "
    return "\n".join(lines)


PROSE = {".md": markdown_prose, ".cpp": cpp_prose, ".hpp": cpp_prose, ".py": python_prose}


def check_text(path, text):
    """All complaints about a file's wording."""
    prose = IDENTIFIER.sub(blank, PROSE[Path(path).suffix](text))
    return [
        f"{path}:{number}: '{match[0]}'; use: {advice}"
        for number, line in enumerate(prose.split("\n"), 1)
        for rule, advice in RULES
        for match in rule.finditer(line)
    ]


def tracked(suffixes):
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    files = [path for path in listed.split("\0") if Path(path).suffix in suffixes and path not in WORD_LISTS]
    return [path for path in files if (ROOT / path).is_file()]


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", metavar="FILE")
    parser.add_argument("--sources", action="store_true", help="also check comments and strings of C++ and Python")
    return parser.parse_args(arguments)


def main(arguments):
    options = parse(arguments)
    files = options.files or tracked(set(PROSE) if options.sources else {".md"})
    complaints = [one for path in files for one in check_text(path, (ROOT / path).read_text(encoding="utf-8"))]
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
