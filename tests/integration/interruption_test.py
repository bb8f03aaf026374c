"""Whatever interrupts a run, the same command again ends it: over all runs, every record is on the tape once, in order."""

import csv
import re
import sqlite3
import time

import harness
from harness import names, rows

RATE = 400


class Interruption(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.records = names(1200)
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
        """The printer has lost its memory. Its total print counter says where it is, but not whether that print was finished: exactly
        that record is in doubt, and the operator reads it off the last product."""
        on_tape = [line for printer in {restarted, *printers_before} for line in printer.prints()]
        number, text = max(on_tape)
        result = self.print(self.file, restarted)
        self.assert_code(6, result)
        doubtful = re.findall(r"^in doubt: (\d+)  (.*)$", result.out, re.MULTILINE)
        self.assertEqual((str(number), text), doubtful[0])
        # The counter does not tell whether it counts a print as it begins or as it ends: the next record may be half printed too.
        self.assertEqual([str(number + 1)], [doubt[0] for doubt in doubtful[1:]])
        self.finish(restarted, *printers_before, options=("--last-printed", text))

    def assert_ledger_complete(self, job):
        """Every row of the ledger is chained, every record of the job is printed, and the database is whole."""
        result = harness.Job([str(harness.BIN / "linefeed"), "ledger", str(job), "--verify", "--spool", str(self.spool)]).wait()
        self.assert_code(0, result)
        exported = harness.Job([str(harness.BIN / "linefeed"), "ledger", str(job), "--export", "csv", "--spool", str(self.spool)]).wait()
        self.assert_code(0, exported)
        rows_of_ledger = list(csv.DictReader(exported.out.splitlines()))
        self.assertEqual([(str(number), "printed") for number, _ in self.records], [(r["number"], r["state"]) for r in rows_of_ledger])
        with sqlite3.connect(f"file:{self.spool}?mode=ro", uri=True) as spool:
            self.assertEqual([("ok",)], spool.execute("PRAGMA integrity_check").fetchall())
        spool.close()


class Signals(Interruption):
    def stop_by(self, number):
        printer = self.simulator("--rate", RATE)
        job = self.start(self.file, printer)
        printer.wait_for_prints(300)
        job.signal(number)
        result = job.wait()
        self.assert_stopped(result, "stopped on request")
        printed = len(printer.prints())
        self.assertEqual(printed + 1, self.continues_with(result), "the record named is the one behind the last product")
        self.assertIn(f"last printed {printed}", result.out)
        time.sleep(0.2)
        self.assertEqual(printed, len(printer.prints()), "the line stands still")
        self.finish(printer)
        self.assert_clean(printer.stop())

    def test_interrupt(self):
        self.stop_by(harness.INTERRUPT)

    def test_terminate(self):
        self.stop_by(harness.TERMINATE)

    def test_interrupt_again_and_again(self):
        printer = self.simulator("--rate", RATE)
        for count in (1, 150, 300, 301, 640, 1100):
            job = self.start(self.file, printer)
            printer.wait_for_prints(count)
            job.signal(harness.INTERRUPT)
            # Before the program has begun to watch for signals it simply dies; nothing is lost by that.
            self.assertIn(job.wait().code, (0, 4, -harness.INTERRUPT))
        self.finish(printer)

    def test_interrupt_before_the_first_product(self):
        printer = self.simulator("--rate", RATE, "--start-delay-ms", 2000)
        job = self.start(self.file, printer)
        time.sleep(0.7)
        job.signal(harness.INTERRUPT)
        result = job.wait()
        self.assert_code(4, result)
        self.assertEqual(1, self.continues_with(result))
        self.assertEqual([], printer.prints())


class PrinterStops(Interruption):
    def test_operator_stops_the_printer(self):
        printer = self.simulator("--rate", RATE, "--stop-at-print", 500)
        result = self.print(self.file, printer)
        self.assert_stopped(result, "stopped at the printer")
        self.assertEqual(501, self.continues_with(result))
        self.finish(printer)

    def test_operator_stops_the_printer_three_times(self):
        printer = self.simulator("--rate", RATE, "--stop-at-print", 1, "--stop-at-print", 256, "--stop-at-print", 1199)
        for record in (2, 257, 1200):
            result = self.print(self.file, printer)
            self.assert_stopped(result)
            self.assertEqual(record, self.continues_with(result))
        self.finish(printer)

    def test_printer_error(self):
        printer = self.simulator("--rate", RATE, "--error-at-print", "500:12113")
        result = self.print(self.file, printer)
        self.assert_stopped(result, "12113")
        self.assertEqual(501, self.continues_with(result))
        # The error is nobody's to acknowledge but the operator's.
        again = self.print(self.file, printer)
        self.assert_stopped(again, "12113", "--acknowledge 12113")
        self.assertEqual(500, len(printer.prints()))
        self.finish(printer, options=("--acknowledge", "12113"))

    def test_cover_opened(self):
        printer = self.simulator("--rate", RATE, "--cover-open-at-print", 500)
        result = self.print(self.file, printer)
        self.assert_code(4, result)
        self.assertEqual(501, self.continues_with(result))
        self.assert_stopped(self.print(self.file, printer), "cover")
        self.assertEqual(500, len(printer.prints()))
        printer.stop()
        # The same printer, switched off and on, with its cover closed.
        restarted = self.simulator("--rate", RATE, "--total-prints", 500)
        self.finish(restarted, printer)

    def test_print_broken_off_is_in_doubt(self):
        options = ("--rate", 50, "--print-ms", 9, "--habit", "abort-print-on-stop", "--stop-at-print", 20)
        for word, expected in (("skip", list(range(1, 31))), ("reprint", [*range(1, 21), *range(20, 31)])):
            with self.subTest(in_doubt=word):
                self.setUp()
                self.file = self.write_csv(rows(self.records[:30]))
                printer = self.simulator(*options)
                result = self.print(self.file, printer)
                self.assert_code(6, result)
                self.assertIn(f"in doubt: 20  {self.records[19][1]}", result.out)
                again = self.print(self.file, printer)
                self.assert_code(6, again)
                self.assertEqual(20, len(printer.prints()), "nothing is printed before the operator has decided")
                self.assert_code(0, self.print(self.file, printer, "--in-doubt", word))
                self.assertEqual(expected, [number for number, _ in printer.prints()])

    def test_operator_reads_the_last_product(self):
        options = ("--rate", 50, "--print-ms", 9, "--habit", "abort-print-on-stop", "--stop-at-print", 20)
        for last, expected in ((20, list(range(1, 31))), (19, [*range(1, 21), *range(20, 31)])):
            with self.subTest(last_printed=last):
                self.setUp()
                self.file = self.write_csv(rows(self.records[:30]))
                printer = self.simulator(*options)
                self.assert_code(6, self.print(self.file, printer))
                self.assert_code(0, self.print(self.file, printer, "--last-printed", self.records[last - 1][1]))
                self.assertEqual(expected, [number for number, _ in printer.prints()])


class Connection(Interruption):
    def test_cut(self):
        printer = self.simulator("--rate", RATE, "--cut-at-print", 500)
        result = self.print(self.file, printer)
        self.assert_stopped(result, "connection")
        self.finish(printer)

    def test_cut_and_continued_when_the_printer_has_run_empty(self):
        printer = self.simulator("--rate", RATE, "--cut-at-print", 500)
        result = self.print(self.file, printer)
        self.assert_stopped(result, "connection")
        self.assertRegex(result.out, "asks the printer how far")
        time.sleep(256 / RATE + 0.3)
        self.finish(printer)

    def test_printer_mute(self):
        printer = self.simulator("--rate", RATE)
        proxy = self.proxy(printer)
        proxy.simulator = printer
        job = self.start(self.file, proxy, "--reply-timeout", 300)
        printer.wait_for_prints(400)
        proxy.mute()
        self.assert_stopped(job.wait(), "does not answer")
        self.assert_code(3, self.print(self.file, proxy, "--reply-timeout", 300))
        proxy.heal()
        self.finish(proxy)

    def test_printer_mute_for_good(self):
        printer = self.simulator("--rate", RATE, "--mute-at-print", 400)
        self.assert_stopped(self.print(self.file, printer, "--reply-timeout", 300), "does not answer")
        printer.stop()
        # It is switched off and on: its memory is gone, but the total print counter is not.
        restarted = self.simulator("--rate", RATE, "--total-prints", len(printer.prints()))
        self.finish_by_last_product(restarted, printer)

    def test_mains_off_and_on(self):
        printer = self.simulator("--rate", RATE, "--power-cycle-at-print", 500)
        self.assert_code(4, self.print(self.file, printer))
        self.finish_by_last_product(printer)

    def test_another_printer_at_the_same_address(self):
        printer = self.simulator("--rate", RATE, "--cut-at-print", 500)
        self.assert_stopped(self.print(self.file, printer))
        printer.stop()
        other = self.simulator("--rate", RATE, "--serial-number", "999")
        result = self.print(self.file, other)
        self.assert_code(6, result)
        self.assertEqual([], other.prints())

    def test_foreign_prints_meanwhile(self):
        printer = self.simulator("--rate", RATE, "--cut-at-print", 500)
        self.assert_stopped(self.print(self.file, printer))
        printer.stop()
        # It was switched off, and printed 1000 products of somebody else's job afterwards: nobody can know.
        restarted = self.simulator("--rate", RATE, "--total-prints", len(printer.prints()) + 1000)
        result = self.print(self.file, restarted)
        self.assert_code(6, result)
        self.assertIn("in doubt: ", result.out)
        self.assertEqual([], restarted.prints())


class Crash(Interruption):
    def crash_at(self, printer, count):
        job = self.start(self.file, printer)
        printer.wait_for_prints(count)
        job.kill()

    def test_killed_and_continued_at_once(self):
        printer = self.simulator("--rate", RATE)
        self.crash_at(printer, 400)
        self.finish(printer)

    def test_killed_and_continued_when_the_printer_has_run_empty(self):
        printer = self.simulator("--rate", RATE)
        self.crash_at(printer, 400)
        time.sleep(256 / RATE + 0.3)
        self.finish(printer)

    def test_killed_again_and_again(self):
        printer = self.simulator("--rate", RATE)
        for count in (1, 2, 120, 300, 500, 700, 701, 900):
            self.crash_at(printer, count)
        self.finish(printer)

    def test_killed_near_the_end(self):
        printer = self.simulator("--rate", RATE)
        self.crash_at(printer, 1100)
        time.sleep(0.5)
        self.assert_printed(self.records, printer)
        self.finish(printer)

    def test_killed_at_any_time_of_the_start(self):
        printer = self.simulator("--rate", RATE)
        for delay_ms in (5, 10, 20, 30, 40, 60, 80, 120):
            job = self.start(self.file, printer)
            time.sleep(delay_ms / 1000)
            job.kill()
        self.finish(printer)

    def test_killed_and_the_printer_switched_off(self):
        printer = self.simulator("--rate", RATE)
        self.crash_at(printer, 400)
        printer.stop()
        restarted = self.simulator("--rate", RATE, "--total-prints", len(printer.prints()))
        self.finish_by_last_product(restarted, printer)

    def test_second_instance_is_refused_and_does_no_harm(self):
        printer = self.simulator("--rate", RATE)
        job = self.start(self.file, printer)
        printer.wait_for_prints(100)
        other = self.write_csv([["x"]], name="other.csv")
        second = self.print(other, self.simulator("--rate", RATE))
        self.assert_one_clear_line(1, second, "spool.db")
        self.assert_code(0, job.wait())
        self.assert_printed(self.records, printer)


if __name__ == "__main__":
    harness.main()
