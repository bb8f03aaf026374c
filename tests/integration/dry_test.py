"""The FIFO runs dry because the host does not get on, and firmware habits together with interruptions: the same command again ends the
job, and every record is on a product once."""

import signal
import time

import harness
import interruption
from harness import rows
from interruption import RATE

DRY_S = 256 / RATE + 0.3  # a full FIFO is printed by then


class RunsDry(interruption.Interruption):
    count = 800

    def test_host_suspended(self):
        """Stopped and continued later, as a laptop is, while the conveyor runs on."""
        printer = self.simulator("--rate", RATE)
        job = self.start(self.file, printer)
        printer.wait_for_prints(200)
        job.signal(signal.SIGSTOP)
        time.sleep(DRY_S)
        printed = len(printer.prints())
        job.signal(signal.SIGCONT)
        result = job.wait()
        self.assert_stopped(result, "5043")
        self.assertEqual(printed + 1, self.continues_with(result))
        self.finish(printer)

    def test_nothing_gets_through(self):
        """What was held on the way arrives when the printer has run empty: it is not for this moment any more."""
        printer = self.simulator("--rate", RATE)
        proxy = self.proxy(printer)
        job = self.start(self.file, proxy)
        printer.wait_for_prints(200)
        proxy.hold_refill()
        time.sleep(DRY_S)
        proxy.heal()
        self.assert_stopped(job.wait(), "5043")
        self.assert_ledger_honest(printer)
        self.finish(proxy)

    def test_products_that_do_not_wait(self):
        """The conveyor runs whether the printer prints or not, so the first product comes at once behind the start. Its record has to
        be in the printer 3 ms before."""
        printer = self.simulator("--rate", RATE, "--free-running")
        result = self.print(self.file, printer)
        self.assert_done(result)
        self.assert_printed(self.records, printer)
        self.assert_clean(printer.stop())


class Firmware(interruption.Interruption):
    """Habits of firmwares, each with a stop at the printer, a cut, a kill -9 while it prints and one after which it runs empty."""

    count = 700

    def interrupt(self, *options):
        for interruption_, more in (("stop", ("--stop-at-print", 250)), ("cut", ("--cut-at-print", 250)), ("kill", ()), ("kill, dry", ())):
            with self.subTest(options=options, interruption=interruption_):
                self.setUp()
                printer = self.simulator("--rate", 2 * RATE, *options, *more)
                job = self.start(self.file, printer)
                if more:
                    result = job.wait()
                    self.assert_code(4, result)
                else:
                    printer.wait_for_prints(200)
                    job.kill()
                    time.sleep(DRY_S / 2 if interruption_ == "kill, dry" else 0)
                self.assertEqual([0], [result.code for result in self.finish_by_products(printer)])

    def test_stop_point_ignored(self):
        self.interrupt("--habit", "ignore-stop-at")

    def test_stop_point_kept_only_while_printing(self):
        self.interrupt("--habit", "stop-at-only-while-printing")

    def test_stale_mail_status(self):
        """Who believed the first answer behind a stop would print again what was printed since the inquiry before."""
        self.interrupt("--habit", "stale-mail-status")

    def test_length_prefixes_and_echo_left_on(self):
        self.interrupt("--length-prefix", "--echo", "--habit", "crlf")

    def test_stale_mail_status_and_stop_point_ignored(self):
        self.interrupt("--habit", "stale-mail-status", "--habit", "ignore-stop-at")

    def test_answers_byte_by_byte(self):
        """One read is not one message."""
        printer = self.simulator("--rate", 100, "--length-prefix", "--echo", "--stop-at-print", 60)
        self.records = self.records[:120]
        self.file = self.write_csv(rows(self.records))
        proxy = self.proxy(printer, crumbs=True)
        self.assert_stopped(self.print(self.file, proxy))
        self.finish(proxy)


if __name__ == "__main__":
    harness.main()
