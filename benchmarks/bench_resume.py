"""From the start of `linefeed print` with a job that is printed in part until the job goes on, as the job and the ledger grow.

Two ends of the run before: Ctrl-C, behind which the printer stands, and kill -9 of linefeed, whose printer prints on and is taken over.
LINEFEED_BENCH_LARGE=1 adds a job of 50 million records: that takes some 6 GB of disk and two minutes.
"""
import os
import shutil
import signal
import statistics
import subprocess
import time

import benchlib

NAME = "resume"
DESCRIPTION = "time from the start until a job goes on, at growing jobs and ledgers"
RATE = 100  # the smallest job must last for all rounds
GROWTH = 2  # of the median, at most, from the smallest job to any other
PATIENCE_S = 300
ENDS = {"Ctrl-C": signal.SIGINT, "kill -9": signal.SIGKILL}
AWAY_S = 0.3  # of a killed linefeed, so that the printer has room when it comes back


class Line:
    """A job on a printer, its spool, and what has come out."""

    def __init__(self, directory, records):
        directory.mkdir()
        self.directory = directory
        self.spool = directory / "spool.db"
        self.source = directory / "records.csv"
        self.tape = directory / "tape.csv"
        benchlib.write_csv(self.source, records)
        self.printer = benchlib.Printer(directory, RATE, "--tape", str(self.tape))

    def close(self):
        self.printer.kill()
        shutil.rmtree(self.directory)

    def prints(self):
        """Times of the products, ns since the epoch. The last line of the tape may be half written."""
        lines = self.tape.read_bytes().split(b"\n")[1:-1] if self.tape.exists() else []
        return [int(line.split(b",", 1)[0]) for line in lines]

    def print_a_little(self, stop):
        """(first record sent, first product), in ms from the start of linefeed, which is ended then."""
        with benchlib.Tap(self.printer.ports[0]) as tap:
            begun, begun_wall = time.monotonic_ns(), time.time_ns()
            process = subprocess.Popen([str(benchlib.BIN / "linefeed"), "print", str(self.source), "--printer", f"tcp://127.0.0.1:{tap.port}",
                                        "--spool", str(self.spool)], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                while tap.first_record_ns is None or self.prints()[-1:] < [begun_wall]:
                    if process.poll() is not None or time.monotonic_ns() - begun > PATIENCE_S * 1e9:
                        raise RuntimeError(f"linefeed does not print: exit code {process.poll()}")
                    time.sleep(0.001)
            finally:
                process.send_signal(stop)
                process.wait()
            product = next(at for at in self.prints() if at > begun_wall)
        return (tap.first_record_ns - begun) / 1e6, (product - begun_wall) / 1e6


def make_ledger_long(line, records):
    subprocess.run([str(benchlib.BIN / "bench_long_ledger"), "--spool", str(line.spool), "--records", str(records)], check=True)


def ledger_rows(line):
    return int(subprocess.run(["sqlite3", str(line.spool), "SELECT count(*) FROM ledger"], check=True, capture_output=True, text=True).stdout)


def measure(directory, records, printed_before, rounds):
    """The rounds of one job; `printed_before` = so many of its records stand in the ledger already, one by one."""
    line = Line(directory / f"{records}-{printed_before}", records)
    try:
        if printed_before:
            subprocess.run([str(benchlib.BIN / "linefeed"), "print", str(line.source), "--printer", "tcp://127.0.0.1:1", "--spool", str(line.spool)],
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)  # imports, and finds no printer
            make_ledger_long(line, printed_before)
        line.print_a_little(signal.SIGINT)
        rows = [{"records": records, "ended by": label, "rows": ledger_rows(line), "ms": []} for label in ENDS]
        for row in rows:
            stop = ENDS[row["ended by"]]
            line.print_a_little(stop)
            for _ in range(rounds):
                time.sleep(AWAY_S if stop == signal.SIGKILL else 0)
                row["ms"].append(line.print_a_little(stop))
        return rows
    finally:
        line.close()


def run(quick):
    sizes = [(1_000, 0), (200_000, 20_000)] if quick else [(1_000, 0), (1_000_000, 0), (1_000_000, 500_000)]
    if os.environ.get("LINEFEED_BENCH_LARGE") and not quick:
        sizes.append((50_000_000, 0))
    with benchlib.workspace() as directory:
        rows = [row for records, printed in sizes for row in measure(directory, records, printed, 5 if quick else 9)]
    table = ["milliseconds from the start of linefeed; first record: sent to the printer; first product: made behind the start",
             f"{'records':>9} {'ledger rows':>12}  {'ended by':10}{'first record':>30}{'first product':>30}",
             f"{'':34}" + f"{'median':>10}{'least':>10}{'most':>10}" * 2]
    checks = []
    for row in rows:
        table.append(f"{row['records']:9} {row['rows']:12}  {row['ended by']:10}" +
                     "".join(f"{figure(times):10.1f}" for times in zip(*row["ms"]) for figure in (statistics.median, min, max)))
        row["median_ms"] = statistics.median(times[0] for times in row["ms"])
        smallest = next(other for other in rows if other["ended by"] == row["ended by"])
        if row is not smallest:
            checks.append({"check": f"behind {row['ended by']}, {row['records']} records and {row['rows']} ledger rows take at most {GROWTH:g} times as "
                                    f"long as {smallest['records']} records", "ok": row["median_ms"] <= GROWTH * smallest["median_ms"]})
    return {"rows": rows, "table": table, "checks": checks}
