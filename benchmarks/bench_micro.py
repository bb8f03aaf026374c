#!/usr/bin/env python3
"""The parts of the refill path one by one: time by google-benchmark, and instructions by callgrind, which hardly vary between runs.

As a program: `bench_micro.py --store` writes the instructions of this build to instructions.json, with which run() compares.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import benchlib

NAME = "micro"
DESCRIPTION = "codec, feeder and session: time and instructions of each part"

STORED = pathlib.Path(__file__).resolve().with_name("instructions.json")
TOLERANCE = 1.1
REPEATS = 500


def count_instructions():
    """Instructions of each part's step, of the release preset with g++."""
    with tempfile.TemporaryDirectory() as directory:
        profile = pathlib.Path(directory) / "profile"
        subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={profile}", benchlib.BIN / "micro_benchmark", "--repeat",
                        str(REPEATS)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        annotated = subprocess.run(["callgrind_annotate", "--inclusive=yes", "--threshold=100", profile], check=True,
                                   stdout=subprocess.PIPE, text=True).stdout
    found = {}
    for match in re.finditer(r"^\s*([\d,]+) .*\brepeat<\(anonymous namespace\)::(\w+)>", annotated, re.MULTILINE):
        instructions = round(int(match.group(1).replace(",", "")) / REPEATS)
        found[match.group(2)] = max(instructions, found.get(match.group(2), 0))
    return found


def measure_times():
    """Nanoseconds of processor time."""
    output = subprocess.run([benchlib.BIN / "micro_benchmark", "--benchmark_format=json", "--benchmark_min_time=1"], check=True,
                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    return {result["name"]: result["cpu_time"] for result in json.loads(output)["benchmarks"]}


def run(quick):
    stored = json.loads(STORED.read_text(encoding="utf-8"))
    instructions = count_instructions()
    times = {} if quick else measure_times()
    table = [f"{'part':20}{'instructions':>14}{'stored':>10}{'ratio':>8}{'ns':>10}"]
    checks = []
    for part, before in stored.items():
        now = instructions.get(part)
        if now is None:
            checks.append({"check": f"{part} is measured", "ok": False})
            continue
        table.append(f"{part:20}{now:14}{before:10}{now / before:8.2f}" + (f"{times[part]:10.1f}" if part in times else ""))
        checks.append({"check": f"{part}: at most {TOLERANCE} times the stored instructions", "ok": now <= before * TOLERANCE})
    return {"table": table, "checks": checks, "instructions": instructions, "times_ns": times}


if __name__ == "__main__":
    if sys.argv[1:] != ["--store"]:
        sys.exit(__doc__)
    STORED.write_text(json.dumps(count_instructions(), indent=1) + "\n", encoding="utf-8")
    print(STORED.read_text(encoding="utf-8"), end="")
