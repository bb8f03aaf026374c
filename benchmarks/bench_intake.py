"""Import into the spool, with validation and full durability, beside `sqlite3 .import` of the same file, alternating in one run; and the peak
memory of the import at growing sizes.

LINEFEED_BENCH_LARGE=1 adds 50 million rows to the memory table: that takes some 6 GB of disk.
"""
import os
import statistics
import subprocess
import time

import benchlib

NAME = "intake"
DESCRIPTION = "rows per second beside sqlite3 .import of the same file, and peak memory"
ROWS = 1_000_000
MEMORY_MIB = 64
RATIO = 2.0  # what intake must reach
QUICK_RATIO = 1.3  # what the slice for CI asks for: both wait for the disk, and the more others write, the closer they come (1.6 has been seen)


def measure(command, directory):
    """Seconds and peak resident memory (MiB) of one command."""
    begun = time.monotonic()
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               env={**os.environ, "TMPDIR": str(directory)})
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise RuntimeError(f"{command[0]} ended with exit code {process.returncode}")
    return time.monotonic() - begun, usage.ru_maxrss / 1024


def import_by_linefeed(source, directory):
    # --dry-run imports completely, durably, into a spool of its own, and prints nothing
    return measure([str(benchlib.BIN / "linefeed"), "print", str(source), "--dry-run"], directory)


def import_by_sqlite(source, directory):
    database = directory / "import.db"
    result = measure(["sqlite3", str(database), "PRAGMA journal_mode=WAL", "PRAGMA synchronous=FULL", ".mode csv",
                      f".import {source} records"], directory)
    for file in directory.glob("import.db*"):
        file.unlink()
    return result


def compare(rows, rounds, directory):
    """What each program needed in each round."""
    source = directory / "compared.csv"
    benchlib.write_csv(source, rows)
    seen = []
    for number in range(1, rounds + 1):
        for program, run_it in (("linefeed", import_by_linefeed), ("sqlite3 .import", import_by_sqlite)):
            seconds, peak_mib = run_it(source, directory)
            seen.append({"round": number, "program": program, "seconds": seconds, "rows_per_s": rows / seconds, "peak_mib": peak_mib})
    source.unlink()
    return seen


def peak_memory(rows, directory):
    source = directory / "large.csv"
    benchlib.write_csv(source, rows)
    seconds, peak_mib = import_by_linefeed(source, directory)
    source.unlink()
    return {"rows": rows, "seconds": seconds, "rows_per_s": rows / seconds, "peak_mib": peak_mib}


def median_ratio(seen):
    """Of the rounds; the two programs of a round ran one after the other."""
    pairs = zip(*([one["rows_per_s"] for one in seen if one["program"] == name] for name in ("linefeed", "sqlite3 .import")))
    return statistics.median(ours / theirs for ours, theirs in pairs)


def run(quick):
    rows, rounds = ROWS, 3 if quick else 5
    sizes = [] if quick else [1_000_000, 10_000_000]
    if os.environ.get("LINEFEED_BENCH_LARGE") and not quick:
        sizes.append(50_000_000)
    with benchlib.workspace() as directory:
        seen = compare(rows, rounds, directory)
        memory = [peak_memory(size, directory) for size in sizes]
    ratio = median_ratio(seen)
    table = [f"{rows} rows of 30 bytes, validated and durable", f"{'round':>5} {'program':16}{'rows/s':>12}{'seconds':>10}{'peak MiB':>10}"]
    table += [f"{one['round']:5} {one['program']:16}{one['rows_per_s']:12.0f}{one['seconds']:10.2f}{one['peak_mib']:10.1f}" for one in seen]
    table.append(f"linefeed / sqlite3 .import, median of the rounds: {ratio:.2f}")
    if memory:
        table += ["", f"{'rows':>10}{'rows/s':>12}{'seconds':>10}{'peak MiB':>10}"]
    table += [f"{one['rows']:10}{one['rows_per_s']:12.0f}{one['seconds']:10.2f}{one['peak_mib']:10.1f}" for one in memory]
    least = QUICK_RATIO if quick else RATIO
    checks = [{"check": f"intake is at least {least:g} times as fast as sqlite3 .import", "ok": ratio >= least}]
    if memory:
        checks.append({"check": f"peak memory below {MEMORY_MIB} MiB at any size", "ok": all(one["peak_mib"] < MEMORY_MIB for one in memory)})
    return {"rounds": seen, "ratio": ratio, "memory": memory, "table": table, "checks": checks}
