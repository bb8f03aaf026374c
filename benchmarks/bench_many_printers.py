"""Many printers at 500/s each, fed by one process with one feed thread and one store thread (feed_many_main.cpp), as the service does it.

The simulators of all printers are one process as well, on one processor and with precedence where that is permitted; the other processor and
what is left of this one is the host's.
"""
import subprocess
import threading
import time

import benchlib

NAME = "many_printers"
DESCRIPTION = "1, 8, 32 and 64 printers at 500/s each: CPU per printer, misses"
RATE = 500
REPLY_DELAY_MS = 5.0


def run_one(count, seconds, options, directory):
    with benchlib.Hiccups() as hiccups:
        row, report = print_on(count, seconds, options, directory)
    return {"printers": count, **benchlib.judge(report, hiccups.stalls, RATE), **row}


def wait_until_all_print(host, patience_s):
    """The host says so on its standard output."""
    watch = threading.Timer(patience_s, host.kill)
    watch.start()
    line = host.stdout.readline()
    watch.cancel()
    if line.strip() != "printing":
        raise RuntimeError(f"not all printers print: {line or 'the host has ended'}")


def print_on(count, seconds, options, directory):
    printer = benchlib.Printer(directory, RATE, printers=count, reply_delay_ms=REPLY_DELAY_MS)
    spread = 0.15 * count  # they start one after the other
    host = None
    try:
        command = [str(benchlib.BIN / "bench_feed_many"), "--spool", str(directory / f"spool{count}-{len(options)}.db"), "--records",
                   str(int(RATE * (seconds + spread + 5))), *options, *(f"127.0.0.1:{port}" for port in printer.ports)]
        host = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        wait_until_all_print(host, benchlib.SETTLE_S + 3 * spread)
        time.sleep(1)
        before = benchlib.cpu_seconds(host.pid), benchlib.cpu_seconds(printer.process.pid), time.monotonic()
        time.sleep(seconds)
        after = benchlib.cpu_seconds(host.pid), benchlib.cpu_seconds(printer.process.pid), time.monotonic()
        ended = host.poll() is not None
        report = printer.stop()
    finally:
        if host:
            host.kill()
            host.wait()
        printer.kill()
    elapsed = after[2] - before[2]
    return {"printing": sum(one["prints"] > 0 for one in report["printers"]), "ended_early": ended,
            "host_cpu_percent": (after[0] - before[0]) / elapsed * 100,
            "simulator_cpu_percent": (after[1] - before[1]) / elapsed * 100}, report


def run(quick):
    plain, realtime = (), benchlib.linefeed_options()
    if quick:
        cases = [("", realtime, 8)]
    else:
        cases = [("", plain, count) for count in (1, 8, 32, 64)]
        cases += [("real-time", realtime, count) for count in (32, 64)] if realtime else []
    with benchlib.workspace() as directory:
        rows = [{"options": label, **run_one(count, 3 if quick else 30, options, directory)} for label, options, count in cases]
    table = [f"one process feeds all; {RATE}/s each, answers after {REPLY_DELAY_MS:g} ms; {benchlib.CORES} processors shared with the simulators",
             f"{'printers':>8} {'feed thread':12}{'printing':>9}{'n':>9}{'avoidable':>11}{'platform':>10}{'min lead ms':>13}{'p50 ms':>8}{'CPU/printer':>13}"
             f"{'CPU host':>10}{'CPU sims':>10}{'late PrintGos':>15}"]
    for row in rows:
        table.append(f"{row['printers']:8} {row['options'] or 'ordinary':12}{row['printing']:9}{row['n']:9}{row['avoidable']:11}{row['platform']:10}"
                     f"{benchlib.ms(row['lead_ms']['min']):>13}{benchlib.ms(row['lead_ms']['p50']):>8}"
                     f"{row['host_cpu_percent'] / row['printers']:12.2f}%{row['host_cpu_percent']:9.0f}%{row['simulator_cpu_percent']:9.0f}%"
                     f"{row['late_print_gos']:15}")
    table.append("CPU in percent of one processor; lead times are the worst printer's; late PrintGos: given more than 1 ms late by the simulator")
    checks = [{"check": f"no avoidable miss with {row['printers']} printers, {row['options'] or 'ordinary'} feed thread",
               "ok": row["avoidable"] == 0 and row["printing"] == row["printers"]} for row in rows if row["printers"] <= 32]
    return {"rows": rows, "table": table, "checks": checks}
