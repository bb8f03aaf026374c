"""Many printers at 500/s each. Until there is a service that feeds them all from one process, each printer has a `linefeed print` of its own:
the figures are those of many processes, and the table says so.
"""
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


def print_on(count, seconds, options, directory):
    printer = benchlib.Printer(directory, RATE, printers=count, reply_delay_ms=REPLY_DELAY_MS)
    # They start one after the other, as lines do, so that it is the printing that is measured and not the starting.
    spread = 0.15 * count
    processes = []
    try:
        for place, port in enumerate(printer.ports):
            processes.append(benchlib.linefeed_host(directory, port, int(RATE * (seconds + spread + 2)), options))
            time.sleep(spread / count)
            if place == 0:
                printer.wait_for_prints()
        time.sleep(1)
        pids = [process.pid for process in processes]
        before = sum(map(benchlib.cpu_seconds, pids)), benchlib.cpu_seconds(printer.process.pid), time.monotonic()
        time.sleep(seconds)
        after = sum(map(benchlib.cpu_seconds, pids)), benchlib.cpu_seconds(printer.process.pid), time.monotonic()
        ended = sum(process.poll() is not None for process in processes)
        report = printer.stop()
    finally:
        for process in processes:
            process.kill()
            process.wait()
        printer.kill()
    elapsed = after[2] - before[2]
    return {"printing": sum(one["prints"] > 0 for one in report["printers"]), "ended_early": ended,
            "host_cpu_percent": (after[0] - before[0]) / elapsed * 100,
            "simulator_cpu_percent": (after[1] - before[1]) / elapsed * 100}, report


def run(quick):
    options = benchlib.linefeed_options(realtime=False)
    with benchlib.workspace() as directory:
        rows = [run_one(count, 3 if quick else 15, options, directory) for count in ((1, 8) if quick else (1, 8, 32, 64))]
    table = [f"one `linefeed print` process for each printer (there is no service yet); {RATE}/s each, answers after {REPLY_DELAY_MS:g} ms; "
             f"{benchlib.CORES} processors shared with the simulators",
             f"{'printers':>8}{'printing':>10}{'n':>9}{'avoidable':>11}{'platform':>10}{'min lead ms':>13}{'p50 ms':>8}{'CPU/printer':>13}{'CPU hosts':>11}"
             f"{'CPU sims':>10}{'late PrintGos':>15}"]
    for row in rows:
        table.append(f"{row['printers']:8}{row['printing']:10}{row['n']:9}{row['avoidable']:11}{row['platform']:10}"
                     f"{benchlib.ms(row['lead_ms']['min']):>13}{benchlib.ms(row['lead_ms']['p50']):>8}"
                     f"{row['host_cpu_percent'] / row['printers']:12.2f}%{row['host_cpu_percent']:10.0f}%{row['simulator_cpu_percent']:9.0f}%"
                     f"{row['late_print_gos']:15}")
    table.append("CPU in percent of one processor; lead times are the worst printer's; late PrintGos: given more than 1 ms late by the simulator")
    checks = [{"check": f"no avoidable miss with {row['printers']} printers", "ok": row["avoidable"] == 0} for row in rows if row["printers"] <= 32]
    return {"rows": rows, "table": table, "checks": checks}
