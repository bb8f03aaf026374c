"""The highest rate without a miss, by bisection, at each reply delay, against theory and against other hosts.

Theory, the credit loop. What a host may send is what `=SM` says has been printed, and it learns that late:
- `=SM` is a sample, and the next is one poll interval p later: what is printed right behind a sample waits up to p to be noticed;
- the answer takes the reply delay d from the sample to the host;
- the record must lie in the printer for the margin m = 3 ms before its PrintGo.
Record n may go when record n − depth has been printed, and must be there m before its own PrintGo, depth periods later. So
    depth / rate ≥ p + d + m,   highest rate = depth / (p + d + m)
with p = 1 ms, the shortest beat of the design (section 4); inquiries overlap, so p may be shorter than d. A host that asks only after the
answer has p = d: depth / (2 d + m). The known-bad host sends one record an inquiry: 1 / d
whatever the depth (so a short FIFO, which tells sooner, is enough). The manual asks once a second and
sends blocks of 50: (depth rounded down to 50) / 1 s.

At short delays theory is beyond what the simulator can do on a small machine: the bare loop shows what is possible, and a row with a shorter FIFO
shows the same loop at rates that the machine can give.
"""
import sys
import time

import benchlib

NAME = "highest_rate"
DESCRIPTION = "Highest rate without a miss, by reply delay"
SHORTEST_POLL_S = 0.001
DELAYS_MS = (0.1, 1.0, 5.0, 20.0, 100.0)
SHORT_FIFO = 64
TINY_FIFO = 8
MOST_RATE = 100000  # of linefeed-sim


def theory(delay_ms, depth):
    return depth / (SHORTEST_POLL_S + delay_ms / 1000 + benchlib.MARGIN_S)


def probe(host, rate, delay_ms, depth, directory, least_s):
    """One run at a rate. ok: no avoidable miss, and the simulator kept up with the rate."""
    seconds = max(least_s, 4 * depth / rate)
    # More records than can be printed in the time: the end of a job is not measured here.
    records = int(rate * (seconds + 1)) // 1000 * 1000 + 1000
    with benchlib.Hiccups() as hiccups, benchlib.line(host, directory, rate, records, reply_delay_ms=delay_ms, depth=depth) as (printer, _):
        time.sleep(seconds)
        report = printer.stop()
    seen = benchlib.judge(report, hiccups.stalls, rate, depth)
    kept_up = seen["rate_seen"] >= 0.97 * rate
    return {"rate": rate, "ok": seen["avoidable"] == 0 and kept_up, "kept_up": kept_up, **seen}


def settled_probe(*arguments):
    """A run that a long stall of the platform may have spoilt is repeated."""
    for _ in range(3):
        seen = probe(*arguments)
        if seen["ok"] or seen["longest_stall_ms"] < 3:
            break
    return seen


def bisect(host, low, high, steps, *rest):
    """The highest rate that was seen to go without a miss, in [low, high], and the probes. 0 if not even `low` goes."""
    probes = []

    def goes(rate):
        probes.append(settled_probe(host, rate, *rest))
        return probes[-1]["ok"]

    best = 0.0
    if goes(high):
        best = high
    else:
        for _ in range(steps):
            # The geometric mean: the range may span orders of magnitude, and only the relative precision counts.
            middle = round((low * high) ** 0.5) if high > 2 * low else round((low + high) / 2)
            if goes(middle):
                best = low = middle
            else:
                high = middle
    worst = next((seen for seen in reversed(probes) if not seen["ok"]), None)
    limit = "none" if worst is None else "simulator" if not worst["kept_up"] else "host"
    return best, limit, probes


def run(quick):
    linefeed = benchlib.linefeed_options()
    if quick:
        cases = [(5.0, SHORT_FIFO, {"linefeed": linefeed})]
    else:
        hosts = {"linefeed": linefeed, "bare loop": "bare"}
        # The manual's rate does not depend on delays of this size: measured once.
        cases = [(delay, depth, {**hosts, **({"known-bad": "single"} if depth == benchlib.DEPTH else {}),
                                 **({"manual": "manual"} if depth == benchlib.DEPTH and delay == 5.0 else {})})
                 for depth in (benchlib.DEPTH, SHORT_FIFO) for delay in DELAYS_MS]
    rows = []
    with benchlib.workspace() as directory:
        for delay, depth, hosts in cases:
            limit_rate = theory(delay, depth)
            row = {"delay_ms": delay, "depth": depth, "theory": limit_rate, "theory_without_poll": depth / (delay / 1000 + benchlib.MARGIN_S),
                   "hosts": {}}
            while missing := [label for label in hosts if label not in row["hosts"]]:
                label, host = missing[0], hosts[missing[0]]
                low, high, steps, fifo = limit_rate * 0.25, min(limit_rate * 1.02, MOST_RATE), 4 if quick else 6, depth
                if label == "known-bad":
                    low, high, fifo = 0.2e3 / delay, min(1.5e3 / delay, limit_rate), TINY_FIFO if delay >= 5 else SHORT_FIFO
                elif label == "manual":
                    low, high = 50, 400
                best, limit, probes = bisect(host, low, high, steps, delay, fifo, directory, 1.0 if quick else 1.5)
                print(f"  FIFO of {fifo}, {delay:g} ms, {label}: {best:.0f}/s", file=sys.stderr, flush=True)
                row["hosts"][label] = {"rate": best, "limited_by": limit, "probes": probes}
                if quick and label == "linefeed" and best < 0.8 * limit_rate:
                    hosts["bare loop"] = "bare"  # is it linefeed or the machine?
            rows.append(row)
    labels = list(dict.fromkeys(label for row in rows for label in row["hosts"]))
    table = [f"linefeed's options: {' '.join(linefeed) or 'none'}; the bare loop has the same precedence",
             "theory = depth / (poll 1 ms + reply delay + margin 3 ms), the limit of the credit loop (see the head of bench_highest_rate.py)",
             "without poll = depth / (reply delay + margin): no host can be faster. (sim): the simulator did not keep up with higher rates",
             f"{'depth':>6}{'delay ms':>10}{'theory/s':>10}{'no poll/s':>11}" + "".join(f"{label + '/s':>13}{'':>13}" for label in labels)]
    for row in rows:
        line = f"{row['depth']:6}{row['delay_ms']:10g}{row['theory']:10.0f}{row['theory_without_poll']:11.0f}"
        for label in labels:
            seen = row["hosts"].get(label)
            share = "" if seen is None else f" {seen['rate'] / row['theory']:4.0%}{' (sim)' if seen['limited_by'] == 'simulator' else ''}"
            line += f"{'' if seen is None else format(seen['rate'], '.0f'):>13}{share:<13}"
        table.append(line)
    checks = []
    if quick:
        possible = min(rows[0]["theory"], rows[0]["hosts"].get("bare loop", {"rate": rows[0]["theory"]})["rate"])
        checks.append({"check": f"linefeed reaches 80 % of theory at 5 ms (FIFO of {SHORT_FIFO}), or of the bare loop if that does not",
                       "ok": rows[0]["hosts"]["linefeed"]["rate"] >= 0.8 * possible})
    return {"rows": rows, "table": table, "checks": checks}
