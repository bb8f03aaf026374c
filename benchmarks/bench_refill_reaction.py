"""The time from `=SM` to the refill beside a bare socket loop, both fed in turn within one process (feed/refill_reaction.cpp)."""
import json
import subprocess

import benchlib

NAME = "refill_reaction"
DESCRIPTION = "from =SM readable to the refill handed to the kernel, beside a bare socket loop"

QUANTILES = ["p50", "p99", "p99.9", "max"]
MOST = {"p50": 1.2, "p99": 1.3}  # of the bare loop
MOST_IN_CI = {"p50": 1.6}  # shared machines; the tail of a short run is chance
ROWS = {
    "reaction_us": "reaction",
    "from_timer_us": "from the timer",
    "wake_up_us": "  of it: wake-up",
    "read_us": "  of it: read",
    "inside_us": "  of it: inside",
    "write_us": "  of it: write",
}


def measure(samples, priority):
    command = [benchlib.BIN / "refill_reaction", "--samples", str(samples)]
    if priority:
        command += ["--priority", str(priority)]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)


def ratio(measured, row, quantile):
    return measured["linefeed"][row][quantile] / measured["bare"][row][quantile]


def table_of(title, measured):
    lines = [f"{title}, {measured['samples']} refills each ({measured['real_time'] or 'no real-time settings'})",
             f"{'µs, linefeed / bare = ratio':20}" + "".join(f"{quantile:>28}" for quantile in QUANTILES)]
    for row, name in ROWS.items():
        cells = [f"{measured['linefeed'][row][quantile]:9.1f} /{measured['bare'][row][quantile]:8.1f} = {ratio(measured, row, quantile):5.2f}"
                 for quantile in QUANTILES]
        lines.append(f"{name:20}" + "".join(f"{cell:>28}" for cell in cells))
    return lines


def run(quick):
    most = MOST_IN_CI if quick else MOST
    runs = {}
    realtime = bool(benchlib.realtime_prefix())
    if not quick or not realtime:
        runs["ordinary threads"] = measure(1000 if quick else 15000, None)
    if realtime:
        runs["SCHED_FIFO"] = measure(1000 if quick else 15000, benchlib.HOST_PRIORITY)
    table = []
    checks = []
    for title, measured in runs.items():
        table += [*table_of(title, measured), ""]
        passed_over = measured["linefeed"]["passed_over"]
        checks.append({"check": f"{title}: no answer was read without its refill being written: {passed_over}", "ok": passed_over == 0})
        for quantile, limit in most.items():
            found = ratio(measured, "reaction_us", quantile)
            checks.append({"check": f"{title}: {quantile} at most {limit} times the bare loop's: {found:.2f}", "ok": found <= limit})
    return {"table": table, "checks": checks, "runs": runs}
