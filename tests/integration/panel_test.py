"""Somebody at the printer's panel, and somebody else who talks to it: a second client presses the keys. Every record is on a product
once, or it was named as in doubt and the operator has looked."""

import threading
import time

import harness
import interruption
from harness import names, rows
from interruption import FOREIGN

RATE = 800


class Panel(interruption.Interruption):
    count = 900

    def test_nozzle_closed(self):
        printer = self.simulator("--rate", RATE, "--nozzle-opening-ms", 200)
        job = self.start(self.file, printer)
        printer.wait_for_prints(200)
        panel = self.client(printer)
        panel.send("!NC")
        self.assert_stopped(job.wait())
        printed = len(printer.prints())
        again = self.print(self.file, printer)
        self.assert_stopped(again, "nozzle")
        self.assertEqual(printed + 1, self.continues_with(again))
        self.assertEqual(printed, len(printer.prints()))
        panel.send("!NO")
        while panel.ask("?RS")[0] != "2":
            time.sleep(0.05)
        self.finish(printer)

    def restart(self, hold, *options):
        """Stopped and started again with a refill under way, which then finds the FIFO empty. Returns linefeed's result."""
        printer = self.simulator("--rate", RATE, "--start-delay-ms", 300, *options)
        proxy = self.proxy(printer)
        job = self.start(self.file, proxy)
        printer.wait_for_prints(150)
        panel = self.client(printer)
        proxy.hold_refill()
        panel.send("!ST")
        self.assertEqual("5", panel.ask("?RS")[1])
        if hold == "until it stands":
            proxy.heal()
            panel.send("!GO")  # over another connection: mostly behind the refill
        else:
            panel.send("!GO")
            self.assertEqual("6", panel.ask("?RS")[1])
            proxy.heal()
        return printer, job.wait()

    def test_restarted_before_a_refill_arrives(self):
        """The records that the stop threw away are on no product, though the last product has a number behind them."""
        printer, result = self.restart("until it prints")
        numbers = [number for number, _ in printer.prints()]
        self.assert_code(6, result)
        self.assert_ledger_honest(printer)
        holes = set(range(1, numbers[-1])) - set(numbers)
        self.assertTrue(holes, "otherwise this is another test")
        self.assertLessEqual(holes, set(self.in_doubt(result)), "named record by record")
        wrong = self.print(self.file, printer, "--last-printed", numbers[-1])
        self.assert_one_clear_line(2, wrong, "--printed")
        outside = self.print(self.file, printer, "--printed", f"1-{numbers[-1]}")
        self.assert_one_clear_line(2, outside, "only these records are in doubt")
        self.assertEqual(len(numbers), len(printer.prints()), "nothing is printed on a word that tells too little")
        answered = self.print(self.file, printer, *self.looked_at(result, printer))
        self.assertIn(answered.code, (0, 4), str(answered))
        self.finish_by_products(printer, in_order=False)

    def test_restarted_behind_a_refill(self):
        printer, result = self.restart("until it stands")
        self.assertIn(result.code, (4, 6), str(result))
        self.assert_ledger_honest(printer)
        answer = self.looked_at(result, printer)
        self.print(self.file, printer, *answer)
        self.finish_by_products(printer, in_order=False)


class SecondClient(interruption.Interruption):
    count = 900

    def test_inquiries_disturb_nothing(self):
        printer = self.simulator("--rate", RATE)
        other = self.client(printer)
        done = threading.Event()
        asked = []

        def ask():
            while not done.is_set():
                for inquiry in ("?SM", "?RS", "?CC", "?VS", "?JL", "?EL"):
                    asked.append(other.ask(inquiry))

        thread = threading.Thread(target=ask, daemon=True)
        thread.start()
        result = self.print(self.file, printer)
        done.set()
        thread.join()
        self.assert_done(result)
        self.assertGreater(len(asked), 100)
        self.assert_printed(self.records, printer)
        self.assert_clean(printer.stop())

    def say(self, *frames, options=()):
        """A second client says it in mid-run; the job is ended all the same."""
        printer = self.simulator("--rate", RATE)
        job = self.start(self.file, printer)
        printer.wait_for_prints(200)
        self.client(printer).send(*frames)
        result = job.wait()
        self.assertIn(result.code, (0, 4, 6), str(result))
        self.assert_ledger_honest(printer)
        answer = self.looked_at(result, printer)
        if answer:
            self.print(self.file, printer, *options, *answer)
        self.finish_by_products(printer, options=options, in_order=False)
        return printer, result

    def test_stops(self):
        _, result = self.say("!ST")
        self.assert_stopped(result, "stopped at the printer")

    def test_flushes(self):
        self.say("!FF")

    def test_sends_a_record_with_a_number_of_its_own(self):
        self.say("=MR999999\tforeign 999999")

    def test_sends_a_record_without_number(self):
        self.say("=MR0\tforeign 0")

    def test_takes_the_stop_point_away(self):
        self.say("=CM0")

    def test_moves_the_stop_point(self):
        """Message 1223 says that the last record is printed; it is not ours."""
        self.say("=CM700")

    def test_switches_length_prefixes_and_echo_on(self):
        _, result = self.say("!LN", "!EM")
        self.assert_code(0, result)

    def test_loads_another_job(self):
        self.say("=JL\\FFSDISK\\JOBS\\other.job")


class OtherJob(interruption.Interruption):
    """Other records printed on the same printer meanwhile, by another host that knows nothing of our ledger, or by this one."""

    count = 700

    def setUp(self):
        super().setUp()
        self.other = self.write_csv(rows((n, f"{FOREIGN} {n}") for n, _ in names(40)), name="other.csv")

    def print_other(self, printer, *options, spool="other"):
        result = self.print(self.other, printer, *options, spool=self.directory / spool / "spool.db")
        self.assert_code(0, result)

    def test_after_a_stop(self):
        printer = self.simulator("--rate", RATE)
        job = self.start(self.file, printer)
        printer.wait_for_prints(200)
        job.signal(harness.INTERRUPT)
        result = job.wait()
        self.assert_stopped(result)
        self.print_other(printer)
        self.assertEqual(1, len(self.finish_by_products(printer)), "the counter has moved, the ledger has not")

    def crash(self, printer, count=200):
        job = self.start(self.file, printer)
        printer.wait_for_prints(count)
        job.kill()
        time.sleep(256 / RATE + 0.2)

    def test_by_another_host_after_a_crash(self):
        printer = self.simulator("--rate", RATE)
        self.crash(printer)
        self.print_other(printer)
        results = self.finish_by_products(printer)
        self.assertEqual([6, 0], [result.code for result in results])

    def test_by_the_same_host_after_a_crash(self):
        """It asks the printer for the first job before it flushes."""
        printer = self.simulator("--rate", RATE)
        self.crash(printer)
        self.print_other(printer, spool="state")
        self.assertEqual(1, len(self.finish_by_products(printer)))

    def test_after_mains_off_and_a_crash(self):
        printer = self.simulator("--rate", RATE)
        self.crash(printer)
        printer.stop()
        restarted = self.simulator("--rate", RATE, "--total-prints", len(printer.prints()))
        self.print_other(restarted)
        results = self.finish_by_products(restarted, printer)
        self.assertEqual([6, 0], [result.code for result in results])


if __name__ == "__main__":
    harness.main()
