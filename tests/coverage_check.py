#!/usr/bin/env python3
"""The strict rule of tests/coverage.sh: every line and every branch of a group is executed by its unit tests, or listed.

usage: coverage_check.py --report GCOVR.json --exceptions FILE --root DIR --group NAME PATTERN… [--group …]

PATTERN is a regular expression over paths below the root; together they name the files of the group. A line of the exceptions is

    file pattern : fragment of the source line | reason

with the file as in fnmatch, e.g. `src/spool/*`. Blank lines and lines that begin with # are left out. A source line that is not
executed, or one of whose branches is never taken, must be matched by an entry; an entry that matches no such
line of any group is an error too, so that the list stays as short as the truth. gcovr must have left out the branches for exceptions.
"""

import argparse
import fnmatch
import json
import pathlib
import re
import sys
from dataclasses import dataclass


@dataclass
class Entry:
    number: int
    files: str
    fragment: str
    used: bool = False

    def matches(self, path, text):
        return fnmatch.fnmatch(path, self.files) and self.fragment in text


def read_entries(path):
    entries = []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        place, separator, reason = line.rpartition(" | ")
        files, colon, fragment = place.partition(" : ")
        if not (separator and reason.strip() and colon and files.strip() and fragment.strip()):
            raise SystemExit(f"{path}:{number}: not `file : fragment | reason`: {line}")
        entries.append(Entry(number, files.strip(), fragment.strip()))
    return entries


def shortcomings(report):
    """(line number, what is missing) of one file, and how many branches there are and are taken."""
    lines, branches, taken = [], 0, 0
    for line in report["lines"]:
        if line.get("gcovr/noncode"):
            continue
        counts = [branch["count"] for branch in line["branches"]]
        branches += len(counts)
        taken += sum(count > 0 for count in counts)
        if line["count"] == 0:
            lines.append((line["line_number"], "never executed"))
        elif 0 in counts:
            lines.append((line["line_number"], f"{counts.count(0)} of {len(counts)} branches never taken"))
    return lines, branches, taken


def check_group(name, patterns, files, entries, root):
    """Prints the figures of one group, marks the entries it uses, and returns what is wrong."""
    patterns = [re.compile(pattern) for pattern in patterns]
    group = sorted(path for path in files if any(pattern.fullmatch(path) for pattern in patterns))
    problems = [f"{name}: no file is like {p.pattern}" for p in patterns if not any(p.fullmatch(path) for path in group)]
    all_branches = all_taken = listed = 0
    for path in group:
        source = (root / path).read_text().splitlines()
        lines, branches, taken = shortcomings(files[path])
        all_branches += branches
        all_taken += taken
        for number, missing in lines:
            text = source[number - 1]
            matching = [entry for entry in entries if entry.matches(path, text)]
            for entry in matching:
                entry.used = True
            listed += bool(matching)
            if not matching:
                problems.append(f"{path}:{number}: {missing}: {text.strip()}")
    print(f"{name}: {len(group)} files, {all_taken} of {all_branches} branches taken, {listed} lines are listed exceptions, "
          f"{len(problems)} problems")
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--report", type=pathlib.Path, required=True)
    parser.add_argument("--exceptions", type=pathlib.Path, required=True)
    parser.add_argument("--root", type=pathlib.Path, required=True)
    parser.add_argument("--group", nargs="+", action="append", required=True, metavar=("NAME", "PATTERN"))
    options = parser.parse_args()

    entries = read_entries(options.exceptions)
    files = {file["file"]: file for file in json.loads(options.report.read_text())["files"]}
    problems = []
    for name, *patterns in options.group:
        problems += check_group(name, patterns, files, entries, options.root)
    problems += [f"{options.exceptions}:{entry.number}: matches nothing that is missing (any more): {entry.fragment}"
                 for entry in entries if not entry.used]
    for problem in problems:
        print(problem, file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
