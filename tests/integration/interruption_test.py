"""Whatever interrupts a run, the same command again ends it: over all runs, every record is on the tape once, in order, or it was
named as in doubt and the operator has looked.

Where each interruption of issue 3 is tested with the real programs. tests/simulation has all of them at random moments besides.

operator stop at the printer        PrinterStops.test_operator_stops_the_printer*; panel_test SecondClient.test_stops
stop by linefeed                    Signals
printer error in mid-run            PrinterStops.test_printer_error
FIFO ran empty                      dry_test RunsDry: the host is suspended; what it sends does not get through
cover opened                        PrinterStops.test_cover_opened
nozzle closed                       panel_test Panel.test_nozzle_closed
stopped and started at the panel    panel_test Panel.test_restarted*
link cut and back within seconds    Connection.test_cut, test_cut_and_back_within_seconds (taken over: no stop, no flush)
link cut until the FIFO ran dry     Connection.test_cut_and_continued_when_the_printer_has_run_empty
printer power-cycled                Connection.test_mains_off_and_on, test_printer_mute_for_good
another job printed meanwhile       panel_test OtherJob; Connection.test_foreign_prints_meanwhile
a different printer                 Connection.test_another_printer_at_the_same_address
kill -9 at any point                Crash; kill_test
host power lost                     Crash, and tests/storage/power_loss_test.cpp for what the disk keeps
both lost                           Crash.test_killed_and_the_printer_switched_off; panel_test OtherJob.test_after_mains_off_and_a_crash
firmware that ignores =CM           habits_test; dry_test Firmware.test_stop_point_ignored (with stop, cut, kill)
stale =SM                           habits_test; dry_test Firmware.test_stale_mail_status (with stop, cut, kill)
length prefixes or echo left on     habits_test; dry_test Firmware.test_length_prefixes_and_echo_left_on (with stop, cut, kill)
a second client                     panel_test SecondClient

"How existing hosts lose or double records" (field-notes.md), line by line:
 1 flush without reading =SM        Connection.test_nothing_is_flushed_before_the_printer_was_asked_twice, test_cut_and_back_within_seconds
 2 re-queue from the older =SM      dry_test Firmware.test_stale_mail_status; tests/simulation/mutations/02
 3 "print finished" = 0 ignored     PrinterStops.test_print_broken_off_is_in_doubt, test_operator_reads_the_last_product
 4 sent records written off         Connection.test_cut*
 5 unconfirmed records issued again Connection.test_cut_when_everything_is_sent; Crash.test_killed_near_the_end
 6 a blind !EQ                      PrinterStops.test_printer_error (the conversation has none)
 7 a counter that others move       panel_test OtherJob
 8 a file read half written         tests/unit/intake/import_test.cpp ("changed while it was read"). There is no drop folder yet
 9 one read = one message           dry_test Firmware.test_answers_byte_by_byte; tests/unit/protocol/frame_decoder_split_test.cpp
10 printed when it was sent         Connection.test_sent_is_not_printed; assert_ledger_honest() at every stop of panel_test and dry_test
"""

import time

import harness
import interruption
from harness import rows
from interruption import RATE


class Signals(interruption.Interruption):
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


class PrinterStops(interruption.Interruption):
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
        proxy = self.proxy(printer)
        result = self.print(self.file, proxy)
        self.assert_stopped(result, "12113")
        self.assertEqual(501, self.continues_with(result))
        # The error is nobody's to acknowledge but the operator's.
        again = self.print(self.file, proxy)
        self.assert_stopped(again, "12113", "--acknowledge 12113")
        self.assertEqual(500, len(printer.prints()))
        self.assertNotIn("!EQ", proxy.said())
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


class Connection(interruption.Interruption):
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


    def test_cut_and_back_within_seconds(self):
        """The printer prints on, and so it is left alone: no stop, no flush, no start. Twice, since a run that was taken over is a run."""
        printer = self.simulator("--rate", RATE)
        for count in (200, 500):
            proxy = self.proxy(printer)
            job = self.start(self.file, proxy)
            printer.wait_for_prints(count)
            proxy.cut()
            self.assert_stopped(job.wait(), "connection")
        taken_over = self.proxy(printer)
        result = self.finish(taken_over)
        self.assertIn("taken over without a stop", result.err)
        self.assertIn("?SM", taken_over.said())
        self.assertEqual(set(), {"!FF", "!ST", "!GO"} & set(taken_over.said()))
        self.assert_clean(printer.stop())

    def test_nothing_is_flushed_before_the_printer_was_asked_twice(self):
        printer = self.simulator("--rate", RATE)
        proxy = self.proxy(printer)
        job = self.start(self.file, proxy)
        printer.wait_for_prints(200)
        proxy.cut()
        self.assert_stopped(job.wait(), "connection")
        time.sleep(256 / RATE + 0.2)
        again = self.proxy(printer)
        self.finish(again)
        said = again.said()
        self.assertGreaterEqual(said[:said.index("!FF")].count("?SM"), 2, said[:20])
        self.assertNotIn("=MR", [word[:3] for word in said[:said.index("!FF")]])

    def test_cut_when_everything_is_sent(self):
        """The printer ends the job by itself: what was never confirmed is not printed a second time."""
        printer = self.simulator("--rate", RATE, "--cut-at-print", 1150)
        self.assert_stopped(self.print(self.file, printer), "connection")
        time.sleep(50 / RATE + 0.2)
        self.assert_ledger_honest(printer)
        self.assert_printed(self.records, printer)
        self.finish(printer)

    def test_sent_is_not_printed(self):
        """What has gone out and is not confirmed is neither printed nor unused for the ledger, as long as nobody knows."""
        printer = self.simulator("--rate", RATE)
        proxy = self.proxy(printer)
        job = self.start(self.file, proxy)
        printer.wait_for_prints(200)
        proxy.cut()
        self.assert_stopped(job.wait(), "connection")
        self.assert_ledger_honest(printer)
        self.finish(printer)


class Crash(interruption.Interruption):
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
