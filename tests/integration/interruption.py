"""What the tests of interruptions have in common: the same command again ends the job, and the tapes are judged."""

import contextlib
import csv
import re
import sqlite3
import time

import harness
from harness import names, rows

RATE = 400
PAUSE_S = 0.3  # from one start to the next, if that did not end the job
MOST_STARTS = 8  # a job that needs more does not get on
FOREIGN = "foreign"  # texts of somebody else's products begin so


class Interruption(harness.TestCase):
    count = 1200

    def setUp(self):
        super().setUp()
        self.records = names(self.count)
        self.file = self.write_csv(rows(self.records))

    def continues_with(self, result):
        """The record that linefeed says it would continue with."""
        match = re.search(r"the same command again continues with record (\d+)$", result.out, re.MULTILINE)
        self.assertIsNotNone(match, str(result))
        return int(match.group(1))

    def assert_stopped(self, result, *words):
        self.assert_one_clear_line(4, result, *words)

    def finish(self, printer, *printers_before, options=()):
        """The same command again, to the end; then all tapes together."""
        result = self.print(self.file, printer, *options)
        self.assert_code(0, result)
        self.assert_printed(self.records, *printers_before, getattr(printer, "simulator", printer))
        self.assert_ledger_complete(int(re.match(r"job (\d+): ", result.out).group(1)))
        return result

    def finish_by_last_product(self, restarted, *printers_before):
        """The printer has lost its memory, and its total print counter is only a bound: what may have been printed is in doubt, and the
        operator reads off the last product how far it came."""
        printers = list(dict.fromkeys((*printers_before, restarted)))
        number, text = [line for printer in printers for line in printer.prints()][-1]
        result = self.print(self.file, restarted)
        self.assert_code(6, result)
        doubtful = self.in_doubt(result)
        self.assertIn(number + 1, (*doubtful, doubtful[-1] + 1), str(result))
        self.assertGreaterEqual(number + 1, doubtful[0], str(result))
        self.assert_ledger_honest(*printers)
        self.finish(restarted, *printers_before, options=("--last-printed", text))

    def finish_by_products(self, printer, *printers_before, options=(), in_order=True):
        """The same command again until the job is done; when asked, the operator looks at all products. Returns the results."""
        printers = [*printers_before, getattr(printer, "simulator", printer)]
        results = []
        answer = ()
        while len(results) < MOST_STARTS:
            results.append(self.print(self.file, printer, *options, *answer))
            if results[-1].code == 0:
                break
            self.assertIn(results[-1].code, (4, 6), str(results[-1]))
            self.assert_ledger_honest(*printers)
            answer = self.looked_at(results[-1], *printers)
            time.sleep(PAUSE_S)
        self.assert_code(0, results[-1])
        printed = self.ours(*printers)
        self.judge(self.records, printed if in_order else sorted(printed))
        self.assert_ledger_complete(int(re.match(r"job (\d+): ", results[-1].out).group(1)))
        return results

    def looked_at(self, result, *printers):
        """What an operator says who has looked which of the records in doubt are on products."""
        if result.code != 6:
            return ()
        seen = {number for number, _ in self.ours(*printers)}
        return "--printed", ",".join(str(number) for number in self.in_doubt(result) if number in seen) or "none"

    def in_doubt(self, result):
        """The records in doubt. linefeed has named the first of them one by one and counted the rest, which its ledger names."""
        numbers = [number for number, state in self.states().items() if state == "in_doubt"]
        named = [int(number) for number in re.findall(r"^in doubt: (\d+)  ", result.out, re.MULTILINE)]
        more = re.search(r"^in doubt: (\d+) more", result.out, re.MULTILINE)
        self.assertEqual(numbers[:len(named)], named, str(result))
        self.assertEqual(len(numbers), len(named) + (int(more.group(1)) if more else 0), str(result))
        return numbers

    def states(self):
        """What the ledger says of each record that was ever issued, of all jobs of the file in the spool."""
        with contextlib.closing(sqlite3.connect(f"file:{self.spool}?mode=ro", uri=True)) as spool:
            segments = spool.execute("SELECT first, s.records, s.state FROM ledger_segments s JOIN jobs ON jobs.id = job "
                                     "WHERE source_path = ? ORDER BY first", (str(self.file),)).fetchall()
        return {number: state for first, count, state in segments for number in range(first, first + count)}

    def ours(self, *printers):
        """What is on the tapes of the records of this job: without products of others and the blank behind the last record."""
        texts = dict(self.records)
        blank = (self.records[-1][0] + 1, "")
        prints = [line for printer in printers for line in printer.prints()]
        return [(n, t) for n, t in prints if (n, t.strip()) != blank and not (t.startswith(FOREIGN) and texts.get(n) != t)]

    def assert_ledger_honest(self, *printers):
        """What the ledger says to be printed is on a product, and what it says not to be printed is on none."""
        on_tape = {number for number, _ in self.ours(*printers)}
        states = self.states()
        self.assertEqual([], [n for n, state in states.items() if state == "printed" and n not in on_tape], "not on a product")
        self.assertEqual([], [n for n in sorted(on_tape) if states.get(n, "fresh") in ("fresh", "unused")], "on a product all the same")

    def assert_ledger_complete(self, job):
        """Every row of the ledger is chained, every record of the job is printed, and the database is whole."""
        result = harness.Job([str(harness.BIN / "linefeed"), "ledger", str(job), "--verify", "--spool", str(self.spool)]).wait()
        self.assert_code(0, result)
        exported = harness.Job([str(harness.BIN / "linefeed"), "ledger", str(job), "--export", "csv", "--spool", str(self.spool)]).wait()
        self.assert_code(0, exported)
        rows_of_ledger = list(csv.DictReader(exported.out.splitlines()))
        self.assertEqual([(str(number), "printed") for number, _ in self.records], [(r["number"], r["state"]) for r in rows_of_ledger])
        with contextlib.closing(sqlite3.connect(f"file:{self.spool}?mode=ro", uri=True)) as spool:
            self.assertEqual([("ok",)], spool.execute("PRAGMA integrity_check").fetchall())
