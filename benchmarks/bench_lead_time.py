"""How long before its PrintGo each record lay in the printer, under loads, against the 3 ms that the printer needs.

The printer is a process of its own, pinned to one processor and with precedence where that is permitted; it gives PrintGos on an absolute
grid and counts a product whose record was not there in time as a miss, instead of stopping. Two controls run with the same printer: the
known-bad host, which must miss, and the manual's own procedure.

Environment: LINEFEED_BENCH_PRINTS, PrintGos with all loads on (1000000, which takes 17 minutes); LINEFEED_BENCH_SECONDS, length of the
other runs (60; 0 = none but the known-bad host); LINEFEED_BENCH_OPTIONS, options for `linefeed print`.
"""
import os
import sys

import benchlib

NAME = "lead_time"
DESCRIPTION = "Lead time against the 3 ms deadline, under loads"
RATE = 1000
REPLY_DELAY_MS = 5.0  # of every answer; real ones take some ms, and the known-bad host must miss


def run_one(host, load, seconds, directory):
    records = int(RATE * seconds)
    with benchlib.load(load, directory), benchlib.Hiccups() as hiccups:
        with benchlib.line(host, directory, RATE, records, reply_delay_ms=REPLY_DELAY_MS) as (printer, process):
            code = benchlib.end(process, seconds + 5)
            report = printer.stop()
    return {"load": load, **benchlib.judge(report, hiccups.stalls, RATE), "exit_code": code, "realtime_printer": printer.realtime}


def plan(quick):
    """(label, host, load, seconds)"""
    plain, realtime = benchlib.linefeed_options(realtime=False), benchlib.linefeed_options()
    if quick:
        return [("linefeed", plain, "all", 8), ("known-bad", "single", "none", 3)]
    seconds = float(os.environ.get("LINEFEED_BENCH_SECONDS", "60"))
    long_run = float(os.environ.get("LINEFEED_BENCH_PRINTS", "1000000")) / RATE
    if seconds == 0:
        return [("linefeed", plain, "all", long_run), ("known-bad", "single", "none", 10)]
    control = min(seconds, 10)
    runs = [("linefeed", plain, load, long_run if load == "all" else seconds) for load in benchlib.LOADS]
    if realtime != plain:
        runs.append(("linefeed, real-time", realtime, "all", seconds))
    runs += [("bare loop", "bare", "all", seconds), ("known-bad", "single", "none", control), ("manual", "manual", "none", control)]
    return runs


def run(quick):
    rows = []
    with benchlib.workspace() as directory:
        for label, host, load, seconds in plan(quick):
            rows.append({"host": label, **run_one(host, load, seconds, directory)})
            print(f"  {label}, {load}: {rows[-1]['avoidable']} avoidable of {rows[-1]['n']}", file=sys.stderr, flush=True)
    table = [f"{RATE} PrintGos/s, FIFO of {benchlib.DEPTH}, each answer after {REPLY_DELAY_MS:g} ms; the printer "
             f"{'has precedence (SCHED_FIFO)' if rows[0]['realtime_printer'] else 'has no precedence: SCHED_FIFO is not permitted'}",
             f"{'host':20}{'load':10}{'n':>9}{'avoidable':>11}{'platform':>10}   lead time ms: {'min':>7}{'p0.001':>8}{'p0.1':>8}{'p50':>8}"
             f"{'stalls':>8}{'longest ms':>12}"]
    for row in rows:
        lead = row["lead_ms"]
        table.append(f"{row['host']:20}{row['load']:10}{row['n']:9}{row['avoidable']:11}{row['platform']:10}{'':17}{benchlib.ms(lead['min']):>7}"
                     f"{benchlib.ms(lead['p0.001']):>8}{benchlib.ms(lead['p0.1']):>8}{benchlib.ms(lead['p50']):>8}{row['stalls']:8}"
                     f"{row['longest_stall_ms']:12.1f}")
    table.append("misses: avoidable, or the platform's; lead times are those of the records printed behind the first fill, so at least 3 ms")
    ours = [row for row in rows if row["host"].startswith("linefeed")]
    bad = next(row for row in rows if row["host"] == "known-bad")
    checks = [{"check": "the known-bad host misses", "ok": bad["avoidable"] > 0},
              {"check": "linefeed has no avoidable miss", "ok": all(row["avoidable"] == 0 for row in ours)},
              {"check": "linefeed prints every number once", "ok": all(row["wrong_numbers"] == 0 for row in ours)}]
    return {"rows": rows, "table": table, "checks": checks}
