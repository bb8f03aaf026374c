#!/usr/bin/env python3
"""Import into the spool, with validation and full durability, beside `sqlite3 .import` of the same file, alternating in one run.

usage: benchmarks/import_benchmark.py [--records N] [--rounds N] [--bin DIR] [-o json]

Prints rows per second and peak memory of each, and the ratio of the best rounds: the machines are shared and noisy, so only figures
of one run compare.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent


def measure(command, **options):
    """Seconds and peak resident memory (KiB) of one command."""
    begun = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, **options)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"import_benchmark: {command[0]} ended with exit code {process.returncode}")
    return time.monotonic() - begun, usage.ru_maxrss


def make_file(path, records):
    """One column of 30 bytes."""
    with open(path, "w", encoding="ascii") as file:
        file.write("serial\n")
        for number in range(1, records + 1):
            file.write(f"SN-{number:010d}-ABCDEFGHIJKLMNOP\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--records", type=int, default=1_000_000)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--bin", default=str(ROOT / "build/release/bin"))
    parser.add_argument("-o", "--output", choices=["text", "json"], default="text")
    arguments = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory(dir=ROOT / "build") as directory:
        source = pathlib.Path(directory) / "records.csv"
        make_file(source, arguments.records)
        for round_number in range(arguments.rounds):
            database = pathlib.Path(directory) / f"import{round_number}.db"
            commands = {
                # --dry-run imports completely, durably, into a spool of its own, and prints nothing
                "linefeed": [f"{arguments.bin}/linefeed", "print", str(source), "--dry-run"],
                "sqlite3 .import": ["sqlite3", str(database), "PRAGMA journal_mode=WAL", "PRAGMA synchronous=FULL",
                                    ".mode csv", f".import {source} records"],
            }
            for name, command in commands.items():
                seconds, peak_kib = measure(command, env={**os.environ, "TMPDIR": directory})
                rows.append({"round": round_number + 1, "program": name, "rows_per_s": arguments.records / seconds,
                             "seconds": seconds, "peak_mib": peak_kib / 1024})
            database.unlink()
    best = {name: max(row["rows_per_s"] for row in rows if row["program"] == name) for name in ("linefeed", "sqlite3 .import")}
    ratio = best["linefeed"] / best["sqlite3 .import"]
    if arguments.output == "json":
        print(json.dumps({"records": arguments.records, "rounds": rows, "ratio_of_best": ratio}, indent=2))
        return
    print(f"{arguments.records} records of 30 bytes")
    for row in rows:
        print(f"round {row['round']}  {row['program']:16}  {row['rows_per_s']:12.0f} rows/s  {row['seconds']:7.2f} s  "
              f"peak {row['peak_mib']:6.1f} MiB")
    print(f"linefeed / sqlite3 .import, best rounds: {ratio:.2f}")


if __name__ == "__main__":
    main()
