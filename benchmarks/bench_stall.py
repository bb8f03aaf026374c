"""The longest stall of the host that no PrintGo notices: the process is stopped (SIGSTOP) for a while, bisecting on the time.

Theory: depth / rate − 3 ms. A full FIFO lasts depth periods, and the first record after the stall must be there 3 ms before its PrintGo.
A host cannot reach it quite, since a stall may begin when the FIFO is not full: one poll interval and one block below. So
each length is tried several times, at random phases, and survives only if it survives every time.
"""
import random
import signal
import time

import benchlib

NAME = "stall"
DESCRIPTION = "Longest stall survived, against depth / rate - 3 ms"
LATE_S = 0.003  # a stall that this program itself ended later than this does not count


def theory(rate):
    return benchlib.DEPTH / rate - benchlib.MARGIN_S


class Line:
    """One printer with a host that keeps printing."""

    def __init__(self, printer, process):
        self.printer, self.process = printer, process
        self.random = random.Random(4711)
        self.printer.wait_for_prints(2 * benchlib.DEPTH)

    def survives(self, stall_s):
        """One stall. None if it could not be made."""
        time.sleep(self.random.uniform(0.05, 0.30))
        before = self.printer.progress()[1]
        self.process.send_signal(signal.SIGSTOP)
        begun = time.monotonic()
        time.sleep(stall_s)
        self.process.send_signal(signal.SIGCONT)
        lasted = time.monotonic() - begun
        time.sleep(0.2 + 0.5 * benchlib.DEPTH / self.printer.rate)  # the FIFO is full again
        if self.process.poll() is not None:
            raise RuntimeError(f"the host has ended with exit code {self.process.returncode}")
        missed = self.printer.progress()[1] > before
        return None if missed and lasted > stall_s + LATE_S else not missed

    def always_survives(self, stall_s, times):
        seen = []
        for _ in range(3 * times):
            survived = self.survives(stall_s)
            if survived is False:
                return False
            if survived:
                seen.append(survived)
            if len(seen) == times:
                return True
        return False


def longest(host, rate, delay_ms, steps, times, directory):
    limit = theory(rate)
    low, high = 0.2 * limit, 1.02 * limit
    records = int(rate * (steps + 2) * times * 3 * (limit + 1))  # enough for every stall
    best = 0.0
    with benchlib.line(host, directory, rate, records, reply_delay_ms=delay_ms) as parts:
        line = Line(*parts)
        for _ in range(steps):
            middle = (low + high) / 2
            if line.always_survives(middle, times):
                best = low = middle
            else:
                high = middle
    return {"rate": rate, "delay_ms": delay_ms, "stall_ms": best * 1e3, "theory_ms": limit * 1e3, "ratio": best / limit}


def run(quick):
    linefeed = benchlib.linefeed_options()
    hosts = {"linefeed": linefeed} if quick else {"linefeed": linefeed, "bare loop": "bare"}
    cases = [(1000, 1.0)] if quick else [(rate, delay) for rate in (500, 1000) for delay in (1.0, 5.0, 20.0)]
    rows = []
    with benchlib.workspace() as directory:
        for rate, delay in cases:
            for label, host in hosts.items():
                rows.append({"host": label, **longest(host, rate, delay, 4 if quick else 7, 2 if quick else 4, directory)})
        if quick and rows[0]["ratio"] < 0.8:  # is it linefeed or the machine?
            rows.append({"host": "bare loop", **longest("bare", *cases[0], 4, 2, directory)})
    table = [f"{'host':12}{'rate/s':>8}{'delay ms':>10}{'longest stall ms':>18}{'theory ms':>11}{'ratio':>8}"]
    for row in rows:
        table.append(f"{row['host']:12}{row['rate']:8}{row['delay_ms']:10g}{row['stall_ms']:18.1f}{row['theory_ms']:11.1f}{row['ratio']:8.0%}")
    table.append("theory = depth / rate - 3 ms; each length survives only if it does so at every one of several random phases")
    possible = {(row["rate"], row["delay_ms"]): min(row["ratio"], 1.0) for row in rows if row["host"] == "bare loop"}
    checks = [{"check": f"linefeed survives 80 % of the theoretical stall at {row['rate']}/s and {row['delay_ms']:g} ms, or of the bare loop's",
               "ok": row["ratio"] >= 0.8 * possible.get((row["rate"], row["delay_ms"]), 1.0)}
              for row in rows if row["host"] == "linefeed"]
    return {"rows": rows, "table": table, "checks": checks}
