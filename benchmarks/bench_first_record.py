"""From the start of `linefeed print --while-importing` until the first record of a large file is in the printer, and until it is on a product.

The printer's conveyor always runs. The same file read whole before anything is printed shows what printing while importing saves.
"""
import pathlib
import statistics
import subprocess
import tempfile
import time

import benchlib

NAME = "first_record"
DESCRIPTION = "time until the first record of a file is in the printer, printing while importing"
RATE = 500
LIMIT_MS = 100
PATIENCE_S = 120


def first_record_ms(source, directory, options):
    """(in the printer, on a product), counted from the start of the process."""
    printer = benchlib.Printer(directory, RATE)
    process = None
    try:
        with benchlib.Tap(printer.ports[0]) as tap:
            spool = pathlib.Path(tempfile.mkdtemp(prefix="first", dir=directory)) / "spool.db"
            begun = time.monotonic_ns()
            process = subprocess.Popen([str(benchlib.BIN / "linefeed"), "print", str(source), "--printer", f"tcp://127.0.0.1:{tap.port}",
                                        "--spool", str(spool), *options], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            while tap.first_record_ns is None:
                if process.poll() is not None or time.monotonic_ns() - begun > PATIENCE_S * 1e9:
                    raise RuntimeError("nothing was printed")
                time.sleep(0.001)
            printer.wait_for_prints()
            process.kill()
            process.wait()
        report = printer.stop()
    finally:
        if process:
            process.kill()
            process.wait()
        printer.kill()
    for file in spool.parent.iterdir():
        file.unlink()
    return (tap.first_record_ns - begun) / 1e6, (report["printers"][0]["first_print_ns"] - begun) / 1e6


def run(quick):
    rows, rounds = (1_000_000, 5) if quick else (10_000_000, 9)
    with benchlib.workspace() as directory:
        source = directory / "records.csv"
        benchlib.write_csv(source, rows)
        streamed = [first_record_ms(source, directory, ("--while-importing",)) for _ in range(rounds)]
        whole = [first_record_ms(source, directory, ()) for _ in range(1 if quick else 3)]
    table = [f"{rows} rows of 30 bytes; milliseconds from the start of the process; {rounds} starts while importing, {len(whole)} behind the import",
             f"{'':18}{'first record in the printer':>36}{'first product':>36}", f"{'':18}" + f"{'median':>12}{'least':>12}{'most':>12}" * 2]
    for label, seen in (("while importing", streamed), ("import, then print", whole)):
        table.append(f"{label:18}" + "".join(f"{figure(times):12.1f}" for times in zip(*seen) for figure in (statistics.median, min, max)))
    in_printer = statistics.median(times[0] for times in streamed)
    checks = [{"check": "printing begins in less than half the time of the import", "ok": in_printer < min(times[0] for times in whole) / 2}]
    if not quick:
        checks.append({"check": f"the first record is in the printer within {LIMIT_MS} ms (median)", "ok": in_printer <= LIMIT_MS})
        checks.append({"check": f"the first record is in the printer within {LIMIT_MS} ms (worst)",
                       "ok": max(times[0] for times in streamed) <= LIMIT_MS})
    return {"rows": rows, "while_importing_ms": streamed, "whole_ms": whole, "table": table, "checks": checks}
