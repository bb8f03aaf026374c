"""Printers on a serial line: pseudo-terminals on which every byte takes the time of the line speed, and may be damaged or lost."""

import os
import signal
import time

import harness
from harness import names, rows


class SerialTestCase(harness.TestCase):
    def line(self, *options, baud=115200, query=""):
        """A simulator and the address of its serial port."""
        port = self.directory / f"port{baud}"
        printer = self.simulator("--serial", port, "--baud", baud, *options)
        printer.serial = f"serial://{port}?baud={baud}{query}"
        return printer

    def print_all(self, printer, count, patience_s=120):
        records = names(count)
        result = self.print(self.write_csv(rows(records)), printer.serial, patience_s=patience_s)
        self.assert_code(0, result)
        self.assert_printed(records, printer)
        return result


class Serial(SerialTestCase):
    def test_115200_baud(self):
        printer = self.line("--rate", 200)
        result = self.print_all(printer, 600)
        self.assertIn("the serial line carries about ", result.err)
        self.assertIn("Without crc=on", result.err)
        self.assert_clean(printer.stop())

    def test_9600_baud(self):
        printer = self.line("--rate", 10, baud=9600)
        self.print_all(printer, 120)
        self.assert_clean(printer.stop())

    def test_9600_baud_secured(self):
        printer = self.line("--rate", 5, baud=9600, query="&crc=on")
        result = self.print_all(printer, 60)
        self.assertIn("secured by CRC32", result.err)
        self.assertNotIn("Without crc=on", result.err)
        self.assert_clean(printer.stop())

    def test_ctrl_c_and_on(self):
        printer = self.line("--rate", 50, query="&crc=on")
        records = names(300)
        file = self.write_csv(rows(records))
        job = self.start(file, printer.serial)
        printer.wait_for_prints(60)
        job.signal(signal.SIGINT)
        self.assert_code(4, job.wait())
        self.assert_code(0, self.print(file, printer.serial))
        self.assert_printed(records, printer)

    def test_kill_9_and_on(self):
        for query in ("", "&crc=on"):
            with self.subTest(query):
                printer = self.line("--rate", 50, query=query, baud=115200 if query else 57600)
                records = names(300)
                file, spool = self.write_csv(rows(records)), self.directory / f"spool{len(query)}.db"
                job = self.start(file, printer.serial, spool=spool)
                printer.wait_for_prints(60)
                job.kill()
                self.assert_code(0, self.print(file, printer.serial, spool=spool))
                self.assert_printed(records, printer)

    def test_adapter_pulled_out_and_plugged_in_again(self):
        printer = self.line("--rate", 50, "--cut-at-print", 60)
        records = names(300)
        file = self.write_csv(rows(records))
        result = self.print(file, printer.serial)
        self.assert_code(4, result)
        gone = self.print(file, f"serial://{self.directory}/gone")
        self.assert_code(3, gone)
        self.assertIn("there is no such device: is the adapter plugged in?", gone.err)
        deadline = time.monotonic() + harness.PATIENCE_S
        while not os.path.exists(self.directory / "port115200") and time.monotonic() < deadline:
            time.sleep(0.05)
        self.assert_code(0, self.print(file, printer.serial))
        self.assert_printed(records, printer)

    def test_one_program_at_a_time(self):
        printer = self.line("--rate", 50)
        records = names(200)
        job = self.start(self.write_csv(rows(records)), printer.serial)
        printer.wait_for_prints(20)
        second = self.print(self.write_csv(rows(names(5)), name="other.csv"), printer.serial, spool=self.directory / "other.db")
        self.assert_code(3, second)
        self.assertIn("the port is in use by another program", second.err)
        self.assert_code(0, job.wait())
        self.assert_printed(records, printer)

    def test_wrong_addresses(self):
        file = self.write_csv(rows(names(5)))
        for address, words in (("serial:///dev/x?baud=9601", "no speed of"), ("serial://ttyUSB0", "absolute path"),
                               ("serial:///dev/x?flow=xon", "flow is rtscts or none"), ("tcp://p?crc=yes", "crc is on or off")):
            with self.subTest(address):
                self.assert_one_clear_line(2, self.print(file, address), words)


class SerialNoise(SerialTestCase):
    """With CRC32 the tape is exact whatever the line does to the bytes; a longer job with LINEFEED_LONG_TESTS."""

    COUNT = 20000 if harness.LONG else 600
    PATIENCE_S = 3600 if harness.LONG else 240

    def test_damaged_bytes(self):
        printer = self.line("--rate", 30, "--damage", 2000, query="&crc=on")
        result = self.print_all(printer, self.COUNT, self.PATIENCE_S)
        self.assertGreater(printer.stop()["damaged_frames"], 0, "the noise did not reach the printer")
        print(f"{self.COUNT} records, one byte in 2000 damaged: {result.err.count('going on')} stops because of noise")

    def test_lost_bytes(self):
        printer = self.line("--rate", 30, "--loss", 5000, query="&crc=on")
        self.print_all(printer, self.COUNT // 2, self.PATIENCE_S)

    def test_over_tcp(self):
        """A terminal server has the noise behind it, so the policy goes with any address."""
        printer = self.simulator("--rate", 100)
        records = names(300)
        self.assert_code(0, self.print(self.write_csv(rows(records)), printer.address + "?crc=on"))
        self.assert_printed(records, printer)
        self.assert_clean(printer.stop())

    def test_without_crc_numbers_hold(self):
        """Nobody notices a changed letter; but no number is printed twice or left out unnoticed."""
        printer = self.line("--rate", 30, "--damage", 2000)
        records = names(self.COUNT // 2)
        file = self.write_csv(rows(records))
        code, runs = 4, 0
        while code in (3, 4, 6) and runs < self.COUNT // 10:
            runs += 1
            result = self.print(file, printer.serial, "--in-doubt", "skip", patience_s=self.PATIENCE_S)
            code = result.code
        self.assertEqual(0, code, str(result))
        doubtful = {number for number, _ in records} - {number for number, _ in printer.prints()}
        printed = [number for number, _ in printer.prints()]
        print(f"without CRC: {runs} runs, {len(printed)} prints, {len(doubtful)} skipped as in doubt")
        self.assertEqual(sorted(set(printed)), printed, "a number twice, or out of order")


if __name__ == "__main__":
    harness.main()
